//! Rigid bodies: the only file that names rapier.

use std::sync::{Arc, OnceLock};

/// The static colliders of a map, built on first use and shared by all its worlds.
#[derive(Clone, Debug, Default)]
pub struct Statics(OnceLock<Arc<()>>);
