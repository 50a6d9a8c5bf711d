//! The maps that come with A-Eye.

use std::sync::{Arc, OnceLock};

use super::{RoadNetwork, bake};

/// Names of the bundled maps.
pub const BUNDLED: [&str; 2] = ["city", "rural"];

/// What they are baked from; `kernel/maps/author.py` writes these.
const TEXTS: [&str; BUNDLED.len()] = [include_str!("../../maps/city.xodr"), include_str!("../../maps/rural.xodr")];

/// A bundled map by name, baked on first use.
pub fn bundled(name: &str) -> Option<Arc<RoadNetwork>> {
    static MAPS: [OnceLock<Option<Arc<RoadNetwork>>>; BUNDLED.len()] = [const { OnceLock::new() }; BUNDLED.len()];
    let k = BUNDLED.iter().position(|known| *known == name)?;
    // A bundled map bakes: a test holds that.
    MAPS[k].get_or_init(|| bake(name, TEXTS[k]).ok().map(Arc::new)).clone()
}
