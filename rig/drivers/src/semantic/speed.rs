//! How fast to go: the limit, bends, junctions, lights, and whatever stands in the way.

use kernel::ego::{self, FRONT_M};
use kernel::map::Turn;
use kernel::ops;
use kernel::signals::LightPhase;

use super::arc::{Arc, Point};
use super::memory::{Ahead, Dash, Track, Tracks};
use super::sight::{Contact, Sight};

/// Half of the car's width, metres.
const HALF_WIDTH_M: f32 = 0.5 * ego::SIZE_M.y;
/// Deceleration that an attentive driver plans with, m/s^2.
const COMFORT_MPS2: f32 = 2.0;
/// Time in which a wrong speed is made right, seconds.
pub const SPEED_TIME_S: f32 = 0.7;
/// Deceleration that a yellow light is worth, m/s^2.
const YELLOW_MPS2: f32 = 3.5;
/// Lateral acceleration of an attentive driver in bends, m/s^2.
const LATERAL_MPS2: f32 = 2.2;
/// Gap kept to what stands in the way, metres.
const STANDOFF_M: f32 = 4.0;
/// Where the car stops before a stop line, metres.
const BEFORE_LINE_M: f32 = 1.5;
/// Speed in turns at junctions, m/s; in those to the right, where people on foot are seen late.
const TURN_MPS: f32 = 5.5;
const RIGHT_TURN_MPS: f32 = 4.5;
/// Speed across junctions without lights, m/s.
const CROSSING_MPS: f32 = 5.5;
/// Distance to one from which it is slowed down for, metres.
const CROSSING_FROM_M: f32 = 30.0;
/// Speed at which the end of the visible road is approached, m/s.
const FEELING_MPS: f32 = 4.5;
/// Distance to a junction within which others are given way, metres.
const GIVE_WAY_M: f32 = 14.0;
/// Quarters of a second that are looked ahead there.
const GIVE_WAY_STEPS: u32 = 16;
/// Acceleration of a car that drives off, m/s^2.
const DRIVING_OFF_MPS2: f32 = 2.0;
/// What must not be met: the front of the car, its middle and its rear axle, metres from the latter.
const PARTS_M: [f32; 3] = [FRONT_M, ego::CENTRE_M.x, 0.0];
/// Distance at which two vehicles meet, metres.
const MEET_M: f32 = 3.0;
/// Curvature of usual turns, 1/m.
const LEFT_BEND: f32 = 0.09;
const RIGHT_BEND: f32 = 0.14;
/// How far the road is looked at, metres.
const REACH_M: f32 = 90.0;
/// How far ahead along the arc somebody counts as in the way, at least, metres: what 2 m/s^2 need from 50 km/h.
const IN_THE_WAY_M: f32 = 50.0;
/// Deceleration that who drives ahead is expected to brake with at any time, m/s^2.
const LEADER_MPS2: f32 = 4.0;
/// An arc of this radius is straight, metres.
const STRAIGHT_M: f32 = 1e4;
/// Sharper arcs than this, 1/m, are turns that end soon: whoever stands between them and straight ahead may be in the way
/// after that, up to this distance, metres.
const TURNING: f32 = 0.025;
const AFTER_TURN_M: f32 = 25.0;
/// Speed with which it is turned towards them, at least, m/s.
const TURNING_IN_MPS: f32 = 2.5;
/// Side clearance to vehicles, as long as the car stands and more the faster it is, to people beside the road, and to
/// people on it, metres.
const BESIDE_VEHICLE_M: [f32; 2] = [0.2, 0.5];
/// Speed from which the greater one is kept, m/s.
const BESIDE_AT_MPS: f32 = 5.0;
const BESIDE_WALKER_M: f32 = 0.6;
const BESIDE_CROSSING_M: f32 = 3.6;

/// People who move faster than this walk, m/s.
const WALKING_MPS: f32 = 0.5;
/// How far ahead people are believed to keep their way, and how well it is known when they are somewhere, seconds; and how
/// far away it is too uncertain where they walk, metres.
const FORESEEN_S: f32 = 3.5;
const MOMENT_S: f32 = 0.7;
const FORESEEN_M: f32 = 42.0;
/// Speed with which the car is taken to come by, at least, m/s.
const CREEPING_MPS: f32 = 2.0;

/// The speed from which the car can slow to `end_mps` within `distance_m`.
fn braking_from(end_mps: f32, distance_m: f32, comfort_mps2: f32) -> f32 {
    (end_mps * end_mps + 2.0 * comfort_mps2 * distance_m.max(0.0)).sqrt()
}

