//! The three windows: what each driver sees, and the control centre.

mod centre;
mod keys;
mod map;
mod plots;

use std::sync::Arc;
use std::sync::mpsc::Sender;

use anyhow::Context;
use base::clock::SessionClock;
use kernel::Seat;
use viewers::feed::View;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, KeyEvent, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop, EventLoopProxy};
use winit::window::WindowId;

use super::board::{Board, Message, Wake};
use super::hud;
use super::stage::Stage;
use crate::desktop::{self, Layout, Pane, Picture, legend};
use centre::Centre;

/// Titles, places and sizes (logical pixels) of the windows at first.
const SEMANTIC: (&str, [u32; 2], [u32; 2]) = ("A-Eye: semantic driver", [0, 0], [640, 360]);
const SAFETY: (&str, [u32; 2], [u32; 2]) = ("A-Eye: safety driver", [650, 0], [640, 360]);
const CENTRE: (&str, [u32; 2], [u32; 2]) = ("A-Eye: control centre", [0, 390], [1290, 560]);

/// Speaks to the windows from other threads.
#[derive(Clone)]
pub struct Waker(EventLoopProxy<Wake>);

impl Waker {
    /// Draws windows anew, or ends them. Once they are gone there is nothing to wake.
    pub fn wake(&self, wake: Wake) {
        let _ = self.0.send_event(wake);
    }

    /// Draws a window anew each time it is called.
    pub fn to(&self, wake: Wake) -> impl Fn() + Send + use<> {
        let waker = self.clone();
        move || waker.wake(wake)
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
    pub fn show(self, link: Link) -> anyhow::Result<()> {
        let mut desk = Desk { link, panes: None, focused: None, failure: None };
        self.events.run_app(&mut desk).context("the windows' event loop")?;
        desk.panes.iter().for_each(Panes::keep_places);
        desk.failure.map_or(Ok(()), Err)
    }
}

/// What the windows show, and whom they tell.
pub struct Link {
    /// What there is to see.
    pub board: Arc<Board>,
    /// To the simulation.
    pub outbox: Sender<Message>,
    /// Time since the session began.
    pub clock: SessionClock,
    /// Monitors that the safety driver's view is spread over.
    pub screens: usize,
}

/// What the event loop drives.
struct Desk {
    link: Link,
    panes: Option<Panes>,
    /// The window that has the keyboard.
    focused: Option<WindowId>,
    failure: Option<anyhow::Error>,
}

struct Panes {
    semantic: Driver,
    safety: Driver,
    centre: (Pane, Centre),
}

/// A driver's window.
struct Driver {
    pane: Pane,
    picture: Picture,
    /// The view that was last on the screen.
    shown: Option<Arc<View>>,
}

impl Panes {
    fn open(events: &ActiveEventLoop, link: &Link) -> anyhow::Result<Self> {
        let layout = Layout::of_user();
        let open = |window: (&str, _, _), device| -> anyhow::Result<Pane> {
            let pane = Pane::open(events, window, device)?;
            layout.get(window.0).iter().for_each(|placement| pane.place(placement));
            Ok(pane)
        };
        let semantic = open(SEMANTIC, None)?;
        let device = semantic.device();
        let safety = open(SAFETY, device.clone())?;
        let centre = open(CENTRE, device)?;
        Ok(Self {
            semantic: Driver { pane: semantic, picture: Picture::sharp(), shown: None },
            safety: Driver { pane: safety, picture: Picture::smooth().over(link.screens), shown: None },
            centre: (centre, Centre::new()),
        })
    }

    /// For the next session.
    fn keep_places(&self) {
        let mut layout = Layout::of_user();
        let panes = [(SEMANTIC.0, &self.semantic.pane), (SAFETY.0, &self.safety.pane), (CENTRE.0, &self.centre.0)];
        for (title, pane) in panes {
            pane.placement().into_iter().for_each(|placement| layout.set(title, placement));
        }
        layout.keep();
    }

    fn all(&mut self) -> [&mut Pane; 3] {
        [&mut self.semantic.pane, &mut self.safety.pane, &mut self.centre.0]
    }

