//! Scenes shared by the integration tests and the benchmarks.

pub mod command;
pub mod files;
pub mod protobuf;
pub mod recordings;
pub mod roads;
pub mod scenes;
pub mod street;
pub mod town;
pub mod toy;
