//! Bridges and tunnels, of which a file says no more than which lanes they carry or cover: deck, parapets and piers of
//! the one, walls and roof of the other, piece by piece along the road.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::Vec3;

use super::limits::PIECE_M;
use super::rounding::{snap, snap3};
use super::shapes::footprint;
use super::source::Source;
use super::terrain::Land;
use crate::geometry::direction;
use crate::map_data::{Lane, LaneId, LaneKind, Prop, PropKind, rising};
use crate::ops;
use crate::places::Roads;

/// Pieces reach into each other by so much, metres, which leaves no gap on the outside of bends.
const OVERLAP_M: f32 = 0.1;
/// From the edge of the outermost lane to a parapet or wall, and how thick these are, metres.
const ASIDE_M: f32 = 0.1;
const THICK_M: f32 = 0.35;
/// A deck lies so far below its lanes and is so thick; a parapet rises so high above them, metres.
const SUNK_M: f32 = 0.1;
const DECK_M: f32 = 1.0;
const PARAPET_M: f32 = 0.95;
/// Land lies at most so high below the lanes of a bridge, metres.
const CLEAR_M: f32 = SUNK_M + DECK_M + 0.2;
/// From pier to pier, how long and wide one is at most, how high one is at least, and the room to lanes beside it, metres.
const SPAN_M: f32 = 20.0;
const PIER_M: [f32; 2] = [1.0, 12.0];
const LEAST_PIER_M: f32 = 1.5;
const PIER_ROOM_M: f32 = 0.6;
/// Height of the inside of a tunnel, and how thick its roof is, metres.
const INSIDE_M: f32 = 5.2;
const ROOF_M: f32 = 0.6;

/// A bridge or tunnel over the lanes of one section of a road.
struct Structure {
    kind: PropKind,
    /// Lanes, and the part of each, metres along it.
    lanes: Vec<(LaneId, Range<f32>)>,
}

/// All bridges and tunnels of a file.
pub(super) struct Structures(Vec<Structure>);

impl Structures {
    pub fn new(source: &Source, lanes: &[Lane]) -> Self {
        let mut all = Vec::new();
        for structure in source.net.structures() {
            let kind = match structure.kind {
                xodr::StructureKind::Bridge { .. } => PropKind::Bridge,
                xodr::StructureKind::Tunnel { .. } => PropKind::Tunnel,
                _ => continue,
            };
            let mut sections: BTreeMap<usize, Vec<(LaneId, Range<f32>)>> = BTreeMap::new();
            for covered in &structure.lanes {
                let Some(&id) = source.ids.get(&covered.lane.0) else { continue };
                let (origin, length_m) = (source.origins[id as usize], lanes[id as usize].length_m);
                let [from, to] = match origin.forward {
                    true => [covered.from, covered.to],
                    false => [length_m - covered.to, length_m - covered.from],
                };
                let part = from.max(0.0)..to.min(length_m);
                if part.end - part.start > OVERLAP_M {
                    sections.entry(origin.section).or_default().push((id, part));
                }
            }
            all.extend(sections.into_values().map(|lanes| Structure { kind, lanes }));
        }
        Self(all)
    }

    /// Points of lanes that lie on the land, and places that bridges pass over with the height that land has there at most.
    pub fn footing(&self, lanes: &[Lane]) -> (Vec<Vec3>, Vec<Vec3>) {
        let mut carried: Vec<Vec<&Range<f32>>> = vec![Vec::new(); lanes.len()];
        for structure in self.0.iter().filter(|s| s.kind == PropKind::Bridge) {
            structure.lanes.iter().for_each(|(id, part)| carried[*id as usize].push(part));
        }
        let (mut land, mut below) = (Vec::new(), Vec::new());
        for (lane, carried) in lanes.iter().zip(&carried) {
            for p in &lane.points {
                if carried.iter().any(|part| part.contains(&p.s_m)) {
                    below.push(p.position - Vec3::Z * CLEAR_M);
                } else {
                    land.push(p.position);
                }
            }
        }
        // Where there is nothing but a bridge, it lies on the land.
        if land.is_empty() { (below, land) } else { (land, below) }
    }

    /// What they are built of.
    pub fn bake(&self, source: &Source, roads: &Roads<'_>, land: &Land) -> Vec<Prop> {
        let mut props = Vec::new();
        for structure in &self.0 {
            let ribs = structure.ribs(source, roads.lanes);
            let mut since_pier_m = SPAN_M / 2.0;
            for pair in ribs.windows(2) {
                let [near, far] = [pair[0], pair[1]];
                let part = Part { kind: structure.kind, near, far };
                match structure.kind {
                    PropKind::Bridge => {
                        props.push(part.across(-SUNK_M - DECK_M, DECK_M));
                        props.extend(part.sides(-SUNK_M - DECK_M, SUNK_M + DECK_M + PARAPET_M));
                        since_pier_m += near[0].distance(far[0]);
                        if let Some(pier) = part.pier(roads, land).filter(|_| since_pier_m > SPAN_M) {
                            since_pier_m = 0.0;
                            props.push(pier);
                        }
                    }
                    _ => {
                        props.push(part.across(INSIDE_M, ROOF_M));
                        props.extend(part.sides(-SUNK_M, SUNK_M + INSIDE_M));
                    }
                }
            }
        }
        props.retain(|prop| prop.size.min_element() > 0.05 && !(is_beside_lanes(prop) && is_in_the_way(roads, prop)));
        props
    }
}

