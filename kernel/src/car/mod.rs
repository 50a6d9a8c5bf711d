//! The ego car: a body on four wheels. Everything here is arithmetic; the body itself, and the rays that find the
//! ground, are in [`crate::physics`].
//!
//! The engine has a vehicle controller, which knows no spin of its wheels: under it brakes and steering have a circle
//! of friction each, nothing locks, and there is no slip to build a tyre on.

mod assist;
mod body;
mod brakes;
mod dimensions;
mod gear;
mod powertrain;
mod steering;
mod surface;
mod suspension;
mod tyre;
mod wheel;

pub use assist::CarSetup;
pub use dimensions::{
    CENTRE_M, CENTRE_OF_MASS_M, FRONT_M, GRAVITY_MPS2, INERTIA, MASS_KG, MAX_WHEEL_ANGLE_RAD, REAR_OVERHANG_M, SIZE_M,
    TRACK_M, WHEEL_RADIUS_M, WHEELBASE_M, WHEELS,
};
pub use gear::{Footprint, RunningGear, mounts, reach_m};
pub use surface::{Footing, Grip};
pub use tyre::{NOMINAL_LOAD_N, Tyre};
pub use wheel::{Torque, Wheel};
