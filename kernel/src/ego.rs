//! The ego car: where it is, and how it stands on its wheels.

use glam::Vec3;

use crate::car::RunningGear;
use crate::motion::Motion;
use crate::ops;
use crate::state;

pub use crate::car::{
    CENTRE_M, FRONT_M, MASS_KG, MAX_WHEEL_ANGLE_RAD, REAR_OVERHANG_M, SIZE_M, TRACK_M, WHEEL_RADIUS_M, WHEELBASE_M,
};

state! {
    /// State of the ego car.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Ego {
        /// Pose and velocities.
        pub motion: Motion,
        /// Its wheels and what acts on them.
        pub gear: RunningGear,
        /// Distance driven so far, micrometres.
        pub odometer_um: u64,
    }
}

impl Ego {
    /// A car that has not driven yet, on flat ground; one that does not move is parked.
    pub fn new(motion: Motion) -> Self {
        let mut ego = Self { motion, gear: RunningGear::rolling(0.0), odometer_um: 0 };
        ego.gear = RunningGear::rolling(ego.speed_mps());
        ego
    }

    /// Direction of the car's x axis.
    pub fn forward(&self) -> Vec3 {
        self.motion.rotation * Vec3::X
    }

    /// Direction of the car's x axis seen from above, radians counter-clockwise from east.
    pub fn heading_rad(&self) -> f32 {
        let forward = self.forward();
        ops::atan2(forward.y, forward.x)
    }

    /// Speed along the car's x axis, m/s; negative in reverse.
    pub fn speed_mps(&self) -> f32 {
        self.motion.velocity_mps.dot(self.forward())
    }

    /// Middle of the car's footprint, metres.
    pub fn middle(&self) -> Vec3 {
        self.motion.position + self.motion.rotation * Vec3::new(CENTRE_M.x, 0.0, 0.0)
    }

    /// Takes over what physics made of the car.
    pub fn moved(&mut self, motion: Motion) {
        let way_m = (motion.position - self.motion.position).length();
        self.odometer_um += ops::round(way_m * 1e6) as u64;
        self.motion = motion;
    }
}
