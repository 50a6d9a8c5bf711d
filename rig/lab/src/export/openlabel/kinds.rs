//! What road users are in the ontology of scenario tags that comes with OpenLABEL 1.0.

use kernel::scene::ActorKind;

/// The ego car's class there.
pub const EGO: &str = "VehicleCar";

/// Every class that is used.
pub const CLASSES: [&str; 9] = [
    EGO,
    "VehicleVan",
    "VehicleTruck",
    "VehicleBus",
    "VehicleMotorcycle",
    "VehicleCycle",
    "VehicleEmergency",
    "HumanPedestrian",
    "HumanWheelchairUser",
];

/// The class of a road user; that of a tram, a door or a thing is not of the ontology, which has none.
pub fn class(kind: ActorKind) -> &'static str {
    match kind {
        ActorKind::Car | ActorKind::Suv => EGO,
        ActorKind::Van => "VehicleVan",
        ActorKind::Truck => "VehicleTruck",
        ActorKind::Bus => "VehicleBus",
        ActorKind::Motorcycle | ActorKind::Scooter => "VehicleMotorcycle",
        ActorKind::Bicycle | ActorKind::CargoBike => "VehicleCycle",
        ActorKind::Emergency => "VehicleEmergency",
        ActorKind::Pedestrian | ActorKind::Child | ActorKind::Pram => "HumanPedestrian",
        ActorKind::Wheelchair => "HumanWheelchairUser",
        ActorKind::Tram => "Tram",
        ActorKind::Door => "CarDoor",
        ActorKind::Obstacle => "Obstacle",
    }
}

/// A class as the ontology has it, if it does.
pub fn told(class: &str) -> Option<&'static str> {
    CLASSES.into_iter().find(|told| *told == class)
}
