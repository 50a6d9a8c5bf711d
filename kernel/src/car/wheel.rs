//! A wheel that turns, and the tyre on it.

use glam::Vec2;

use super::dimensions::{WHEEL_INERTIA, WHEEL_RADIUS_M};
use super::suspension::standing_travel_m;
use super::tyre::{DAMPING_S, Tyre};
use crate::state;

state! {
    /// What of a wheel steers the future.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Wheel {
        /// How fast it turns, rad/s, positive forwards.
        pub spin_radps: f32,
        /// How far its spring is pressed, metres.
        pub travel_m: f32,
        /// How far the tread is bent along and across the wheel, metres, positive forwards and to the left.
        pub tread_m: Vec2,
    }
}

/// What turns a wheel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Torque {
    /// Of the engine, N m, positive forwards.
    pub drive_nm: f32,
    /// Greatest braking torque, N m.
    pub brake_nm: f32,
    /// The brake gives way rather than turning the wheel slower than this forwards or backwards, rad/s.
    pub least_radps: f32,
    /// The engine gives way rather than turning it faster than this, rad/s.
    pub most_radps: f32,
}

impl Wheel {
    /// A wheel that rolls at a speed, m/s, on flat ground.
    pub fn rolling(speed_mps: f32) -> Self {
        Self { spin_radps: speed_mps / WHEEL_RADIUS_M, travel_m: standing_travel_m(), tread_m: Vec2::ZERO }
    }

    /// Turns for a step of time while its hub moves over the ground at a velocity along and across it, m/s; gives the
    /// force on the car along and across, N, and the slip in slips of greatest force.
    pub fn turn(&mut self, tyre: &Tyre, hub_mps: Vec2, torque: &Torque, step_s: f32) -> (Vec2, f32) {
        let rolling_mps = self.spin_radps * WHEEL_RADIUS_M;
        let sliding_mps = (hub_mps - Vec2::X * rolling_mps).length();
        let kept = 1.0 / (1.0 + step_s * tyre.fading_per_s(sliding_mps, rolling_mps));
        let damped = DAMPING_S / step_s;
        // With the tread's deflection at the step's end in the equation of the wheel, any step is stable.
        let carried = (self.tread_m - step_s * hub_mps) * kept;
        let springy = tyre.stiffness_n_per_m * WHEEL_RADIUS_M;
        let held_nm = springy * ((1.0 + damped) * carried.x - damped * self.tread_m.x);
        let inertia = WHEEL_INERTIA / step_s + springy * WHEEL_RADIUS_M * (1.0 + damped) * step_s * kept;
        self.spin_radps = torque.spin(WHEEL_INERTIA / step_s * self.spin_radps - held_nm, inertia);

        let bent = carried + Vec2::X * (step_s * WHEEL_RADIUS_M * self.spin_radps * kept);
        let force = tyre.stiffness_n_per_m * (bent + damped * (bent - self.tread_m));
        self.tread_m = bent;
        let slips = sliding_mps / (rolling_mps.abs() * tyre.peak_slip).max(1e-3);
        (tyre.held(force), slips)
    }

    /// Turns in the air for a step of time.
    pub fn turn_freely(&mut self, torque: &Torque, step_s: f32) {
        self.tread_m = Vec2::ZERO;
        self.spin_radps = torque.spin(WHEEL_INERTIA / step_s * self.spin_radps, WHEEL_INERTIA / step_s);
    }
}

impl Torque {
    /// The spin that engine and brake leave a wheel which would turn at `pushed` / `inertia` without them.
    fn spin(&self, pushed: f32, inertia: f32) -> f32 {
        let alone = pushed / inertia;
        let driven = alone + self.drive_nm / inertia;
        let driven = if driven.abs() > self.most_radps && driven.abs() > alone.abs() {
            driven.signum() * self.most_radps.max(if alone * driven > 0.0 { alone.abs() } else { 0.0 })
        } else {
            driven
        };
        let braked = (driven.abs() - self.brake_nm / inertia).max(self.least_radps.min(driven.abs())).max(0.0);
        braked * driven.signum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::surface::Grip;
    use super::*;

    const STEP_S: f32 = 1.0 / 240.0;
    const DRY: Grip = Grip { peak: 1.0, sliding: 0.8, rolling: 0.013 };

    fn torque(drive_nm: f32, brake_nm: f32) -> Torque {
        Torque { drive_nm, brake_nm, least_radps: 0.0, most_radps: f32::MAX }
    }

    /// The force after a second at a speed of the hub.
    fn steady(hub_mps: Vec2, torque: &Torque) -> (Wheel, Vec2) {
        let tyre = Tyre::new(3500.0, &DRY);
        let mut wheel = Wheel::rolling(hub_mps.x);
        let mut force = Vec2::ZERO;
        for _ in 0..240 {
            force = wheel.turn(&tyre, hub_mps, torque, STEP_S).0;
        }
        (wheel, force)
    }

    #[test]
    fn a_torque_below_the_limit_becomes_force_and_one_beyond_it_locks() {
        let (wheel, force) = steady(Vec2::X * 20.0, &torque(0.0, 800.0));
        assert!((force.x + 800.0 / WHEEL_RADIUS_M).abs() < 25.0, "{force}");
        assert!(wheel.spin_radps > 50.0);
        let (wheel, force) = steady(Vec2::X * 20.0, &torque(0.0, 1500.0));
        assert_eq!(wheel.spin_radps, 0.0);
        assert!((force.x + 0.8 * Tyre::new(3500.0, &DRY).limit_n).abs() < 5.0, "{force}");
        let (wheel, force) = steady(Vec2::X * 2.0, &torque(3000.0, 0.0));
        assert!(wheel.spin_radps > 100.0 && force.x > 2000.0, "it spins: {wheel:?} {force}");
    }

    #[test]
    fn limits_of_spin_bind_the_brake_and_the_engine_but_push_nothing() {
        let bound = Torque { least_radps: 50.0, ..torque(0.0, 3000.0) };
        let (wheel, _) = steady(Vec2::X * 20.0, &bound);
        assert!((wheel.spin_radps - 50.0).abs() < 1e-3, "{wheel:?}");
        let bound = Torque { most_radps: 70.0, ..torque(3000.0, 0.0) };
        let (wheel, _) = steady(Vec2::X * 20.0, &bound);
        assert!((wheel.spin_radps - 70.0).abs() < 1e-3, "{wheel:?}");
        let bound = Torque { least_radps: 90.0, most_radps: 10.0, ..torque(0.0, 0.0) };
        let (wheel, force) = steady(Vec2::X * 20.0, &bound);
        assert!((wheel.spin_radps * WHEEL_RADIUS_M - 20.0).abs() < 0.01 && force.length() < 1.0, "{wheel:?} {force}");
    }

    #[test]
    fn side_slip_pushes_against_itself_and_shares_the_circle_with_the_brake() {
        let (_, side) = steady(Vec2::new(20.0, 2.0), &torque(0.0, 0.0));
        let (_, both) = steady(Vec2::new(20.0, 2.0), &torque(0.0, 700.0));
        assert!(side.y < -3000.0 && both.x < -1500.0 && both.y > side.y, "{side} {both}");
    }
}
