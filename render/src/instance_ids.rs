//! How instances are numbered: traffic from 1, then those who play a story, parked cars above them, the ego car last.

use kernel::scene::{FIRST_DOOR_ID, FIRST_PARKED_ID, FIRST_STORY_DOOR_ID, FIRST_STORY_ID};

/// Instance of the ego car.
pub const EGO_INSTANCE: u16 = u16::MAX;

/// Instances of parked cars count from here.
pub const FIRST_PARKED_INSTANCE: u16 = 32768;

/// Those who play a story count from here: as many as a story has at most.
const FIRST_STORY_INSTANCE: u16 = FIRST_PARKED_INSTANCE - 256;

/// Instance of a parked car by its number among those of the map, pushed or not.
pub fn instance_of_parked(number: usize) -> u16 {
    let last = EGO_INSTANCE - 1;
    u16::try_from(number).ok().and_then(|n| n.checked_add(FIRST_PARKED_INSTANCE)).map_or(last, |n| n.min(last))
}

/// The number of the parked car that an actor is or that it is a door of.
pub fn parked_number(id: u32) -> Option<usize> {
    let first = match id {
        FIRST_STORY_DOOR_ID.. => return None,
        FIRST_DOOR_ID.. => FIRST_DOOR_ID,
        _ => FIRST_PARKED_ID,
    };
    Some(id.checked_sub(first)? as usize)
}

/// Instance of an actor; a door belongs to its car.
pub fn instance_of_actor(id: u32) -> u16 {
    let playing =
        |role: u32| FIRST_STORY_INSTANCE + role.min(u32::from(FIRST_PARKED_INSTANCE - FIRST_STORY_INSTANCE) - 1) as u16;
    match id {
        FIRST_STORY_DOOR_ID.. => playing(id - FIRST_STORY_DOOR_ID),
        FIRST_STORY_ID..FIRST_PARKED_ID => playing(id - FIRST_STORY_ID),
        _ => parked_number(id).map_or(id.min(u32::from(FIRST_STORY_INSTANCE) - 1) as u16, instance_of_parked),
    }
}

/// The number that who has an instance has everywhere else: 0 the ego car, from [`FIRST_STORY_ID`] on who plays a story, from
/// [`FIRST_PARKED_ID`] on a parked car.
pub fn actor_of_instance(instance: u16) -> u32 {
    match instance {
        EGO_INSTANCE => 0,
        FIRST_PARKED_INSTANCE.. => FIRST_PARKED_ID + u32::from(instance - FIRST_PARKED_INSTANCE),
        FIRST_STORY_INSTANCE.. => FIRST_STORY_ID + u32::from(instance - FIRST_STORY_INSTANCE),
        _ => u32::from(instance),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everybody_has_an_instance_of_its_own_and_a_door_that_of_its_car() {
        let ids =
            (1..400).chain((0..256).map(|role| FIRST_STORY_ID + role)).chain((0..400).map(|n| FIRST_PARKED_ID + n));
        assert!(
            ids.clone().all(|id| actor_of_instance(instance_of_actor(id)) == id)
                && actor_of_instance(EGO_INSTANCE) == 0
        );
        let mut instances: Vec<u16> = ids.map(instance_of_actor).chain([EGO_INSTANCE]).collect();
        assert!(instances.is_sorted());
        instances.dedup();
        assert_eq!(instances.len(), 399 + 256 + 400 + 1);
        assert_eq!(instance_of_actor(FIRST_DOOR_ID + 7), instance_of_actor(FIRST_PARKED_ID + 7));
        assert_eq!(instance_of_actor(FIRST_STORY_DOOR_ID + 7), instance_of_actor(FIRST_STORY_ID + 7));
        assert_eq!((parked_number(FIRST_STORY_DOOR_ID + 7), parked_number(FIRST_DOOR_ID + 7)), (None, Some(7)));
    }
}
