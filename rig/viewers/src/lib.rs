//! Drives and recordings for viewers of robot logs (Foxglove, Lichtblick, Rerun): road users as boxes, the
//! figures of a tick, and a server that shows a drive as it goes.

pub mod boxes;
pub mod events;
pub mod feed;
pub mod figures;
pub mod messages;
pub mod server;
