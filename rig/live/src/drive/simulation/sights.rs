//! What is on the drivers' screens: the semantic bot looks at it, and its age is shown.

use std::sync::Arc;

use kernel::Seat;
use viewers::feed::View;

use crate::drive::run::Screen;

/// The pictures on the drivers' screens; none before the first one of a run has come there.
#[derive(Default)]
pub struct Sights {
    screen: Option<Screen>,
    /// When the scene of the safety driver's image was captured, microseconds.
    image_of_us: Option<u64>,
}

impl Sights {
    /// A view came onto a driver's screen, microseconds since the session began.
    pub fn take(&mut self, seat: Seat, view: Arc<View>, presented_us: u64) {
        match seat {
            Seat::Semantic => self.screen = Some(Screen { view, presented_us }),
            Seat::Safety => self.image_of_us = Some(view.captured_us),
        }
    }

    /// What the semantic driver sees.
    pub fn screen(&self) -> Option<&Screen> {
        self.screen.as_ref()
    }

    /// When the scenes of the mask and of the image on the screens were captured, microseconds.
    pub fn captured_us(&self) -> [Option<u64>; 2] {
        [self.screen.as_ref().map(|screen| screen.view.captured_us), self.image_of_us]
    }
}
