//! Maps: their data, what is derived from it, and where maps come from.

mod load;
mod network;

pub use crate::baking::BakeError;
pub use crate::map_data::*;
pub use crate::places::Ground;
pub use load::{BUNDLED, bake, bundled};
pub use network::RoadNetwork;

#[cfg(test)]
mod tests;
