//! Others who will be in the way: people and vehicles that cross it, and whom the car gives way to at junctions.

use core::f32::consts::FRAC_PI_2;

use kernel::ego::{self, FRONT_M};
use kernel::map::Turn;
use kernel::ops;

use super::arc::{Arc, HALF_WIDTH_M, Point};
use super::memory::Dash;
use super::speed::{STANDOFF_M, turning_mps};
use super::tracks::{Track, Tracks};

/// People who move faster than this walk, and vehicles drive, m/s.
const WALKING_MPS: f32 = 0.5;
const DRIVING_MPS: f32 = 1.5;
/// How far ahead people and vehicles are believed to keep their way, and how well it is known when they are somewhere,
/// seconds; and how far away it is too uncertain where they go, metres.
const WALK_FORESEEN_S: f32 = 3.5;
const DRIVE_FORESEEN_S: f32 = 2.5;
const MOMENT_S: f32 = 0.7;
const FORESEEN_M: f32 = 42.0;
/// Speed with which the car is taken to come by, at least, m/s.
const CREEPING_MPS: f32 = 2.0;
/// Side clearance to people who walk, metres.
const BESIDE_WALKER_M: f32 = 0.6;
/// Who drives at a greater angle than this to the way crosses it, as a sine.
const ACROSS: f32 = 0.7;

/// Distance to a junction within which others are given way, metres.
const GIVE_WAY_M: f32 = 14.0;
/// Quarters of a second that are looked ahead there.
const GIVE_WAY_STEPS: u32 = 20;
/// Acceleration of a car that drives off, m/s^2.
const DRIVING_OFF_MPS2: f32 = 2.0;
/// What must not be met: the front of the car, its middle and its rear axle, metres from the latter.
const PARTS_M: [f32; 3] = [FRONT_M, ego::CENTRE_M.x, 0.0];
/// Distance at which two vehicles meet, metres.
const MEET_M: f32 = 3.0;
/// Curvature of usual turns, 1/m.
const LEFT_BEND: f32 = 0.09;
const RIGHT_BEND: f32 = 0.14;
/// Who comes from farther away than this may be faster than it looks, metres.
const DOUBTED_FROM_M: f32 = 18.0;

/// Metres from the front of the car to where it must stand because of people who walk into its way: those who will be
/// there, give or take a moment, when the car comes by at its speed.
pub fn walkers_m(people: &Tracks, arc: Arc, speed_mps: f32) -> Option<f32> {
    let meets = |track: &Track| meets_m(track, arc, speed_mps, WALK_FORESEEN_S, HALF_WIDTH_M + BESIDE_WALKER_M);
    people.moving(WALKING_MPS).filter_map(meets).reduce(f32::min)
}

/// The same because of vehicles that drive across its way.
pub fn vehicles_m(vehicles: &Tracks, arc: Arc, speed_mps: f32) -> Option<f32> {
    let crosses = |track: &&Track| {
        let (_, _, heading_rad) = arc.at(arc.project(track.at.0, track.at.1).0);
        let (vx, vy) = track.velocity_mps;
        let across_mps = vy * ops::cos(heading_rad) - vx * ops::sin(heading_rad);
        across_mps.abs() > ACROSS * ops::hypot(vx, vy)
    };
    let meets = |track: &Track| meets_m(track, arc, speed_mps, DRIVE_FORESEEN_S, MEET_M);
    vehicles.moving(DRIVING_MPS).filter(crosses).filter_map(meets).reduce(f32::min)
}

/// Where to stand because of somebody who will be within `half_m` of the way when the car comes by.
fn meets_m(track: &Track, arc: Arc, speed_mps: f32, foreseen_s: f32, half_m: f32) -> Option<f32> {
    let (s_m, _) = arc.project(track.at.0, track.at.1);
    let to_m = s_m - FRONT_M;
    let there_s = to_m / speed_mps.max(CREEPING_MPS);
    if to_m <= 0.0 || s_m > FORESEEN_M || there_s > foreseen_s {
        return None;
    }
    let times_s = [there_s - MOMENT_S, there_s, there_s + MOMENT_S];
    let places = times_s.map(|t_s| track.after(t_s.max(0.0))).map(|(x_m, y_m)| arc.project(x_m, y_m));
    let in_the_way = places.into_iter().filter(|(_, left_m)| left_m.abs() < half_m);
    in_the_way.map(|(s_m, _)| s_m - FRONT_M - STANDOFF_M).reduce(f32::min)
}

