//! Doors of those who play.

use crate::actor::FIRST_STORY_DOOR_ID;
use crate::ops;
use crate::time::Tick;
use crate::traffic::{Door, Hinge, OPEN_RAD};

use super::actor::{self, DoorSwing, StoryActor};
use super::script;

/// Begins to open or to shut one.
pub fn swing(actor: &mut StoryActor, door: script::Door, tick: Tick) {
    let swinging = &mut actor.doors[usize::from(!door.is_left)];
    let from = swinging.share(tick);
    *swinging = DoorSwing { from, to: door.open, since: tick, takes_ticks: door.takes_ticks };
}

/// Those of a role that stand open at a tick: of two the wider one.
pub fn open(actor: &StoryActor, role: (usize, &script::Role), tick: Tick) -> Option<Door> {
    let shares = actor.doors.map(|door| door.share(tick));
    let side = usize::from(shares[1] > shares[0]);
    if shares[side] <= 0.0 {
        return None;
    }
    let (at, out) = (&actor.spot, if side == 0 { 1.0 } else { -1.0 });
    let hinge = Hinge::of(at.position, at.heading_rad, actor::size_m(role.1), out);
    let leaf = hinge.leaf(OPEN_RAD * shares[side]);
    Some(Door {
        id: FIRST_STORY_DOOR_ID + role.0 as u32,
        position: hinge.middle(leaf),
        heading_rad: ops::atan2(leaf.y, leaf.x),
        begins: actor.doors[side].since.checked_add(1) == Some(tick) && actor.doors[side].to > 0.0,
    })
}
