//! The body as a rigid one, for the steps within a tick: velocities along its own axes, in which the wheels stay where
//! they are.

use glam::{Quat, Vec3};

use super::dimensions::{GRAVITY_MPS2, INERTIA, MASS_KG};
use crate::motion::Motion;

/// Air drag, N s^2/m^2: 0.5 times a density of 1.2 kg/m^3, 2.2 m^2 and a coefficient of 0.3.
const DRAG_N_PER_MPS2: f32 = 0.4;

/// A body that forces push.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    rotation: Quat,
    /// Velocity of the centre of mass, m/s.
    pub velocity_mps: Vec3,
    /// Angular velocity, rad/s.
    pub spin_radps: Vec3,
    gravity_mps2: Vec3,
}

impl Body {
    /// The body in motion.
    pub fn new(motion: &Motion) -> Self {
        let to_body = motion.rotation.conjugate();
        Self {
            rotation: motion.rotation,
            velocity_mps: to_body * motion.velocity_mps,
            spin_radps: to_body * motion.spin_radps,
            gravity_mps2: to_body * Vec3::new(0.0, 0.0, -GRAVITY_MPS2),
        }
    }

    /// Velocity of a place, metres from the centre of mass.
    pub fn velocity_at(&self, arm_m: Vec3) -> Vec3 {
        self.velocity_mps + self.spin_radps.cross(arm_m)
    }

    /// Takes a step under a force, N, and a moment about the centre of mass, N m, with air drag and gravity.
    pub fn push(&mut self, force_n: Vec3, moment_nm: Vec3, step_s: f32) {
        let (velocity, spin) = (self.velocity_mps, self.spin_radps);
        let drag_n = velocity * (-DRAG_N_PER_MPS2 * velocity.length());
        let pushed = (force_n + drag_n) / MASS_KG + self.gravity_mps2;
        // The axes turn below the velocities.
        self.velocity_mps += (pushed - spin.cross(velocity)) * step_s;
        self.gravity_mps2 -= spin.cross(self.gravity_mps2) * step_s;
        self.spin_radps += moment_nm / INERTIA * step_s;
    }

    /// Velocities in the world's axes, after the body turned for some time since it was made, s.
    pub fn velocities(&self, since_s: f32) -> (Vec3, Vec3) {
        let half = self.spin_radps * (0.5 * since_s);
        let rotation = (self.rotation * Quat::from_xyzw(half.x, half.y, half.z, 1.0)).normalize();
        (rotation * self.velocity_mps, rotation * self.spin_radps)
    }
}
