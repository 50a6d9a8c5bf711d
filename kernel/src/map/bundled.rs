//! The maps that come with A-Eye.

use std::sync::Arc;

use super::RoadNetwork;

/// Names of the bundled maps.
pub const BUNDLED: [&str; 2] = ["city", "rural"];

/// A bundled map by name.
pub fn bundled(_name: &str) -> Option<Arc<RoadNetwork>> {
    todo!()
}
