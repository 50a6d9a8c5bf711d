//! How a body moves.

use glam::{Quat, Vec3};

use crate::state;

state! {
    /// Pose and velocities of a free body.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Motion {
        /// Origin of the body, metres.
        pub position: Vec3,
        /// Rotation from the body's axes (x forward, y left, z up) to the world's.
        pub rotation: Quat,
        /// Velocity of the centre of mass, m/s.
        pub velocity_mps: Vec3,
        /// Angular velocity, rad/s.
        pub spin_radps: Vec3,
    }
}
