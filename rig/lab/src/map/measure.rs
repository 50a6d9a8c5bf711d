//! Counts and lengths of what is in a map.

use std::collections::BTreeMap;

use glam::Vec3;
use kernel::map::{Control, LaneKind, LanePoint, MapData, Prop, PropKind, Told};

use super::figures::{Junctions, Lanes, Limit, Parking, Props, Relief};

/// Gradients are those of stretches so long, metres: heights are told in millimetres.
const STRETCH_M: f32 = 5.0;

/// Kilometres, to the metre.
pub(super) fn km(metres: f64) -> f64 {
    // Adding 0 makes the negative zero of an empty sum positive.
    metres.round() / 1000.0 + 0.0
}

/// What a kind of lane is called.
pub(super) fn lane_kind(kind: LaneKind) -> &'static str {
    match kind {
        LaneKind::Driving => "driving",
        LaneKind::Biking => "biking",
        LaneKind::Sidewalk => "sidewalk",
        LaneKind::Shoulder => "shoulder",
        LaneKind::Parking => "parking",
        LaneKind::Other => "other",
    }
}

/// What a kind of prop is called.
fn prop_kind(kind: PropKind) -> &'static str {
    match kind {
        PropKind::Building => "building",
        PropKind::Tree => "tree",
        PropKind::Hedge => "hedge",
        PropKind::Lamp => "street lamp",
        PropKind::Sign => "sign",
        PropKind::SignalPole => "traffic light",
        PropKind::ParkedCar => "parked car",
        PropKind::Fence => "fence",
        PropKind::Wall => "wall",
        PropKind::GuardRail => "guard rail",
        PropKind::Furniture => "furniture",
        PropKind::Movable => "movable thing",
        PropKind::Sundry => "other thing",
        PropKind::Bridge => "bridge piece",
        PropKind::Tunnel => "tunnel piece",
    }
}

/// Width and height of the lanes, metres.
pub(super) fn extent_m(map: &MapData) -> [f64; 2] {
    let points = map.lanes.iter().flat_map(|lane| &lane.points).map(|point| point.position);
    let (low, high) = points.fold((Vec3::MAX, Vec3::MIN), |(low, high), p| (low.min(p), high.max(p)));
    let side = |low: f32, high: f32| (10.0 * f64::from(high - low)).round() / 10.0;
    [side(low.x, high.x), side(low.y, high.y)]
}

/// Heights, and where it is steepest.
pub(super) fn relief(map: &MapData) -> Relief {
    let heights = map.lanes.iter().flat_map(|lane| &lane.points).map(|point| point.position.z);
    let (low, high) = heights.fold((f32::MAX, f32::MIN), |(low, high), z| (low.min(z), high.max(z)));
    let driving = map.lanes.iter().filter(|lane| lane.kind == LaneKind::Driving);
    let (mut steepest, mut name) = (0.0, "");
    for lane in driving {
        let gradient = gradient(&lane.points);
        if gradient > steepest {
            (steepest, name) = (gradient, &lane.name);
        }
    }
    let hundredths = |value: f32| (100.0 * f64::from(value)).round() / 100.0;
    Relief {
        lowest_m: hundredths(low),
        highest_m: hundredths(high),
        gradient_pct: hundredths(100.0 * steepest),
        steepest: name.to_owned(),
    }
}

/// Greatest gradient over [`STRETCH_M`] of a line, 0 on a shorter one.
fn gradient(points: &[LanePoint]) -> f32 {
    let (mut from, mut greatest) = (0, 0.0f32);
    for to in points {
        while points[from + 1].s_m + STRETCH_M <= to.s_m {
            from += 1;
        }
        let along_m = (to.position - points[from].position).truncate().length();
        if to.s_m - points[from].s_m >= STRETCH_M {
            greatest = greatest.max((to.position.z - points[from].position.z).abs() / along_m.max(0.5 * STRETCH_M));
        }
    }
    greatest
}

