//! How fast to go: the limit, bends, junctions, lights, and whatever stands in the way.

use kernel::ego::FRONT_M;
use kernel::map::Turn;
use kernel::ops;
use kernel::signals::LightPhase;

use super::arc::{Arc, HALF_WIDTH_M};
use super::aside::Course;
use super::memory::{Ahead, Dash};
use super::sight::{Contact, Sight};
use super::tracks::Tracks;

/// Deceleration that an attentive driver plans with, m/s^2.
const COMFORT_MPS2: f32 = 2.0;
/// Time in which a wrong speed is made right, seconds.
pub const SPEED_TIME_S: f32 = 0.7;
/// Deceleration that a yellow light is worth, m/s^2.
const YELLOW_MPS2: f32 = 3.5;
/// Lateral acceleration of an attentive driver in bends, m/s^2.
const LATERAL_MPS2: f32 = 2.2;
/// Gap kept to what stands in the way, metres.
pub const STANDOFF_M: f32 = 4.0;
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
/// How far the road is looked at, metres.
const REACH_M: f32 = 90.0;
/// How far ahead along the arc somebody counts as in the way, at least, metres: what 2 m/s^2 need from 50 km/h.
const IN_THE_WAY_M: f32 = 50.0;
/// Deceleration that who drives ahead is expected to brake with at any time, m/s^2.
const LEADER_MPS2: f32 = 4.0;
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
/// Slower than this the car creeps, m/s, and looks at the bumpers of lorries that are nearer than this, metres.
const CREEPING_MPS: f32 = 3.0;
const BUMPERS_TO_M: f32 = 7.0;
const BESIDE_WALKER_M: f32 = 0.6;
const BESIDE_CROSSING_M: f32 = 3.6;

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
pub fn obstacle(contacts: &[Contact], vehicles: &Tracks, course: Course, speed_mps: f32) -> Option<Ahead> {
    let creeps = speed_mps < CREEPING_MPS;
    let in_the_way = contacts.iter().filter_map(|contact| {
        let arc = course.by(contact.x_m);
        let (s_m, left_m) = arc.project(contact.x_m, contact.y_m);
        let is_beside = |left_m: f32, room_m: f32| left_m.abs() >= arc.swept_m(left_m) + room_m;
        // Who creeps by the bumper of a lorry is nearer to it than to the ground that it hides.
        let is_bumper = creeps && contact.is_high() && contact.x_m < BUMPERS_TO_M;
        let lowest = contact.lowest();
        let is_clear = !is_bumper || is_beside(arc.project(lowest.0, lowest.1).1, BESIDE_VEHICLE_M[0]);
        if s_m >= in_the_way_m(speed_mps) || is_beside(left_m, clearance_m(contact, speed_mps)) && is_clear {
            return None;
        }
        let leads_mps = leads_mps(contact, vehicles, arc);
        Some(Ahead { stop_in_m: s_m - FRONT_M - STANDOFF_M + standing_m(leads_mps), leads_mps })
    });
    in_the_way.reduce(Ahead::nearer)
}

/// Whether the car turns at a junction.
fn is_turning(dash: &Dash) -> bool {
    dash.turn != Turn::Straight && dash.junction_m == 0.0
}

/// Where the car must stand, metres from its front, if it goes on straight at any moment of a turn: behind those between
/// its arc and straight ahead, and behind where those who drive away would come to a stand.
pub fn after_turn_m(contacts: &[Contact], vehicles: &Tracks, arc: Arc, dash: &Dash) -> Option<f32> {
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
    let stand_in_m = |contact: &Contact| {
        let stand_m = standing_m(leads_mps(contact, vehicles, Arc::to(contact.x_m, contact.y_m)));
        ops::hypot(contact.x_m, contact.y_m) - FRONT_M - STANDOFF_M + stand_m
    };
    found.map(stand_in_m).reduce(f32::min)
}

/// How fast somebody drives ahead, m/s; people do not.
fn leads_mps(contact: &Contact, vehicles: &Tracks, arc: Arc) -> f32 {
    if contact.is_person { 0.0 } else { vehicles.leads_mps(contact, arc) }
}

