//! Braking distances.

use super::*;

/// Distance, metres, of a car whose four tyres all hold with a friction, under the loads that braking gives them, with
/// air drag.
fn stopping_m(friction: f64, from_mps: f64) -> f64 {
    let deceleration = |speed: f64| {
        let mut a = friction * G;
        for _ in 0..50 {
            let moved = MASS * a * HEIGHT / BASE;
            let wheels = [0.5 * (MASS * G * FRONT + moved), 0.5 * (MASS * G * (1.0 - FRONT) - moved)];
            a = (2.0 * (most_n(friction, wheels[0]) + most_n(friction, wheels[1])) + 0.4 * speed * speed) / MASS;
        }
        a
    };
    let step = from_mps / 1000.0;
    (0..1000).map(|k| (f64::from(k) + 0.5) * step).map(|speed| speed * step / deceleration(speed)).sum()
}

/// Distance of a full stop from a speed.
fn driven_m(kind: SurfaceKind, from_mps: f32, setup: CarSetup) -> f64 {
    let mut drive = Drive::over(kind, from_mps, setup);
    drive.hold(30, |car| cruise(car, from_mps, 0.0));
    let (from, speed) = (drive.ego.motion.position.x, f64::from(drive.ego.speed_mps()));
    drive.hold(seconds(20), |_| pedals(0.0, 1.0));
    assert!(drive.ego.speed_mps().abs() < 1e-3, "{}", drive.ego.speed_mps());
    // The engine moves a body by its velocity at a tick's end: half a tick of the way is missing.
    let way_m = f64::from(drive.ego.motion.position.x - from) + 0.5 * speed / 60.0;
    let scale = f64::from(from_mps) / speed * (f64::from(from_mps) / speed);
    way_m * scale
}

#[test]
fn braking_distances_are_those_of_the_tyre_curve() {
    for &kind in SurfaceKind::ALL {
        for kmh in [50.0, 100.0] {
            let from = kmh / 3.6;
            let [peak, sliding] = friction(kind);
            let (best, locked) = (stopping_m(peak, from), stopping_m(sliding, from));
            let abs = driven_m(kind, from as f32, HELPED);
            let bare = driven_m(kind, from as f32, BARE);
            assert!((0.90..1.0).contains(&(best / abs)), "{kind:?} {kmh} km/h: {abs} m, at best {best} m");
            assert!((best / abs) > 0.95, "{kind:?} {kmh} km/h: {abs} m, at best {best} m");
            assert!((bare / locked - 1.0).abs() < 0.05, "{kind:?} {kmh} km/h: {bare} m, sliding {locked} m");
            assert!(bare > 1.05 * abs, "{kind:?} {kmh} km/h: {bare} m, {abs} m");
        }
    }
}

#[test]
fn a_pedal_in_the_daily_range_decelerates_in_proportion() {
    for pedal in [0.1, 0.2, 0.4] {
        let mut drive = Drive::at(20.0);
        let from = drive.ego.speed_mps();
        drive.hold(seconds(1), |_| pedals(0.0, pedal));
        let rate = from - drive.ego.speed_mps();
        // The pedal, rolling resistance, the motor, and air drag.
        let expected = 8.4 * pedal + 5.0 * pedal * pedal * pedal * pedal + 0.13 + 150.0 / 1400.0 + 0.4 * 380.0 / 1400.0;
        assert!((rate / expected - 1.0).abs() < 0.08, "{rate} m/s^2, expected {expected}");
    }
}

#[test]
fn locked_wheels_do_not_steer_and_helped_ones_do() {
    let turned = |setup| {
        let mut drive = Drive::over(SurfaceKind::Road, 20.0, setup);
        drive.hold(seconds(2), |_| Controls::from_fractions(0.4, 0.0, 1.0));
        (drive.ego.heading_rad(), drive.ego.gear.wheels.map(|wheel| wheel.spin_radps))
    };
    let ((bare, spins), (helped, _)) = (turned(BARE), turned(HELPED));
    assert_eq!(spins, [0.0; 4]);
    assert!(bare.abs() < 0.05 && helped < -0.25, "{bare} {helped}");
}
