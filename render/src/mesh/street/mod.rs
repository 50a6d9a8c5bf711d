//! What stands and lies along a street: surfaces, houses, trees, posts, barriers, furniture.

pub mod barrier;
pub mod building;
mod glyphs;
pub mod hedge;
pub mod lamp;
pub mod loose;
pub mod sign;
pub mod signal;
pub mod street_furniture;
pub mod structure;
pub mod surface;
pub mod tree;