    fn of(&mut self, id: WindowId) -> Option<&mut Pane> {
        self.all().into_iter().find(|pane| pane.id() == id)
    }
}

impl Driver {
    /// Paints the newest view, and gives it when it is new on the screen. Of a mask, the class under the mouse is named, and
    /// all of them are listed where nobody drives by it.
    fn paint(&mut self, view: Option<Arc<View>>, hud: &desktop::HudText, is_driving: bool) -> Option<Arc<View>> {
        self.pane.paint(|ui| {
            let rect = self.picture.paint_with_hud(ui, view.as_ref().map(|view| &view.image), hud);
            if let Some(mask) = view.as_ref().filter(|view| view.mask.is_some()) {
                if !is_driving {
                    legend::column_in(ui.painter(), rect, &legend::classes(&mask.image));
                }
                legend::name_under_mouse(ui, &mask.image, rect);
            }
        });
        let view = view?;
        let is_new = self.shown.as_ref().is_none_or(|shown| !Arc::ptr_eq(shown, &view));
        self.shown = Some(view.clone());
        is_new.then_some(view)
    }
}

impl Link {
    /// To the simulation; when it is gone, its last word ends the windows.
    fn tell(&self, message: Message) {
        let _ = self.outbox.send(message);
    }
}

impl Desk {
    fn paint(&mut self, id: WindowId) {
        let Self { link, panes: Some(panes), .. } = self else { return };
        let Link { board, clock, .. } = &*link;
        let Some(status) = board.status.get() else { return };
        let of_this_run = |view: &Arc<View>| view.run == status.run;
        let hud = |seat| hud::text(&status, seat);
        let is_driving = status.stage == Stage::Driving;
        let (seat, new) = if panes.semantic.pane.id() == id {
            let view = board.feed.semantic.get().filter(of_this_run);
            (Seat::Semantic, panes.semantic.paint(view, &hud(Seat::Semantic), is_driving))
        } else if panes.safety.pane.id() == id {
            let view = board.feed.safety.get().filter(of_this_run);
            (Seat::Safety, panes.safety.paint(view, &hud(Seat::Safety), is_driving))
        } else {
            let (pane, centre) = &mut panes.centre;
            return pane.paint(|ui| centre.paint(ui, &status, board));
        };
        if let Some(view) = new {
            link.tell(Message::Shown(seat, view, clock.now_us()));
        }
    }

    fn seat_key(&self, event: &KeyEvent) {
        if let (Some(key), false) = (keys::seat_key(event.physical_key), event.repeat) {
            self.link.tell(Message::SeatKey(key, event.state == ElementState::Pressed));
        }
    }

    fn key(&mut self, id: WindowId, event: &KeyEvent) {
        self.seat_key(event);
        if event.state == ElementState::Released {
            return;
        }
        if let Some(act) = keys::window_key(event) {
            if let (Some(pane), false) = (self.panes.as_mut().and_then(|panes| panes.of(id)), event.repeat) {
                act(pane);
            }
        } else if let Some(press) = keys::press(event) {
            self.link.tell(Message::Press(press, event.repeat));
        }
    }
}

impl ApplicationHandler<Wake> for Desk {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.panes.is_some() {
            return;
        }
        match Panes::open(events, &self.link) {
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
            Wake::Semantic => panes.semantic.pane.redraw(),
            Wake::Safety => panes.safety.pane.redraw(),
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
            WindowEvent::CloseRequested => self.link.tell(Message::Closed),
            WindowEvent::Destroyed => self.link.tell(Message::Gone),
            WindowEvent::Focused(true) => {
                self.focused = Some(id);
                self.link.tell(Message::Focus(true));
            }
            WindowEvent::Focused(false) => {
                self.link.tell(Message::KeysReleased);
                // The next window of ours may have got it before this one lost it.
                if self.focused == Some(id) {
                    self.focused = None;
                    self.link.tell(Message::Focus(false));
                }
            }
            _ => {}
        }
        if let Some(pane) = self.panes.as_mut().and_then(|panes| panes.of(id)) {
            pane.event(&event);
        }
    }
}
