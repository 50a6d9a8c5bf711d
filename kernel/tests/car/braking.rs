//! Braking distances.

use super::*;

/// Distance, metres, of a car whose four tyres all hold with a friction by speed, under the loads that braking gives
/// them, with air drag.
fn stopping_m(friction: impl Fn(f64) -> f64, from_mps: f64) -> f64 {
    let deceleration = |speed: f64| {
        let friction = friction(speed);
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
fn driven_m(kind: SurfaceKind, weather: &Weather, from_mps: f32, setup: CarSetup) -> f64 {
    let mut drive = Drive { water: Water::of(weather), ..Drive::over(kind, from_mps, setup) };
    drive.hold(30, |car| cruise(car, from_mps, 0.0));
    let (from, speed) = (drive.ego.motion.position.x, f64::from(drive.ego.speed_mps()));
    drive.hold(seconds(60), |_| pedals(0.0, 1.0));
    assert!(drive.ego.speed_mps().abs() < 1e-3, "{}", drive.ego.speed_mps());
    // The engine moves a body by its velocity at a tick's end: half a tick of the way is missing.
    let way_m = f64::from(drive.ego.motion.position.x - from) + 0.5 * speed / 60.0;
    let scale = f64::from(from_mps) / speed * (f64::from(from_mps) / speed);
    way_m * scale
}

/// Peak or sliding friction by speed on ground of some wetness, 0 to 1, in water of some depth, mm, that lifts the tyre
/// by 10.35 mph times the root of its pressure of 2.3 bar in psi.
fn in_water(dry: f64, wet: f64, wetness: f64, depth_mm: f64) -> impl Fn(f64) -> f64 {
    let floats_mps = 10.35 * f64::sqrt(2.3 * 14.504) * 0.44704;
    move |speed| {
        let lifted = (speed / floats_mps) * (speed / floats_mps) * f64::min(depth_mm / 3.0, 1.0);
        (dry * (1.0 - wetness) + wet * wetness) * f64::max(1.0 - lifted, 0.05)
    }
}

/// Full stops from a speed, metres: the tyre curve integrated independently, at its peak and sliding, and driven with
/// anti-lock brakes and with locked wheels.
pub struct Stops {
    pub best: f64,
    pub locked: f64,
    pub abs: f64,
    pub bare: f64,
}

pub fn stops(kind: SurfaceKind, wetness: f64, kmh: f64) -> Stops {
    let weather = Weather { wetness_pct: 100.0 * wetness as f32, ..Weather::dry(0.0, 0.0, 45.0, 0.0) };
    let film_mm = if kind == SurfaceKind::Terrain { 0.0 } else { 0.4 * wetness };
    let from = kmh / 3.6;
    let ([peak, sliding], [wet_peak, wet_sliding]) = (friction(kind), wet_friction(kind));
    Stops {
        best: stopping_m(in_water(peak, wet_peak, wetness, film_mm), from),
        locked: stopping_m(in_water(sliding, wet_sliding, wetness, film_mm), from),
        abs: driven_m(kind, &weather, from as f32, HELPED),
        bare: driven_m(kind, &weather, from as f32, BARE),
    }
}

#[test]
fn braking_distances_are_those_of_the_tyre_curve_by_surface_and_wetness() {
    let cases = GROUNDS.iter().flat_map(|kind| [0.0, 0.5, 1.0].map(|wetness| (*kind, wetness)));
    for (kind, wetness) in cases {
        for kmh in [50.0, 100.0] {
            let Stops { best, locked, abs, bare } = stops(kind, wetness, kmh);
            let what = format!("{kind:?}, wetness {wetness}, {kmh} km/h");
            assert!((0.95..1.0).contains(&(best / abs)), "{what}: {abs} m, at best {best} m");
            assert!((bare / locked - 1.0).abs() < 0.05, "{what}: {bare} m, sliding {locked} m");
            assert!(bare > 1.05 * abs, "{what}: {bare} m, {abs} m");
        }
    }
}

#[test]
fn a_fast_car_floats_on_water_and_a_slow_one_does_not() {
    let wet = Weather { wetness_pct: 100.0, ..Weather::dry(0.0, 0.0, 45.0, 0.0) };
    let flooded = Weather { precipitation_pct: 100.0, puddles_pct: 100.0, ..wet };
    let times = |kmh: f32| {
        let [flooded, wet] = [flooded, wet].map(|weather| driven_m(SurfaceKind::Road, &weather, kmh / 3.6, HELPED));
        flooded / wet
    };
    let [town, road, motorway] = [30.0, 60.0, 110.0].map(times);
    assert!(town < 1.1 && road < 1.4 && motorway > 2.0, "{town} {road} {motorway}");
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
