//! The three windows: what each driver sees, and the control centre.

mod centre;
mod keys;

use std::sync::Arc;
use std::sync::mpsc::Sender;

use anyhow::Context;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, KeyEvent, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop, EventLoopProxy};
use winit::window::WindowId;

use super::board::{Board, Message, View, Wake};
use super::hud;
use crate::clock::SessionClock;
use crate::desktop::{self, Pane, Picture};
use centre::Centre;

/// Titles, places and sizes (logical pixels) of the windows at first.
const SEMANTIC: (&str, [u32; 2], [u32; 2]) = ("A-Eye: semantic driver", [0, 0], [640, 360]);
const SAFETY: (&str, [u32; 2], [u32; 2]) = ("A-Eye: safety driver", [650, 0], [640, 360]);
const CENTRE: (&str, [u32; 2], [u32; 2]) = ("A-Eye: control centre", [0, 400], [1290, 540]);

/// Speaks to the windows from other threads.
#[derive(Clone)]
pub struct Waker(EventLoopProxy<Wake>);

impl Waker {
    /// Draws windows anew, or ends them. Once they are gone there is nothing to wake.
    pub fn wake(&self, wake: Wake) {
        let _ = self.0.send_event(wake);
    }
}

/// The windows before they open.
pub struct Windows {
    events: EventLoop<Wake>,
}

impl Windows {
    /// Finds the display.
    pub fn new() -> anyhow::Result<Self> {
        let events = desktop::event_loop("--headless drives without")?;
        Ok(Self { events })
    }

    /// To speak to the windows from other threads.
    pub fn waker(&self) -> Waker {
        Waker(self.events.create_proxy())
    }

    /// Shows the board until [`Wake::Over`].
    pub fn show(self, board: Arc<Board>, outbox: Sender<Message>, clock: SessionClock) -> anyhow::Result<()> {
        let mut desk = Desk { board, outbox, clock, panes: None, failure: None };
        self.events.run_app(&mut desk).context("the windows' event loop")?;
        desk.failure.map_or(Ok(()), Err)
    }
}

/// What the event loop drives.
struct Desk {
    board: Arc<Board>,
    outbox: Sender<Message>,
    clock: SessionClock,
    panes: Option<Panes>,
    failure: Option<anyhow::Error>,
}

struct Panes {
    semantic: (Pane, Picture),
    safety: (Pane, Picture),
    centre: (Pane, Centre),
    /// The view that was last on the semantic driver's screen.
    shown: Option<Arc<View>>,
}

impl Panes {
    fn open(events: &ActiveEventLoop) -> anyhow::Result<Self> {
        let semantic = Pane::open(events, SEMANTIC, None)?;
        let device = semantic.device();
        let safety = Pane::open(events, SAFETY, device.clone())?;
        let centre = Pane::open(events, CENTRE, device)?;
        Ok(Self {
            semantic: (semantic, Picture::sharp()),
            safety: (safety, Picture::smooth()),
            centre: (centre, Centre::default()),
            shown: None,
        })
    }

    fn all(&mut self) -> [&mut Pane; 3] {
        [&mut self.semantic.0, &mut self.safety.0, &mut self.centre.0]
    }

    fn of(&mut self, id: WindowId) -> Option<&mut Pane> {
        self.all().into_iter().find(|pane| pane.id() == id)
    }
}

impl Desk {
    /// To the simulation; when it is gone, its last word ends the windows.
    fn tell(&self, message: Message) {
        let _ = self.outbox.send(message);
    }

    fn paint(&mut self, id: WindowId) {
        let Self { board, panes: Some(panes), clock, outbox, .. } = self else { return };
        let Some(status) = board.status.get() else { return };
        let hud = hud::text(&status);
        if panes.semantic.0.id() == id {
            let view = board.semantic.get().filter(|view| view.run == status.run);
            let (pane, picture) = &mut panes.semantic;
            pane.paint(|ui| picture.paint_with_hud(ui, view.as_ref().map(|view| &view.image), &hud));
            let is_new = |view: &Arc<View>| panes.shown.as_ref().is_none_or(|shown| !Arc::ptr_eq(shown, view));
            if let Some(view) = view.filter(is_new) {
                panes.shown = Some(view.clone());
                let _ = outbox.send(Message::Shown(view, clock.now_us()));
            }
        } else if panes.safety.0.id() == id {
            let view = board.safety.get().filter(|view| view.run == status.run);
            let (pane, picture) = &mut panes.safety;
            pane.paint(|ui| picture.paint_with_hud(ui, view.as_ref().map(|view| &view.image), &hud));
        } else {
            let views = [board.semantic.get(), board.safety.get()];
            let (pane, centre) = &mut panes.centre;
            pane.paint(|ui| centre.paint(ui, &status, views.each_ref().map(Option::as_ref)));
        }
    }

    fn seat_key(&self, event: &KeyEvent) {
        if let (Some(key), false) = (keys::seat_key(event.physical_key), event.repeat) {
            self.tell(Message::SeatKey(key, event.state == ElementState::Pressed));
        }
    }

    fn key(&mut self, id: WindowId, event: &KeyEvent) {
        self.seat_key(event);
        if event.state == ElementState::Released {
            return;
        }
        if keys::is_full_screen(event) && !event.repeat {
            if let Some(pane) = self.panes.as_mut().and_then(|panes| panes.of(id)) {
                pane.toggle_full_screen();
            }
        } else if let Some(press) = keys::press(event) {
            self.tell(Message::Press(press, event.repeat));
        }
    }
}

impl ApplicationHandler<Wake> for Desk {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.panes.is_some() {
            return;
        }
        match Panes::open(events) {
            Ok(panes) => self.panes = Some(panes),
            Err(error) => {
                self.failure = Some(error);
                events.exit();
            }
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, wake: Wake) {
        if wake == Wake::Over {
            return events.exit();
        }
        let Some(panes) = &mut self.panes else { return };
        match wake {
            Wake::Semantic => panes.semantic.0.redraw(),
            Wake::Safety => panes.safety.0.redraw(),
            Wake::Centre => panes.centre.0.redraw(),
            Wake::All | Wake::Over => panes.all().into_iter().for_each(|pane| pane.redraw()),
        }
    }

    fn window_event(&mut self, _: &ActiveEventLoop, id: WindowId, event: WindowEvent) {
        match &event {
            WindowEvent::RedrawRequested => return self.paint(id),
            WindowEvent::KeyboardInput { event, is_synthetic: false, .. } => return self.key(id, event),
            // A key that was down already when the window got the keyboard, or lost it.
            WindowEvent::KeyboardInput { event, .. } => return self.seat_key(event),
            WindowEvent::CloseRequested => self.tell(Message::Closed),
            WindowEvent::Focused(false) => self.tell(Message::KeysReleased),
            _ => {}
        }
        if let Some(pane) = self.panes.as_mut().and_then(|panes| panes.of(id)) {
            pane.event(&event);
        }
    }
}
