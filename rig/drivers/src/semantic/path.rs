//! Where to steer: the arc that follows the arrow, keeps the lane and stays on the asphalt.

use kernel::map::Turn;
use kernel::{ego, ops};

use super::arc::{Arc, Point, SHARPEST};
use super::memory::{Dash, Trail};
use super::sight::{Ground, Sight};

/// Distance along the route of the point that the arrow of the HUD shows, metres from the middle of
/// the car.
pub const ARROW_M: f32 = 12.0;
/// Distance to a junction within which lines and edges stop to lead, metres.
const JUNCTION_M: f32 = 8.0;
/// Distance of the point on the trail that is steered to: least, and by speed (Coulter 1992), metres
/// and seconds.
const LOOK_M: f32 = 7.5;
const LOOK_S: f32 = 0.8;
/// The least in turns: who aims farther ahead in a tight one unwinds before its end, and comes out of it wide, metres.
const TURNING_LOOK_M: f32 = 4.5;
/// Bearing of the arrow from which the car is turning, degrees.
const TURNING_DEG: i16 = 10;
/// From the rear axle to the middle of the car, metres.
const MIDDLE_M: f32 = ego::CENTRE_M.x;
/// Arcs tried on each side of the wanted one.
const TRIED: i32 = 12;
/// Half of the width that has to be asphalt, metres.
const HALF_TRACK_M: f32 = 1.0;
/// Length over which an arc is looked at, beyond the point that is steered to, metres.
const LOOKED_BEYOND_M: f32 = 3.0;
/// Lane widths that are believed, metres.
const LANE_WIDTHS_M: std::ops::RangeInclusive<f32> = 2.5..=4.6;
/// Distance kept from an edge of the road without lines, metres.
const FROM_EDGE_M: f32 = 1.75;
/// Largest correction of the arrow by the lane, metres.
const LARGEST_SHIFT_M: f32 = 1.2;
/// Rows that must agree before the lane is believed.
const LEAST_ROWS: usize = 4;

impl Arc {
    /// Metres along the arc until the middle of the car would leave the asphalt.
    pub fn free_m(&self, sight: &Sight<'_>, reach_m: f32) -> f32 {
        let mut blocked_m = 0.0;
        let mut s_m = 6.0;
        while s_m < reach_m {
            let (x, y, _) = self.at(s_m);
            blocked_m = if sight.ground(x, y) == Ground::Other { blocked_m + 0.5 } else { 0.0 };
            if blocked_m > 1.5 {
                return s_m - blocked_m;
            }
            s_m += 0.5;
        }
        reach_m
    }

    /// Share of the car's track up to `reach_m` that is no asphalt, near ground counting more.
    fn off_road(&self, sight: &Sight<'_>, reach_m: f32) -> f32 {
        let (mut off, mut all) = (0.0, 0.0);
        for step in 0..20 {
            let s_m = 6.0 + step as f32 * (reach_m - 6.0) / 20.0;
            for left_m in [-HALF_TRACK_M, 0.0, HALF_TRACK_M] {
                let (x, y) = self.beside(s_m, left_m);
                let weight = 1.0 / s_m;
                all += weight;
                off += if sight.ground(x, y) == Ground::Other { weight } else { 0.0 };
            }
        }
        off / all
    }
}

/// The place that the arrow points to, in the car's frame: so far along an arc that starts straight ahead.
pub fn arrow_point(bearing_deg: i16) -> Point {
    let bearing_rad = -f32::from(bearing_deg).to_radians();
    let chord = if bearing_rad == 0.0 { 1.0 } else { ops::sin(bearing_rad) / bearing_rad };
    let distance_m = ARROW_M * chord.max(0.5);
    (MIDDLE_M + distance_m * ops::cos(bearing_rad), distance_m * ops::sin(bearing_rad))
}

/// The arc to steer: along the remembered arrows, outside of junctions moved to the middle of the lane.
pub fn choose(sight: &Sight<'_>, dash: &Dash, trail: &Trail) -> Arc {
    let look_m = LOOK_M.max(LOOK_S * dash.speed_mps).min(ARROW_M);
    let (is_at_junction, bends) = (dash.junction_m < JUNCTION_M, dash.bearing_deg.abs() > TURNING_DEG);
    let turns = bends || is_at_junction && dash.turn != Turn::Straight;
    let aim_m = if turns { TURNING_LOOK_M.max(LOOK_S * dash.speed_mps).min(ARROW_M) } else { look_m };
    let (x_m, y_m) = trail.point_at(aim_m).unwrap_or_else(|| arrow_point(dash.bearing_deg));
    let followed = Arc::to(x_m, y_m);
    if is_at_junction || bends {
        return nearest_on_road(sight, followed, look_m);
    }
    let shifted = lane_shift_m(sight, followed).map(|shift_m| followed.beside(MIDDLE_M + ARROW_M, shift_m));
    nearest_on_road(sight, shifted.map_or(followed, |(x_m, y_m)| Arc::to(x_m, y_m)), look_m)
}

