//! Where surfaces lie along their roads: what is laid, driven or worn follows them.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};
use kernel::map::{Lane, LaneId, LaneKind, RoadNetwork};
use kernel::ops;

/// Pavements look for the road that they are beside so far away, metres.
const BESIDE_M: f32 = 12.0;
/// Corners of a triangle of the ground are closer to its middle than this, and so are the places of lanes side by side, metres.
const REACH_M: f32 = 60.0;

/// The roads of a map.
pub(super) struct Roads<'a> {
    network: &'a RoadNetwork,
    /// For each lane those of its road that are driven on and lie beside it; none in junctions, where lanes lie over each other.
    beside: Vec<Vec<LaneId>>,
}

/// A stretch of a lane around a place on it.
#[derive(Clone, Copy)]
pub(super) struct Piece<'a> {
    id: LaneId,
    pub(super) lane: &'a Lane,
    /// Where the place is on it.
    s_m: f32,
}

/// A stretch of a road on which the same lanes lie side by side.
pub(super) struct Stretch<'a> {
    /// Whose surface it is.
    pub(super) on: Piece<'a>,
    /// Of the lane that distances count along.
    along: Piece<'a>,
    /// Whether the surface's lane leads the other way.
    turned: bool,
    /// Driven lanes to the left of it, as that one leads.
    to_the_left: usize,
}

/// A stretch of a pavement.
pub(super) struct Pavement<'a> {
    pub(super) on: Piece<'a>,
    /// On which side of it its road is: 1 is left, -1 right.
    pub(super) road: Option<f32>,
}

/// What tells a lane's road: part of its name.
pub(super) fn road_of(lane: &Lane) -> &str {
    lane.name.split('/').next().unwrap_or_default()
}

/// Whether two lanes of a road may be side by side: a road of many sections has others before and after, and its other leg beyond
/// a bend.
fn lie_beside(one: &Lane, other: &Lane) -> bool {
    let middle = |lane: &Lane| lane.at(0.5 * lane.length_m).position;
    middle(one).distance_squared(middle(other)) < REACH_M * REACH_M
}

impl<'a> Roads<'a> {
    pub(super) fn new(network: &'a RoadNetwork) -> Self {
        let mut driven: BTreeMap<&str, Vec<LaneId>> = BTreeMap::new();
        for (id, lane) in (0..).zip(&network.lanes) {
            if lane.kind == LaneKind::Driving && lane.junction.is_none() {
                driven.entry(road_of(lane)).or_default().push(id);
            }
        }
        let beside = network.lanes.iter().map(|lane| {
            let of_road = driven.get(road_of(lane)).filter(|_| lane.junction.is_none());
            let lies_beside = |id: &&LaneId| lie_beside(lane, &network.lanes[**id as usize]);
            of_road.into_iter().flatten().filter(lies_beside).copied().collect()
        });
        Self { network, beside: beside.collect() }
    }

    /// The stretch that a place of a roadway is on; nothing in junctions and beside all lanes.
    pub(super) fn stretch(&self, place: Vec3) -> Option<Stretch<'a>> {
        let kinds = [LaneKind::Driving, LaneKind::Shoulder, LaneKind::Parking, LaneKind::Biking, LaneKind::Other];
        let on = kinds.into_iter().find_map(|kind| self.on(place, kind))?;
        if on.lane.junction.is_some() {
            return None;
        }
        let lanes = self.beside[on.id as usize].iter().map(|&id| (id, &self.network.lanes[id as usize]));
        let beside: Vec<Piece> = lanes.filter_map(|lane| on.beside(lane, place)).collect();
        let along = *beside.first()?;
        let is_turned = |piece: &Piece| ops::cos(piece.heading_rad() - along.heading_rad()) < 0.0;
        let is_left = |other: &&Piece| {
            // A place on the right of a lane has it on the left.
            (other.uv(place).y < 0.0) != is_turned(other) && !core::ptr::eq(other.lane, on.lane)
        };
        let to_the_left = beside.iter().filter(is_left).count();
        Some(Stretch { on, along, turned: is_turned(&on), to_the_left })
    }

    /// The pavement that a place is on.
    pub(super) fn pavement(&self, place: Vec3) -> Option<Pavement<'a>> {
        let on = self.on(place, LaneKind::Sidewalk)?;
        let road = self.network.nearest_lane(place, LaneKind::Driving, None, BESIDE_M).map(|road| {
            let middle = self.network.lanes[road.lane as usize].at(road.s_m).position;
            let ahead = Vec2::from_angle(on.heading_rad());
            (ahead.perp_dot((middle - place).truncate()) + on.uv(place).y).signum()
        });
        Some(Pavement { on, road })
    }

    /// The lane of a kind that a place is on.
    fn on(&self, place: Vec3, kind: LaneKind) -> Option<Piece<'a>> {
        let on = *self.network.lanes_at(place, kind).first()?;
        Some(Piece { id: on.lane, lane: &self.network.lanes[on.lane as usize], s_m: on.s_m })
    }
}

