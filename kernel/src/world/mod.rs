//! The world: everything that happens in a tick.

mod bodies;
mod doors;
mod error;
mod keyframe;
mod output;
mod snapshot;
mod start;
mod tick;
mod view;

pub use error::WorldError;
pub use keyframe::{FieldDifference, Keyframe};
pub use output::TickOutput;
pub use snapshot::PARTS;
pub use tick::{KEYFRAME_GRACE_TICKS, World};
