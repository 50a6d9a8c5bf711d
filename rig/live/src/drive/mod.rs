//! The live rig: two people, or bots, at two screens, one car, and a control centre.
//!
//! The simulation paces itself by the clock and waits for nobody: views are drawn, predicted and
//! painted by other threads, of which the newest result wins.

mod aftermath;
mod alert;
mod board;
mod disk;
mod eyes;
mod force;
mod hud;
mod pacing;
mod pending;
mod run;
mod seating;
mod simulation;
mod stage;
mod strip;
mod terminal;
#[cfg(test)]
mod tests;
mod timings;
mod traces;
mod windows;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{self, Sender};

use anyhow::{Context, anyhow};
use base::clock::SessionClock;
use base::maps::Map;
use base::output;
use base::progress::Interrupt;
use base::say::say;
use drivers::checkpoint::CheckpointChoice;
use drivers::pictures::{Pictures, Screens};
use drivers::seat::SeatChoice;
use kernel::Scenario;
use kernel::time::{TICK_HZ, Tick};
use render::Camera;
use study::{Lineup, Protocol, Study};

pub use aftermath::Tell;
use board::{Board, Message, Wake};
use eyes::Eyes;
use seating::Seating;
use simulation::{Agenda, Links, Plan, Simulation};
pub use timings::LiveFigures;
use timings::Timings;
use viewers::server::{Endpoint, Server};
use windows::{Link, Waker, Windows};

use crate::speakers;

/// A session of live drives.
pub struct Options {
    /// What is driven.
    pub wanted: Wanted,
    /// What each driver drives with, semantic driver's first.
    pub seats: [SeatChoice; 2],
    /// Calibrations of wheels and gamepads, chosen by the names of their devices.
    pub calibration: Vec<PathBuf>,
    /// Greatest force of wheels and gamepads, [0, 1].
    pub force: f32,
    /// Where the drivers hear the car.
    pub sound: speakers::Options,
    /// Where the drive is shown to Foxglove.
    pub foxglove: Option<Endpoint>,
    /// The pictures in windows.
    pub pictures: Pictures,
    /// Where the recording goes; further runs go to `FILE-2.mcap`, `FILE-3.mcap` and so on.
    pub record: PathBuf,
    /// Told what each run came to.
    pub tell: Tell,
}

/// What is driven in a session.
pub enum Wanted {
    /// One scenario, again and again.
    Scenario {
        /// Where to drive.
        map: Map,
        /// The scenario of the first run; the others follow from its seed.
        scenario: Box<Scenario>,
        /// What the semantic driver sees.
        checkpoint: CheckpointChoice,
        /// What makes it part of a study with people.
        study: Study,
    },
    /// The trials of a protocol, as far as they are not driven yet.
    Trials(Protocol),
}

/// Drives in windows until the operators have had enough.
pub fn drive(options: Options) -> anyhow::Result<()> {
    let Options { wanted, seats, calibration, force, sound, foxglove, pictures, record, tell } = options;
    output::check_file(&record)?;
    let (plan, lineup) = opened(wanted, &pictures, Around { force, foxglove, record, tell, unattended: None })?;
    let seating = Seating::new(seats, &calibration)?;
    let timings = session(plan, seating, lineup, &pictures, &sound)?;
    if let Some(figures) = timings.figures() {
        say(figures);
        figures.shortfalls().iter().for_each(say);
    }
    Ok(())
}

/// How well this machine keeps real time: bots drive in windows for so long, as people would. Nothing
/// of it is kept.
pub fn trial(choice: &CheckpointChoice, pictures: &Pictures, seconds: u32) -> anyhow::Result<LiveFigures> {
    let dir = tempfile::tempdir()?;
    let map = Map::find(kernel::map::BUNDLED[0])?;
    let scenario = Box::new(map.scenario(1));
    let wanted = Wanted::Scenario { map, scenario, checkpoint: choice.clone(), study: Study::default() };
    let around = Around {
        force: 0.0,
        foxglove: None,
        record: dir.path().join("trial.mcap"),
        tell: Arc::new(|_, _| Ok(())),
        unattended: Some(Tick::from(seconds) * Tick::from(TICK_HZ)),
    };
    let (plan, lineup) = opened(wanted, pictures, around)?;
    let seating = Seating::new([SeatChoice::Bot, SeatChoice::Bot], &[])?;
    let timings = session(plan, seating, lineup, pictures, &speakers::Options::null())?;
    timings.figures().context("no picture came onto the semantic driver's screen")
}

/// What a session has around what is driven.
struct Around {
    force: f32,
    foxglove: Option<Endpoint>,
    record: PathBuf,
    tell: Tell,
    unattended: Option<Tick>,
}

