//! Who sits in the seats. People and bots share one path: controls each tick.

pub mod checkpoint;
pub mod crew;
pub mod episode;
pub mod expert;
pub mod external;
pub mod film;
pub mod footprint;
mod indicate;
pub mod pictures;
pub mod readout;
pub mod recorded_eye;
pub mod safety;
pub mod seat;
pub mod semantic;
pub mod session;
pub mod simulate;
pub mod single_track;
pub mod temper;
pub mod vision;

use kernel::Controls;
use readout::Readout;

/// A driver in one of the seats; `View` is all it gets to see.
pub trait Driver<View: ?Sized> {
    /// The position of the driver's control unit for the next tick.
    fn controls(&mut self, view: &View) -> Controls;
}

/// All that the semantic driver sees.
#[derive(Clone, Copy, Debug)]
pub struct SemanticView<'a> {
    /// The mask on the screen.
    pub mask: MaskView<'a>,
    /// What the HUD shows.
    pub hud: Readout,
}

/// A borrowed mask: tag ids of CARLA 0.9.10, rows from top to bottom, seen through
/// `render::Camera::driver`.
#[derive(Clone, Copy, Debug)]
pub struct MaskView<'a> {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// `width * height` tag ids.
    pub ids: &'a [u8],
}
