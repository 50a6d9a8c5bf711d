//! Questions about places on a map: the nearest lane, the ground below.

mod grid;
mod ground;
mod index;
mod parked;
mod roads;

pub(crate) use grid::Grid;
pub use ground::Ground;
pub(crate) use index::Places;
pub(crate) use parked::ParkedCars;
pub(crate) use roads::{LaneGrid, Roads};
