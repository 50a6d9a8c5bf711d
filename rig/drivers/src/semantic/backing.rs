//! A step back from what has come so near that neither can go on: a bus, say, whose tail would sweep over the car's place.

use kernel::Controls;
use kernel::ego::FRONT_M;
use kernel::time::TICK_S;

use super::arc::HALF_WIDTH_M;
use super::moved::Moved;
use super::sight::Contact;

/// So long the car stands without a way by before it backs off, seconds.
const WAITED_S: f32 = 45.0;
/// Who stands nearer before its front, and to its sides, may need its place, metres. Queues keep more.
const NEAR_M: f32 = 1.5;
const BESIDE_M: f32 = 0.3;
/// So far it backs off, metres, within so long, seconds: less than who has stopped behind it leaves.
const BACK_M: f32 = 1.2;
const LONGEST_S: f32 = 6.0;
/// Its speed then, m/s, and the throttle for each m/s that is missing.
const BACKING_MPS: f32 = 0.6;
const THROTTLE_S_PER_M: f32 = 0.5;
const BRAKE: f32 = 0.3;
/// It does so again only after it has driven on, metres.
const AGAIN_M: f32 = 5.0;
/// Who has come no farther than this still stands there, metres: a way by that led nowhere.
const NOWHERE_M: f32 = 0.5;

/// Whether the car backs off, and when it may.
#[derive(Clone, Copy, Debug)]
pub enum Backing {
    /// It has been stuck for so long, and has come so far meanwhile.
    Waits { stood_s: f32, crept_m: f32 },
    /// It backs off, so far yet and for so long at most.
    Backs { left_m: f32, left_s: f32 },
    /// It did, and has driven so far since.
    Backed { driven_m: f32 },
}

impl Default for Backing {
    fn default() -> Self {
        Self::Waits { stood_s: 0.0, crept_m: 0.0 }
    }
}

impl Backing {
    /// Whether the reverse gear is in.
    pub fn is_on(&self) -> bool {
        matches!(self, Self::Backs { .. })
    }

    /// Takes in how the car moved in this tick; `is_stuck` where it waits for what stands close before it and knows no way by.
    pub fn carry(&mut self, moved: Moved, is_stuck: bool) {
        match self {
            Self::Waits { stood_s, crept_m } => {
                *crept_m += moved.forward_m;
                *stood_s += if is_stuck && moved.forward_m == 0.0 { TICK_S } else { 0.0 };
                if *crept_m > NOWHERE_M {
                    *self = Self::default();
                } else if *stood_s >= WAITED_S {
                    *self = Self::Backs { left_m: BACK_M, left_s: LONGEST_S };
                }
            }
            Self::Backs { left_m, left_s } => {
                *left_m += moved.forward_m;
                *left_s -= TICK_S;
                if *left_m <= 0.0 || *left_s <= 0.0 {
                    *self = Self::Backed { driven_m: 0.0 };
                }
            }
            Self::Backed { driven_m } => {
                *driven_m += moved.forward_m;
                if *driven_m > AGAIN_M {
                    *self = Self::default();
                }
            }
        }
    }

    /// The pedals and the gear at a speed backwards, m/s; the wheel stays as it is given.
    pub fn controls(steer: f32, back_mps: f32) -> Controls {
        let missing_mps = BACKING_MPS - back_mps;
        let throttle = THROTTLE_S_PER_M * missing_mps;
        let brake = if missing_mps < -BACKING_MPS { BRAKE } else { 0.0 };
        Controls { flags: Controls::REVERSE, ..Controls::from_fractions(steer, throttle, brake) }
    }
}

/// Whether a vehicle is closer before the car than one stops behind another.
pub fn is_close(contacts: &[Contact]) -> bool {
    let near = |contact: &Contact| {
        let (x_m, y_m) = contact.nearest().unwrap_or(contact.lowest());
        x_m < FRONT_M + NEAR_M && y_m.abs() < HALF_WIDTH_M + BESIDE_M
    };
    contacts.iter().any(|contact| !contact.is_person && near(contact))
}

#[cfg(test)]
mod tests {
    use super::*;

    const STILL: Moved = Moved { forward_m: 0.0, turned_rad: 0.0 };

    fn moved(mps: f32) -> Moved {
        Moved { forward_m: mps * TICK_S, turned_rad: 0.0 }
    }

    fn after(backing: &mut Backing, seconds: f32, moved: Moved, is_stuck: bool) -> bool {
        (0..(seconds / TICK_S) as usize).for_each(|_| backing.carry(moved, is_stuck));
        backing.is_on()
    }

    #[test]
    fn it_backs_off_once_after_a_while_and_again_only_after_it_has_driven_on() {
        let mut backing = Backing::default();
        assert!(!after(&mut backing, WAITED_S - 1.0, STILL, true));
        assert!(!after(&mut backing, 2.0, moved(0.3), true) && !after(&mut backing, WAITED_S - 1.0, STILL, true));
        assert!(!after(&mut backing, 0.2, moved(0.3), false), "a way by that led nowhere");
        assert!(after(&mut backing, 1.1, STILL, true));
        assert!(after(&mut backing, 0.9 * BACK_M / BACKING_MPS, moved(-BACKING_MPS), true));
        assert!(!after(&mut backing, 0.2 * BACK_M / BACKING_MPS, moved(-BACKING_MPS), true));
        assert!(!after(&mut backing, 3.0 * WAITED_S, STILL, true), "once");
        assert!(
            !after(&mut backing, 1.1 * AGAIN_M, moved(1.0), false) && after(&mut backing, WAITED_S + 0.1, STILL, true)
        );
        assert!(!after(&mut backing, LONGEST_S + 0.1, STILL, true), "something holds it");
    }

    #[test]
    fn only_vehicles_close_before_it_call_for_that() {
        let close = |x_m: f32, y_m: f32| is_close(&[Contact::of_car((FRONT_M + x_m, y_m))]);
        assert!(close(1.0, 0.0) && close(1.0, 1.1) && !close(2.5, 0.0) && !close(1.0, 2.0));
        let person = Contact { is_person: true, ..Contact::of_car((FRONT_M + 1.0, 0.0)) };
        assert!(!is_close(&[person]));
        let flank = Contact { is_cut: true, ..Contact::of_car((FRONT_M + 2.5, 0.0)) };
        assert!(is_close(&[flank]), "the picture cuts it");
    }

    #[test]
    fn the_car_rolls_back_at_its_speed() {
        let at = |mps: f32| Backing::controls(0.0, mps);
        assert!([0.0, 0.3, 0.6, 2.0].into_iter().all(|mps| at(mps).has(Controls::REVERSE)));
        assert!(
            at(0.0).throttle > at(0.3).throttle && at(0.6).throttle == 0 && at(0.0).brake == 0 && at(2.0).brake > 0
        );
    }
}
