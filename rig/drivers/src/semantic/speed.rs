//! How fast to go: the limit, bends, junctions, lights, and whatever stands in the way.

use kernel::ego::{self, FRONT_M};
use kernel::events::Hud;
use kernel::map::Turn;
use kernel::ops;
use kernel::signals::LightPhase;

use super::arc::Arc;
use super::memory::{Track, Tracks};
use super::sight::{Contact, Sight};

/// Half of the car's width, metres.
const HALF_WIDTH_M: f32 = 0.5 * ego::SIZE_M.y;
/// Deceleration that is planned with, m/s^2.
pub const COMFORT_MPS2: f32 = 2.0;
/// Time in which a wrong speed is made right, seconds.
pub const SPEED_TIME_S: f32 = 0.7;
/// Deceleration that a yellow light is worth, m/s^2.
const YELLOW_MPS2: f32 = 3.5;
/// Lateral acceleration in bends, m/s^2.
const LATERAL_MPS2: f32 = 2.2;
/// Gap kept to what stands in the way, metres.
const STANDOFF_M: f32 = 4.0;
/// Where the car stops before a stop line, metres.
const BEFORE_LINE_M: f32 = 1.5;
/// Speed in turns at junctions, m/s.
const TURN_MPS: f32 = 5.5;
/// Speed across junctions without lights, m/s.
const CROSSING_MPS: f32 = 5.5;
/// Speed at which the end of the visible road is approached, m/s.
const FEELING_MPS: f32 = 4.5;
/// Distance to a junction within which others are given way, metres.
const GIVE_WAY_M: u16 = 14;
/// Quarters of a second that are looked ahead there.
const GIVE_WAY_STEPS: u32 = 16;
/// Distance at which two vehicles meet, metres.
const MEET_M: f32 = 3.0;
/// Curvature of usual turns, 1/m.
const LEFT_BEND: f32 = 0.09;
const RIGHT_BEND: f32 = 0.14;
/// How far the road is looked at, metres.
const REACH_M: f32 = 45.0;
/// How far ahead along the arc somebody counts as in the way, metres: what 2 m/s^2 need from 50 km/h.
const IN_THE_WAY_M: f32 = 50.0;
/// Side clearance to vehicles, to people beside the road, and to people on it, metres.
const BESIDE_VEHICLE_M: f32 = 0.5;
const BESIDE_WALKER_M: f32 = 0.6;
const BESIDE_CROSSING_M: f32 = 3.6;

/// People who move faster than this walk, m/s.
const WALKING_MPS: f32 = 0.5;
/// How far ahead people are believed to keep their way, and how well it is known when they are somewhere, seconds.
const FORESEEN_S: f32 = 3.5;
const MOMENT_S: f32 = 0.7;
/// Speed with which the car is taken to come by, at least, m/s.
const CREEPING_MPS: f32 = 2.0;

/// The speed from which the car can slow to `end_mps` within `distance_m`.
fn braking_from(end_mps: f32, distance_m: f32) -> f32 {
    (end_mps * end_mps + 2.0 * COMFORT_MPS2 * distance_m.max(0.0)).sqrt()
}

/// The speed from which the car comes to a stand within `distance_m` by comfortable braking that sets in after the time
/// in which a wrong speed is made right (the safe speed of Gipps 1981 behind one who stands).
pub fn safe_mps(distance_m: f32) -> f32 {
    let lag_mps = COMFORT_MPS2 * SPEED_TIME_S;
    braking_from(lag_mps, distance_m) - lag_mps
}

/// What the driver wants of the pedals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish {
    /// Speed that would be right now with nowhere to stand, m/s.
    pub speed_mps: f32,
    /// Distance to a point where the car has to stand, metres from its front.
    pub stop_in_m: Option<f32>,
}

/// Others on the road, and where to wait for them.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    /// Metres from the front of the car to where it must stand because of people and vehicles.
    pub obstacle_m: Option<f32>,
    /// Metres from the front of the car to where it lets others pass.
    pub give_way_m: Option<f32>,
    /// The HUD shows a light, or showed the one of this junction.
    pub has_lights: bool,
}

/// The speed for an arc.
pub fn wish(sight: &Sight<'_>, arc: Arc, hud: &Hud, scene: Scene) -> Wish {
    let stops = [scene.obstacle_m, stop_line_m(hud), scene.give_way_m];
    let stop_in_m = stops.into_iter().flatten().reduce(f32::min);
    let bend_mps = (LATERAL_MPS2 / arc.curvature.abs().max(1e-3)).sqrt();
    let road_mps = braking_from(FEELING_MPS, arc.free_m(sight, REACH_M) - FRONT_M);
    let speed_mps = hud.limit_mps.min(bend_mps).min(road_mps).min(junction_mps(hud, scene.has_lights));
    Wish { speed_mps, stop_in_m }
}