impl<'a> Piece<'a> {
    /// The stretch of another lane of its road around a place, if that one has any there.
    fn beside(&self, (id, lane): (LaneId, &'a Lane), place: Vec3) -> Option<Piece<'a>> {
        // Both are about as long, and lead the same way or the other.
        let share = self.s_m / self.lane.length_m;
        let tried = [share, 1.0 - share].map(|share| share * lane.length_m);
        let found = tried.map(|s_m| lane.project_near(place, s_m, REACH_M));
        let (s_m, _, distance_m) = if found[0].2 < found[1].2 { found[0] } else { found[1] };
        (s_m > 0.0 && s_m < lane.length_m && distance_m < REACH_M).then_some(Piece { id, lane, s_m })
    }

    fn heading_rad(&self) -> f32 {
        self.lane.at(self.s_m).heading_rad
    }

    /// Metres along the lane and to the left of its middle; beyond its ends they go on straight.
    fn uv(&self, place: Vec3) -> Vec2 {
        let (s_m, ..) = self.lane.project_near(place, self.s_m, REACH_M);
        let nearest = self.lane.at(s_m);
        let (off, ahead) = ((place - nearest.position).truncate(), Vec2::from_angle(nearest.heading_rad));
        Vec2::new(s_m + ahead.dot(off), ahead.perp_dot(off))
    }
}

impl Stretch<'_> {
    /// Metres along the road and to the left of the middle of one of its lanes.
    pub(super) fn uv(&self, place: Vec3) -> Vec2 {
        self.along.uv(place)
    }

    /// 0 or 1, each at one edge of a lane: neighbours share the one between them. Beside driven lanes it is that of their edge.
    pub(super) fn phase(&self, place: Vec3) -> u8 {
        let is_right = self.on.lane.kind == LaneKind::Driving && (self.on.uv(place).y < 0.0) != self.turned;
        ((self.to_the_left + usize::from(is_right)) % 2) as u8
    }
}

impl Pavement<'_> {
    /// Metres along it and from the edge beside the road.
    pub(super) fn uv(&self, place: Vec3) -> Vec2 {
        let Vec2 { x: s_m, y: lateral_m } = self.on.uv(place);
        Vec2::new(s_m, self.on.lane.at(s_m).half_width_m - self.road.unwrap_or(1.0) * lateral_m)
    }
}

#[cfg(test)]
mod tests {
    use kernel::map::SurfaceKind;

    use super::*;

