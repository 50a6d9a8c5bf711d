//! Houses, trees, lamps and fences where a file has none: deterministic, and never on a lane.

use glam::{Vec2, Vec3};

use super::bake::{Source, direction, snap, snap3};
use super::{LaneId, LaneKind, Prop, PropKind, RoadNetwork, props};
use crate::ops;
use crate::rng::{self, Stream};

/// Room between a dressing and any lane, metres.
const CLEAR_M: f32 = 0.35;
/// From one street lamp to the next, metres.
const LAMP_PITCH_M: f32 = 28.0;
/// Roads that bend more tightly than this get guard rails on the outside, metres.
const RAIL_RADIUS_M: f32 = 160.0;
/// Length of one piece of guard rail, metres.
const PIECE_M: f32 = 4.0;

pub(super) fn bake(source: &Source, map: &mut RoadNetwork) {
    let has = |kind: PropKind| map.props.iter().any(|p| p.kind == kind);
    let (houses, trees, rails, lamps) =
        (!has(PropKind::Building), !has(PropKind::Tree), !has(PropKind::GuardRail), !has(PropKind::Lamp));
    let verges: Vec<Verge> = (0..map.lanes.len() as LaneId).filter_map(|id| Verge::of(source, map, id)).collect();
    let mut site = Site::new(map);
    for verge in verges.iter().filter(|v| v.in_town) {
        if lamps {
            verge.lamps(&mut site);
        }
    }
    for verge in verges.iter().filter(|v| v.in_town && houses) {
        verge.houses(&mut site);
    }
    for verge in &verges {
        match verge.in_town {
            true => verge.gardens(&mut site),
            false => {
                if rails {
                    verge.guard_rails(&mut site);
                }
                if trees {
                    verge.country(&mut site);
                }
            }
        }
    }
    let placed = site.placed;
    map.props.extend(placed);
}

/// The outer edge of a road, along which things stand.
struct Verge {
    lane: LaneId,
    /// +1 where the open land lies to the left of the lane, -1 to the right.
    side: f32,
    in_town: bool,
}

impl Verge {
    /// The verge beside a lane that is the outermost of its road, if it is one.
    fn of(source: &Source, map: &RoadNetwork, lane: LaneId) -> Option<Self> {
        let own = source.origins[lane as usize];
        if map.lanes[lane as usize].junction.is_some() || map.lanes[lane as usize].length_m < 6.0 {
            return None;
        }
        let siblings = source.origins.iter().filter(|o| o.road == own.road && o.section == own.section);
        let (low, high) = siblings.fold((0, 0), |(a, b), o| (a.min(o.od_id), b.max(o.od_id)));
        // Seen along the reference line, the land beyond the highest id is to the left.
        let along = match own.od_id {
            id if id == high && id > 0 => 1.0,
            id if id == low && id < 0 => -1.0,
            _ => return None,
        };
        let side = if own.forward { along } else { -along };
        Some(Self { lane, side, in_town: map.lanes[lane as usize].kind == LaneKind::Sidewalk })
    }

    /// A place `s_m` along the lane and `out_m` beyond its edge, with the heading of the lane.
    fn place(&self, map: &RoadNetwork, s_m: f32, out_m: f32) -> (Vec3, f32) {
        let p = map.lane_point(self.lane, s_m);
        let out = direction(p.heading_rad).perp() * (self.side * (p.half_width_m + out_m));
        (p.position + out.extend(0.0), p.heading_rad)
    }

    fn lamps(&self, site: &mut Site) {
        let length = site.map.lanes[self.lane as usize].length_m;
        let mut s = LAMP_PITCH_M / 2.0;
        while s < length {
            let (at, heading) = self.place(site.map, s, 0.6);
            // The lamp's x axis points over the road.
            let towards = ops::wrap_angle(heading - self.side * std::f32::consts::FRAC_PI_2);
            site.put(PropKind::Lamp, at, towards, Vec3::new(0.2, 0.2, 7.0), 0);
            s += LAMP_PITCH_M;
        }
    }

