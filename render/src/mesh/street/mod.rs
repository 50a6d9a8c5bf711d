//! What stands and lies along a street: surfaces, houses, trees, posts, barriers, furniture.

pub mod barrier;
pub mod building;
pub mod hedge;
pub mod loose;
pub mod posts;
pub mod signal;
pub mod street_furniture;
pub mod structure;
pub mod surface;
pub mod tree;
