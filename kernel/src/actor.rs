//! What other road users are, and how large.

use glam::Vec3;

use crate::state_enum;

/// Those who play a story are actors with ids from here on: this plus the number of the role. Traffic has lower ids.
pub const FIRST_STORY_ID: u32 = 1 << 15;
/// Parked cars that were pushed are actors with ids from here on: this plus the car's number among those of the map, in
/// the order of its props. Others have lower ids.
pub const FIRST_PARKED_ID: u32 = 1 << 16;
/// Open doors are actors with ids from here on: this plus the number of the parked car.
pub const FIRST_DOOR_ID: u32 = 1 << 28;
/// Open doors of those who play a story are actors with ids from here on: this plus the number of the role.
pub const FIRST_STORY_DOOR_ID: u32 = 3 << 28;

state_enum! {
    /// What an actor is.
    pub enum ActorKind {
        /// Passenger car.
        Car = 0,
        /// Lorry or large van.
        Truck = 1,
        /// Bus.
        Bus = 2,
        /// Motorcycle with its rider.
        Motorcycle = 3,
        /// Bicycle with its rider.
        Bicycle = 4,
        /// Person on foot.
        Pedestrian = 5,
        /// Van or people carrier.
        Van = 6,
        /// Sport utility vehicle.
        Suv = 7,
        /// Motor scooter with its rider.
        Scooter = 8,
        /// Bicycle with a box before its rider.
        CargoBike = 9,
        /// Patrol car or ambulance on a van's body, without siren.
        Emergency = 10,
        /// Open door of a parked car; x is from its hinge to its edge.
        Door = 11,
        /// Child on foot, about nine years old.
        Child = 12,
        /// Person on foot who pushes a pram.
        Pram = 13,
        /// Person in a wheelchair.
        Wheelchair = 14,
        /// Tram of three sections.
        Tram = 15,
        /// Thing that can be moved, as a bin or a barrel: only in stories.
        Obstacle = 16,
    }
}

impl ActorKind {
    /// Length, width and height of the box around an actor, metres. A child is as tall as the median of nine years in the
    /// WHO growth reference, an occupied wheelchair is as large as ISO 7176-5 allows.
    pub fn size_m(self) -> Vec3 {
        match self {
            Self::Car => Vec3::new(4.5, 1.85, 1.5),
            Self::Truck => Vec3::new(7.0, 2.4, 3.0),
            Self::Bus => Vec3::new(11.0, 2.5, 3.1),
            Self::Motorcycle => Vec3::new(2.1, 0.8, 1.6),
            Self::Bicycle => Vec3::new(1.8, 0.6, 1.75),
            Self::Pedestrian => Vec3::new(0.5, 0.6, 1.75),
            Self::Van => Vec3::new(4.9, 1.9, 2.0),
            Self::Suv => Vec3::new(4.5, 1.9, 1.65),
            Self::Scooter => Vec3::new(1.9, 0.75, 1.6),
            Self::CargoBike => Vec3::new(2.5, 0.7, 1.75),
            Self::Emergency => Vec3::new(4.9, 1.9, 2.25),
            Self::Door => Vec3::new(1.1, 0.12, 1.4),
            Self::Child => Vec3::new(0.4, 0.45, 1.33),
            Self::Pram => Vec3::new(1.5, 0.6, 1.75),
            Self::Wheelchair => Vec3::new(1.2, 0.7, 1.35),
            Self::Tram => Vec3::new(30.0, 2.4, 3.5),
            Self::Obstacle => Vec3::new(0.8, 0.8, 1.0),
        }
    }

    /// Mass with whom it carries, kg.
    pub fn mass_kg(self) -> f32 {
        match self {
            Self::Car => 1400.0,
            Self::Truck => 7000.0,
            Self::Bus => 12000.0,
            Self::Motorcycle => 280.0,
            Self::Bicycle => 90.0,
            Self::Pedestrian => 75.0,
            Self::Van => 2100.0,
            Self::Suv => 1850.0,
            Self::Scooter => 200.0,
            Self::CargoBike => 150.0,
            Self::Emergency => 2800.0,
            Self::Door => 35.0,
            Self::Child => 28.0,
            Self::Pram => 95.0,
            Self::Wheelchair => 100.0,
            Self::Tram => 40000.0,
            Self::Obstacle => 60.0,
        }
    }

    /// On foot, not in traffic's lanes: also who sits in a wheelchair.
    pub fn is_on_foot(self) -> bool {
        matches!(self, Self::Pedestrian | Self::Child | Self::Pram | Self::Wheelchair)
    }

    /// On foot with wheels: longer than wide.
    pub fn is_wheeled_on_foot(self) -> bool {
        matches!(self, Self::Pram | Self::Wheelchair)
    }

    /// Pedalled: keeps to the kerb, is passed with room, and is not on motorways.
    pub fn is_pedalled(self) -> bool {
        matches!(self, Self::Bicycle | Self::CargoBike)
    }

    /// A motorcycle of any kind.
    pub fn is_motorcycle(self) -> bool {
        matches!(self, Self::Motorcycle | Self::Scooter)
    }

    /// Lorry, bus or tram: long and heavy.
    pub fn is_heavy(self) -> bool {
        matches!(self, Self::Truck | Self::Bus | Self::Tram)
    }

    /// A motor vehicle with four wheels or more.
    pub fn is_car_or_heavier(self) -> bool {
        self.is_vehicle() && !self.is_pedalled() && !self.is_motorcycle()
    }

    /// Somebody drives or rides it.
    pub fn is_vehicle(self) -> bool {
        !self.is_on_foot() && !matches!(self, Self::Door | Self::Obstacle)
    }
}