/// Whether a piece stands beside the lanes of its road, not above or below them.
fn is_beside_lanes(prop: &Prop) -> bool {
    prop.size.y <= THICK_M
}

/// Whether traffic or people on foot would run into a piece.
fn is_in_the_way(roads: &Roads<'_>, prop: &Prop) -> bool {
    let kinds = [LaneKind::Driving, LaneKind::Sidewalk];
    let on = |p: Vec3, kind| roads.at(p, kind).iter().any(|lane| roads.beyond_edge(lane) < -0.05);
    footprint(prop, 1.0).iter().any(|p| kinds.iter().any(|&kind| on(*p, kind)))
}

impl Structure {
    /// The left and right edge every few metres, seen along the line that the road is measured along.
    fn ribs(&self, source: &Source, lanes: &[Lane]) -> Vec<[Vec3; 2]> {
        let number = |(id, _): &&(LaneId, Range<f32>)| source.origins[*id as usize].od_id;
        let (Some(left), Some(right)) = (self.lanes.iter().max_by_key(number), self.lanes.iter().min_by_key(number))
        else {
            return Vec::new();
        };
        let longest_m = (left.1.end - left.1.start).max(right.1.end - right.1.start);
        let count = ops::floor(longest_m / PIECE_M) as u32 + 1;
        let edge = |(id, part): &(LaneId, Range<f32>), share: f32, side: f32| {
            let (forward, along) = (source.origins[*id as usize].forward, part.end - part.start);
            let p = lanes[*id as usize].at(part.start + along * if forward { share } else { 1.0 - share });
            let side = if forward { side } else { -side };
            p.position + (direction(p.heading_rad).perp() * (side * p.half_width_m)).extend(0.0)
        };
        (0..=count).map(|k| k as f32 / count as f32).map(|k| [edge(left, k, 1.0), edge(right, k, -1.0)]).collect()
    }
}

/// A few metres of a bridge or tunnel, between two ribs.
#[derive(Clone, Copy)]
struct Part {
    kind: PropKind,
    near: [Vec3; 2],
    far: [Vec3; 2],
}

impl Part {
    /// A box from the middle of the near end to that of the far end, so high and beginning so far above them.
    fn piece(&self, near: Vec3, far: Vec3, width_m: f32, above_m: f32, height_m: f32) -> Prop {
        let along = far - near;
        let length_m = along.truncate().length();
        Prop {
            kind: self.kind,
            position: snap3((near + far) / 2.0 + Vec3::Z * above_m),
            heading_rad: snap(ops::atan2(along.y, along.x)),
            size: snap3(Vec3::new(length_m + OVERLAP_M, width_m, height_m)),
            variant: rising(along.z * (1.0 + OVERLAP_M / length_m.max(OVERLAP_M))),
        }
    }

    /// A deck or roof.
    fn across(&self, above_m: f32, height_m: f32) -> Prop {
        let middle = |[left, right]: [Vec3; 2]| (left + right) / 2.0;
        let width = |[left, right]: [Vec3; 2]| left.distance(right);
        let width_m = width(self.near).max(width(self.far)) + 2.0 * (ASIDE_M + THICK_M);
        self.piece(middle(self.near), middle(self.far), width_m, above_m, height_m)
    }

    /// What runs along both edges.
    fn sides(&self, above_m: f32, height_m: f32) -> [Prop; 2] {
        [0, 1].map(|side| {
            let outside = |rib: [Vec3; 2]| {
                let out = (rib[side] - rib[1 - side]).truncate().normalize_or_zero();
                rib[side] + (out * (ASIDE_M + THICK_M / 2.0)).extend(0.0)
            };
            self.piece(outside(self.near), outside(self.far), THICK_M, above_m, height_m)
        })
    }

    /// A pier below the middle of the near end, where nobody drives or walks and the land is far enough below.
    fn pier(&self, roads: &Roads<'_>, land: &Land) -> Option<Prop> {
        let [left, right] = self.near;
        let top = (left + right) / 2.0 - Vec3::Z * (SUNK_M + DECK_M);
        let across = (left - right).truncate();
        let ends = [left, right, (left + right) / 2.0].map(|p| land.height_m(p.truncate()));
        let (low, high) = (ends.into_iter().fold(f32::MAX, f32::min), ends.into_iter().fold(f32::MIN, f32::max));
        let pier = Prop {
            kind: self.kind,
            position: snap3(top.truncate().extend(low - 0.5)),
            heading_rad: snap(ops::atan2(-across.x, across.y)),
            size: snap3(Vec3::new(PIER_M[0], (0.6 * across.length()).min(PIER_M[1]), top.z - low + 0.5)),
            variant: rising(0.0),
        };
        // Lanes near the foot of a pier, and those under which it would end: bridges cross bridges.
        let is_free = |p: Vec3| {
            let heights = (0..).map(|k| p.z + 3.0 * k as f32).take_while(|z| *z < top.z - 3.0);
            heights.map(|z| p.truncate().extend(z)).all(|p| !roads.is_near(p, PIER_ROOM_M))
        };
        let stands = top.z - high > LEAST_PIER_M && footprint(&pier, 1.0).into_iter().all(is_free);
        stands.then_some(pier)
    }
}
