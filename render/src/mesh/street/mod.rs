//! What stands and lies along a street: surfaces, houses, trees, posts, barriers, furniture.

mod along;
pub mod barrier;
pub mod building;
pub mod loose;
pub mod posts;
pub mod signal;
pub mod street_furniture;
pub mod structure;
pub mod surface;
pub mod tree;
mod verge;
