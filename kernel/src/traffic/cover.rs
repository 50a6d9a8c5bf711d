//! Stepping out from behind what hides somebody from those who come on the near lane.

use glam::{Vec2, Vec3};

use crate::geometry::direction;
use crate::map_data::{MapData, PropKind};

use super::actors::Actors;
use super::body::Body;
use super::lapse::Lapse;
use super::vehicle::Vehicle;
use super::walker::Walker;

/// What hides somebody begins within so much of the way across, on the side from which they come, metres.
const BESIDE_M: std::ops::Range<f32> = 0.3..4.0;
/// And lies so far before where somebody stands, metres.
const BEFORE_M: std::ops::Range<f32> = 0.3..5.0;
/// Who stands at a kerb or stop for so much longer, tenths of a second, is walked past: that takes half as long.
const STAYS_DS: u8 = 80;

/// A box on the ground, by its middle, axis and half its length and width.
struct Cover {
    middle: Vec2,
    axis: Vec2,
    half: Vec2,
}

/// Whether a parked car, or a vehicle that stands at a stop or kerb, hides a walker who is about to cross.
pub(super) fn hides(actors: &Actors, walker: &Walker, [from, to]: [Vec2; 2]) -> bool {
    let map = actors.map();
    let Some(lane) = map.walk_edges[walker.edge as usize].beside else { return false };
    let (s_m, ..) = map.lanes[lane as usize].project(from.extend(0.0));
    let onward = direction(map.lane_point(lane, s_m).heading_rad);
    let across = (to - from).normalize_or_zero();
    let is_before = |cover: &Cover| {
        let half_m =
            |way: Vec2| cover.half.x * cover.axis.dot(way).abs() + cover.half.y * cover.axis.perp_dot(way).abs();
        let offset = cover.middle - from;
        BESIDE_M.contains(&(-offset.dot(onward) - half_m(onward)))
            && BEFORE_M.contains(&(offset.dot(across) - half_m(across)))
    };
    parked(map).any(|cover| is_before(&cover)) || standing(actors).any(|cover| is_before(&cover))
}

fn parked(map: &MapData) -> impl Iterator<Item = Cover> {
    let cars = map.props.iter().filter(|prop| prop.kind == PropKind::ParkedCar);
    cars.map(|prop| Cover {
        middle: prop.position.truncate(),
        axis: direction(prop.heading_rad),
        half: prop.size.truncate() * 0.5,
    })
}

fn standing(actors: &Actors) -> impl Iterator<Item = Cover> {
    let vehicles = actors.state.vehicles.iter().zip(&actors.bodies);
    vehicles.filter(|(vehicle, _)| stays(vehicle)).map(|(_, body)| Cover::of(body))
}

impl Cover {
    fn of(body: &Body) -> Self {
        Self {
            middle: body.position.truncate(),
            axis: (body.rotation * Vec3::X).truncate().normalize_or(Vec2::X),
            half: body.kind.size_m().truncate() * 0.5,
        }
    }
}

/// Whether a vehicle stands at a stop or kerb for as long as somebody needs to get past it.
pub(super) fn stays(vehicle: &Vehicle) -> bool {
    matches!(vehicle.lapse, Lapse::Boards | Lapse::Halts) && vehicle.lapse_left > STAYS_DS
}
