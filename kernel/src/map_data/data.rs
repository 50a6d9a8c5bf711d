//! A whole map.

use glam::Vec3;
use xxhash_rust::xxh3::xxh3_128;

use super::bus_stop::BusStop;
use super::digest::Digested;
use super::ids::{LaneId, LightGroupId};
use super::junction::{Junction, LightGroup, LightHead};
use super::lane::{Lane, LanePoint, Projection, StopKind};
use super::scenery::{Prop, Surface};
use super::walkway::{Crosswalk, WalkEdge, WalkNode};

/// Everything about a map, as plain data.
#[derive(Clone, Debug, Default)]
pub struct MapData {
    /// Name of a bundled map, or the file's stem.
    pub name: String,
    /// xxh3 over everything below; see [`Self::content_digest`].
    pub digest: u128,
    /// All lanes.
    pub lanes: Vec<Lane>,
    /// All junctions.
    pub junctions: Vec<Junction>,
    /// Signal groups.
    pub light_groups: Vec<LightGroup>,
    /// Signal heads.
    pub light_heads: Vec<LightHead>,
    /// Bus stops, by lane and place.
    pub bus_stops: Vec<BusStop>,
    /// Crosswalks.
    pub crosswalks: Vec<Crosswalk>,
    /// Where the ways of pedestrians meet.
    pub walk_nodes: Vec<WalkNode>,
    /// The ways of pedestrians.
    pub walk_edges: Vec<WalkEdge>,
    /// Static surfaces.
    pub surfaces: Vec<Surface>,
    /// Static objects.
    pub props: Vec<Prop>,
    /// Least and greatest corner of everything.
    pub bounds: [Vec3; 2],
    /// What was subtracted from the coordinates of the file, metres east and north: whole kilometres, and 0 for all
    /// maps that lie within 10 km of their file's origin.
    pub origin_m: [f64; 2],
}

impl MapData {
    /// What [`MapData::digest`] must be: xxh3-128 over everything but the name.
    pub fn content_digest(&self) -> u128 {
        let Self {
            name: _,
            digest: _,
            lanes,
            junctions,
            light_groups,
            light_heads,
            bus_stops,
            crosswalks,
            walk_nodes,
            walk_edges,
            surfaces,
            props,
            bounds,
            origin_m,
        } = self;
        let mut bytes = Vec::new();
        let parts: [&dyn Digested; 11] = [
            lanes,
            junctions,
            light_groups,
            light_heads,
            bus_stops,
            crosswalks,
            walk_nodes,
            walk_edges,
            surfaces,
            props,
            bounds,
        ];
        parts.iter().for_each(|part| part.digest(&mut bytes));
        // Maps at their file's origin, which are nearly all, keep the digests that recordings of them hold.
        if *origin_m != [0.0; 2] {
            bytes.extend(origin_m.iter().flat_map(|m| m.to_le_bytes()));
        }
        xxh3_128(&bytes)
    }

    /// The point of `lane` at `s_m` from its start, interpolated; `s_m` is clamped to the lane.
    pub fn lane_point(&self, lane: LaneId, s_m: f32) -> LanePoint {
        self.lanes[lane as usize].at(s_m)
    }

    /// The light that holds those at the line of the lane `before` who go on to `next`, if one does.
    pub fn light_between(&self, before: LaneId, next: LaneId) -> Option<LightGroupId> {
        let at_line = self.lanes[before as usize].stop.and_then(|stop| match stop.kind {
            StopKind::Light(group) => Some(group),
            StopKind::Stop | StopKind::Yield => None,
        });
        self.lanes[next as usize].light.or(at_line)
    }

    /// Where `position` is relative to `lane`.
    pub fn project(&self, lane: LaneId, position: Vec3) -> Projection {
        Projection::onto(lane, &self.lanes[lane as usize], position)
    }
}