/// The way on which who drives ahead comes to a stand, metres.
fn standing_m(leads_mps: f32) -> f32 {
    0.5 * leads_mps * leads_mps / LEADER_MPS2
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

/// Metres from the front of the car to a stop line that has to be respected.
fn stop_line_m(dash: &Dash) -> Option<f32> {
    let to_line_m = dash.light_m - BEFORE_LINE_M;
    match dash.light? {
        LightPhase::Green => None,
        LightPhase::Red => Some(to_line_m),
        LightPhase::Yellow => (needed_mps2(dash.speed_mps, to_line_m) < YELLOW_MPS2).then_some(to_line_m),
    }
}

/// Speed in a turn at a junction, m/s.
pub fn turning_mps(turn: Turn) -> f32 {
    if turn == Turn::Right { RIGHT_TURN_MPS } else { TURN_MPS }
}

/// Speed allowed by the junction ahead, and the distance to it.
fn junction_mps(dash: &Dash, has_lights: bool) -> (f32, f32) {
    let there_mps = match dash.turn {
        Turn::Straight if !has_lights && dash.junction_m < CROSSING_FROM_M => CROSSING_MPS,
        Turn::Straight => f32::INFINITY,
        turn => turning_mps(turn),
    };
    (there_mps, dash.junction_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_car_creeps_by_a_parked_one_that_is_too_near_for_driving_by() {
        let beside = |room_m: f32| {
            let y_m = -HALF_WIDTH_M - room_m;
            Contact::of_car((6.0, y_m))
        };
        let (nobody, ahead) = (Tracks::default(), Arc { curvature: 0.0 });
        let ahead = Course::straight_on(ahead);
        let stops = |room_m, speed_mps| obstacle(&[beside(room_m)], &nobody, ahead, speed_mps).is_some();
        assert_eq!([0.15, 0.3, 0.45, 0.55].map(|room_m| stops(room_m, 0.0)), [true, false, false, false]);
        assert_eq!([0.15, 0.3, 0.45, 0.55].map(|room_m| stops(room_m, 12.0)), [true, true, true, false]);
    }

    #[test]
    fn who_is_beside_the_straight_car_may_be_in_the_way_of_the_turning_one() {
        let sharp = Arc { curvature: -0.125 };
        let (x_m, y_m) = sharp.beside(5.0, HALF_WIDTH_M + 0.6);
        let beside = Contact::of_car((x_m, y_m));
        assert!(obstacle(&[beside], &Tracks::default(), Course::straight_on(sharp), 2.0).is_some());
    }

    /// The front of a lorry 3 m ahead hides ground that is beside the car's way.
    #[test]
    fn a_car_does_not_creep_into_a_bumper_that_hides_the_ground_beside_it() {
        let bumper = Contact { height_m: 2.5, ..Contact::of_car((6.8, HALF_WIDTH_M + 0.4)) };
        let ahead = Course::straight_on(Arc { curvature: 0.0 });
        let stops = |contact, speed_mps| obstacle(&[contact], &Tracks::default(), ahead, speed_mps).is_some();
        assert!(stops(bumper, 1.0));
        let others =
            [Contact { x_m: 9.0, ..bumper }, Contact { y_m: 2.2, ..bumper }, Contact { height_m: 1.4, ..bumper }];
        assert_eq!(others.map(|contact| stops(contact, 1.0)), [false; 3], "far ahead, well beside, a car");
    }

    #[test]
    fn a_turn_is_driven_slowly_towards_whom_it_may_end_behind() {
        let at = |x_m: f32, y_m: f32| Contact::of_car((x_m, y_m));
        let dash =
            |junction_m| Dash { speed_mps: 5.0, limit_mps: 13.9, turn: Turn::Right, junction_m, ..Dash::default() };
        let found = |contact, curvature| after_turn_m(&[contact], &Tracks::default(), Arc { curvature }, &dash(0.0));
        // To the right: straight ahead, between that and the arc, left of it, right of the arc.
        let contacts = [at(16.0, 0.0), at(16.0, -6.0), at(16.0, 4.0), at(6.0, -6.0)];
        assert_eq!(contacts.map(|contact| found(contact, -0.1).is_some()), [true, true, false, false]);
        assert_eq!(
            contacts.map(|contact| found(Contact { y_m: -contact.y_m, ..contact }, 0.1).is_some()),
            [true, true, false, false]
        );
        assert_eq!(found(at(16.0, 0.0), -0.02), None, "a bend");
        assert_eq!(
            after_turn_m(&[at(16.0, 0.0)], &Tracks::default(), Arc { curvature: -0.1 }, &dash(30.0)),
            None,
            "no junction"
        );
    }
}