    /// A row of houses with their fronts to the street.
    fn houses(&self, site: &mut Site) {
        let length = site.map.lanes[self.lane as usize].length_m;
        let mut s = 2.0;
        while s < length {
            let width = 9.0 + 9.0 * site.random();
            let depth = 9.0 + 5.0 * site.random();
            let floors = ops::floor(2.0 + 4.5 * site.random() * site.random() + site.random());
            let setback = 1.4 + 1.2 * site.random();
            let variant = site.pick(8);
            let (at, heading) = self.place(site.map, s + width / 2.0, setback + depth / 2.0);
            let front = ops::wrap_angle(heading - self.side * std::f32::consts::FRAC_PI_2);
            // Its x axis leaves through the front door.
            let size = Vec3::new(depth, width, 3.1 * floors + 0.9);
            let done = site.put(PropKind::Building, at, front, size, variant);
            s += if done { width + if site.random() < 0.2 { 6.0 } else { 0.4 } } else { 3.0 };
        }
    }

    /// Trees, hedges and benches where no house stands.
    fn gardens(&self, site: &mut Site) {
        let length = site.map.lanes[self.lane as usize].length_m;
        let mut s = 3.0;
        while s < length {
            let chance = site.random();
            let (at, heading) = self.place(site.map, s, 1.6 + 1.5 * site.random());
            match chance {
                c if c < 0.45 => site.tree(at, 5.0 + 3.0 * chance),
                c if c < 0.65 => _ = site.put(PropKind::Hedge, at, heading, Vec3::new(3.0, 0.9, 1.2), 0),
                c if c < 0.7 => _ = site.put(PropKind::Furniture, at, heading, Vec3::new(1.6, 0.6, 0.9), 0),
                _ => {}
            }
            s += 5.0;
        }
    }

    /// Guard rails on the outside of tight bends.
    fn guard_rails(&self, site: &mut Site) {
        let length = site.map.lanes[self.lane as usize].length_m;
        let mut s = 0.0;
        while s + PIECE_M <= length {
            let (a, b) = (site.map.lane_point(self.lane, s), site.map.lane_point(self.lane, s + PIECE_M));
            let bend = ops::wrap_angle(b.heading_rad - a.heading_rad) / PIECE_M;
            if bend * self.side < -1.0 / RAIL_RADIUS_M {
                let (at, heading) = self.place(site.map, s + PIECE_M / 2.0, 0.9);
                site.put(PropKind::GuardRail, at, heading, Vec3::new(PIECE_M - 0.05, 0.25, 0.8), 0);
            }
            s += PIECE_M;
        }
    }

    /// Trees in groups, hedges and fences along a country road.
    fn country(&self, site: &mut Site) {
        let length = site.map.lanes[self.lane as usize].length_m;
        let mut s = 4.0;
        while s < length {
            // What grows changes every 60 m or so.
            let patch = rng::unit(u64::from(self.lane), Stream::Dressing, (s / 60.0) as u64, 0);
            let (near, heading) = self.place(site.map, s, 3.0);
            let far = 4.0 + 22.0 * site.random() * site.random();
            let height = 6.0 + 7.0 * site.random();
            let (at, _) = self.place(site.map, s, far);
            match patch {
                p if p < 0.45 => site.tree(at, height),
                p if p < 0.6 => _ = site.put(PropKind::Hedge, near, heading, Vec3::new(5.6, 1.2, 1.5), 0),
                p if p < 0.75 => _ = site.put(PropKind::Fence, near, heading, Vec3::new(5.9, 0.1, 1.1), 0),
                _ => {}
            }
            s += 6.0;
        }
    }
}

/// The ground on which things are put, and what stands there already.
struct Site<'a> {
    map: &'a RoadNetwork,
    placed: Vec<Prop>,
    drawn: u64,
    /// Indices of the props (first the map's own, then `placed`) by square of 32 m.
    taken: std::collections::BTreeMap<(i32, i32), Vec<u32>>,
}

const SQUARE_M: f32 = 32.0;

