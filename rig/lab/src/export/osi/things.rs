//! What stands on a map: things, parked cars among them, and traffic signs.

use std::collections::BTreeSet;

use glam::Vec3;
use kernel::geometry::direction;
use kernel::map::{LaneKind, Prop, PropKind, RoadNetwork, SIGN_BUS_STOP, SIGN_LIMIT, SIGN_STOP, SIGN_YIELD};
use kernel::ops;

use super::ids;
use super::messages::{
    Identifier, MainSign, MainSignClassification, Orientation3d, SignType, SignValue, StationaryClassification,
    StationaryObject, StationaryType, TrafficSign, Unit, Variability,
};
use super::place::{Frame, upright};

/// The middle of a sign's board before the axis of its post and below its top, metres; its thickness.
const BEFORE_POST_M: f32 = 0.06;
const BELOW_TOP_M: f32 = 0.42;
const BOARD_M: f32 = 0.02;
/// A limit is that of a lane no farther away than this, metres.
const BESIDE_M: f32 = 20.0;
const MPS_OF_KMH: f32 = 1.0 / 3.6;
const MPS_OF_MPH: f32 = 0.44704;

/// Everything but signs. Cars that were `pushed` are road users now.
pub fn things(network: &RoadNetwork, pushed: &BTreeSet<u64>, frame: Frame) -> Vec<StationaryObject> {
    let mut parked = 0..;
    let mut thing = |(index, prop): (usize, &Prop)| {
        let id = match prop.kind {
            PropKind::ParkedCar => ids::parked(parked.next()?),
            _ => ids::prop(index),
        };
        (!pushed.contains(&id.value)).then(|| stationary(id, prop, frame))
    };
    let props = network.props.iter().enumerate().filter(|(_, prop)| prop.kind != PropKind::Sign);
    props.filter_map(&mut thing).collect()
}

fn stationary(id: Identifier, prop: &Prop, frame: Frame) -> StationaryObject {
    let rise_m = prop.rise_m();
    let pitch = f64::from(ops::atan2(-rise_m, prop.size.x));
    let orientation = Orientation3d { pitch, ..upright(prop.heading_rad) };
    let middle = prop.position + 0.5 * (prop.size.z + rise_m) * Vec3::Z;
    StationaryObject {
        id,
        base: frame.stationary(middle, orientation, prop.size),
        classification: StationaryClassification { r#type: kind(prop.kind) as i32 },
        model_reference: format!("{:?}", prop.kind).to_lowercase(),
    }
}

fn kind(kind: PropKind) -> StationaryType {
    match kind {
        PropKind::Building => StationaryType::Building,
        PropKind::Tree => StationaryType::Tree,
        PropKind::Hedge => StationaryType::Vegetation,
        PropKind::Lamp => StationaryType::EmittingStructure,
        PropKind::SignalPole => StationaryType::Pole,
        PropKind::Fence | PropKind::GuardRail => StationaryType::Barrier,
        PropKind::Wall => StationaryType::Wall,
        PropKind::Bridge => StationaryType::Bridge,
        PropKind::Tunnel => StationaryType::OverheadStructure,
        PropKind::ParkedCar | PropKind::Sign | PropKind::Furniture | PropKind::Movable | PropKind::Sundry => {
            StationaryType::Other
        }
    }
}

/// The traffic signs.
pub fn signs(network: &RoadNetwork, frame: Frame) -> Vec<TrafficSign> {
    let props = network.props.iter().enumerate().filter(|(_, prop)| prop.kind == PropKind::Sign);
    props.map(|(index, prop)| TrafficSign { id: ids::prop(index), main_sign: board(network, prop, frame) }).collect()
}

fn board(network: &RoadNetwork, prop: &Prop, frame: Frame) -> MainSign {
    let before = (BEFORE_POST_M * direction(prop.heading_rad)).extend(prop.size.z - BELOW_TOP_M);
    let size_m = Vec3::new(BOARD_M, prop.size.y, prop.size.y);
    let limit = prop.variant.checked_sub(SIGN_LIMIT);
    let kind = match prop.variant {
        SIGN_STOP => SignType::Stop,
        SIGN_YIELD => SignType::GiveWay,
        SIGN_BUS_STOP => SignType::BusStop,
        _ if limit.is_some() => SignType::SpeedLimitBegin,
        _ => SignType::Other,
    };
    MainSign {
        base: frame.stationary(prop.position + before, upright(prop.heading_rad), size_m),
        classification: MainSignClassification {
            variability: Variability::Fixed as i32,
            r#type: kind as i32,
            value: limit.map(|number| limit_of(network, prop, number)),
        },
    }
}

/// A map keeps the number alone: its unit is the one in which the lane beside it has about that limit.
fn limit_of(network: &RoadNetwork, prop: &Prop, number: u32) -> SignValue {
    let lane = network.nearest_lane(prop.position, LaneKind::Driving, None, BESIDE_M);
    let off_mps = |unit_mps: f32| {
        let limit_mps = lane.as_ref().map_or(0.0, |near| network.lanes[near.lane as usize].speed_limit_mps);
        (limit_mps - number as f32 * unit_mps).abs()
    };
    let in_miles = lane.is_some() && off_mps(MPS_OF_MPH) < off_mps(MPS_OF_KMH);
    let unit = if in_miles { Unit::MilePerHour } else { Unit::KilometerPerHour };
    SignValue { value: number.into(), value_unit: unit as i32, text: number.to_string() }
}

#[cfg(test)]
mod tests {
    use kernel::map::bundled;
    use kernel::scene::FIRST_PARKED_ID;

    use super::*;

    const FRAME: Frame = Frame { origin_m: [0.0; 2] };

    #[test]
    fn a_pushed_car_is_no_longer_among_what_stands() {
        let city = bundled("city").expect("bundled");
        let all = things(&city, &BTreeSet::new(), FRAME);
        let pushed = BTreeSet::from([u64::from(FIRST_PARKED_ID) + 2]);
        let rest = things(&city, &pushed, FRAME);
        let numbers =
            |things: &[StationaryObject]| things.iter().map(|thing| thing.id.value).collect::<BTreeSet<u64>>();
        assert_eq!(numbers(&all).len(), all.len(), "numbers differ");
        assert_eq!(numbers(&all).difference(&numbers(&rest)).copied().collect::<BTreeSet<u64>>(), pushed);
        let third = city.props.iter().filter(|prop| prop.kind == PropKind::ParkedCar).nth(2).expect("cars are parked");
        let told = all.iter().find(|thing| pushed.contains(&thing.id.value)).expect("it stands");
        assert_eq!((told.base.position.x, told.base.position.y), (third.position.x.into(), third.position.y.into()));
    }

    #[test]
    fn limits_are_told_in_the_unit_of_their_road() {
        let motorway = bundled("motorway").expect("bundled");
        let limits: Vec<SignValue> =
            signs(&motorway, FRAME).into_iter().filter_map(|sign| sign.main_sign.classification.value).collect();
        assert!(!limits.is_empty() && limits.iter().all(|limit| limit.value_unit == Unit::KilometerPerHour as i32));
        assert!(limits.iter().any(|limit| limit.text == "120" && limit.value == 120.0), "{limits:?}");
    }
}
