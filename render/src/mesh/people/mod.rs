//! People: their builds and clothes, what they carry, and how they walk.

mod baggage;
pub(super) mod figure;
mod head;
mod outfit;
pub mod person;
