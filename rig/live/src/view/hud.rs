//! The HUD of both drivers at a tick that is looked at.

use drivers::film::reel::Moment;
use kernel::Seat;
use kernel::arbiter::Applied;

use crate::desktop::HudText;

/// That of a moment.
pub fn text(moment: &Moment) -> HudText {
    let seat = |of: fn(&Applied) -> Seat| moment.applied.as_ref().map_or(Seat::Semantic, of);
    let flags = moment.applied.map_or(0, |applied| applied.controls.flags);
    HudText::new(&moment.hud, seat(|applied| applied.steering), seat(|applied| applied.pedals), flags)
}
