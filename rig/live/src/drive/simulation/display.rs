//! What the simulation puts on the board, and the windows that are drawn anew for it.

use std::sync::Arc;

use kernel::time::Tick;
use kernel::{TickInput, TickOutput, World};
use viewers::feed::Look;

use crate::drive::alert::Alert;
use crate::drive::board::{Board, Status, Wake};
use crate::drive::traces::Traces;

/// The board, and what is shown of the run that is on.
pub struct Display {
    board: Arc<Board>,
    wake: Box<dyn Fn(Wake) + Send>,
    traces: Traces,
    /// Both drivers' controls.
    pub input: TickInput,
    last: Option<TickOutput>,
    alert: Option<Alert>,
}

impl Drop for Display {
    /// Nobody waits for what does not come any more.
    fn drop(&mut self) {
        self.board.feed.scene.close();
        self.board.status.close();
    }
}

impl Display {
    /// Shows nothing yet. `wake` draws windows anew.
    pub fn new(board: Arc<Board>, wake: Box<dyn Fn(Wake) + Send>) -> Self {
        Self { board, wake, traces: Traces::default(), input: TickInput::default(), last: None, alert: None }
    }

    /// A new run waits, of which nothing has been driven.
    pub fn begin(&mut self, world: &World) {
        self.traces = Traces::of(world);
        self.show_traces();
        (self.last, self.alert) = (None, None);
    }

    /// Takes a tick in.
    pub fn tick(&mut self, world: &World, input: TickInput, output: TickOutput) {
        self.traces.tick(world, &input, &output);
        self.input = input;
        self.alert = Alert::of(output.tick, &output.events).or(self.alert.take());
        self.last = Some(output);
    }

    /// What the last tick came to.
    pub fn last(&self) -> Option<&TickOutput> {
        self.last.as_ref()
    }

    /// What is to be told at a tick of what the car did wrong, or of what happened to it.
    pub fn alert(&self, tick: Tick) -> Option<&Alert> {
        self.alert.as_ref().filter(|alert| alert.is_shown(tick))
    }

    /// Puts the plots on the board.
    pub fn show_traces(&self) {
        self.board.traces.put(self.traces.clone());
    }

    /// Puts what there is to see on the board.
    pub fn show_scene(&self, run: u32, eye: usize, world: &World, captured_us: u64) {
        let network = world.network().clone();
        self.board.feed.scene.put(Look { run, network, eye, scene: world.scene(), captured_us });
    }

    /// Puts how the session is on the board, and has windows drawn anew.
    pub fn show_status(&self, status: Option<Status>, wake: Option<Wake>) {
        if let Some(status) = status {
            self.board.feed.figures.put(status.figures());
            self.board.status.put(status);
        }
        if let Some(wake) = wake {
            (self.wake)(wake);
        }
    }
}
