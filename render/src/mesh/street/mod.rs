//! What stands and lies along a street: surfaces, houses, trees, posts, barriers, furniture.

mod along;
pub mod barrier;
pub mod building;
mod drain;
pub mod furniture;
mod glyphs;
pub mod hedge;
pub mod lamp;
pub mod sign;
pub mod signal;
pub mod structure;
pub mod surface;
pub mod tree;
mod verge;