/// What the session is about, and the eyes that drive it.
fn opened(wanted: Wanted, pictures: &Pictures, around: Around) -> anyhow::Result<(Plan, Lineup)> {
    let open = |checkpoints: &[CheckpointChoice], is_blind: bool| {
        Lineup::open(checkpoints, is_blind, pictures.of_networks(), pictures.inference)
    };
    let (agenda, study, lineup) = match wanted {
        Wanted::Scenario { map, scenario, checkpoint, study } => {
            let lineup = open(&study.candidates(&checkpoint), true)?;
            let draw = lineup.cast().draw(scenario.seed);
            (Agenda::Drawn { map, scenario, draw }, study, lineup)
        }
        Wanted::Trials(protocol) => {
            let lineup = open(&protocol.checkpoints, protocol.is_blind)?;
            let study = protocol.study();
            (Agenda::Planned(Box::new(protocol)), study, lineup)
        }
    };
    let Around { force, foxglove, record, tell, unattended } = around;
    let plan = Plan {
        agenda,
        force,
        foxglove,
        record,
        provenance: study.provenance()?,
        cast: lineup.cast().clone(),
        operators: study.names(),
        is_familiarisation: study.familiarisation,
        tell,
        unattended,
    };
    Ok((plan, lineup))
}

/// Opens the windows and drives until the operators, or the plan, have had enough.
fn session(
    plan: Plan,
    seating: Seating,
    lineup: Lineup,
    pictures: &Pictures,
    sound: &speakers::Options,
) -> anyhow::Result<Timings> {
    let windows = Windows::new()?;
    let (_speakers, sound) = speakers::open(sound)?;
    let (outbox, inbox) = mpsc::channel();
    let (board, clock) = (Arc::new(Board::default()), SessionClock::starting_now());
    let _server = plan.foxglove.clone().map(|at| Server::bind(at, board.feed.clone(), clock)).transpose()?;
    let waker = windows.waker();
    let wake = waker.clone();
    let links = Links {
        board: board.clone(),
        inbox,
        outbox: outbox.clone(),
        wake: Box::new(move |what| wake.wake(what)),
        clock,
        sound,
        interrupt: Interrupt::listen(),
    };
    let simulation = Simulation::new(plan, seating, links)?;
    let network = simulation.network();
    let [safety_eyes, semantic_eyes] = [Eyes::on(network)?, Eyes::on(network)?];

    let (width, height) = pictures.image_size;
    let cameras = match pictures.screens {
        Screens::Three => Camera::driver_row(width, height).to_vec(),
        Screens::One => vec![Camera::driver(width, height)],
    };
    let imaging = pictures.imaging.in_quality(safety_eyes.quality_for_people());
    let cameras: Vec<_> = cameras.into_iter().map(|camera| camera.at(imaging)).collect();
    std::thread::scope(|scope| {
        scope.spawn({
            let (board, outbox, show) = (&*board, outbox.clone(), waker.to(Wake::Safety));
            let cameras = cameras.clone();
            move || report(&outbox, || eyes::watch_as_safety(board, safety_eyes, &cameras, clock, show))
        });
        scope.spawn({
            let (board, outbox, show) = (&*board, outbox.clone(), waker.to(Wake::Semantic));
            move || report(&outbox, || eyes::watch_as_semantic(board, semantic_eyes, lineup, clock, show))
        });
        let driving = scope.spawn(move || {
            let _over = Over(waker);
            simulation.drive()
        });
        let link = Link { board: board.clone(), outbox: outbox.clone(), clock, screens: cameras.len() };
        // A window that the system takes away makes winit panic; the recording is to be finished all the same.
        let shown = catch_unwind(AssertUnwindSafe(|| windows.show(link)));
        let shown = shown.unwrap_or_else(|_| Err(anyhow!("a window was taken away; the session is over")));
        // The windows are gone, by the simulation's word or by a failure of their own.
        let _ = outbox.send(Message::Gone);
        let driven = driving.join().unwrap_or_else(|_| Err(anyhow!("the simulation thread panicked")));
        board.feed.scene.close();
        shown.and(driven)
    })
}

/// Tells the simulation when an eye cannot go on; a simulation that is over needs no eyes.
fn report(outbox: &Sender<Message>, watch: impl FnOnce() -> anyhow::Result<()>) {
    let watched = catch_unwind(AssertUnwindSafe(watch)).unwrap_or_else(|_| Err(anyhow!("drawing a view panicked")));
    if let Err(error) = watched {
        let _ = outbox.send(Message::Failed(error));
    }
}

/// Ends the windows when the simulation ends, however it does.
struct Over(Waker);

impl Drop for Over {
    fn drop(&mut self) {
        self.0.wake(Wake::Over);
    }
}
