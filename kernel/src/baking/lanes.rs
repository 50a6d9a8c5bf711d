//! Lanes in their direction of travel, and how they follow and border each other.

use super::error::BakeError;
use super::limits::LANE_POINTS;
use super::notes::{Notes, Passed};
use super::pace;
use super::rounding::{snap, snap3};
use super::shapes::point;
use super::source::{Origin, Source, nowhere_to_drive};
use crate::map_data::{Lane, LaneId, LaneKind, LanePoint};
use crate::ops;

/// Vertices of a centre line are at most this far apart.
const MAX_STEP_M: f32 = 2.0;
/// Vertices nearer to each other than this are one.
const MIN_STEP_M: f32 = 0.05;
/// A strip narrower than this everywhere is no lane.
const MIN_WIDTH_M: f32 = 0.1;
/// A lane that starts farther from the end of another does not follow it, whatever the file says.
const MAX_GAP_M: f32 = 1.5;

/// The lanes of the file, each with its origin, which the source remembers.
pub(super) fn bake(mut source: Source, notes: &mut Notes) -> Result<(Source, Vec<Lane>), BakeError> {
    let mut lanes: Vec<Lane> = Vec::new();
    let mut origins: Vec<Origin> = Vec::new();
    let net = &source.net;
    let mut points_left = LANE_POINTS;
    for lane in net.lanes() {
        if lane.layer != xodr::Layer::Permanent {
            pass(notes, &source, lane, "is of a temporary layer");
            continue;
        }
        let Some(at) = net.road_lane(lane.id) else { continue };
        let forward = lane.direction != xodr::Direction::Backward;
        let road = net.road(at.road).map_or("", |r| r.od_id());
        let refused = |reason: String| {
            let place = format!("road {road}, section {}, lane {}", at.section, at.od_id);
            BakeError { place, reason }
        };
        points_left -= lane.center.points().len() as f64 + f64::from(lane.center.length() / MAX_STEP_M);
        if points_left.is_nan() || points_left < 0.0 {
            let reason = format!("expected at most {LANE_POINTS} points on the centre lines of lanes in the file");
            return Err(refused(reason));
        }
        let points = centre_line(lane, forward);
        if points.len() < 2 || points.iter().all(|p| p.half_width_m * 2.0 < MIN_WIDTH_M) {
            pass(notes, &source, lane, "is a strip without width or length");
            continue;
        }
        if let Some(why) = lost(lane) {
            pass(notes, &source, lane, why);
        }
        let Some(speed_limit_mps) = speed_limit_mps(net, lane) else {
            return Err(refused(
                "expected a speed limit above 0 where one drives, but <speed> or a sign says 0".into(),
            ));
        };
        origins.push(Origin { lane: lane.id, road: at.road.0, section: at.section, od_id: at.od_id, forward });
        lanes.push(Lane {
            kind: kind(lane.kind),
            name: format!("{road}/{}", at.od_id),
            length_m: points.last().map_or(0.0, |p| p.s_m),
            speed_limit_mps,
            points,
            ..Lane::default()
        });
    }
    origins.into_iter().for_each(|origin| source.remember(origin));
    if !lanes.iter().any(|l| l.kind == LaneKind::Driving) {
        return Err(nowhere_to_drive(source.roads));
    }
    link(&source, &mut lanes, notes);
    Ok((source, lanes))
}

/// Notes a lane that is left out, or whose type says more than is made of it.
fn pass(notes: &mut Notes, source: &Source, lane: &xodr::Lane, why: &'static str) {
    notes.pass(Passed::Lane, why, || format!("type {}", lane.kind), || source.place_of_lane(lane.id));
}

/// What a lane's type or direction says that [`kind`] does not keep.
fn lost(lane: &xodr::Lane) -> Option<&'static str> {
    use xodr::LaneType as T;
    match lane.kind {
        T::Bus | T::Taxi | T::Hov => Some("everybody drives there"),
        T::Shared => Some("is driven on, not walked on"),
        k if k.is_drivable() && lane.direction == xodr::Direction::Both => Some("is driven in one direction"),
        T::Tram | T::Rail => Some("nothing runs there"),
        T::RoadWorks | T::Special1 | T::Special2 | T::Special3 | T::Unknown => Some("nobody uses it"),
        _ => None,
    }
}

fn kind(kind: xodr::LaneType) -> LaneKind {
    use xodr::LaneType as T;
    match kind {
        k if k.is_drivable() => LaneKind::Driving,
        T::Biking => LaneKind::Biking,
        T::Sidewalk => LaneKind::Sidewalk,
        T::Shoulder | T::Stop | T::Border => LaneKind::Shoulder,
        T::Parking => LaneKind::Parking,
        _ => LaneKind::Other,
    }
}

