//! What the standard calls a road user.

use kernel::scene::{ActorKind, lamps};

use super::messages::{BrakeLight, Indicator, Light, LightState, MovingType, Role, VehicleClassification, VehicleType};

/// What an actor is; nothing for the ego car, which is a car.
pub fn moving(kind: Option<ActorKind>) -> MovingType {
    match kind {
        Some(ActorKind::Door | ActorKind::Obstacle) => MovingType::Other,
        kind if vehicle(kind).is_some() => MovingType::Vehicle,
        _ => MovingType::Pedestrian,
    }
}

/// What a vehicle is, with its lamps; nothing for all else. Who sits in a wheelchair is a vehicle in the standard.
pub fn classification(kind: Option<ActorKind>, burning: u8) -> Option<VehicleClassification> {
    let role = match kind {
        Some(ActorKind::Bus | ActorKind::Tram) => Role::PublicTransport,
        // A patrol car or an ambulance: which, its shape alone says.
        Some(ActorKind::Emergency) => Role::Other,
        _ => Role::Civil,
    };
    let kind = vehicle(kind)? as i32;
    Some(VehicleClassification { r#type: kind, light_state: lights(burning), has_trailer: false, role: role as i32 })
}

fn vehicle(kind: Option<ActorKind>) -> Option<VehicleType> {
    Some(match kind {
        None | Some(ActorKind::Car | ActorKind::Suv) => VehicleType::MediumCar,
        Some(ActorKind::Van | ActorKind::Emergency) => VehicleType::DeliveryVan,
        Some(ActorKind::Truck) => VehicleType::HeavyTruck,
        Some(ActorKind::Bus) => VehicleType::Bus,
        Some(ActorKind::Tram) => VehicleType::Tram,
        Some(ActorKind::Motorcycle | ActorKind::Scooter) => VehicleType::Motorbike,
        Some(ActorKind::Bicycle | ActorKind::CargoBike) => VehicleType::Bicycle,
        Some(ActorKind::Wheelchair) => VehicleType::Wheelchair,
        Some(ActorKind::Pedestrian | ActorKind::Child | ActorKind::Pram) => return None,
        Some(ActorKind::Door | ActorKind::Obstacle) => return None,
    })
}

/// In the words of this program.
pub fn name(kind: Option<ActorKind>) -> String {
    kind.map_or("ego".to_owned(), |kind| format!("{kind:?}").to_lowercase())
}

fn lights(burning: u8) -> LightState {
    let on = |lamp: u8| burning & lamp != 0;
    let indicator = match (on(lamps::LEFT), on(lamps::RIGHT)) {
        (true, true) => Indicator::Warning,
        (true, false) => Indicator::Left,
        (false, true) => Indicator::Right,
        (false, false) => Indicator::Off,
    };
    LightState {
        indicator_state: indicator as i32,
        head_light: if on(lamps::HEADLIGHTS) { Light::On } else { Light::Off } as i32,
        brake_light_state: if on(lamps::BRAKE) { BrakeLight::Normal } else { BrakeLight::Off } as i32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vehicles_alone_have_a_class_of_vehicles() {
        for kind in [ActorKind::Car, ActorKind::Tram, ActorKind::CargoBike, ActorKind::Wheelchair] {
            let class = classification(Some(kind), 0).expect("a vehicle");
            assert_eq!(moving(Some(kind)), MovingType::Vehicle);
            assert!(class.r#type != VehicleType::Unknown as i32 && class.role != Role::Unknown as i32, "{kind:?}");
        }
        for (kind, told) in [(ActorKind::Pram, MovingType::Pedestrian), (ActorKind::Door, MovingType::Other)] {
            assert_eq!((moving(Some(kind)), classification(Some(kind), 0)), (told, None));
        }
        assert_eq!((moving(None), name(None).as_str()), (MovingType::Vehicle, "ego"));
    }

    #[test]
    fn lamps_burn_as_in_the_scene() {
        let lights = |burning| classification(None, burning).expect("a vehicle").light_state;
        let dark = lights(0);
        assert_eq!(dark.indicator_state, Indicator::Off as i32);
        assert_eq!((dark.head_light, dark.brake_light_state), (Light::Off as i32, BrakeLight::Off as i32));
        let lit = lights(lamps::BRAKE | lamps::LEFT | lamps::HEADLIGHTS);
        assert_eq!(lit.indicator_state, Indicator::Left as i32);
        assert_eq!((lit.head_light, lit.brake_light_state), (Light::On as i32, BrakeLight::Normal as i32));
        assert_eq!(lights(lamps::LEFT | lamps::RIGHT).indicator_state, Indicator::Warning as i32);
    }
}