/// Lanes by what they are for and by what the file calls them.
pub(super) fn lanes(map: &MapData, told: &Told) -> Vec<Lanes> {
    let mut sums: BTreeMap<(LaneKind, &'static str), (usize, f64)> = BTreeMap::new();
    for (lane, lane_type) in map.lanes.iter().zip(&told.lane_types) {
        let sum = sums.entry((lane.kind, lane_type)).or_default();
        *sum = (sum.0 + 1, sum.1 + f64::from(lane.length_m));
    }
    let line = |((kind, lane_type), (count, m))| Lanes { kind: lane_kind(kind), lane_type, count, km: km(m) };
    sums.into_iter().map(line).collect()
}

/// Driving lanes by their limits.
pub(super) fn limits(map: &MapData) -> Vec<Limit> {
    let mut sums: BTreeMap<i64, f64> = BTreeMap::new();
    for lane in map.lanes.iter().filter(|lane| lane.kind == LaneKind::Driving) {
        let tenths = (36.0 * f64::from(lane.speed_limit_mps)).round() as i64;
        *sums.entry(tenths).or_default() += f64::from(lane.length_m);
    }
    sums.into_iter().map(|(tenths, m)| Limit { kmh: tenths as f64 / 10.0, km: km(m) }).collect()
}

/// Junctions by what tells who goes first.
pub(super) fn junctions(told: &Told) -> Junctions {
    let mut junctions = Junctions { count: told.controls.len(), ..Junctions::default() };
    for control in &told.controls {
        *match control {
            Control::Lights => &mut junctions.signals,
            Control::Roundabout => &mut junctions.roundabout,
            Control::Stop => &mut junctions.stop,
            Control::Yield => &mut junctions.give_way,
            Control::Priority => &mut junctions.priority,
            Control::Right => &mut junctions.right_before_left,
            Control::Open => &mut junctions.open,
        } += 1;
    }
    junctions
}

/// Room to park, and parked cars.
pub(super) fn parking(map: &MapData) -> Parking {
    let lanes = map.lanes.iter().filter(|lane| lane.kind == LaneKind::Parking);
    let cars = map.props.iter().filter(|prop| prop.kind == PropKind::ParkedCar).count();
    Parking { lanes_km: km(lanes.map(|lane| f64::from(lane.length_m)).sum()), cars }
}

/// What stands around.
pub(super) fn props(map: &MapData, told: &Told) -> Vec<Props> {
    let (named, made_up) = map.props.split_at(told.named_props.min(map.props.len()));
    let of = |props: &[Prop], kind| props.iter().filter(|prop| prop.kind == kind).count();
    let line = |&kind| Props { kind: prop_kind(kind), named: of(named, kind), made_up: of(made_up, kind) };
    PropKind::ALL.iter().map(line).filter(|line| line.named + line.made_up > 0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points every half a metre, as high as `height` says of how far along they are.
    fn line(length_m: f32, height: impl Fn(f32) -> f32) -> Vec<LanePoint> {
        let along = (0..=(2.0 * length_m) as usize).map(|k| k as f32 / 2.0);
        let point =
            |s_m| LanePoint { position: Vec3::new(s_m, 0.0, height(s_m)), heading_rad: 0.0, half_width_m: 1.75, s_m };
        along.map(point).collect()
    }

    #[test]
    fn gradients_are_those_of_stretches() {
        assert_eq!(gradient(&line(50.0, |_| 7.0)), 0.0);
        assert!((gradient(&line(50.0, |s| 0.08 * s)) - 0.08).abs() < 1e-4);
        assert!((gradient(&line(50.0, |s| -0.08 * s.max(30.0))) - 0.08).abs() < 1e-4, "downhill, at the end");
        assert!(gradient(&line(50.0, |s| if s == 20.0 { 0.005 } else { 0.0 })) < 0.002, "an uneven place is no hill");
        assert_eq!(gradient(&line(4.0, |s| s)), 0.0, "too short to tell");
    }
}
