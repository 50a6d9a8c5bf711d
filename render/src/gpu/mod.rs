//! Everything that speaks to the graphics adapter.

mod attachments;
mod buffers;
mod device;
mod passes;
mod pipelines;
mod readback;
mod resolve;
mod shaders;
mod shadow_passes;
mod targets;
mod textures;

pub(crate) use buffers::{GrowingBuffer, SceneUniform};
pub(crate) use device::Gpu;
pub(crate) use passes::{Draws, Passes};
pub(crate) use pipelines::Lighting;
#[cfg(test)]
pub(crate) use readback::NEAR_M;
pub(crate) use shadow_passes::ShadowDraws;
pub(crate) use targets::Targets;
