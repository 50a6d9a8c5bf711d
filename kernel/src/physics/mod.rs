//! Rigid bodies: the only folder that names rapier.
//!
//! Nothing in here is saved. A [`Physics`] is made anew from the world's compact state at every
//! keyframe, live and in replay alike, so that its caches never have to survive.

mod build;
mod engine;
mod statics;

pub use engine::{Hold, Physics, Touched};
pub use statics::Statics;