fn centre_line(lane: &xodr::Lane, forward: bool) -> Vec<LanePoint> {
    let centre = &lane.center;
    let n = centre.points().len();
    let mut line: Vec<LanePoint> = Vec::with_capacity(n);
    for k in 0..n {
        let i = if forward { k } else { n - 1 - k };
        let position = point(centre.points()[i]);
        let t = centre.tangents()[i];
        let sign = if forward { 1.0 } else { -1.0 };
        let width = lane.widths.get(i).or(lane.widths.last()).copied().unwrap_or(lane.width);
        let heading_rad = snap_angle(ops::atan2(sign * t.y, sign * t.x));
        append(&mut line, LanePoint { position, heading_rad, half_width_m: snap(width / 2.0), s_m: 0.0 }, k + 1 == n);
    }
    measure(&mut line);
    line
}

/// Adds a vertex: not when it is too near, unless it is the end; with others between when too far.
fn append(line: &mut Vec<LanePoint>, next: LanePoint, is_end: bool) {
    if let Some(&last) = line.last() {
        let gap = last.position.distance(next.position);
        if gap < MIN_STEP_M {
            if is_end && line.len() > 1 {
                line.pop();
                line.push(next);
            }
            return;
        }
        let parts = ops::floor(gap / MAX_STEP_M - 1e-3) as u32 + 1;
        for k in 1..parts.min(100_000) {
            let mut between = last.towards(&next, k as f32 / parts as f32);
            between.position = snap3(between.position);
            line.push(between);
        }
    }
    line.push(next);
}

fn measure(line: &mut [LanePoint]) {
    let mut s = 0.0;
    for k in 1..line.len() {
        s = snap(s + line[k].position.distance(line[k - 1].position));
        line[k].s_m = s;
    }
}

/// Rounds to 2^-14 rad, within (-pi, pi].
fn snap_angle(angle_rad: f32) -> f32 {
    ops::wrap_angle(ops::floor(angle_rad * 16384.0 + 0.5) / 16384.0)
}

/// The limit of a lane; `None` where it is 0 though one drives there.
fn speed_limit_mps(net: &xodr::RoadNetwork, lane: &xodr::Lane) -> Option<f32> {
    let middle = lane.center.length() / 2.0;
    let limit_mps = pace::limit_mps(net.speed_limit_at(lane.id, middle), net.road_type_at(lane.id, middle));
    limit_mps.or_else(|| (!lane.kind.is_drivable()).then_some(pace::within(0.0)))
}

/// Tells each lane what follows, precedes and borders it.
fn link(source: &Source, lanes: &mut [Lane], notes: &mut Notes) {
    for id in 0..lanes.len() {
        let Some(from) = source.net.lane(source.origins[id].lane) else { continue };
        let mut next: Vec<LaneId> = from.successors.iter().filter_map(|l| source.ids.get(&l.0).copied()).collect();
        next.retain(|&to| {
            let follows = follows(&lanes[id], &lanes[to as usize]);
            let [here, there] = [&lanes[id], &lanes[to as usize]];
            let of_one_kind = here.kind == there.kind;
            // A strip beside the road may well go on as another.
            if !follows && (of_one_kind || here.kind == LaneKind::Driving) {
                let what = || format!("{} lane after {} lane", said(there), said(here));
                let why = if of_one_kind {
                    "begins too far off to follow"
                } else {
                    "is of another kind, and does not follow"
                };
                notes.pass(Passed::Reference, why, what, || source.place_of_lane(from.id));
            }
            follows
        });
        next.sort_unstable();
        next.dedup();
        for &to in &next {
            lanes[to as usize].predecessors.push(id as LaneId);
        }
        lanes[id].successors = next;
        lanes[id].left = beside(source, from, &source.origins[id], true);
        lanes[id].right = beside(source, from, &source.origins[id], false);
    }
}

/// What a lane is for, in a note.
fn said(lane: &Lane) -> &'static str {
    match lane.kind {
        LaneKind::Driving => "driving",
        LaneKind::Biking => "biking",
        LaneKind::Sidewalk => "sidewalk",
        LaneKind::Shoulder => "shoulder",
        LaneKind::Parking => "parking",
        LaneKind::Other => "other",
    }
}

fn follows(from: &Lane, to: &Lane) -> bool {
    let end = from.points[from.points.len() - 1].position;
    from.kind == to.kind && end.distance(to.points[0].position) < MAX_GAP_M
}

fn beside(source: &Source, lane: &xodr::Lane, origin: &Origin, left: bool) -> Option<LaneId> {
    let outward = if left == origin.forward { 1 } else { -1 };
    let wanted = match origin.od_id + outward {
        0 => outward,
        id => id,
    };
    let is_wanted = |n: &&xodr::LaneId| source.net.road_lane(**n).is_some_and(|at| at.od_id == wanted);
    let neighbour = lane.neighbors.iter().find(is_wanted)?;
    let middle = lane.center.points()[lane.center.points().len() / 2];
    let s = source.net.road_position_on(xodr::RoadId(origin.road), middle)?.s;
    let here = xodr::LanePosition { lane: lane.id, s, offset: 0.0 };
    let may = if left { source.net.may_change_left(here) } else { source.net.may_change_right(here) };
    (may != Some(false)).then(|| source.ids.get(&neighbour.0).copied()).flatten()
}
