//! People: their builds and clothes, what they carry, and how they walk.

pub mod appearance;
mod baggage;
pub(super) mod figure;
mod head;
mod outfit;
pub mod person;
