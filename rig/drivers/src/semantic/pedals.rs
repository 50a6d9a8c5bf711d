//! From what the driver wants to the pedals: a foot that takes its time.

use kernel::time::{TICK_HZ, TICK_S, Tick};

use super::speed::{self, SPEED_TIME_S, Wish};
use crate::vision::LATENCY_TICKS;

/// Acceleration at full throttle and deceleration at full brake, m/s^2.
pub const FULL_THROTTLE_MPS2: f32 = 4.0;
pub const FULL_BRAKE_MPS2: f32 = 8.4;
/// Acceleration and deceleration towards another speed, at most, m/s^2.
const SPEEDING_UP_MPS2: f32 = 2.5;
const SLOWING_DOWN_MPS2: f32 = 4.0;
/// Time from the screen to the pedal where nobody expected it, seconds: with the age of the mask that is on the screen some
/// 0.7 s from the world to the pedal (expected signals: Green 2000).
const REACTION_S: f32 = 0.5;
/// A foot that lifts from the throttle or brakes less than this is not surprised, m/s^2.
const SURPRISING_MPS2: f32 = 0.5;
/// A foot that braked stays over the brake for this long, seconds.
const READY_S: f32 = 1.5;
/// Slower than this the car can be held, m/s.
const HOLDING_MPS: f32 = 0.5;
/// Brake that holds the car.
const HOLDING: f32 = 0.5;
/// Time that the pedals and the suspension take, seconds, and how far the nose goes down for each m/s^2 of braking, radians.
const PEDAL_S: f32 = 0.1;
pub const DOWN_RAD_PER_MPS2: f32 = 0.0032;

/// The right foot.
#[derive(Clone, Copy, Debug)]
pub enum Foot {
    /// On a pedal, or over the brake for some time yet; it has been wanted there at once for so long.
    Drives { ready_ticks: Tick, wanted_ticks: Tick },
    /// Holds the car, which could drive off for so long.
    Holds { free_ticks: Tick },
}

impl Default for Foot {
    fn default() -> Self {
        Self::Drives { ready_ticks: 0, wanted_ticks: 0 }
    }
}

impl Foot {
    /// Throttle and brake for a wish, [0, 1]. What is sudden is done after a reaction time, which is so many times the usual
    /// one: braking for what was not there before, and driving off.
    pub fn press(&mut self, speed_mps: f32, wish: &Wish, reaction_factor: f32) -> (f32, f32) {
        let reaction_ticks = (reaction_factor * REACTION_S * TICK_HZ as f32) as Tick;
        let is_to_stand = wish.speed_mps.min(wish.safe_mps()) < 0.3;
        match self {
            Self::Drives { .. } if is_to_stand && speed_mps < HOLDING_MPS => *self = Self::Holds { free_ticks: 0 },
            Self::Holds { free_ticks } if is_to_stand => *free_ticks = 0,
            Self::Holds { free_ticks } if *free_ticks < reaction_ticks => *free_ticks += 1,
            Self::Holds { .. } => *self = Self::Drives { ready_ticks: ready_ticks(), wanted_ticks: 0 },
            Self::Drives { .. } => {}
        }
        match self {
            Self::Holds { .. } => (0.0, HOLDING),
            Self::Drives { ready_ticks: over_brake, wanted_ticks } => {
                let (free_mps2, stop_mps2) = (free_mps2(speed_mps, wish), stop_mps2(speed_mps, wish));
                if wish.expects_others {
                    *over_brake = ready_ticks();
                }
                let is_wanted = stop_mps2 < free_mps2.min(-SURPRISING_MPS2);
                *wanted_ticks = if is_wanted { *wanted_ticks + 1 } else { 0 };
                let is_surprised = is_wanted && *over_brake == 0 && *wanted_ticks <= reaction_ticks;
                let mps2 = if is_surprised { free_mps2 } else { free_mps2.min(stop_mps2) };
                let brakes_to_stand = stop_mps2 < 0.0 && stop_mps2 <= free_mps2 && !is_surprised;
                *over_brake = if brakes_to_stand || mps2 < -SURPRISING_MPS2 {
                    ready_ticks()
                } else {
                    over_brake.saturating_sub(1)
                };
                if mps2 >= 0.0 { (mps2 / FULL_THROTTLE_MPS2, 0.0) } else { (0.0, -mps2 / FULL_BRAKE_MPS2) }
            }
        }
    }
}

/// The nose of the car, as the driver feels it: it dips when the car brakes, and all in the picture is higher then.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nose {
    mps2: f32,
    /// How far it was down, radians, at the last ticks, the oldest first.
    past_rad: [f32; LATENCY_TICKS as usize + 1],
}

impl Nose {
    /// Takes in what the pedals do.
    pub fn dip(&mut self, throttle: f32, brake: f32, speed_mps: f32) {
        let asked_mps2 = FULL_THROTTLE_MPS2 * throttle - FULL_BRAKE_MPS2 * brake;
        // Who stands is not braked.
        let asked_mps2 = if speed_mps > 0.0 { asked_mps2 } else { asked_mps2.max(0.0) };
        self.mps2 += (asked_mps2 - self.mps2) * TICK_S / PEDAL_S;
        self.past_rad.rotate_left(1);
        self.past_rad[LATENCY_TICKS as usize] = -DOWN_RAD_PER_MPS2 * self.mps2;
    }

    /// How far it was down when the picture was taken that is on the screen for the first time, radians.
    pub fn down_rad(&self) -> f32 {
        self.past_rad[0]
    }
}

fn ready_ticks() -> Tick {
    (READY_S * TICK_HZ as f32) as Tick
}

