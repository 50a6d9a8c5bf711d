//! How instances are numbered: traffic from 1, parked cars above it, the ego car last.

/// Instance of the ego car.
pub const EGO_INSTANCE: u16 = u16::MAX;

/// Instances of parked cars count from here.
pub const FIRST_PARKED_INSTANCE: u16 = 32768;
