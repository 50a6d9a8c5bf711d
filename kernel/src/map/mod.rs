//! Maps: their data, what is derived from it, and where maps come from.

mod load;
mod network;

pub use crate::baking::{BakeError, Baked, Control, Mark, Passed, PassedOver, Told, bake_with_notes};
pub use crate::map_data::*;
pub use crate::places::Ground;
pub use load::{BUNDLED, bake, bundled, bundled_text};
pub use network::RoadNetwork;

#[cfg(test)]
mod tests;
