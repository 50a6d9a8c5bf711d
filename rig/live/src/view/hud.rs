//! The HUD of both drivers at a tick that is looked at.

use drivers::film::reel::Moment;
use kernel::arbiter::Applied;
use kernel::{Controls, Seat};

use crate::desktop::HudText;

/// That of a moment.
pub fn text(moment: &Moment) -> HudText {
    let seat = |of: fn(&Applied) -> Seat| moment.applied.as_ref().map_or(Seat::Semantic, of);
    let is_reverse = moment.applied.is_some_and(|applied| applied.controls.has(Controls::REVERSE));
    HudText::new(&moment.hud, seat(|applied| applied.steering), seat(|applied| applied.pedals), is_reverse)
}
