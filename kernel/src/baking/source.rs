//! The file that a map is baked from, and where each lane came from.

use std::collections::BTreeMap;

use super::error::BakeError;
use super::limits::{self, Checked};
use super::notes::Notes;
use super::warnings;
use crate::map_data::LaneId;

/// A parsed file, and where each baked lane came from.
pub(super) struct Source {
    pub net: xodr::RoadNetwork,
    pub provenance: xodr::Provenance,
    /// What was subtracted from the coordinates of the file, metres east and north.
    pub origin_m: [f64; 2],
    /// Elements `<road>` of the file.
    pub roads: usize,
    /// By [`LaneId`].
    pub origins: Vec<Origin>,
    /// The way back from xodr's ids.
    pub ids: BTreeMap<usize, LaneId>,
    /// The lanes of each section, in ascending order.
    sections: BTreeMap<Section, Vec<LaneId>>,
}

/// Where a lane came from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Origin {
    pub lane: xodr::LaneId,
    pub road: usize,
    pub section: usize,
    pub od_id: i32,
    /// Whether it is driven along its road's reference line.
    pub forward: bool,
}

/// A road and the index of one of its sections.
type Section = (usize, usize);

impl Origin {
    /// The road and direction that lanes of one approach to a junction share.
    pub fn approach(&self) -> Approach {
        (self.road, self.forward)
    }
}

/// One road driven in one direction.
pub(super) type Approach = (usize, bool);

/// Height of a pavement above the road where the file gives none, metres.
const KERB_M: f32 = 0.125;

impl Source {
    /// The file, before any lane is baked.
    pub fn read(text: &str, notes: &mut Notes) -> Result<Self, BakeError> {
        let Checked { text, origin_m, roads } = limits::check(text, notes)?;
        let (net, provenance) = xodr::load_str_with_provenance(&text).map_err(|error| explain(error, roads))?;
        warnings::note(&provenance.warnings, notes);
        let (origins, ids, sections) = (Vec::new(), BTreeMap::new(), BTreeMap::new());
        Ok(Self { net, provenance, origin_m, roads, origins, ids, sections })
    }

    /// Remembers where the next lane came from.
    pub fn remember(&mut self, origin: Origin) {
        let id = self.origins.len() as LaneId;
        self.ids.insert(origin.lane.0, id);
        self.sections.entry((origin.road, origin.section)).or_default().push(id);
        self.origins.push(origin);
    }

    /// The lanes of the section that a lane is in, itself among them.
    pub fn section_of(&self, lane: LaneId) -> &[LaneId] {
        let origin = &self.origins[lane as usize];
        &self.sections[&(origin.road, origin.section)]
    }

    /// How far a lane stands above the road: pavements do, unless the file raises them itself.
    pub fn rise(&self, lane: LaneId) -> f32 {
        let origin = self.origins[lane as usize];
        let told = self.told_of(origin.lane);
        let is_raised = told.is_some_and(|p| p.heights.iter().any(|h| h.inner > 0.02 || h.outer > 0.02));
        if is_raised { 0.0 } else { KERB_M }
    }

    /// Where a signal takes effect, by its index in the file.
    pub fn place_of_signal(&self, signal: usize) -> String {
        self.provenance.signals.get(signal).map_or_else(String::new, |p| along(&p.road_id, p.s))
    }

    /// Where an object stands, by its index in the file.
    pub fn place_of_object(&self, object: usize) -> String {
        self.provenance.objects.get(object).map_or_else(String::new, |p| match p.road_id.is_empty() {
            true => format!("junction {}", p.junction_id),
            false => along(&p.road_id, p.s),
        })
    }

    /// Where a road mark begins, by its index in the file.
    pub fn place_of_mark(&self, mark: usize) -> String {
        self.provenance.road_marks.get(mark).map_or_else(String::new, |p| along(&p.road_id, p.s))
    }

    /// The road, section and number of a lane.
    pub fn place_of_lane(&self, lane: xodr::LaneId) -> String {
        let at = self.net.road_lane(lane);
        let road = at.and_then(|at| self.net.road(at.road)).map_or("", |road| road.od_id());
        at.map_or_else(String::new, |at| format!("road {road}, section {}, lane {}", at.section, at.od_id))
    }

    /// What the file says that a lane is made of, along its centre line.
    pub fn materials(&self, lane: xodr::LaneId) -> &[xodr::Along<xodr::Material>] {
        let all = self.net.lane_materials();
        let (from, to) = (all.partition_point(|m| m.lane.0 < lane.0), all.partition_point(|m| m.lane.0 <= lane.0));
        &all[from..to]
    }

    /// What xodr remembers of a lane: its records are in the order of their lanes.
    fn told_of(&self, lane: xodr::LaneId) -> Option<&xodr::LaneProvenance> {
        let lanes = &self.provenance.lanes;
        let at = lanes.binary_search_by_key(&lane.0, |p| p.lane.0).ok()?;
        Some(&lanes[at])
    }
}

/// A place along a road.
fn along(road: &str, s_m: f64) -> String {
    format!("road {road}, s {s_m:.1} m")
}

/// The refusal of a file with so many roads, where there is no lane to drive on.
pub(super) fn nowhere_to_drive(roads: usize) -> BakeError {
    let expected = "expected a road with a length, a plan view, and a lane of type driving that has a width";
    let reason = match roads {
        0 => format!("{expected}, but there is no road"),
        1 => format!("{expected}, but the only road is none"),
        _ => format!("{expected}, but none of the {roads} roads is one"),
    };
    whole(reason)
}

/// What xodr says of a file where no road has any lane.
const NO_LANES: &str = "no lanes found";

fn explain(error: xodr::ImportError, roads: usize) -> BakeError {
    use xodr::ImportError as E;
    match error {
        E::Xml(e) => limits::malformed(&e),
        E::Malformed(what) if what == NO_LANES => nowhere_to_drive(roads),
        E::Malformed(what) => whole(format!("expected OpenDRIVE that can be read, but it has {what}")),
        other => whole(format!("expected OpenDRIVE that can be read, but {other}")),
    }
}

fn whole(reason: String) -> BakeError {
    BakeError { place: "the whole file".to_owned(), reason }
}