/// The braking that brings the car to a stand within `distance_m`, m/s^2.
pub fn needed_mps2(speed_mps: f32, distance_m: f32) -> f32 {
    speed_mps * speed_mps / (2.0 * distance_m.max(0.3))
}

/// What the driver wants of the pedals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish {
    /// Speed that would be right now with nowhere to stand, m/s.
    pub speed_mps: f32,
    /// Distance to a point where the car has to stand, metres from its front.
    pub stop_in_m: Option<f32>,
    /// Deceleration that is planned with, m/s^2.
    pub comfort_mps2: f32,
    /// Others are to be expected in the way: the foot is over the brake.
    pub expects_others: bool,
}

impl Wish {
    /// The speed from which the car comes to a stand where it has to by comfortable braking that sets in after the time
    /// in which a wrong speed is made right (the safe speed of Gipps 1981 behind one who stands), m/s.
    pub fn safe_mps(&self) -> f32 {
        self.stop_in_m.map_or(f32::INFINITY, |stop_m| safe_mps(stop_m, self.comfort_mps2))
    }
}

fn safe_mps(stop_m: f32, comfort_mps2: f32) -> f32 {
    let lag_mps = comfort_mps2 * SPEED_TIME_S;
    braking_from(lag_mps, stop_m, comfort_mps2) - lag_mps
}

/// Others on the road, and where to wait for them.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    /// Metres from the front of the car to where it must stand because of people and vehicles.
    pub obstacle_m: Option<f32>,
    /// The same because of those who may be in the way after the turn.
    pub after_turn_m: Option<f32>,
    /// Metres from the front of the car to where it lets others pass.
    pub give_way_m: Option<f32>,
    /// The HUD shows a light, or showed the one of this junction.
    pub has_lights: bool,
}

/// The speed for an arc, of a driver who brakes and turns so many times as hard as an attentive one.
pub fn wish(sight: &Sight<'_>, arc: Arc, dash: &Dash, scene: Scene, vigour: f32) -> Wish {
    let comfort_mps2 = vigour * COMFORT_MPS2;
    let stops = [scene.obstacle_m, stop_line_m(dash), scene.give_way_m];
    let stop_in_m = stops.into_iter().flatten().reduce(f32::min);
    let bend_mps = (vigour * LATERAL_MPS2 / arc.curvature.abs().max(1e-3)).sqrt();
    let road_mps = braking_from(FEELING_MPS, arc.free_m(sight, REACH_M) - FRONT_M, comfort_mps2);
    let (there_mps, junction_m) = junction_mps(dash, scene.has_lights);
    let junction_mps = braking_from(there_mps, junction_m - 2.0, comfort_mps2);
    let to_them_mps = scene.after_turn_m.map_or(f32::INFINITY, |stand_m| safe_mps(stand_m, comfort_mps2));
    let turning_mps = to_them_mps.max(TURNING_IN_MPS);
    let speed_mps = dash.limit_mps.min(bend_mps).min(road_mps).min(junction_mps).min(turning_mps);
    Wish { speed_mps, stop_in_m, comfort_mps2, expects_others: is_turning(dash) }
}

/// Farther along the arc nobody counts as in the way, metres.
fn in_the_way_m(speed_mps: f32) -> f32 {
    IN_THE_WAY_M.max(0.5 * speed_mps * speed_mps / COMFORT_MPS2)
}

/// Where the car must stand because of people and vehicles: behind those who stand, and behind where those who drive ahead
/// would come to a stand.
pub fn obstacle(contacts: &[Contact], vehicles: &Tracks, arc: Arc, speed_mps: f32) -> Option<Ahead> {
    let in_the_way = contacts.iter().filter_map(|contact| {
        let (s_m, left_m) = arc.project(contact.x_m, contact.y_m);
        let is_beside = left_m.abs() >= swept_m(arc, left_m) + clearance_m(contact, speed_mps);
        if s_m >= in_the_way_m(speed_mps) || is_beside {
            return None;
        }
        let leads_mps = if contact.is_person { 0.0 } else { vehicles.leads_mps(contact, arc) };
        let stand_in_m = 0.5 * leads_mps * leads_mps / LEADER_MPS2;
        Some(Ahead { stop_in_m: s_m - FRONT_M - STANDOFF_M + stand_in_m, leads_mps })
    });
    in_the_way.reduce(Ahead::nearer)
}

