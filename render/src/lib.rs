//! From a snapshot of the scene to pixels: colour, class, instance and depth from one pass.
//!
//! [`Renderer::draw`] takes what the kernel says there is to see and gives a [`Frame`] whose planes
//! come from the same draw and carry the same tick, so that they cannot be misaligned. Nothing
//! here reads the clock; the same adapter and driver give the same bits for the same scene.

pub mod adapter;
pub mod camera;
mod error;
mod frame;
mod renderer;
pub mod tags;

pub use adapter::{AdapterChoice, AdapterInfo, adapters};
pub use camera::{Camera, Mount};
pub use error::RenderError;
pub use frame::Frame;
pub use renderer::{Preset, RenderOptions, Renderer};
pub use tags::SemanticTag;
