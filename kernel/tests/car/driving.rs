//! Daily driving.

use proptest::prelude::*;

use super::*;
use kernel::time::TICK_S;

#[test]
fn it_drives_straight_ahead() {
    let mut drive = Drive::at(0.0);
    drive.hold(seconds(20), |_| pedals(0.7, 0.0));
    let ego = &drive.ego;
    assert!(ego.motion.position.x > 200.0, "{}", ego.motion.position);
    assert!(ego.motion.position.y.abs() < 0.1, "{}", ego.motion.position);
    assert!(ego.motion.position.z.abs() < 0.05, "{}", ego.motion.position);
}

#[test]
fn it_reaches_50_kmh_like_a_car() {
    let mut drive = Drive::at(0.0);
    drive.hold(seconds(4), |_| pedals(1.0, 0.0));
    let kmh = drive.ego.speed_mps() * 3.6;
    assert!((45.0..65.0).contains(&kmh), "{kmh} km/h after 4 s");
}

#[test]
fn reverse_goes_back_and_the_hand_brake_holds() {
    let mut drive = Drive::at(0.0);
    let reverse = Controls { flags: Controls::REVERSE, ..pedals(0.5, 0.0) };
    drive.hold(seconds(3), |_| reverse);
    assert!(drive.ego.speed_mps() < -1.0, "{}", drive.ego.speed_mps());
    drive.hold(seconds(3), |_| Controls { flags: Controls::HAND_BRAKE, ..Default::default() });
    assert!(drive.ego.speed_mps().abs() < 0.01, "{}", drive.ego.speed_mps());
}

#[test]
fn it_creeps_as_an_automatic_once_it_has_been_driven() {
    let mut drive = Drive::at(0.0);
    drive.hold(1, |_| pedals(0.02, 0.0));
    drive.hold(seconds(20), |_| Controls::default());
    let speed = drive.ego.speed_mps();
    assert!((0.8..1.9).contains(&speed), "{speed} m/s");
    drive.hold(seconds(3), |_| pedals(0.0, 0.1));
    assert!(drive.ego.speed_mps().abs() < 1e-3, "{}", drive.ego.speed_mps());
}

/// Speed after rolling without a pedal for a time: drag of 0.4 N s^2/m^2, rolling resistance, 150 N of the motor, and
/// four wheels of 1.2 kg m^2 that go on turning.
pub fn rolled_mps(rolling: f64, from_mps: f64, time_s: f64) -> f64 {
    let inertia = MASS + 4.0 * 1.2 / (0.32 * 0.32);
    let (mut speed, step) = (from_mps, 1e-3);
    for _ in 0..(time_s / step) as usize {
        speed -= step * (0.4 * speed * speed + rolling * MASS * G + 150.0) / inertia;
    }
    speed
}

/// Surfaces, their coefficients of rolling resistance, and for how long a car is watched that coasts on them, s.
pub const ROLLING: [(SurfaceKind, f64, usize); 3] =
    [(SurfaceKind::Road, 0.013, 40), (SurfaceKind::Gravel, 0.02, 40), (SurfaceKind::Terrain, 0.05, 25)];

/// Speeds of a car that rolls without a pedal, from 100 km/h on, each second, m/s.
pub fn coasted_mps(kind: SurfaceKind, seconds_long: usize) -> Vec<f64> {
    let from_mps = 100.0 / 3.6;
    let mut drive = Drive::over(kind, from_mps, HELPED);
    drive.hold(seconds(1), |car| cruise(car, from_mps, 0.0));
    let mut speeds = vec![f64::from(drive.ego.speed_mps())];
    for _ in 0..seconds_long {
        drive.hold(seconds(1), |_| Controls::default());
        speeds.push(f64::from(drive.ego.speed_mps()));
    }
    speeds
}