impl<'a> Site<'a> {
    fn new(map: &'a RoadNetwork) -> Self {
        let mut site = Self { map, placed: Vec::new(), drawn: 0, taken: Default::default() };
        for (k, prop) in map.props.iter().enumerate() {
            site.take(k as u32, prop);
        }
        site
    }

    fn random(&mut self) -> f32 {
        self.drawn += 1;
        rng::unit(0, Stream::Dressing, self.drawn, 0)
    }

    fn pick(&mut self, n: u32) -> u32 {
        self.drawn += 1;
        rng::below(0, Stream::Dressing, self.drawn, 0, n)
    }

    fn tree(&mut self, at: Vec3, height: f32) {
        let crown = 0.45 * height;
        let variant = self.pick(4);
        self.put(PropKind::Tree, at, 0.0, Vec3::new(crown, crown, height), variant);
    }

    /// Puts a prop where it fits; says whether it did.
    fn put(&mut self, kind: PropKind, position: Vec3, heading_rad: f32, size: Vec3, variant: u32) -> bool {
        let prop = Prop { kind, position: snap3(position), heading_rad: snap(heading_rad), size: snap3(size), variant };
        let fits = self.is_off_lanes(&prop) && self.is_free(&prop) && self.is_inside(&prop);
        if fits {
            let id = (self.map.props.len() + self.placed.len()) as u32;
            self.take(id, &prop);
            self.placed.push(prop);
        }
        fits
    }

    fn is_off_lanes(&self, prop: &Prop) -> bool {
        use LaneKind as K;
        // A crown may hang over a sidewalk, a trunk may not stand on it.
        let mut foot = *prop;
        if prop.kind == PropKind::Tree {
            foot.size = Vec3::new(0.6, 0.6, prop.size.z);
        }
        let hit = |p: Vec3, kind| !self.map.lanes_around(p, kind, CLEAR_M).is_empty();
        let kinds = [K::Driving, K::Sidewalk, K::Parking, K::Shoulder, K::Biking, K::Other];
        !props::footprint(&foot, 2.0).iter().any(|&p| kinds.iter().any(|&k| hit(p, k)))
    }

    fn is_inside(&self, prop: &Prop) -> bool {
        let [low, high] = self.map.bounds.map(|b| b.truncate());
        props::corners(prop).iter().all(|c| c.cmpge(low).all() && c.cmple(high).all())
    }

    fn squares(prop: &Prop) -> impl Iterator<Item = (i32, i32)> + use<> {
        let corners = props::corners(prop);
        let cell = |v: f32| ops::floor(v / SQUARE_M) as i32;
        let low = corners.iter().fold(Vec2::splat(f32::MAX), |m, c| m.min(*c));
        let high = corners.iter().fold(Vec2::splat(f32::MIN), |m, c| m.max(*c));
        let (x1, y0, y1) = (cell(high.x), cell(low.y), cell(high.y));
        (cell(low.x)..=x1).flat_map(move |x| (y0..=y1).map(move |y| (x, y)))
    }

    fn take(&mut self, id: u32, prop: &Prop) {
        for square in Self::squares(prop) {
            self.taken.entry(square).or_default().push(id);
        }
    }

    fn is_free(&self, prop: &Prop) -> bool {
        let get = |id: u32| match self.map.props.get(id as usize) {
            Some(own) => own,
            None => &self.placed[id as usize - self.map.props.len()],
        };
        !Self::squares(prop)
            .filter_map(|s| self.taken.get(&s))
            .flatten()
            .any(|&id| overlap(&props::corners(prop), &props::corners(get(id))))
    }
}

/// Whether two rectangles overlap (separating axes).
fn overlap(a: &[Vec2; 4], b: &[Vec2; 4]) -> bool {
    let axes = [a[1] - a[0], a[3] - a[0], b[1] - b[0], b[3] - b[0]];
    axes.iter().all(|axis| {
        let range =
            |r: &[Vec2; 4]| r.iter().map(|c| c.dot(*axis)).fold((f32::MAX, f32::MIN), |(l, h), v| (l.min(v), h.max(v)));
        let ((al, ah), (bl, bh)) = (range(a), range(b));
        al < bh && bl < ah
    })
}
