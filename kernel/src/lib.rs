//! The deterministic world of A-Eye.
//!
//! A [`World`] advances in fixed ticks from a [`Scenario`], a [`RoadNetwork`] and one [`TickInput`]
//! a tick. Nothing else reaches it: no clock, file, thread, environment variable or GPU. The same
//! inputs give the same [`StateHash`] on every machine; `DETERMINISM.md` says how far that goes.
//!
//! Coordinates follow ISO 8855 and OpenDRIVE: metres, x east, y north, z up, radians
//! counter-clockwise. Steering is positive to the right, as devices and CARLA have it.

mod actor;
/// Some helpers of tests are for those beside `src` too.
#[cfg(test)]
extern crate self as kernel;

pub mod arbiter;
mod baking;
pub mod car;
pub mod controls;
pub mod ego;
pub mod events;
pub mod geometry;
mod identity;
mod light;
pub mod map;
mod map_data;
pub mod motion;
pub mod ops;
pub mod physics;
mod places;
pub mod rng;
pub mod route;
pub mod scenario;
pub mod scene;
pub mod signals;
pub mod state;
pub mod story;
pub mod time;
pub mod traffic;
pub mod watch;
pub mod weather;
pub mod world;

pub use controls::{Controls, Seat, TickInput};
pub use identity::{ENGINES, identity};
pub use map::RoadNetwork;
pub use scenario::Scenario;
pub use scene::SceneSnapshot;
pub use state::StateHash;
pub use world::{Keyframe, TickOutput, World, WorldError};
