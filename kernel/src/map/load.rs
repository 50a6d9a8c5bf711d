//! Where maps come from: OpenDRIVE texts, some of which come with A-Eye.

use std::sync::{Arc, OnceLock};

use super::network::RoadNetwork;
use crate::baking::{self, BakeError};

/// Names of the bundled maps.
pub const BUNDLED: [&str; 7] = ["city", "rural", "old_town", "suburb", "ring", "motorway", "lakeside"];

/// What they are baked from; `kernel/maps/author.py` writes these.
const TEXTS: [&str; BUNDLED.len()] = [
    include_str!("../../maps/city.xodr"),
    include_str!("../../maps/rural.xodr"),
    include_str!("../../maps/old_town.xodr"),
    include_str!("../../maps/suburb.xodr"),
    include_str!("../../maps/ring.xodr"),
    include_str!("../../maps/motorway.xodr"),
    include_str!("../../maps/lakeside.xodr"),
];

/// Bakes the text of an OpenDRIVE file; `name` goes into [`MapData::name`](crate::map_data::MapData).
///
/// # Errors
/// When the text is not well-formed XML, or holds no lane to drive on.
pub fn bake(name: &str, xodr: &str) -> Result<RoadNetwork, BakeError> {
    baking::bake(name, xodr).map(|map| RoadNetwork::from(map).of_text(xodr))
}

/// The OpenDRIVE text of a bundled map by name.
pub fn bundled_text(name: &str) -> Option<&'static str> {
    BUNDLED.iter().position(|known| *known == name).map(|k| TEXTS[k])
}

/// A bundled map by name, baked on first use.
pub fn bundled(name: &str) -> Option<Arc<RoadNetwork>> {
    static MAPS: [OnceLock<Option<Arc<RoadNetwork>>>; BUNDLED.len()] = [const { OnceLock::new() }; BUNDLED.len()];
    let k = BUNDLED.iter().position(|known| *known == name)?;
    // A bundled map bakes: a test holds that.
    MAPS[k].get_or_init(|| bake(name, TEXTS[k]).ok().map(Arc::new)).clone()
}
