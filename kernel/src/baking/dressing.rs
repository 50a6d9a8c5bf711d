//! Houses, trees, lamps and fences where a file has none: deterministic, and never on a lane.

use std::collections::BTreeMap;
use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::rounding::{snap, snap3};
use super::shapes::{corners, footprint};
use super::source::Source;
use crate::geometry::{corners_overlap, direction};
use crate::map_data::{FurnitureKind, Lane, LaneId, LaneKind, Prop, PropKind};
use crate::ops;
use crate::places::Roads;
use crate::rng::{self, Stream};

/// Room between a dressing and any lane, metres.
const CLEAR_M: f32 = 0.35;
/// From one street lamp to the next, metres.
const LAMP_PITCH_M: f32 = 28.0;
/// Roads that bend more tightly than this get guard rails on the outside, metres.
const RAIL_RADIUS_M: f32 = 160.0;
/// Length of one piece of guard rail, metres.
const PIECE_M: f32 = 4.0;

/// The props that the file names, and those that dress the rest of the map.
pub(super) fn bake(source: &Source, roads: Roads<'_>, bounds: [Vec3; 2], props: Vec<Prop>) -> Vec<Prop> {
    let has = |kind: PropKind| props.iter().any(|p| p.kind == kind);
    let (houses, trees, rails, lamps) =
        (!has(PropKind::Building), !has(PropKind::Tree), !has(PropKind::GuardRail), !has(PropKind::Lamp));
    let lanes = 0..roads.lanes.len() as LaneId;
    let verges: Vec<Verge> = lanes.filter_map(|id| Verge::of(source, roads.lanes, id)).collect();
    let mut site = Site::new(roads, bounds, props);
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
    site.props
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
    fn of(source: &Source, lanes: &[Lane], lane: LaneId) -> Option<Self> {
        let own = source.origins[lane as usize];
        if lanes[lane as usize].junction.is_some() || lanes[lane as usize].length_m < 6.0 {
            return None;
        }
        let siblings = source.section_of(lane).iter().map(|&l| source.origins[l as usize].od_id);
        let (low, high) = siblings.fold((0, 0), |(a, b), id| (a.min(id), b.max(id)));
        // Seen along the reference line, the land beyond the highest id is to the left.
        let along = match own.od_id {
            id if id == high && id > 0 => 1.0,
            id if id == low && id < 0 => -1.0,
            _ => return None,
        };
        let side = if own.forward { along } else { -along };
        Some(Self { lane, side, in_town: lanes[lane as usize].kind == LaneKind::Sidewalk })
    }

    /// A place `s_m` along the lane and `out_m` beyond its edge, with the heading of the lane.
    fn place(&self, lanes: &[Lane], s_m: f32, out_m: f32) -> (Vec3, f32) {
        let p = lanes[self.lane as usize].at(s_m);
        let out = direction(p.heading_rad).perp() * (self.side * (p.half_width_m + out_m));
        (p.position + out.extend(0.0), p.heading_rad)
    }

    fn lamps(&self, site: &mut Site) {
        let length = site.roads.lanes[self.lane as usize].length_m;
        let mut s = LAMP_PITCH_M / 2.0;
        while s < length {
            let (at, heading) = self.place(site.roads.lanes, s, 0.6);
            // The lamp's x axis points over the road.
            let towards = ops::wrap_angle(heading - self.side * std::f32::consts::FRAC_PI_2);
            site.put(PropKind::Lamp, at, towards, Vec3::new(0.2, 0.2, 7.0), 0);
            s += LAMP_PITCH_M;
        }
    }

    /// A row of houses with their fronts to the street.
    fn houses(&self, site: &mut Site) {
        let length = site.roads.lanes[self.lane as usize].length_m;
        let mut s = 2.0;
        while s < length {
            let width = 9.0 + 9.0 * site.random();
            let depth = 9.0 + 5.0 * site.random();
            let floors = ops::floor(2.0 + 4.5 * site.random() * site.random() + site.random());
            let setback = 1.4 + 1.2 * site.random();
            let variant = site.pick(8);
            let (at, heading) = self.place(site.roads.lanes, s + width / 2.0, setback + depth / 2.0);
            let front = ops::wrap_angle(heading - self.side * std::f32::consts::FRAC_PI_2);
            // Its x axis leaves through the front door.
            let size = Vec3::new(depth, width, 3.1 * floors + 0.9);
            let done = site.put(PropKind::Building, at, front, size, variant);
            s += if done { width + if site.random() < 0.2 { 6.0 } else { 0.4 } } else { 3.0 };
        }
    }

    /// Trees, hedges and benches where no house stands.
    fn gardens(&self, site: &mut Site) {
        let length = site.roads.lanes[self.lane as usize].length_m;
        let mut s = 3.0;
        while s < length {
            let chance = site.random();
            let (at, heading) = self.place(site.roads.lanes, s, 1.6 + 1.5 * site.random());
            match chance {
                c if c < 0.45 => site.tree(at, 5.0 + 3.0 * chance),
                c if c < 0.65 => _ = site.put(PropKind::Hedge, at, heading, Vec3::new(3.0, 0.9, 1.2), 0),
                c if c < 0.7 => {
                    // Who sits there looks at the street.
                    let along = if self.side > 0.0 { heading } else { ops::wrap_angle(heading + PI) };
                    let bench = FurnitureKind::Bench.variant();
                    site.put(PropKind::Furniture, at, along, Vec3::new(1.6, 0.6, 0.9), bench);
                }
                _ => {}
            }
            s += 5.0;
        }
    }

    /// Guard rails on the outside of tight bends.
    fn guard_rails(&self, site: &mut Site) {
        let length = site.roads.lanes[self.lane as usize].length_m;
        let mut s = 0.0;
        while s + PIECE_M <= length {
            let lane = &site.roads.lanes[self.lane as usize];
            let (a, b) = (lane.at(s), lane.at(s + PIECE_M));
            let bend = ops::wrap_angle(b.heading_rad - a.heading_rad) / PIECE_M;
            if bend * self.side < -1.0 / RAIL_RADIUS_M {
                let (at, heading) = self.place(site.roads.lanes, s + PIECE_M / 2.0, 0.9);
                site.put(PropKind::GuardRail, at, heading, Vec3::new(PIECE_M - 0.05, 0.25, 0.8), 0);
            }
            s += PIECE_M;
        }
    }

    /// Trees in groups, hedges and fences along a country road.
    fn country(&self, site: &mut Site) {
        let length = site.roads.lanes[self.lane as usize].length_m;
        let mut s = 4.0;
        while s < length {
            // What grows changes every 60 m or so.
            let patch = rng::unit(u64::from(self.lane), Stream::Dressing, (s / 60.0) as u64, 0);
            let (near, heading) = self.place(site.roads.lanes, s, 3.0);
            let far = 4.0 + 22.0 * site.random() * site.random();
            let height = 6.0 + 7.0 * site.random();
            let (at, _) = self.place(site.roads.lanes, s, far);
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
    roads: Roads<'a>,
    bounds: [Vec3; 2],
    props: Vec<Prop>,
    drawn: u64,
    /// Indices of the props by square of 32 m.
    taken: BTreeMap<(i32, i32), Vec<u32>>,
}

const SQUARE_M: f32 = 32.0;

impl<'a> Site<'a> {
    fn new(roads: Roads<'a>, bounds: [Vec3; 2], props: Vec<Prop>) -> Self {
        let mut site = Self { roads, bounds, props: Vec::new(), drawn: 0, taken: BTreeMap::new() };
        props.into_iter().for_each(|prop| site.add(prop));
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
        // What looks at lanes comes last: on a heap of them it takes longest.
        let fits = self.is_inside(&prop) && self.is_free(&prop) && self.is_off_lanes(&prop);
        if fits {
            self.add(prop);
        }
        fits
    }

    fn is_off_lanes(&self, prop: &Prop) -> bool {
        // A crown may hang over a sidewalk, a trunk may not stand on it.
        let mut foot = *prop;
        if prop.kind == PropKind::Tree {
            foot.size = Vec3::new(0.6, 0.6, prop.size.z);
        }
        !footprint(&foot, 2.0).into_iter().any(|p| self.roads.is_near(p, CLEAR_M))
    }

    fn is_inside(&self, prop: &Prop) -> bool {
        let [low, high] = self.bounds.map(|b| b.truncate());
        corners(prop).iter().all(|c| c.cmpge(low).all() && c.cmple(high).all())
    }

    fn squares(prop: &Prop) -> impl Iterator<Item = (i32, i32)> + use<> {
        let corners = corners(prop);
        let cell = |v: f32| ops::floor(v / SQUARE_M) as i32;
        let low = corners.iter().fold(Vec2::splat(f32::MAX), |m, c| m.min(*c));
        let high = corners.iter().fold(Vec2::splat(f32::MIN), |m, c| m.max(*c));
        let (x1, y0, y1) = (cell(high.x), cell(low.y), cell(high.y));
        (cell(low.x)..=x1).flat_map(move |x| (y0..=y1).map(move |y| (x, y)))
    }

    fn add(&mut self, prop: Prop) {
        for square in Self::squares(&prop) {
            self.taken.entry(square).or_default().push(self.props.len() as u32);
        }
        self.props.push(prop);
    }

    fn is_free(&self, prop: &Prop) -> bool {
        let near = Self::squares(prop).filter_map(|s| self.taken.get(&s)).flatten();
        near.into_iter().all(|&id| !corners_overlap(&corners(prop), &corners(&self.props[id as usize])))
    }
}