/// Metres from the front of the car to where it lets others pass at a junction without lights: where
/// the car would meet a moving vehicle within the next seconds if both went on.
pub fn give_way_m(arc: Arc, dash: &Dash, vehicles: &Tracks) -> Option<f32> {
    if dash.junction_m > GIVE_WAY_M {
        return None;
    }
    let meets = |(at, velocity_mps): (Point, Point)| {
        let after = |t_s: f32| (at.0 + t_s * velocity_mps.0, at.1 + t_s * velocity_mps.1);
        (1..=GIVE_WAY_STEPS).find_map(|step| {
            let t_s = 0.25 * step as f32;
            let driven_m = drives_off_m(dash, t_s);
            let near = |(x, y): Point, t_s: f32| ops::hypot(after(t_s).0 - x, after(t_s).1 - y) < MEET_M;
            let is_met = |s_m: &f32| {
                let place = expected_way(arc, dash, *s_m);
                [t_s - 0.75, t_s, t_s + 0.75].into_iter().any(|t_s| near(place, t_s))
            };
            // Who is there already gets away by going on.
            let places_m = PARTS_M.into_iter().map(|part_m| part_m + driven_m).filter(|s_m| *s_m > FRONT_M);
            places_m.rev().find(is_met).map(|s_m| s_m - FRONT_M)
        })
    };
    let same_way = |(vx, vy): Point| vx > 2.0 * vy.abs();
    let drives = |velocity_mps: Point| ops::hypot(velocity_mps.0, velocity_mps.1) > DRIVING_MPS;
    let may = |track: &Track| [track.velocity_mps, fastest(track, dash.limit_mps)].map(|v| (track.at, v));
    let moving = vehicles.known().flat_map(may).filter(|(_, v)| drives(*v) && !same_way(*v));
    let meeting_m = moving.filter_map(meets).reduce(f32::min)?;
    // Before the junction it waits at its border, inside right before the other's way.
    let border_m = dash.junction_m - 1.0;
    Some(if border_m > 0.0 { border_m } else { meeting_m - MEET_M })
}

/// The velocity of somebody who comes as fast as it may: from far away a row of pixels is many metres, so that who comes
/// seems slow for long.
fn fastest(track: &Track, limit_mps: f32) -> Point {
    let (vx, vy) = track.velocity_mps;
    if track.at.0 < DOUBTED_FROM_M || vx > 0.0 {
        return (vx, vy);
    }
    (-track.approaches_at_most_mps().min(limit_mps).max(-vx), vy)
}

/// The way of a car that goes on as fast as it is, or drives off, metres.
fn drives_off_m(dash: &Dash, t_s: f32) -> f32 {
    let (speed_mps, turn_mps) = (dash.speed_mps, turning_mps(dash.turn));
    if speed_mps >= turn_mps {
        return speed_mps * t_s;
    }
    let speeding_up_s = t_s.min((turn_mps - speed_mps) / DRIVING_OFF_MPS2);
    let sped_up_m = (speed_mps + 0.5 * DRIVING_OFF_MPS2 * speeding_up_s) * speeding_up_s;
    sped_up_m + turn_mps * (t_s - speeding_up_s)
}

