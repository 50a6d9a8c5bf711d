//! No tyre ever gives more than its load and the ground allow.

use proptest::prelude::*;

use super::*;

/// Controls that are held for some ticks each.
fn sequences() -> impl Strategy<Value = Vec<(Controls, u8)>> {
    let controls = (any::<i16>(), any::<u16>(), any::<u16>(), 0..4u8, any::<bool>()).prop_map(
        |(steer, throttle, brake, flags, coast)| Controls {
            steer,
            throttle,
            brake: if coast { 0 } else { brake },
            flags,
        },
    );
    prop::collection::vec((controls, 5..60u8), 2..8)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(1000)))]

    /// 10,000 of them: `PROPTEST_CASES=10000`.
    #[test]
    fn force_stays_inside_the_friction_circle(
        sequence in sequences(),
        kind in prop::sample::select(GROUNDS.to_vec()),
        speed in 0f32..40.0,
        (abs, esc) in any::<(bool, bool)>(),
    ) {
        let mut drive = Drive::over(kind, speed, CarSetup { abs, esc });
        for (controls, ticks) in sequence {
            for _ in 0..ticks {
                drive.step(&controls);
                let mut loads = 0.0;
                for print in drive.physics.footprints() {
                    let most = most_n(friction(kind)[0], f64::from(print.load_n));
                    let force = f64::from(print.force_n.length());
                    prop_assert!(force <= most * 1.0001 + 0.01, "{force} of {most} N: {print:?}");
                    loads += print.load_n;
                }
                prop_assert!(loads.is_finite() && drive.ego.motion.position.is_finite());
                prop_assert!(drive.ego.gear.wheels.iter().all(|wheel| wheel.spin_radps.abs() < 2000.0));
            }
        }
    }
}

#[test]
fn braking_in_a_turn_has_one_circle_for_both() {
    let mut drive = Drive::at(20.0);
    drive.hold(seconds(1), |car| cruise(car, 20.0, 0.12));
    let mut most = 0f32;
    for _ in 0..60 {
        let before = drive.ego.motion.velocity_mps;
        drive.step(&Controls::from_fractions(0.3, 0.0, 1.0));
        most = most.max((drive.ego.motion.velocity_mps - before).truncate().length() * 60.0);
    }
    assert!(most > 8.0 && most < 1.06 * 9.81, "{most} m/s^2 at friction 1");
}

#[test]
fn the_wheel_pulls_back_to_its_middle_and_grows_light_at_the_limit() {
    let torque = |steer: f32| {
        let mut drive = Drive::over(SurfaceKind::Road, 20.0, BARE);
        drive.hold(90, |car| cruise(car, 20.0, steer));
        drive.ego.gear.aligning_torque_nm
    };
    let pulls = [0.03, 0.06, 0.12, 0.5].map(torque);
    assert!(pulls.iter().all(|pull| *pull < 0.0), "steered to the right it pulls to the left: {pulls:?}");
    assert!(pulls[1] < pulls[0] && pulls[3] > pulls[1], "{pulls:?}");
    assert!((torque(-0.06) + pulls[1]).abs() < 2.0);
}

#[test]
fn the_torque_in_the_steering_grows_with_the_turn_and_falls_off_before_the_side_force_does() {
    // Turned slowly to full lock at a speed that the front tyres can hold on the wheel's first degrees only.
    let mut drive = Drive::over(SurfaceKind::Road, 20.0, BARE);
    drive.hold(60, |car| cruise(car, 20.0, 0.0));
    let mut torques = Vec::new();
    let mut sides = Vec::new();
    for tick in 0..300 {
        let controls = cruise(&drive.ego, 20.0, 0.001 * tick as f32);
        drive.step(&controls);
        torques.push(-drive.ego.gear.aligning_torque_nm);
        sides.push(-drive.physics.footprints()[..2].iter().map(|print| print.force_n.y).sum::<f32>());
    }
    let peak = |values: &[f32]| (0..values.len()).max_by(|a, b| values[*a].total_cmp(&values[*b])).expect("values");
    let (torque, side) = (peak(&torques), peak(&sides));
    assert!(torques[0].abs() < 2.0, "straight ahead nothing pulls: {}", torques[0]);
    assert!((80.0..300.0).contains(&torques[torque]), "{} N m", torques[torque]);
    assert!(torque + 10 < side, "the torque is greatest at tick {torque}, the side force at {side}");
    // What is left where the tyres hold most is what the steering axis alone gives.
    let left_nm = torques[side];
    assert!(left_nm < 0.8 * torques[torque], "{left_nm} of {} N m", torques[torque]);
    assert!((left_nm / (0.015 * sides[side]) - 1.0).abs() < 0.1, "{left_nm} N m of {} N", sides[side]);
}

#[test]
fn nearly_nothing_pulls_at_the_steering_of_a_car_that_stands() {
    // What stays in the treads of wheels that are turned is less than a tenth of what a turn brings.
    for (steer, most_nm) in [(-1.0, 14.0), (-0.3, 14.0), (0.0, 0.1), (0.3, 14.0), (1.0, 14.0)] {
        let mut drive = Drive::at(0.0);
        drive.hold(seconds(3), |_| Controls::from_fractions(steer, 0.0, 0.5));
        let torque_nm = drive.ego.gear.aligning_torque_nm;
        assert!(torque_nm.abs() < most_nm, "{torque_nm} N m at {steer}");
    }
}
