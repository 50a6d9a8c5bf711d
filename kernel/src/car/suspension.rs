//! Springs, dampers and anti-roll bars between the body and wheels without a mass of their own, which stand on tyres
//! that are springs themselves. So the deflection follows a step of the ground within milliseconds, not at once.

use super::dimensions::{WHEEL_RADIUS_M, is_front, standing_load_n};

/// Way from where the spring is fixed to the hub with the spring unloaded, metres.
pub const REST_M: f32 = 0.3;
/// How far a spring is pressed when the car stands, metres: the body bounces at 1.7 Hz.
const STANDING_M: f32 = 0.086;
/// Stiffness of a tyre, N/m.
const TYRE_N_PER_M: f32 = 200_000.0;
/// Damping in compression and in release, N s/m.
const BUMP_NS_PER_M: f32 = 2_500.0;
const REBOUND_NS_PER_M: f32 = 3_600.0;
/// Stiffness of the anti-roll bars of front and rear axle, N/m of difference between the wheels.
const FRONT_BAR_N_PER_M: f32 = 18_000.0;
const REAR_BAR_N_PER_M: f32 = 8_000.0;
/// From this deflection on the bump stop acts, metres, and its stiffness, N/m.
const STOP_M: f32 = 0.17;
const STOP_N_PER_M: f32 = 150_000.0;
/// Greatest load of a wheel, N.
const MAX_LOAD_N: f32 = 20_000.0;

/// How far the spring of a wheel is pressed when the car stands, metres.
pub const fn standing_travel_m() -> f32 {
    STANDING_M
}

/// Height at which the spring of a wheel is fixed above the car's origin, metres.
pub const fn mount_height_m(wheel: usize) -> f32 {
    REST_M - STANDING_M + WHEEL_RADIUS_M - standing_load_n(wheel) / TYRE_N_PER_M
}

/// The deflection of a spring after a step of time, and the load of its wheel, N, from the deflections of it and of
/// the other wheel of its axle before and the way down from mount to ground, metres; `None` far above the ground.
///
/// Tyre force = spring + damper + bar + stop, solved for the deflection at the step's end.
pub fn settle(wheel: usize, travel_m: f32, other_m: f32, distance_m: Option<f32>, step_s: f32) -> (f32, f32) {
    let spring = standing_load_n(wheel) / STANDING_M;
    let bar = if is_front(wheel) { FRONT_BAR_N_PER_M } else { REAR_BAR_N_PER_M };
    let pressed = distance_m.map_or(f32::MIN, |distance| WHEEL_RADIUS_M + REST_M - distance);
    let solve = |tyre: f32, stop: f32| {
        let push = tyre * pressed.max(-1.0) + bar * other_m + stop * STOP_M;
        let elastic = tyre + spring + bar + stop;
        let damper = if push > elastic * travel_m { BUMP_NS_PER_M } else { REBOUND_NS_PER_M } / step_s;
        (push + damper * travel_m) / (elastic + damper)
    };
    let stop = if travel_m > STOP_M { STOP_N_PER_M } else { 0.0 };
    let standing = solve(TYRE_N_PER_M, stop);
    let load = TYRE_N_PER_M * (pressed - standing);
    if load > 0.0 { (standing, load.min(MAX_LOAD_N)) } else { (solve(0.0, stop).max(0.0), 0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_standing_car_stays_as_it_stands() {
        for wheel in 0..4 {
            let (travel, load) = settle(wheel, STANDING_M, STANDING_M, Some(mount_height_m(wheel)), 1.0 / 240.0);
            assert!((travel - STANDING_M).abs() < 1e-5 && (load - standing_load_n(wheel)).abs() < 2.0, "{load}");
        }
    }

    #[test]
    fn a_step_up_pushes_for_milliseconds_and_a_hole_lets_go() {
        let at = mount_height_m(0);
        let (mut travel, mut loads) = (STANDING_M, Vec::new());
        for _ in 0..48 {
            let (next, load) = settle(0, travel, STANDING_M, Some(at - 0.08), 1.0 / 240.0);
            travel = next;
            loads.push(load);
        }
        assert!(loads[0] > 10_000.0 && loads[0] < 20_000.0 && loads[47] < 8_500.0, "{loads:?}");
        let (_, load) = settle(0, STANDING_M, STANDING_M, None, 1.0 / 240.0);
        assert_eq!(load, 0.0);
    }
}
