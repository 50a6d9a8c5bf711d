//! Who comes towards a slow car, and may need the road that is between its arc and straight ahead, is let come by first.

use kernel::ego::FRONT_M;

use super::arc::{Arc, HALF_WIDTH_M, Point};
use super::tracks::{Track, Tracks};

/// Slower than this the car lets others come by, m/s: it has slowed for them, or drives off.
const SLOW_MPS: f32 = 4.0;
/// Who comes faster than this along the car's axis, m/s, and is nearer than this, metres, goes on for so long, seconds.
const COMES_MPS: f32 = 1.0;
const NEAR_M: f32 = 16.0;
const FORESEEN_S: f32 = 1.75;
const STEP_S: f32 = 0.25;
/// Half of the width of a car and room beside it, metres.
const ROOM_M: f32 = HALF_WIDTH_M + 1.1;
/// So far before them the car stands, metres.
const STANDOFF_M: f32 = 1.5;

/// Metres from the front of the car to where it must stand because of those who come: who turns ends somewhere between the
/// arc and straight ahead, and they do, too.
pub fn coming_m(arc: Arc, speed_mps: f32, vehicles: &Tracks) -> Option<f32> {
    let comes = |track: &&Track| track.velocity_mps.0 < -COMES_MPS && track.at.0 < NEAR_M;
    let meets_m = |track: &Track| {
        let steps = (0..=(FORESEEN_S / STEP_S) as u32).map(|step| track.after(step as f32 * STEP_S));
        let in_the_way = steps.filter(|at| at.0 > FRONT_M && is_between(arc, *at));
        in_the_way.map(|(x_m, _)| x_m - FRONT_M - STANDOFF_M).reduce(f32::min)
    };
    let coming = vehicles.moving(COMES_MPS).filter(|_| speed_mps < SLOW_MPS).filter(comes);
    coming.filter_map(meets_m).reduce(f32::min)
}

/// Whether a place lies between an arc and straight ahead, or near one of them.
fn is_between(arc: Arc, (x_m, y_m): Point) -> bool {
    let (_, left_m) = arc.project(x_m, y_m);
    left_m.min(y_m) < ROOM_M && left_m.max(y_m) > -ROOM_M
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::semantic::moved::Moved;
    use crate::semantic::sight::Contact;

    /// Somebody who goes on like this for a second, as they are seen by a car that stands still.
    fn seen(from: Point, velocity_mps: Point) -> Tracks {
        let mut tracks = Tracks::default();
        for look in 0..10 {
            let t_s = 0.1 * look as f32;
            tracks.look(&[Contact::of_car((from.0 + t_s * velocity_mps.0, from.1 + t_s * velocity_mps.1))]);
            (0..6).for_each(|_| tracks.carry(Moved { forward_m: 0.0, turned_rad: 0.0 }));
        }
        tracks
    }

    /// Out of a right turn, its nose still to the left: an oncoming car is straight ahead, and beside the arc.
    #[test]
    fn a_slow_car_lets_come_by_who_comes_between_its_arc_and_straight_ahead() {
        let right = Arc { curvature: -0.08 };
        let oncoming = seen((15.0, 0.5), (-3.0, 0.5));
        let stands_in_m = coming_m(right, 2.0, &oncoming).expect("it comes");
        assert!(stands_in_m < 5.0, "{stands_in_m}");
        assert_eq!(coming_m(right, 6.0, &oncoming), None, "who is fast has decided otherwise");
        assert_eq!(coming_m(right, 2.0, &seen((15.0, 0.5), (3.0, 0.5))), None, "it drives away");
        assert_eq!(coming_m(right, 2.0, &seen((15.0, 0.5), (0.0, 0.0))), None, "it stands");
        assert_eq!(coming_m(right, 2.0, &seen((12.0, -10.0), (-3.0, 0.0))), None, "on the inner side of the turn");
    }

    /// Somebody ahead turns left across the way: not yet across it, but on the way there.
    #[test]
    fn who_turns_across_the_way_is_let_pass_and_who_keeps_its_lane_is_not_waited_for() {
        let ahead = Arc { curvature: 0.0 };
        assert!(coming_m(ahead, 1.3, &seen((16.0, 6.5), (-4.6, -2.2))).is_some());
        assert_eq!(coming_m(ahead, 1.3, &seen((16.0, 3.0), (-4.6, 0.0))), None);
    }
}
