//! How instances are numbered: traffic from 1, parked cars above it, the ego car last.

use kernel::scene::{FIRST_DOOR_ID, FIRST_PARKED_ID};

/// Instance of the ego car.
pub const EGO_INSTANCE: u16 = u16::MAX;

/// Instances of parked cars count from here.
pub const FIRST_PARKED_INSTANCE: u16 = 32768;

/// Instance of a parked car by its number among those of the map, pushed or not.
pub fn instance_of_parked(number: usize) -> u16 {
    let last = EGO_INSTANCE - 1;
    u16::try_from(number).ok().and_then(|n| n.checked_add(FIRST_PARKED_INSTANCE)).map_or(last, |n| n.min(last))
}

/// The number of the parked car that an actor is or that it is a door of.
pub fn parked_number(id: u32) -> Option<usize> {
    let first = if id < FIRST_DOOR_ID { FIRST_PARKED_ID } else { FIRST_DOOR_ID };
    Some(id.checked_sub(first)? as usize)
}

/// Instance of an actor; a door belongs to its car.
pub fn instance_of_actor(id: u32) -> u16 {
    parked_number(id).map_or_else(|| id.min(u32::from(FIRST_PARKED_INSTANCE) - 1) as u16, instance_of_parked)
}
