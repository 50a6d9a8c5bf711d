//! What other road users are, and how large.

use glam::Vec3;

use crate::state_enum;

state_enum! {
    /// What an actor is.
    pub enum ActorKind {
        /// Passenger car.
        Car = 0,
        /// Lorry or van.
        Truck = 1,
        /// Bus.
        Bus = 2,
        /// Motorcycle with its rider.
        Motorcycle = 3,
        /// Bicycle with its rider.
        Bicycle = 4,
        /// Person on foot.
        Pedestrian = 5,
    }
}

impl ActorKind {
    /// Length, width and height of the box around an actor, metres.
    pub fn size_m(self) -> Vec3 {
        match self {
            Self::Car => Vec3::new(4.5, 1.85, 1.5),
            Self::Truck => Vec3::new(7.0, 2.4, 3.0),
            Self::Bus => Vec3::new(11.0, 2.5, 3.1),
            Self::Motorcycle => Vec3::new(2.1, 0.8, 1.6),
            Self::Bicycle => Vec3::new(1.8, 0.6, 1.75),
            Self::Pedestrian => Vec3::new(0.5, 0.6, 1.75),
        }
    }
}
