//! A map with all that is derived from it.

use std::fmt;
use std::ops::Deref;
use std::sync::{Arc, OnceLock};

use glam::Vec3;

use crate::baking::{Survey, lights_by_id};
use crate::map_data::{LaneKind, LightGroupId, MapData, Projection};
use crate::physics::Statics;
use crate::places::{Ground, Places};
use crate::traffic::Ways;

/// A map, and what is derived from it: made on first use, once, and shared by every world on the map
/// and by all that look things up in it.
///
/// Deriving takes about 30 ms on a bundled map, as long as 500 ticks, so that a short replay or the
/// way back to a keyframe must not do it again. It cannot go stale: the data never changes in here,
/// and another map is made [`from`](From) other data.
pub struct RoadNetwork {
    map: Arc<MapData>,
    places: OnceLock<Arc<Places>>,
    statics: OnceLock<Arc<Statics>>,
    ways: OnceLock<Arc<Ways>>,
    /// The text that it was baked from; nothing where it was made otherwise.
    text: Arc<str>,
    survey: OnceLock<Option<Arc<Survey>>>,
    lights_by_id: OnceLock<Vec<(String, LightGroupId)>>,
}

impl From<MapData> for RoadNetwork {
    fn from(map: MapData) -> Self {
        Self {
            map: Arc::new(map),
            places: OnceLock::new(),
            statics: OnceLock::new(),
            ways: OnceLock::new(),
            text: Arc::from(""),
            survey: OnceLock::new(),
            lights_by_id: OnceLock::new(),
        }
    }
}

impl Deref for RoadNetwork {
    type Target = MapData;

    fn deref(&self) -> &MapData {
        &self.map
    }
}

impl fmt::Debug for RoadNetwork {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "RoadNetwork({}, {:032x})", self.name, self.digest)
    }
}

impl RoadNetwork {
    /// The same with the text that it was baked from.
    pub(crate) fn of_text(self, text: &str) -> Self {
        Self { text: Arc::from(text), ..self }
    }

    /// Its roads by their ids in the file, along their reference lines, to which other formats refer.
    pub(crate) fn survey(&self) -> Option<&Survey> {
        self.survey.get_or_init(|| Survey::of(&self.text).map(Arc::new)).as_deref()
    }

    /// Its traffic lights by the ids of their signals in the file.
    pub(crate) fn lights_of(&self, signal: &str) -> impl Iterator<Item = LightGroupId> + '_ {
        let all = self.lights_by_id.get_or_init(|| lights_by_id(&self.text).unwrap_or_default());
        let from = all.partition_point(|(id, _)| id.as_str() < signal);
        let named = all[from..].iter().take_while({
            let signal = signal.to_owned();
            move |(id, _)| *id == signal
        });
        named.map(|(_, group)| *group)
    }

    /// Where its lanes and its ground are.
    pub(crate) fn places(&self) -> &Arc<Places> {
        self.places.get_or_init(|| Arc::new(Places::new(&self.map)))
    }

    /// What physics starts from.
    pub(crate) fn statics(&self) -> &Arc<Statics> {
        self.statics.get_or_init(|| Arc::new(Statics::new(&self.map)))
    }

    /// What traffic looks up.
    pub fn ways(&self) -> &Arc<Ways> {
        self.ways.get_or_init(|| Arc::new(Ways::new(self.places())))
    }

    /// The lane of `kind` nearest to `position` among those within `radius_m`; lanes that overlap
    /// in a junction tie at distance, then the one whose direction is nearer to `heading_rad` wins.
    pub fn nearest_lane(
        &self,
        position: Vec3,
        kind: LaneKind,
        heading_rad: Option<f32>,
        radius_m: f32,
    ) -> Option<Projection> {
        self.places().roads().nearest(position, kind, heading_rad, radius_m)
    }

    /// The driving lane nearest to `position` within `radius_m` that leads about where `heading_rad` does (within 60
    /// degrees).
    pub fn nearest_leading(&self, position: Vec3, heading_rad: f32, radius_m: f32) -> Option<Projection> {
        self.places().roads().leading(position, heading_rad, radius_m)
    }

    /// The lanes of `kind` whose area holds `position`, in ascending order of their ids.
    pub fn lanes_at(&self, position: Vec3, kind: LaneKind) -> Vec<Projection> {
        self.places().roads().at(position, kind)
    }

    /// Whether `position` lies on a driving lane (by its area seen from above).
    pub fn on_road(&self, position: Vec3) -> bool {
        self.places().roads().on_road(position)
    }

    /// The highest ground at most 1 m above `position` and below it; `None` beyond the map.
    pub fn ground(&self, position: Vec3) -> Option<Ground> {
        self.places().ground(position)
    }
}
