//! Scenes shared by the integration tests and the benchmarks.

pub mod scenes;
pub mod street;
