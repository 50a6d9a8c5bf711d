//! OpenDRIVE text to [`RoadNetwork`]: the order of the steps, and what they share.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};

use super::{Index, LaneId, RoadNetwork};
use super::{crosswalks, digest, dressing, junctions, lanes, lights, props, surfaces, terrain, walk};
use crate::ops;

/// Why a text is not a usable map.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {reason}")]
pub struct BakeError {
    /// Where in the file: a line, a road, or the whole document.
    pub place: String,
    /// What is wrong, and what was expected.
    pub reason: String,
}

/// What the steps read: the parsed file, and where each baked lane came from.
pub(super) struct Source {
    pub net: xodr::RoadNetwork,
    pub provenance: xodr::Provenance,
    /// By [`LaneId`].
    pub origins: Vec<Origin>,
    /// The way back from xodr's ids.
    pub ids: BTreeMap<usize, LaneId>,
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

impl Origin {
    /// The road and direction that lanes of one approach to a junction share.
    pub fn approach(&self) -> Approach {
        (self.road, self.forward)
    }
}

/// One road driven in one direction.
pub(super) type Approach = (usize, bool);

/// Bakes the text of an OpenDRIVE file; `name` goes into [`RoadNetwork::name`].
///
/// # Errors
/// When the text is not well-formed XML, or holds no lane to drive on.
pub fn bake(name: &str, xodr: &str) -> Result<RoadNetwork, BakeError> {
    let mut source = read(xodr)?;
    let mut map = RoadNetwork { name: name.to_owned(), ..RoadNetwork::default() };
    lanes::bake(&mut source, &mut map)?;
    junctions::bake(&source, &mut map);
    crosswalks::bake(&source, &mut map);
    lights::bake(&source, &mut map);
    walk::bake(&source, &mut map);
    surfaces::bake(&source, &mut map);
    // After the paint: who waits without a sign has no line on the road.
    junctions::rank(&source, &mut map);
    map.bounds = bounds(&map);
    terrain::bake(&mut map);
    props::bake(&source, &mut map);
    dressing::bake(&source, &mut map);
    // Built while there was no ground yet.
    map.index = Index::default();
    map.digest = digest::of(&map);
    Ok(map)
}

fn read(text: &str) -> Result<Source, BakeError> {
    let (net, provenance) = xodr::load_str_with_provenance(text).map_err(explain)?;
    Ok(Source { net, provenance, origins: Vec::new(), ids: BTreeMap::new() })
}

fn explain(error: xodr::ImportError) -> BakeError {
    match error {
        xodr::ImportError::Xml(e) => BakeError {
            place: format!("line {}", e.pos().row),
            reason: format!("expected well-formed OpenDRIVE XML, but {e}"),
        },
        other => BakeError { place: "the whole file".to_owned(), reason: format!("expected OpenDRIVE: {other}") },
    }
}

/// Room around the lanes that belongs to the map, metres.
const MARGIN_M: f32 = 60.0;

fn bounds(map: &RoadNetwork) -> [Vec3; 2] {
    let mut low = Vec3::splat(f32::MAX);
    let mut high = Vec3::splat(f32::MIN);
    for p in map.lanes.iter().flat_map(|l| &l.points) {
        low = low.min(p.position);
        high = high.max(p.position);
    }
    let around = Vec3::new(MARGIN_M, MARGIN_M, 0.0);
    [low - around - Vec3::Z * 5.0, high + around + Vec3::Z * 40.0]
}

/// Rounds to 2^-10, in which the last bits of differing libm results vanish.
pub(super) fn snap(value: f32) -> f32 {
    ops::floor(value * 1024.0 + 0.5) / 1024.0
}

/// [`snap`] for each coordinate.
pub(super) fn snap3(v: Vec3) -> Vec3 {
    Vec3::new(snap(v.x), snap(v.y), snap(v.z))
}

/// A point of xodr, rounded.
pub(super) fn point(p: xodr::Point) -> Vec3 {
    snap3(Vec3::new(p.x, p.y, p.z))
}

/// The unit vector of a heading.
pub(super) fn direction(heading_rad: f32) -> Vec2 {
    Vec2::new(ops::cos(heading_rad), ops::sin(heading_rad))
}
