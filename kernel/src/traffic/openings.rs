//! Which doors of parked cars stand open, and how far.

use glam::{Vec2, Vec3};

use crate::actor::{ActorKind, FIRST_DOOR_ID, FIRST_PARKED_ID};
use crate::ops;
use crate::rng::{Stream, below, unit};
use crate::time::{Tick, seconds};

use super::actors::Actors;
use super::body::{Obstacle, Surroundings};
use super::doors::{CELL_TICKS, Door, DoorSpot, Doors, OPEN_RAD, Opening, SLOW_MPS, overlap, touches};
use super::hazard::Hazard;

/// Least and greatest time from when it begins to open until it is shut.
const OPEN_TICKS: [Tick; 2] = [seconds(4), seconds(8)];
/// Behind its front by more than this, the ego car passes a door and does not drive into it, metres.
const FRONT_M: f32 = 1.0;
/// Who is farther away is not beside it, metres.
const BESIDE_M: f32 = 20.0;

impl Actors {
    /// Draws which doors open about this time.
    pub(super) fn know_doors(&mut self, tick: Tick) {
        let cell = tick / CELL_TICKS;
        if self.rates.doors_per_h <= 0.0 || self.doors.cell == Some(cell) {
            return;
        }
        let chance = self.rates.doors_per_h * (CELL_TICKS as f32 / seconds(3600) as f32);
        let drawn = |spot: &DoorSpot, of: u64| (u64::from(spot.parked) << 2 | of, cell);
        let seed = self.seed;
        let opens = |(spot, index): (&DoorSpot, u32)| {
            let (entity, cell) = drawn(spot, 0);
            if unit(seed, Stream::Door, entity, cell) >= chance {
                return None;
            }
            let within = |of: u64, [least, most]: [Tick; 2]| {
                let (entity, cell) = drawn(spot, of);
                least + Tick::from(below(seed, Stream::Door, entity, cell, (most - least) as u32))
            };
            let open_ticks = within(1, OPEN_TICKS);
            let from = cell * CELL_TICKS + within(2, [0, CELL_TICKS - open_ticks]);
            Some(Opening { spot: index, ticks: [from, from + open_ticks] })
        };
        let openings = self.ways.door_spots.iter().zip(0..).filter_map(opens).collect();
        self.doors = Doors { cell: Some(cell), openings };
    }

    fn open_spots(&self, tick: Tick) -> impl Iterator<Item = (&Opening, &DoorSpot)> {
        let open = self.doors.openings.iter().filter(move |opening| opening.is_open(tick));
        open.map(|opening| (opening, &self.ways.door_spots[opening.spot as usize]))
    }

    /// What those who drive by expect of doors: that they are open as far as they go.
    pub(super) fn door_hazards(&self, around: &Surroundings<'_>) -> impl Iterator<Item = Hazard> {
        let stays = |spot: &DoorSpot| !around.is_loose(FIRST_PARKED_ID + spot.parked);
        self.open_spots(around.tick).filter(move |(_, spot)| stays(spot)).map(|(_, spot)| {
            let leaf = spot.hinge.leaf(OPEN_RAD);
            Hazard::of(&Obstacle {
                id: FIRST_DOOR_ID + spot.parked,
                position: spot.hinge.middle(leaf),
                heading_rad: ops::atan2(leaf.y, leaf.x),
                velocity_mps: Vec3::ZERO,
                size_m: ActorKind::Door.size_m(),
                on_foot: false,
            })
        })
    }

    /// The doors that stand open, each as far as those beside it let it.
    pub(super) fn open_doors(&self, tick: Tick, ego: Obstacle) -> impl Iterator<Item = Door> {
        self.open_spots(tick).filter_map(move |(opening, spot)| {
            let angle_rad = opening.angle_rad(tick);
            let leaf = [1.0, 0.75, 0.5, 0.25].map(|share| spot.hinge.leaf(share * angle_rad));
            let leaf = leaf.into_iter().find(|leaf| self.has_room(spot, *leaf, &ego))?;
            let (id, begins) = (FIRST_DOOR_ID + spot.parked, tick == opening.ticks[0]);
            Some(Door { id, position: spot.hinge.middle(leaf), heading_rad: ops::atan2(leaf.y, leaf.x), begins })
        })
    }

    /// Whether a door meets nobody there who is beside it already.
    fn has_room(&self, spot: &DoorSpot, leaf: Vec2, ego: &Obstacle) -> bool {
        let middle = spot.hinge.middle(leaf);
        let ego_front_m = if ego.velocity_mps.length() < SLOW_MPS { 0.0 } else { FRONT_M };
        let near = |body: &&super::Body| body.position.distance_squared(middle) < BESIDE_M * BESIDE_M;
        let mut bodies = self.seen().iter().filter(near);
        !overlap(ego, ego_front_m, middle, leaf)
            && !bodies.any(|body| {
                let forward = (body.rotation * Vec3::X).truncate().normalize_or(Vec2::X);
                touches(body.position, forward, body.kind.size_m().truncate() * 0.5, middle, leaf)
            })
    }
}