/// Whether the car turns at a junction.
fn is_turning(dash: &Dash) -> bool {
    dash.turn != Turn::Straight && dash.junction_m == 0.0
}

/// How far from the arc of its rear axle the car reaches on a side, metres: on the outer one of a turn its front swings out.
fn swept_m(arc: Arc, left_m: f32) -> f32 {
    let radius_m = 1.0 / arc.curvature.abs();
    if left_m * arc.curvature >= 0.0 || radius_m > STRAIGHT_M {
        return HALF_WIDTH_M;
    }
    ops::hypot(radius_m + HALF_WIDTH_M, FRONT_M) - radius_m
}

/// Where the car must stand, metres from its front, if it goes on straight at any moment of a turn: behind those between
/// its arc and straight ahead.
pub fn after_turn_m(contacts: &[Contact], arc: Arc, dash: &Dash) -> Option<f32> {
    let is_between = |contact: &&Contact| {
        let room_m = HALF_WIDTH_M + clearance_m(contact, dash.speed_mps);
        let (_, left_m) = arc.project(contact.x_m, contact.y_m);
        let side = arc.curvature.signum();
        // Outside of the arc, and inside of straight ahead.
        contact.on_road && side * left_m < room_m && side * contact.y_m > -room_m
    };
    let is_near = |contact: &&Contact| (FRONT_M..AFTER_TURN_M).contains(&contact.x_m);
    let turns = is_turning(dash) && arc.curvature.abs() > TURNING;
    let found = contacts.iter().filter(|_| turns).filter(is_near).filter(is_between);
    found.map(|contact| ops::hypot(contact.x_m, contact.y_m) - FRONT_M - STANDOFF_M).reduce(f32::min)
}

/// Metres from the front of the car to where it must stand because of people who walk into its way: those who will be
/// there, give or take a moment, when the car comes by at its speed.
pub fn crossing_m(tracks: &Tracks, arc: Arc, speed_mps: f32) -> Option<f32> {
    let meets = |track: &Track| {
        let (s_m, _) = arc.project(track.at.0, track.at.1);
        let to_m = s_m - FRONT_M;
        let there_s = to_m / speed_mps.max(CREEPING_MPS);
        let is_in_the_way = |t_s: f32| {
            let (x_m, y_m) = track.after(t_s.max(0.0));
            arc.project(x_m, y_m).1.abs() < HALF_WIDTH_M + BESIDE_WALKER_M
        };
        let times_s = [there_s - MOMENT_S, there_s, there_s + MOMENT_S];
        let is_ahead = to_m > 0.0 && s_m < FORESEEN_M && there_s < FORESEEN_S;
        (is_ahead && times_s.into_iter().any(is_in_the_way)).then_some(to_m - STANDOFF_M)
    };
    tracks.moving(WALKING_MPS).filter_map(meets).reduce(f32::min)
}

fn clearance_m(contact: &Contact, speed_mps: f32) -> f32 {
    match (contact.is_person, contact.on_road) {
        (false, _) => {
            let [standing_m, driving_m] = BESIDE_VEHICLE_M;
            standing_m + (driving_m - standing_m) * (speed_mps / BESIDE_AT_MPS).clamp(0.0, 1.0)
        }
        (true, false) => BESIDE_WALKER_M,
        (true, true) => BESIDE_CROSSING_M,
    }
}

/// Metres from the front of the car to where it lets others pass at a junction without lights: where
/// the car would meet a moving vehicle within the next seconds if both went on.
pub fn give_way_m(arc: Arc, dash: &Dash, tracks: &Tracks) -> Option<f32> {
    if dash.junction_m > GIVE_WAY_M {
        return None;
    }
    let meets = |track: &Track| {
        (1..=GIVE_WAY_STEPS).find_map(|step| {
            let t_s = 0.25 * step as f32;
            let driven_m = drives_off_m(dash.speed_mps, t_s);
            let near = |(x, y): Point, t_s: f32| ops::hypot(track.after(t_s).0 - x, track.after(t_s).1 - y) < MEET_M;
            let is_met = |s_m: &f32| {
                let place = expected_way(arc, dash, *s_m);
                [t_s - 0.75, t_s, t_s + 0.75].into_iter().any(|t_s| near(place, t_s))
            };
            // Who is there already gets away by going on.
            let places_m = PARTS_M.into_iter().map(|part_m| part_m + driven_m).filter(|s_m| *s_m > FRONT_M);
            places_m.rev().find(is_met).map(|s_m| s_m - FRONT_M)
        })
    };
    let same_way = |track: &&Track| track.velocity_mps.0 > 2.0 * track.velocity_mps.1.abs();
    let meeting_m = tracks.moving(1.5).filter(|t| !same_way(t)).filter_map(meets).reduce(f32::min)?;
    // Before the junction it waits at its border, inside right before the other's way.
    let border_m = dash.junction_m - 1.0;
    Some(if border_m > 0.0 { border_m } else { meeting_m - MEET_M })
}

