//! What a tick is in Foxglove's protobuf messages (github.com/foxglove/foxglove-sdk/tree/main/schemas), and in a few
//! of our own: said once, for drives as they go and for files.
//!
//! What has a time takes it as nanoseconds: since 1970 of a drive that goes on, simulated in a file.

pub mod actors;
pub mod camera;
pub mod ground;
mod parts;
pub mod poses;
pub mod report;
pub mod rig;
pub mod telemetry;
pub mod topics;
