//! Who has which number in a trace. Road users keep theirs, all of which are below 2^32.

use kernel::map::LaneId;
use kernel::scene::FIRST_PARKED_ID;

use super::messages::Identifier;

/// The ego car; actors have numbers from 1 on.
pub const EGO: Identifier = Identifier { value: 0 };
/// The first of each kind of what belongs to the map.
const LANES: u64 = 1 << 32;
const BOUNDARIES: u64 = 2 << 32;
const LAMPS: u64 = 3 << 32;
const PROPS: u64 = 4 << 32;

/// An actor.
pub fn actor(id: u32) -> Identifier {
    Identifier { value: id.into() }
}

/// The car that is parked as the map's so many'th; it keeps its number when it is pushed and becomes an actor.
pub fn parked(number: usize) -> Identifier {
    Identifier { value: u64::from(FIRST_PARKED_ID) + number as u64 }
}

/// A lane.
pub fn lane(id: LaneId) -> Identifier {
    Identifier { value: LANES + u64::from(id) }
}

/// The left and the right edge of a lane.
pub fn boundaries(lane: LaneId) -> [Identifier; 2] {
    [0, 1].map(|side| Identifier { value: BOUNDARIES + 2 * u64::from(lane) + side })
}

/// One of the three lamps of a signal head.
pub fn lamp(head: usize, lamp: usize) -> Identifier {
    Identifier { value: LAMPS + (3 * head + lamp) as u64 }
}

/// A thing of the map, by its place among all of them.
pub fn prop(index: usize) -> Identifier {
    Identifier { value: PROPS + index as u64 }
}
