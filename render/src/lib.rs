//! From a snapshot of the scene to pixels: colour, class, instance and depth from one pass.
//!
//! [`Renderer::draw`] takes what the kernel says there is to see and gives a [`Frame`] whose planes
//! come from the same draw and carry the same tick, so that they cannot be misaligned. Nothing
//! here reads the clock; the same adapter and driver give the same bits for the same scene.

mod actors;
pub mod adapter;
pub mod camera;
mod castings;
mod clouds;
mod corners;
mod effects;
mod error;
mod frame;
mod glows;
mod gpu;
mod ground_textures;
mod horizon;
mod identity;
mod imaging;
mod instance_ids;
pub mod leaves;
mod light;
mod light_map;
pub mod mesh;
mod mirrors;
pub mod models;
mod night;
mod noise;
mod quality;
mod quincunx;
mod rain;
mod renderer;
mod scenery;
mod sensor;
#[cfg(test)]
mod shader_constants;
mod shadow_box;
mod shadows;
mod sieve;
mod spray;
mod street_lamps;
pub mod tags;
mod tile;
mod view;
pub mod wind;

pub use adapter::{AdapterChoice, AdapterInfo, adapters};
pub use camera::{Camera, Mount};
pub use effects::check_lens;
pub use error::RenderError;
pub use frame::Frame;
pub use identity::identity;
pub use imaging::Imaging;
pub use instance_ids::{EGO_INSTANCE, FIRST_PARKED_INSTANCE, actor_of_instance, instance_of_actor, instance_of_parked};
pub use models::ModelsId;
pub use quality::Quality;
pub use renderer::Renderer;
pub use sensor::Sensor;
pub use tags::SemanticTag;
