//! Doors of parked cars that open into a lane.
//!
//! Which door opens when follows from the seed and the time alone; how far it opens, also from who is beside it. Nothing
//! of it is state. Rates: [`HazardRates`](super::HazardRates); sources: docs/hazards.md.

use glam::{Vec2, Vec3};

use crate::actor::{ActorKind, FIRST_DOOR_ID, FIRST_PARKED_ID};
use crate::geometry::{direction, rectangles_overlap};
use crate::map_data::{LaneKind, Prop};
use crate::ops;
use crate::places::Places;
use crate::time::{Tick, seconds};

use super::body::Obstacle;

/// Whether a door opens is drawn for so long at once; it then opens and shuts within that time.
pub(super) const CELL_TICKS: Tick = seconds(20);
/// It swings so long in either direction.
const SWING_TICKS: Tick = seconds(1);
/// Angle of a door that is fully open, radians: 65 degrees, the last detent of most.
pub(crate) const OPEN_RAD: f32 = 1.134;
/// From the middle of a car to the hinges of its front doors, as a share of its length.
const HINGE: f32 = 0.2;
/// Roads at heights farther apart than this are not beside the car, metres.
const LEVEL_M: f32 = 2.0;
/// Slower than this somebody is let by with the door pulled to, m/s.
pub(super) const SLOW_MPS: f32 = 2.0;

/// A door that opens into a lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct DoorSpot {
    /// Number of the parked car.
    pub parked: u32,
    /// Where it hangs.
    pub hinge: Hinge,
}

/// Where a front door hangs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hinge {
    position: Vec3,
    /// From there along the shut door, and away from the car.
    shut: Vec2,
    out: Vec2,
}

/// A door that is open at some time of the present cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Opening {
    pub spot: u32,
    /// It begins to open, and is shut.
    pub ticks: [Tick; 2],
}

/// The doors that are open at some time of a cell.
#[derive(Clone, Debug, Default)]
pub(super) struct Doors {
    pub cell: Option<Tick>,
    pub openings: Vec<Opening>,
}

/// A door that stands open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Door {
    /// Its id, from [`FIRST_DOOR_ID`] on.
    pub id: u32,
    /// Middle of its footprint, metres.
    pub position: Vec3,
    /// Direction from its hinge to its edge, radians.
    pub heading_rad: f32,
    /// It begins to open.
    pub begins: bool,
}

impl Door {
    /// The parked car that it belongs to.
    pub fn parked_id(&self) -> u32 {
        self.id - FIRST_DOOR_ID + FIRST_PARKED_ID
    }

    /// Whether the ego car drives into it.
    pub fn is_hit(&self, ego: &Obstacle) -> bool {
        ego.velocity_mps.length() >= SLOW_MPS && overlap(ego, 0.0, self.position, direction(self.heading_rad))
    }
}

/// The doors of parked cars, one of each at most, whose edges come over a lane outside junctions.
pub(super) fn door_spots(places: &Places) -> Vec<DoorSpot> {
    let numbered = places.parked.cars.iter().zip(0..);
    let spots = numbered.flat_map(|(car, parked)| [1.0, -1.0].map(|side| spot(car, parked, side)));
    let roads = places.roads();
    let in_lane = |spot: &DoorSpot| {
        let edge = spot.hinge.position + spot.hinge.leaf(OPEN_RAD).extend(0.0) * ActorKind::Door.size_m().x;
        roads.at(edge, LaneKind::Driving).iter().any(|place| {
            let lane = &places.map.lanes[place.lane as usize];
            lane.junction.is_none() && (lane.at(place.s_m).position.z - edge.z).abs() < LEVEL_M
        })
    };
    // Between two lanes the door on the left counts: one a car, as its id is.
    let mut found: Vec<DoorSpot> = spots.filter(in_lane).collect();
    found.dedup_by_key(|spot| spot.parked);
    found
}

fn spot(car: &Prop, parked: u32, side: f32) -> DoorSpot {
    DoorSpot { parked, hinge: Hinge::of(car.position, car.heading_rad, car.size, side) }
}

impl Hinge {
    /// That of a car's front door on the left (1) or on the right (-1).
    pub fn of(position: Vec3, heading_rad: f32, size_m: Vec3, side: f32) -> Self {
        let ahead = direction(heading_rad);
        let out = ahead.perp() * side;
        let position = position + (ahead * (HINGE * size_m.x) + out * (0.5 * size_m.y)).extend(0.0);
        Self { position, shut: -ahead, out }
    }

    /// Direction of the door that is open by an angle.
    pub fn leaf(&self, angle_rad: f32) -> Vec2 {
        self.shut * ops::cos(angle_rad) + self.out * ops::sin(angle_rad)
    }

    /// Middle of the door then.
    pub fn middle(&self, leaf: Vec2) -> Vec3 {
        self.position + (leaf * (0.5 * ActorKind::Door.size_m().x)).extend(0.0)
    }
}

impl Opening {
    pub fn is_open(&self, tick: Tick) -> bool {
        (self.ticks[0]..self.ticks[1]).contains(&tick)
    }

    /// How far it is open, if nobody is beside it.
    pub fn angle_rad(&self, tick: Tick) -> f32 {
        let swung = (tick + 1 - self.ticks[0]).min(self.ticks[1] - tick).min(SWING_TICKS);
        OPEN_RAD * (swung as f32 / SWING_TICKS as f32)
    }
}

/// Whether the ego car without so much of its front shares ground with a door.
pub(super) fn overlap(ego: &Obstacle, front_m: f32, door: Vec3, leaf: Vec2) -> bool {
    let forward = direction(ego.heading_rad);
    let half = Vec2::new(0.5 * (ego.size_m.x - front_m), 0.5 * ego.size_m.y);
    touches(ego.position - (forward * (0.5 * front_m)).extend(0.0), forward, half, door, leaf)
}

pub(super) fn touches(middle: Vec3, forward: Vec2, half: Vec2, door: Vec3, leaf: Vec2) -> bool {
    let to = door - middle;
    let turned = |v: Vec2| Vec2::new(v.dot(forward), forward.perp_dot(v));
    let door_half = ActorKind::Door.size_m().truncate() * 0.5;
    to.z.abs() < LEVEL_M && rectangles_overlap(half, turned(to.truncate()), turned(leaf), door_half)
}