/// The way of a car that goes on as fast as it is, or drives off, metres.
fn drives_off_m(speed_mps: f32, t_s: f32) -> f32 {
    if speed_mps >= TURN_MPS {
        return speed_mps * t_s;
    }
    let speeding_up_s = t_s.min((TURN_MPS - speed_mps) / DRIVING_OFF_MPS2);
    let sped_up_m = (speed_mps + 0.5 * DRIVING_OFF_MPS2 * speeding_up_s) * speeding_up_s;
    sped_up_m + TURN_MPS * (t_s - speeding_up_s)
}

/// Where the rear axle will be after `s_m` metres: straight up to the junction, then round its bend.
fn expected_way(arc: Arc, dash: &Dash, s_m: f32) -> (f32, f32) {
    let straight_m = dash.junction_m;
    let bend = match dash.turn {
        Turn::Straight => arc.curvature,
        Turn::Left => LEFT_BEND.max(arc.curvature),
        Turn::Right => -RIGHT_BEND.max(-arc.curvature),
    };
    let (x, y, _) = Arc { curvature: bend }.at((s_m - straight_m).max(0.0));
    (x + straight_m.min(s_m), y)
}

/// Metres from the front of the car to a stop line that has to be respected.
fn stop_line_m(dash: &Dash) -> Option<f32> {
    let to_line_m = dash.light_m - BEFORE_LINE_M;
    match dash.light? {
        LightPhase::Green => None,
        LightPhase::Red => Some(to_line_m),
        LightPhase::Yellow => (needed_mps2(dash.speed_mps, to_line_m) < YELLOW_MPS2).then_some(to_line_m),
    }
}

