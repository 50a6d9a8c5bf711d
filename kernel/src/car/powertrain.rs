//! The electric motor of the front axle and its pedal, with the manners of an automatic: it creeps without the
//! pedal, and drags when the car rolls faster.

use super::dimensions::WHEEL_RADIUS_M;
use crate::controls::Controls;

const MAX_POWER_W: f32 = 90_000.0;
const MAX_DRIVE_N: f32 = 5_600.0;
const MAX_REVERSE_N: f32 = 3_000.0;
/// Speed at which the motor gives no more in reverse, m/s.
const MAX_REVERSE_MPS: f32 = 6.0;
/// Above this speed the motor does not push against the motion, m/s.
const GEAR_CHANGE_MPS: f32 = 1.0;
/// Force without the pedal at standstill, N, and the speed at which none is left, m/s.
const CREEP_N: f32 = 450.0;
const CREEP_MPS: f32 = 1.9;
/// Drag of the motor without the pedal, N.
const MOTOR_DRAG_N: f32 = 150.0;

/// Torque of the motor on each front wheel, N m, positive forwards, at a mean spin of theirs, rad/s. Any brake
/// takes away what pushes.
pub fn torque_nm(controls: &Controls, braking: bool, spin_radps: f32) -> f32 {
    let back = controls.has(Controls::REVERSE);
    let along = if back { -1.0 } else { 1.0 };
    let speed_mps = along * spin_radps * WHEEL_RADIUS_M;
    let idle = idle_n(speed_mps);
    let force_n = if braking {
        idle.min(0.0)
    } else {
        let full = if back { full_reverse_n(speed_mps) } else { full_n(speed_mps) };
        idle + controls.throttle_fraction() * (full - idle).max(0.0)
    };
    0.5 * along * force_n * WHEEL_RADIUS_M
}

/// Force without the pedal at a speed in the direction of the gear, m/s.
fn idle_n(speed_mps: f32) -> f32 {
    (CREEP_N * (1.0 - speed_mps / CREEP_MPS)).clamp(-MOTOR_DRAG_N, CREEP_N)
}

fn full_n(speed_mps: f32) -> f32 {
    if speed_mps < -GEAR_CHANGE_MPS { 0.0 } else { MAX_DRIVE_N.min(MAX_POWER_W / speed_mps.max(1.0)) }
}

fn full_reverse_n(speed_mps: f32) -> f32 {
    if (-GEAR_CHANGE_MPS..=MAX_REVERSE_MPS).contains(&speed_mps) { MAX_REVERSE_N } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn more_throttle_pushes_more_in_the_gear(
            low in any::<u16>(), more in any::<u16>(), back in any::<bool>(), spin in -100f32..200.0,
        ) {
            let flags = if back { Controls::REVERSE } else { 0 };
            let along = if back { -1.0 } else { 1.0 };
            let push = |throttle, braking| {
                along * torque_nm(&Controls { throttle, flags, ..Controls::default() }, braking, spin)
            };
            prop_assert!(push(low.saturating_add(more), false) >= push(low, false));
            prop_assert!(push(more, true) <= push(0, false).min(0.0));
        }
    }

    #[test]
    fn it_creeps_drags_and_stops_pushing() {
        let at = |throttle, speed: f32| {
            torque_nm(&Controls { throttle, ..Controls::default() }, false, speed / WHEEL_RADIUS_M) * 2.0
                / WHEEL_RADIUS_M
        };
        assert!((at(0, 0.0) - CREEP_N).abs() < 0.1 && at(0, CREEP_MPS).abs() < 0.1);
        assert!((at(0, 20.0) + MOTOR_DRAG_N).abs() < 0.1);
        assert!((at(u16::MAX, 30.0) - 3000.0).abs() < 1.0, "90 kW at 30 m/s");
    }
}
