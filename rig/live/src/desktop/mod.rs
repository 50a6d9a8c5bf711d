//! What every application with windows shares: windows that egui paints on one graphics device,
//! pictures in them, and the HUD over a driver's picture.

mod blit;
pub mod hud;
pub mod layout;
pub mod legend;
pub mod overlay;
pub mod pane;
pub mod picture;

pub use hud::HudText;
pub use layout::Layout;
pub use pane::Pane;
pub use picture::Picture;

use anyhow::anyhow;
use winit::event_loop::{ControlFlow, EventLoop};

/// Finds the display; `otherwise` says what can be done without one.
pub fn event_loop<T: 'static>(otherwise: &str) -> anyhow::Result<EventLoop<T>> {
    let events = EventLoop::with_user_event().build();
    let events = events.map_err(|error| {
        // Before the reason stands a place in winit's source.
        let error = error.to_string();
        let reason = error.rsplit(": ").next().unwrap_or(&error);
        anyhow!("no windows ({reason}): expected a display, as DISPLAY names it; {otherwise}")
    })?;
    events.set_control_flow(ControlFlow::Wait);
    Ok(events)
}