/// Speed allowed by the junction ahead, and the distance to it.
fn junction_mps(dash: &Dash, has_lights: bool) -> (f32, f32) {
    let there_mps = match dash.turn {
        Turn::Left => TURN_MPS,
        Turn::Right => RIGHT_TURN_MPS,
        Turn::Straight if !has_lights && dash.junction_m < CROSSING_FROM_M => CROSSING_MPS,
        Turn::Straight => f32::INFINITY,
    };
    (there_mps, dash.junction_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::semantic::moved::Moved;

    /// A person who goes on like this for a second, as they are seen by a car that stands still.
    fn walker(from: (f32, f32), velocity_mps: (f32, f32)) -> Tracks {
        let mut tracks = Tracks::default();
        for look in 0..10 {
            let t_s = 0.1 * look as f32;
            let (x_m, y_m) = (from.0 + t_s * velocity_mps.0, from.1 + t_s * velocity_mps.1);
            tracks.look(&[Contact { x_m, depth_error_m: 0.0, y_m, is_person: true, on_road: false }]);
            (0..6).for_each(|_| tracks.carry(Moved { forward_m: 0.0, turned_rad: 0.0 }));
        }
        tracks
    }

    /// A left turn across the lane of one who comes from ahead with 10 m/s: whether it is waited for.
    #[test]
    fn who_turns_left_waits_for_whom_it_would_not_have_passed_in_time() {
        let oncoming = |x_m: f32| {
            let mut tracks = Tracks::default();
            for look in 0..10 {
                let x_m = x_m + 1.0 * (10 - look) as f32;
                tracks.look(&[Contact { x_m, depth_error_m: 0.0, y_m: 3.5, is_person: false, on_road: true }]);
                (0..6).for_each(|_| tracks.carry(Moved { forward_m: 0.0, turned_rad: 0.0 }));
            }
            tracks
        };
        let dash = |speed_mps| Dash {
            speed_mps,
            limit_mps: 13.9,
            light: None,
            light_m: 0.0,
            turn: Turn::Left,
            junction_m: 0.0,
            bearing_deg: -15,
        };
        let waits = |x_m, speed_mps| give_way_m(Arc { curvature: 0.09 }, &dash(speed_mps), &oncoming(x_m)).is_some();
        // From a stand its rear leaves the other's lane after 4 s, at 5.5 m/s after 2 s.
        assert_eq!([12.0, 25.0, 35.0].map(|x_m| waits(x_m, 0.0)), [true, true, true]);
        assert_eq!([12.0, 25.0, 45.0].map(|x_m| waits(x_m, TURN_MPS)), [true, true, false]);
    }

    #[test]
    fn a_car_creeps_by_a_parked_one_that_is_too_near_for_driving_by() {
        let beside = |room_m: f32| {
            let y_m = -HALF_WIDTH_M - room_m;
            Contact { x_m: 6.0, depth_error_m: 0.0, y_m, is_person: false, on_road: true }
        };
        let (nobody, ahead) = (Tracks::default(), Arc { curvature: 0.0 });
        let stops = |room_m, speed_mps| obstacle(&[beside(room_m)], &nobody, ahead, speed_mps).is_some();
        assert_eq!([0.15, 0.3, 0.45, 0.55].map(|room_m| stops(room_m, 0.0)), [true, false, false, false]);
        assert_eq!([0.15, 0.3, 0.45, 0.55].map(|room_m| stops(room_m, 12.0)), [true, true, true, false]);
    }

    #[test]
    fn the_front_of_a_turning_car_swings_out() {
        let sharp = Arc { curvature: -0.125 };
        let swings_m = swept_m(sharp, 1.0) - HALF_WIDTH_M;
        assert!((0.5..0.8).contains(&swings_m), "{swings_m}");
        assert_eq!(swept_m(sharp, -1.0), HALF_WIDTH_M);
        assert!(swept_m(Arc { curvature: 0.002 }, -1.0) < HALF_WIDTH_M + 0.02);
        assert_eq!([0.0, 1e-8].map(|curvature| swept_m(Arc { curvature }, -1.0)), [HALF_WIDTH_M; 2]);
        // Somebody half a metre beside the straight car is in the way of the turning one.
        let (x_m, y_m) = sharp.beside(5.0, HALF_WIDTH_M + 0.6);
        let beside = Contact { x_m, depth_error_m: 0.0, y_m, is_person: false, on_road: true };
        assert!(obstacle(&[beside], &Tracks::default(), sharp, 2.0).is_some());
    }

    #[test]
    fn a_turn_is_driven_slowly_towards_whom_it_may_end_behind() {
        let at = |x_m: f32, y_m: f32| Contact { x_m, depth_error_m: 0.0, y_m, is_person: false, on_road: true };
        let dash = |junction_m| Dash {
            speed_mps: 5.0,
            limit_mps: 13.9,
            light: None,
            light_m: 0.0,
            turn: Turn::Right,
            junction_m,
            bearing_deg: 0,
        };
        let found = |contact, curvature| after_turn_m(&[contact], Arc { curvature }, &dash(0.0));
        // To the right: straight ahead, between that and the arc, left of it, right of the arc.
        let contacts = [at(16.0, 0.0), at(16.0, -6.0), at(16.0, 4.0), at(6.0, -6.0)];
        assert_eq!(contacts.map(|contact| found(contact, -0.1).is_some()), [true, true, false, false]);
        assert_eq!(
            contacts.map(|contact| found(Contact { y_m: -contact.y_m, ..contact }, 0.1).is_some()),
            [true, true, false, false]
        );
        assert_eq!(found(at(16.0, 0.0), -0.02), None, "a bend");
        assert_eq!(after_turn_m(&[at(16.0, 0.0)], Arc { curvature: -0.1 }, &dash(30.0)), None, "no junction");
    }

    #[test]
    fn who_walks_into_the_way_is_expected_there_and_who_walks_along_it_is_not() {
        let ahead = Arc { curvature: 0.0 };
        let at_8_mps = |tracks: &Tracks| crossing_m(tracks, ahead, 8.0);
        let enters = at_8_mps(&walker((20.0, -5.5), (0.0, 1.4))).expect("it is in the way");
        assert!((enters - (20.0 - FRONT_M - STANDOFF_M)).abs() < 0.5, "{enters}");
        assert_eq!(at_8_mps(&walker((20.0, -4.5), (1.4, 0.0))), None, "along the road");
        assert_eq!(at_8_mps(&walker((20.0, -3.0), (0.0, -1.4))), None, "away from it");
        assert_eq!(at_8_mps(&walker((20.0, -12.0), (0.0, 1.4))), None, "long after the car");
        assert_eq!(at_8_mps(&walker((20.0, -3.0), (0.0, 0.0))), None, "waits");
        // Who will have crossed before a slow car comes is not waited for.
        assert_eq!(crossing_m(&walker((20.0, 1.0), (0.0, 1.4)), ahead, 4.0), None);
    }
}