/// Where the rear axle will be after `s_m` metres: straight up to the junction, round its bend, and straight on.
fn expected_way(arc: Arc, dash: &Dash, s_m: f32) -> Point {
    let straight_m = dash.junction_m;
    let bend = match dash.turn {
        Turn::Straight => arc.curvature,
        Turn::Left => LEFT_BEND.max(arc.curvature),
        Turn::Right => -RIGHT_BEND.max(-arc.curvature),
    };
    let left_rad =
        if dash.turn == Turn::Straight { f32::INFINITY } else { (FRAC_PI_2 - dash.turned_rad).clamp(0.0, FRAC_PI_2) };
    let after_m = (s_m - straight_m).max(0.0);
    let bend_m = after_m.min(left_rad / bend.abs());
    let (x, y, heading_rad) = Arc { curvature: bend }.at(bend_m);
    let on_m = after_m - bend_m;
    (x + on_m * ops::cos(heading_rad) + straight_m.min(s_m), y + on_m * ops::sin(heading_rad))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::semantic::moved::Moved;
    use crate::semantic::sight::Contact;

    const STILL: Moved = Moved { forward_m: 0.0, turned_rad: 0.0 };

    /// Somebody who goes on like this for a second, as they are seen by a car that stands still.
    fn seen(from: Point, velocity_mps: Point, is_person: bool) -> Tracks {
        let mut tracks = Tracks::default();
        for look in 0..10 {
            let t_s = 0.1 * look as f32;
            let (x_m, y_m) = (from.0 + t_s * velocity_mps.0, from.1 + t_s * velocity_mps.1);
            tracks.look(&[Contact { is_person, on_road: !is_person, ..Contact::of_car((x_m, y_m)) }]);
            (0..6).for_each(|_| tracks.carry(STILL));
        }
        tracks
    }

    fn turning_left(speed_mps: f32) -> Dash {
        Dash { speed_mps, limit_mps: 13.9, turn: Turn::Left, junction_m: 0.0, bearing_deg: -15, ..Dash::default() }
    }

    /// A left turn across the lane of one who comes from ahead with 10 m/s: whether it is waited for.
    #[test]
    fn who_turns_left_waits_for_whom_it_would_not_have_passed_in_time() {
        let oncoming = |x_m: f32| seen((x_m + 10.0, 3.5), (-10.0, 0.0), false);
        let left = Arc { curvature: 0.09 };
        let waits = |x_m, speed_mps| give_way_m(left, &turning_left(speed_mps), &oncoming(x_m)).is_some();
        // From a stand its rear leaves the other's lane after 4 s, at 5.5 m/s after 2 s.
        assert_eq!([12.0, 25.0, 35.0].map(|x_m| waits(x_m, 0.0)), [true, true, true]);
        assert_eq!([12.0, 25.0, 45.0].map(|x_m| waits(x_m, turning_mps(Turn::Left))), [true, true, false]);
    }

    /// At 60 m a row of pixels is 20 m: who has come within it seems to stand.
    #[test]
    fn who_comes_from_far_may_be_faster_than_it_seems() {
        let within_a_row = |depth_error_m: f32, looks: u32| {
            let mut tracks = Tracks::default();
            for _ in 0..looks {
                tracks.look(&[Contact { depth_error_m, ..Contact::of_car((40.0, 3.5)) }]);
                (0..6).for_each(|_| tracks.carry(STILL));
            }
            give_way_m(Arc { curvature: 0.09 }, &turning_left(0.0), &tracks).is_some()
        };
        assert!(within_a_row(10.0, 10), "20 m in a second are possible");
        assert!(!within_a_row(1.0, 25), "it would have been seen");
        // Who drives away is believed.
        let away = seen((40.0, 3.5), (5.0, 0.0), false);
        assert_eq!(give_way_m(Arc { curvature: 0.09 }, &turning_left(0.0), &away), None);
    }

    #[test]
    fn who_has_turned_goes_on_straight() {
        let at_m =
            |turned_rad, s_m| expected_way(Arc { curvature: 0.09 }, &Dash { turned_rad, ..turning_left(5.0) }, s_m);
        let (x_m, y_m) = at_m(FRAC_PI_2, 20.0);
        assert!((x_m - 20.0).abs() < 1e-3 && y_m.abs() < 1e-3, "{x_m} {y_m}");
        // A quarter of a circle of 11 m, and 10 m more to the left.
        let radius_m = 1.0 / LEFT_BEND;
        let (x_m, y_m) = at_m(0.0, FRAC_PI_2 * radius_m + 10.0);
        assert!((x_m - radius_m).abs() < 1e-2 && (y_m - radius_m - 10.0).abs() < 1e-2, "{x_m} {y_m}");
    }

    #[test]
    fn who_walks_into_the_way_is_expected_there_and_who_walks_along_it_is_not() {
        let ahead = Arc { curvature: 0.0 };
        let walker = |from, velocity_mps| seen(from, velocity_mps, true);
        let at_8_mps = |tracks: &Tracks| walkers_m(tracks, ahead, 8.0);
        let enters = at_8_mps(&walker((20.0, -5.5), (0.0, 1.4))).expect("it is in the way");
        assert!((enters - (20.0 - FRONT_M - STANDOFF_M)).abs() < 0.5, "{enters}");
        assert_eq!(at_8_mps(&walker((20.0, -4.5), (1.4, 0.0))), None, "along the road");
        assert_eq!(at_8_mps(&walker((20.0, -3.0), (0.0, -1.4))), None, "away from it");
        assert_eq!(at_8_mps(&walker((20.0, -12.0), (0.0, 1.4))), None, "long after the car");
        assert_eq!(at_8_mps(&walker((20.0, -3.0), (0.0, 0.0))), None, "waits");
        // Who will have crossed before a slow car comes is not waited for.
        assert_eq!(walkers_m(&walker((20.0, 1.0), (0.0, 1.4)), ahead, 4.0), None);
    }

    #[test]
    fn who_drives_across_the_way_is_let_pass() {
        let ahead = Arc { curvature: 0.0 };
        let at_10_mps = |from, velocity_mps| vehicles_m(&seen(from, velocity_mps, false), ahead, 10.0);
        assert!(at_10_mps((24.0, -20.0), (0.0, 8.0)).is_some());
        assert_eq!(at_10_mps((24.0, 2.0), (-8.0, 0.0)), None, "it comes along its own lane");
        assert_eq!(at_10_mps((24.0, 4.0), (0.0, 8.0)), None, "it has passed");
        assert!(at_10_mps((27.0, -24.0), (0.0, 8.0)).is_some());
        assert_eq!(at_10_mps((27.0, -16.0), (0.0, 8.0)), None, "it will have passed");
    }
}