    /// Corners of the roadway of a map with the stretches they are on.
    fn corners<'a>(network: &'a RoadNetwork, roads: &Roads<'a>) -> Vec<([Vec3; 3], Stretch<'a>)> {
        let surface = network.surfaces.iter().find(|surface| surface.kind == SurfaceKind::Road).expect("roads");
        let of = |triangle: &[u32; 3]| {
            let corners = triangle.map(|i| surface.positions[i as usize]);
            Some((corners, roads.stretch(corners.iter().sum::<Vec3>() / 3.0)?))
        };
        surface.triangles.iter().filter_map(of).collect()
    }

    #[test]
    fn a_lane_goes_from_one_phase_to_the_other_and_shares_them_with_its_neighbours() {
        for name in ["city", "motorway"] {
            let network = kernel::map::bundled(name).expect("a bundled map");
            let roads = Roads::new(&network);
            let mut known = BTreeMap::new();
            let (mut driven, mut torn) = (0, 0);
            for (corners, stretch) in corners(&network, &roads) {
                let phases = corners.map(|at| stretch.phase(at));
                let is_driven = stretch.on.lane.kind == LaneKind::Driving;
                driven += usize::from(is_driven);
                torn += usize::from(is_driven != (phases[0] != phases[1] || phases[1] != phases[2]));
                for (at, phase) in corners.into_iter().zip(phases) {
                    let here = (stretch.uv(at).to_array().map(f32::to_bits), phase);
                    let road = core::ptr::from_ref(stretch.along.lane);
                    let there = *known.entry((at.to_array().map(f32::to_bits), road)).or_insert(here);
                    assert_eq!(here.0, there.0, "{name}: {at}");
                    torn += usize::from(here != there);
                }
            }
            // Where lanes begin and end they have no width.
            assert!(driven > 300 && 20 * torn < driven, "{name}: {torn} of {driven}");
        }
    }

    /// What is laid is as large everywhere: a triangle covers as much of its pattern as of the ground.
    #[test]
    fn no_pattern_is_stretched_where_pavements_end() {
        for name in ["lakeside", "old_town"] {
            let network = kernel::map::bundled(name).expect("a bundled map");
            let roads = Roads::new(&network);
            let surface = network.surfaces.iter().find(|s| s.kind == SurfaceKind::Sidewalk).expect("pavements");
            let (mut laid_m2, mut torn_m2) = (0.0, 0.0);
            for triangle in &surface.triangles {
                let corners = triangle.map(|i| surface.positions[i as usize]);
                let Some(pavement) = roads.pavement(corners.iter().sum::<Vec3>() / 3.0) else { continue };
                let area = |[a, b, c]: [Vec2; 3]| 0.5 * (b - a).perp_dot(c - a).abs();
                let ground_m2 = area(corners.map(Vec3::truncate));
                let pattern_m2 = area(corners.map(|at| pavement.uv(at)));
                laid_m2 += ground_m2;
                torn_m2 += if (pattern_m2 - ground_m2).abs() > 0.4 * ground_m2 { ground_m2 } else { 0.0 };
            }
            assert!(torn_m2 < 0.01 * laid_m2, "{name}: {torn_m2} of {laid_m2} m2");
        }
    }

    #[test]
    fn pavements_count_from_the_edge_beside_their_road() {
        let network = kernel::map::bundled("city").expect("a bundled map");
        let roads = Roads::new(&network);
        let (mut right, mut wrong) = (0, 0);
        for lane in network.lanes.iter().filter(|lane| lane.kind == LaneKind::Sidewalk && lane.junction.is_none()) {
            let middle = lane.at(0.5 * lane.length_m);
            let Some(pavement) = roads.pavement(middle.position).filter(|on| on.road.is_some()) else { continue };
            let aside = Vec2::from_angle(middle.heading_rad).perp().extend(0.0) * (0.8 * middle.half_width_m);
            let from_road = |at: Vec3| {
                let road = network.nearest_lane(at, LaneKind::Driving, None, 2.0 * BESIDE_M);
                road.map_or(f32::INFINITY, |road| road.distance_m)
            };
            let [a, b] = [middle.position + aside, middle.position - aside];
            let agrees = (pavement.uv(a).y < pavement.uv(b).y) == (from_road(a) < from_road(b));
            *if agrees { &mut right } else { &mut wrong } += 1;
        }
        assert!(right > 10 && wrong == 0, "{right} right, {wrong} wrong");
    }
}
