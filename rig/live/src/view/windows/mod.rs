//! The viewer's window: two views, what there is to know about the tick, and the timeline.

mod bar;
mod colours;
mod face;
mod facts;
mod keys;

use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::Duration;

use anyhow::Context;
use base::clock::SessionClock;
use base::newest::Newest;
use drivers::film::Film;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, KeyEvent, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::keyboard::ModifiersState;
use winit::window::WindowId;

use super::clerk::Errand;
use super::projector::{Request, Shown};
use super::viewing::{Action, Order, Viewing};
use crate::desktop::{self, Pane};
use face::Face;
use keys::Meaning;

/// Place and size (logical pixels) of the window at first.
const PLACE: ([u32; 2], [u32; 2]) = ([0, 0], [1290, 800]);

/// What the other threads tell the window.
#[derive(Debug)]
pub enum Word {
    /// There is something new to be shown.
    Shown,
    /// Something to tell the person at the screen.
    Said(String),
    /// A thread cannot go on.
    Failed(anyhow::Error),
    /// The program is to end.
    Over,
}

/// Speaks to the window from other threads.
#[derive(Clone)]
pub struct Voice(EventLoopProxy<Word>);

impl Voice {
    /// Once the window is gone there is nobody to tell.
    pub fn say(&self, word: Word) {
        let _ = self.0.send_event(word);
    }
}

/// The window before it opens.
pub struct Window {
    events: EventLoop<Word>,
}

impl Window {
    /// Finds the display.
    pub fn new() -> anyhow::Result<Self> {
        Ok(Self { events: desktop::event_loop("--digests and aeye rerender need none")? })
    }

    /// To speak to the window from other threads.
    pub fn voice(&self) -> Voice {
        Voice(self.events.create_proxy())
    }

    /// Shows until the person at the screen has seen enough.
    pub fn show(self, viewing: Viewing, links: Links<'_>) -> anyhow::Result<()> {
        let clock = SessionClock::starting_now();
        let mut desk = Desk {
            viewing,
            links,
            clock,
            advanced_us: 0,
            asked: None,
            is_photographing: false,
            modifiers: ModifiersState::empty(),
            open: None,
            failure: None,
        };
        self.events.run_app(&mut desk).context("the window's event loop")?;
        desk.failure.map_or(Ok(()), Err)
    }
}

/// The threads around the window.
pub struct Links<'a> {
    /// What is looked at.
    pub film: &'a Film,
    /// What is to be shown.
    pub requests: &'a Newest<Request>,
    /// What was made of the newest request that was served.
    pub shown: &'a Newest<Shown>,
    /// What is to be kept.
    pub errands: Sender<Errand>,
}

/// What the event loop drives.
struct Desk<'a> {
    viewing: Viewing,
    links: Links<'a>,
    clock: SessionClock,
    /// Until when time has moved the playback, microseconds.
    advanced_us: u64,
    /// The request that was last made.
    asked: Option<Request>,
    /// A screenshot is to be taken as soon as what was asked for is there.
    is_photographing: bool,
    modifiers: ModifiersState,
    open: Option<(Pane, Face)>,
    failure: Option<anyhow::Error>,
}

impl Desk<'_> {
    fn act(&mut self, action: Action) {
        match self.viewing.act(action) {
            Some(Order::Cut(ticks)) => self.send(Errand::Case(ticks)),
            Some(Order::Screenshot) => self.is_photographing = true,
            None => {}
        }
        self.redraw();
    }

    /// The clerk is there as long as the window is.
    fn send(&self, errand: Errand) {
        let _ = self.links.errands.send(errand);
    }

    fn redraw(&self) {
        if let Some((pane, _)) = &self.open {
            pane.redraw();
        }
    }

    /// Asks for what is to be shown, if it is not what was asked for last.
    fn ask(&mut self) {
        let request = self.viewing.request();
        if self.asked.as_ref() != Some(&request) {
            self.asked = Some(request.clone());
            self.links.requests.put(request);
            self.redraw();
        }
    }

    /// Takes a screenshot that is due. While it plays, what is on the screen will do.
    fn photograph(&mut self) {
        let is_it =
            |shown: &Arc<Shown>| self.viewing.playback.is_playing() || self.asked.as_ref() == Some(&shown.request);
        if let Some(shown) = self.links.shown.get().filter(is_it)
            && std::mem::take(&mut self.is_photographing)
        {
            self.send(Errand::Screenshot(shown));
        }
    }

    /// Lets time pass, and sleeps until it matters again.
    fn pass_time(&mut self, events: &ActiveEventLoop) {
        let now_us = self.clock.now_us();
        self.viewing.playback.advance(now_us.saturating_sub(self.advanced_us));
        self.advanced_us = now_us;
        let wait_us = self.viewing.playback.wait_us();
        events.set_control_flow(
            wait_us.map_or(ControlFlow::Wait, |us| ControlFlow::wait_duration(Duration::from_micros(us))),
        );
    }

    fn paint(&mut self) {
        let Self { viewing, links, open: Some((pane, face)), .. } = self else { return };
        let shown = links.shown.get();
        let mut actions = Vec::new();
        pane.paint(|ui| face.paint(ui, viewing, links.film, shown.as_deref(), &mut actions));
        for action in actions {
            self.act(action);
        }
    }

    fn key(&mut self, events: &ActiveEventLoop, event: &KeyEvent) {
        if event.state == ElementState::Released {
            return;
        }
        let shift = self.modifiers.shift_key();
        match keys::meaning(&event.logical_key, event.physical_key, shift, event.repeat) {
            Some(Meaning::Do(action)) => self.act(action),
            Some(Meaning::FullScreen) => {
                if let Some((pane, _)) = &self.open {
                    pane.toggle_full_screen();
                }
            }
            Some(Meaning::Quit) => events.exit(),
            None => {}
        }
    }
}

impl ApplicationHandler<Word> for Desk<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.open.is_some() {
            return;
        }
        let title = format!("A-Eye: {}", self.links.film.path.display());
        match Pane::open(events, (&title, PLACE.0, PLACE.1), None) {
            Ok(pane) => self.open = Some((pane, Face::default())),
            Err(error) => {
                self.failure = Some(error);
                events.exit();
            }
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, word: Word) {
        match word {
            Word::Shown => self.redraw(),
            Word::Said(text) => {
                self.viewing.said = text;
                self.redraw();
            }
            Word::Failed(error) => {
                self.failure = Some(error);
                events.exit();
            }
            Word::Over => events.exit(),
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match &event {
            WindowEvent::RedrawRequested => return self.paint(),
            WindowEvent::KeyboardInput { event, is_synthetic: false, .. } => return self.key(events, event),
            WindowEvent::KeyboardInput { .. } => return,
            WindowEvent::ModifiersChanged(modifiers) => self.modifiers = modifiers.state(),
            WindowEvent::CloseRequested => return events.exit(),
            _ => {}
        }
        if let Some((pane, _)) = &mut self.open {
            pane.event(&event);
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        self.pass_time(events);
        self.ask();
        self.photograph();
    }
}