/// Acceleration towards a speed, m/s^2.
fn towards_mps2(speed_mps: f32, wanted_mps: f32) -> f32 {
    (wanted_mps - speed_mps) / SPEED_TIME_S
}

/// Acceleration with nowhere to stand, m/s^2.
fn free_mps2(speed_mps: f32, wish: &Wish) -> f32 {
    towards_mps2(speed_mps, wish.speed_mps).clamp(-SLOWING_DOWN_MPS2, SPEEDING_UP_MPS2)
}

/// Acceleration towards where the car has to stand, m/s^2: comfortable as long as that is enough, then as hard as the
/// distance that is left asks for.
fn stop_mps2(speed_mps: f32, wish: &Wish) -> f32 {
    let needed_mps2 = wish.stop_in_m.map_or(0.0, |stop_m| speed::needed_mps2(speed_mps, stop_m));
    towards_mps2(speed_mps, wish.safe_mps()).max(-needed_mps2.max(wish.comfort_mps2))
}

#[cfg(test)]
mod tests {
    use super::*;

    const WISH: Wish = Wish { speed_mps: 13.0, stop_in_m: None, comfort_mps2: 2.0, expects_others: false };

    /// Ticks until a foot that was on the throttle does something else.
    fn ticks_until(foot: &mut Foot, speed_mps: f32, wish: &Wish, is_done: impl Fn((f32, f32)) -> bool) -> usize {
        (1..).find(|_| is_done(foot.press(speed_mps, wish, 1.0))).expect("it happens")
    }

    #[test]
    fn who_is_surprised_brakes_after_the_reaction_time_and_who_brakes_already_at_once() {
        let mut foot = Foot::default();
        assert!(foot.press(12.0, &WISH, 1.0).0 > 0.0);
        let sudden = Wish { stop_in_m: Some(20.0), ..WISH };
        let brakes = |(_, brake): (f32, f32)| brake > 0.3;
        assert_eq!(ticks_until(&mut foot, 12.0, &sudden, brakes), 31);
        // Half a second with nothing in the way: the foot is still there.
        (0..30).for_each(|_| assert!(foot.press(12.0, &WISH, 1.0).0 > 0.0));
        assert_eq!(ticks_until(&mut foot, 12.0, &sudden, brakes), 1);
        let mut turns = Foot::default();
        turns.press(12.0, &Wish { expects_others: true, ..WISH }, 1.0);
        assert_eq!(ticks_until(&mut turns, 12.0, &sudden, brakes), 1);
        let mut tired = Foot::default();
        assert!((0..45).all(|_| tired.press(12.0, &sudden, 1.5).1 == 0.0) && tired.press(12.0, &sudden, 1.5).1 > 0.3);
    }

    #[test]
    fn what_comes_gradually_surprises_nobody() {
        let (mut foot, mut speed_mps, mut stop_m, mut hardest) = (Foot::default(), 12.0_f32, 90.0_f32, 0.0_f32);
        while speed_mps > 0.1 {
            let (throttle, brake) = foot.press(speed_mps, &Wish { stop_in_m: Some(stop_m), ..WISH }, 1.5);
            let mps2 = throttle * FULL_THROTTLE_MPS2 - brake * FULL_BRAKE_MPS2;
            hardest = if speed_mps > HOLDING_MPS { hardest.max(-mps2) } else { hardest };
            speed_mps += mps2 / TICK_HZ as f32;
            stop_m -= speed_mps / TICK_HZ as f32;
        }
        assert!(hardest < 2.4 && (-0.8..0.5).contains(&stop_m), "{hardest} m/s^2, {stop_m} m before it");
    }

    #[test]
    fn a_car_that_is_held_drives_off_after_the_reaction_time() {
        let mut foot = Foot::default();
        let red = Wish { stop_in_m: Some(0.0), ..WISH };
        assert_eq!(foot.press(0.2, &red, 1.0), (0.0, HOLDING));
        assert_eq!(ticks_until(&mut foot, 0.0, &WISH, |(throttle, _)| throttle > 0.0), 31);
    }

    /// On a flat road, 6 m/s and then the brake.
    #[test]
    fn the_nose_is_where_the_kernel_has_it() {
        let map = base::maps::Map::find("city").expect("it is bundled");
        let text = "map = \"city\"\n[traffic]\ncars = 0\nmotorcycles = 0\nbicycles = 0\npedestrians = 0\n";
        let scenario = kernel::Scenario::from_toml(text).expect("it is a scenario");
        let mut world = kernel::World::new(&scenario, &map.network).expect("it fits");
        let (mut nose, mut felt) = (Nose::default(), Vec::new());
        for tick in 0..200 {
            let (throttle, brake) = if tick < 120 { (0.8, 0.0) } else { (0.0, 0.35) };
            let semantic = kernel::Controls::from_fractions(0.0, throttle, brake);
            nose.dip(throttle, brake, world.hud().speed_mps);
            world.step(&kernel::TickInput { semantic, safety: kernel::Controls::default() });
            let forward = world.scene().ego.rotation * glam::Vec3::X;
            felt.push((nose.past_rad[LATENCY_TICKS as usize], -forward.z));
        }
        assert!((world.hud().speed_mps - 2.0).abs() < 0.5, "{} m/s", world.hud().speed_mps);
        for (tick, (feels_rad, is_rad)) in felt.into_iter().enumerate() {
            // The body swings when the pedals change, which nobody foresees.
            let most_rad = if (60..120).contains(&tick) || tick >= 160 { 0.0015 } else { 0.009 };
            assert!((feels_rad - is_rad).abs() < most_rad, "tick {tick}: {feels_rad} rad, it is {is_rad}");
        }
    }
}