/// How far to the left of the arc the middle of its lane lies, by lines and edges.
fn lane_shift_m(sight: &Sight<'_>, arc: Arc) -> Option<f32> {
    let mut by_lane = Vec::new();
    let mut by_edge = Vec::new();
    for (row, x_m) in sight.rows_between(ARROW_M - 5.0, ARROW_M + 4.0) {
        let y_m = 0.5 * arc.curvature * x_m * x_m;
        match sight.borders(row, y_m, 4.5) {
            [Some(left), Some(right)] if LANE_WIDTHS_M.contains(&(left.distance_m + right.distance_m)) => {
                by_lane.push(0.5 * (left.distance_m - right.distance_m));
            }
            [_, Some(right)] if !right.is_line => by_edge.push(FROM_EDGE_M - right.distance_m),
            _ => {}
        }
    }
    let shift_m = median(by_lane).or_else(|| median(by_edge))?;
    Some(shift_m.clamp(-LARGEST_SHIFT_M, LARGEST_SHIFT_M))
}

fn median(mut values: Vec<f32>) -> Option<f32> {
    values.sort_by(f32::total_cmp);
    (values.len() >= LEAST_ROWS).then(|| values[values.len() / 2])
}

/// The arc next to the wanted one whose track is asphalt.
fn nearest_on_road(sight: &Sight<'_>, wanted: Arc, look_m: f32) -> Arc {
    let cost = |arc: Arc, step: i32| arc.off_road(sight, look_m + LOOKED_BEYOND_M) + 0.012 * step.abs() as f32;
    let arc_of = |step: i32| Arc { curvature: (wanted.curvature + 0.01 * step as f32).clamp(-SHARPEST, SHARPEST) };
    (-TRIED..=TRIED)
        .map(|step| (cost(arc_of(step), step), arc_of(step)))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map_or(wanted, |(_, arc)| arc)
}

#[cfg(test)]
mod tests {
    use render::SemanticTag;

    use super::*;
    use crate::MaskView;
    use crate::semantic::moved::Moved;

    /// Right turns at junctions go a quarter round this, metres.
    const RADIUS_M: f32 = 8.0;
    const BEFORE_M: f32 = 30.0;

    /// A point of a lane that turns right after [`BEFORE_M`].
    fn lane(s_m: f32) -> Point {
        let turns_m = core::f32::consts::FRAC_PI_2 * RADIUS_M;
        let turned = (s_m - BEFORE_M).clamp(0.0, turns_m) / RADIUS_M;
        let (sin, cos) = (ops::sin(turned), ops::cos(turned));
        (s_m.min(BEFORE_M) + RADIUS_M * sin, RADIUS_M * (cos - 1.0) - (s_m - BEFORE_M - turns_m).max(0.0))
    }

    /// Nothing but asphalt is seen: the arrow leads, in its steps of 5 degrees.
    #[test]
    fn a_car_that_turns_right_stays_in_its_lane() {
        let ids = vec![SemanticTag::Road as u8; 256 * 128];
        let sight = Sight::new(MaskView { width: 256, height: 128, ids: &ids }, 0.0);
        let ends_m = BEFORE_M + core::f32::consts::FRAC_PI_2 * RADIUS_M;
        let (mut trail, mut x, mut y, mut heading, mut s_m) = (Trail::default(), 10.0_f32, 0.0_f32, 0.0_f32, 10.0_f32);
        let (mut curvature, mut most_m) = (0.0_f32, [0.0_f32; 2]);
        while s_m < ends_m + 10.0 {
            let (mx, my) = (x + MIDDLE_M * ops::cos(heading), y + MIDDLE_M * ops::sin(heading));
            let away_m = |s_m: f32| ops::hypot(lane(s_m).0 - mx, lane(s_m).1 - my);
            s_m = (0..40)
                .map(|step| s_m + 0.02 * step as f32)
                .min_by(|a, b| away_m(*a).total_cmp(&away_m(*b)))
                .expect("40");
            let (tx, ty) = lane(s_m + ARROW_M);
            let bearing = -ops::wrap_angle(ops::atan2(ty - my, tx - mx) - heading).to_degrees();
            let junction_m = (BEFORE_M - s_m - ego::SIZE_M.x * 0.5).max(0.0);
            let is_before = s_m < ends_m;
            let dash = Dash {
                speed_mps: 4.3,
                turn: if is_before { Turn::Right } else { Turn::Straight },
                junction_m: if is_before { junction_m } else { f32::INFINITY },
                bearing_deg: 5 * (bearing / 5.0).round() as i16,
                ..Dash::default()
            };
            let moved = Moved::along(Arc { curvature }, dash.speed_mps);
            trail.extend(moved, arrow_point(dash.bearing_deg));
            let wanted = choose(&sight, &dash, &trail).curvature;
            curvature += (wanted - curvature).clamp(-0.006, 0.006);
            heading += moved.turned_rad;
            (x, y) = (x + moved.forward_m * ops::cos(heading), y + moved.forward_m * ops::sin(heading));
            let side = ops::hypot(mx - BEFORE_M, my + RADIUS_M) - RADIUS_M;
            let aside_m = if s_m < BEFORE_M {
                my
            } else if s_m < ends_m {
                side
            } else {
                mx - BEFORE_M - RADIUS_M
            };
            most_m = [most_m[0].max(aside_m), most_m[1].min(aside_m)];
        }
        assert!(most_m[0] < 0.45 && most_m[1] > -0.45, "{most_m:?} m to the outside and to the inside");
    }
}