#[test]
fn coasting_from_100_kmh_is_drag_and_rolling_resistance() {
    for (kind, rolling, seconds_long) in ROLLING {
        let speeds = coasted_mps(kind, seconds_long);
        for (after_s, speed) in speeds.iter().enumerate() {
            let expected = rolled_mps(rolling, speeds[0], after_s as f64);
            let what = format!("{kind:?}: {speed} after {after_s} s, expected {expected}");
            assert!((speed - expected).abs() < 0.01 * speeds[0], "{what}");
        }
    }
}

#[test]
fn drag_acts_under_any_throttle() {
    // A throttle that holds 25 m/s against drag, rolling resistance and idle.
    let hold_n = 0.4 * 625.0 + 0.013 * MASS * G + 150.0;
    let throttle = hold_n / (90_000.0 / 25.0 + 150.0);
    let mut drive = Drive::at(25.0);
    drive.hold(seconds(30), |_| pedals(throttle as f32, 0.0));
    assert!((drive.ego.speed_mps() - 25.0).abs() < 0.5, "{}", drive.ego.speed_mps());
}

/// Way, metres, and speed, m/s, after some ticks of unchanged pedals.
fn driven(kind: SurfaceKind, from_mps: f32, controls: Controls, ticks: Tick) -> (f32, f32) {
    let mut drive = Drive::over(kind, from_mps, HELPED);
    drive.hold(ticks, |_| controls);
    (drive.ego.motion.position.x, drive.ego.speed_mps())
}

/// A car that stopped rocks on its tyres for a moment, so fast, m/s.
const ROCKING_MPS: f32 = 0.1;
/// Below this speed wheels may lock, m/s.
const LET_GO_MPS: f32 = 1.5;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(48)))]

    #[test]
    fn more_throttle_is_never_slower_and_more_brake_never_faster(
        kind in prop::sample::select(GROUNDS.to_vec()),
        from in 0f32..35.0,
        low in 0f32..1.0,
        more in 0f32..1.0,
        ticks in 10..150u64,
    ) {
        let high = low + (1.0 - low) * more;
        let throttled = |throttle| driven(kind, from, pedals(throttle, 0.0), ticks);
        let (less, most) = (throttled(low), throttled(high));
        prop_assert!(most.0 >= less.0 - 0.001 && most.1 >= less.1 - 0.001, "{most:?} {less:?}");
        let braked = |brake| driven(kind, from, pedals(0.0, brake), ticks);
        let (less, most) = (braked(low), braked(high));
        // Where anti-lock brakes let go, the harder pedal locks the wheels sooner, and locked wheels hold less.
        let [peak, sliding] = friction(kind);
        let locked_m = LET_GO_MPS * LET_GO_MPS * 0.5 * (1.0 / (sliding * G) - 1.0 / (peak * G)) as f32;
        prop_assert!(most.0 <= less.0 + locked_m, "{most:?} {less:?}");
        let locked_mps = LET_GO_MPS * (1.0 - sliding / peak) as f32;
        let room = if most.1.abs() < LET_GO_MPS { ROCKING_MPS + locked_mps } else { 0.005 };
        prop_assert!(most.1 <= less.1.max(0.0) + room, "{most:?} {less:?}");
        let both = driven(kind, from, pedals(high, low), ticks);
        prop_assert!(both.0 <= throttled(high).0 + 0.001, "{both:?}");
    }
}

#[test]
fn steering_to_the_right_turns_right_at_half_a_g_without_rolling() {
    for (speed_mps, steer) in [(10.0, 0.22), (14.0, 0.12)] {
        let mut drive = Drive::at(speed_mps);
        drive.hold(seconds(1), |car| cruise(car, speed_mps, steer));
        let before = drive.ego.motion.velocity_mps;
        drive.hold(6, |car| cruise(car, speed_mps, steer));
        let g = (drive.ego.motion.velocity_mps - before).length() / (6.0 * TICK_S) / 9.81;
        assert!((0.4..0.7).contains(&g), "{g} g at {speed_mps} m/s");
        assert!(drive.ego.heading_rad() < -0.2);
        assert!(drive.upright() > 0.99, "{}", drive.upright());
    }
}