/// Metres from the front of the car to where it must stand because of people and vehicles.
pub fn obstacle_m(contacts: &[Contact], arc: Arc) -> Option<f32> {
    let distances = contacts.iter().filter_map(|contact| {
        let (s_m, left_m) = arc.project(contact.x_m, contact.y_m);
        let in_the_way = s_m < IN_THE_WAY_M && left_m.abs() < HALF_WIDTH_M + clearance_m(contact);
        in_the_way.then_some(s_m - FRONT_M - STANDOFF_M)
    });
    distances.reduce(f32::min)
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
        let is_ahead = to_m > 0.0 && s_m < IN_THE_WAY_M && there_s < FORESEEN_S;
        (is_ahead && times_s.into_iter().any(is_in_the_way)).then_some(to_m - STANDOFF_M)
    };
    tracks.moving(WALKING_MPS).filter_map(meets).reduce(f32::min)
}

fn clearance_m(contact: &Contact) -> f32 {
    match (contact.is_person, contact.on_road) {
        (false, _) => BESIDE_VEHICLE_M,
        (true, false) => BESIDE_WALKER_M,
        (true, true) => BESIDE_CROSSING_M,
    }
}

/// Metres from the front of the car to where it lets others pass at a junction without lights: where
/// the car would meet a moving vehicle within the next seconds if both went on.
pub fn give_way_m(arc: Arc, hud: &Hud, tracks: &Tracks) -> Option<f32> {
    if hud.arrow.distance_m > GIVE_WAY_M {
        return None;
    }
    let own_mps = hud.speed_mps.max(3.5);
    let meets = |track: &Track| {
        (1..=GIVE_WAY_STEPS).find_map(|step| {
            let t_s = 0.25 * step as f32;
            let (x, y) = expected_way(arc, hud, FRONT_M + own_mps * t_s);
            let near = |t_s: f32| ops::hypot(track.after(t_s).0 - x, track.after(t_s).1 - y) < MEET_M;
            [t_s - 0.75, t_s, t_s + 0.75].into_iter().any(near).then_some(own_mps * t_s)
        })
    };
    let same_way = |track: &&Track| track.velocity_mps.0 > 2.0 * track.velocity_mps.1.abs();
    let meeting_m = tracks.moving(1.5).filter(|t| !same_way(t)).filter_map(meets).reduce(f32::min)?;
    // Before the junction it waits at its border, inside right before the other's way.
    let border_m = f32::from(hud.arrow.distance_m) - 1.0;
    Some(if border_m > 0.0 { border_m } else { meeting_m - MEET_M })
}

/// Where the rear axle will be after `s_m` metres: straight up to the junction, then round its bend.
fn expected_way(arc: Arc, hud: &Hud, s_m: f32) -> (f32, f32) {
    let straight_m = f32::from(hud.arrow.distance_m);
    let bend = match hud.arrow.turn {
        Turn::Straight => arc.curvature,
        Turn::Left => LEFT_BEND.max(arc.curvature),
        Turn::Right => -RIGHT_BEND.max(-arc.curvature),
    };
    let (x, y, _) = Arc { curvature: bend }.at((s_m - straight_m).max(0.0));
    (x + straight_m.min(s_m), y)
}

/// Metres from the front of the car to a stop line that has to be respected.
fn stop_line_m(hud: &Hud) -> Option<f32> {
    let to_line_m = f32::from(hud.light_distance_m) - BEFORE_LINE_M;
    let needed_mps2 = hud.speed_mps * hud.speed_mps / (2.0 * to_line_m.max(0.1));
    match hud.light? {
        LightPhase::Green => None,
        LightPhase::Red => Some(to_line_m),
        LightPhase::Yellow => (needed_mps2 < YELLOW_MPS2).then_some(to_line_m),
    }
}

/// Speed allowed by the junction ahead.
fn junction_mps(hud: &Hud, has_lights: bool) -> f32 {
    let there_mps = match hud.arrow.turn {
        Turn::Left | Turn::Right => TURN_MPS,
        Turn::Straight if !has_lights && hud.arrow.distance_m < 30 => CROSSING_MPS,
        Turn::Straight => return f32::INFINITY,
    };
    braking_from(there_mps, f32::from(hud.arrow.distance_m) - 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::semantic::memory::Moved;

    /// A person who goes on like this for a second, as they are seen by a car that stands still.
    fn walker(from: (f32, f32), velocity_mps: (f32, f32)) -> Tracks {
        let mut tracks = Tracks::default();
        for look in 0..10 {
            let t_s = 0.1 * look as f32;
            let (x_m, y_m) = (from.0 + t_s * velocity_mps.0, from.1 + t_s * velocity_mps.1);
            tracks.look(&[Contact { x_m, y_m, is_person: true, on_road: false }]);
            (0..6).for_each(|_| tracks.carry(Moved { forward_m: 0.0, turned_rad: 0.0 }));
        }
        tracks
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
