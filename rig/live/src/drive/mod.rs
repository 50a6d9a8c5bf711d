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
use base::chart::Chart;
use base::clock::SessionClock;
use base::maps::Map;
use base::output;
use base::progress::Interrupt;
use base::say::say;
use drivers::checkpoint::CheckpointChoice;
use drivers::pictures::{Pictures, Screens};
use drivers::seat::SeatChoice;
use kernel::time::{TICK_HZ, Tick};
use kernel::{Scenario, World};
use render::Camera;
use study::{Lineup, Study};

pub use aftermath::Tell;
use board::{About, Board, Message, Wake};
use seating::Seating;
use simulation::{Links, Plan, Simulation};
pub use timings::LiveFigures;
use timings::Timings;
use viewers::server::{Endpoint, Server};
use windows::{Link, Waker, Windows};

/// A session of live drives.
pub struct Options {
    /// Where to drive.
    pub map: Map,
    /// The scenario of the first run; the others follow from its seed.
    pub scenario: Scenario,
    /// What each driver drives with, semantic driver's first.
    pub seats: [SeatChoice; 2],
    /// Calibrations of wheels and gamepads, chosen by the names of their devices.
    pub calibration: Vec<PathBuf>,
    /// Greatest force of wheels and gamepads, [0, 1].
    pub force: f32,
    /// Where the drive is shown to Foxglove.
    pub foxglove: Option<Endpoint>,
    /// What the semantic driver sees.
    pub checkpoint: CheckpointChoice,
    /// The pictures in windows.
    pub pictures: Pictures,
    /// What makes it part of a study with people.
    pub study: Study,
    /// Where the recording goes; further runs go to `FILE-2.mcap`, `FILE-3.mcap` and so on.
    pub record: PathBuf,
    /// Told what each run came to.
    pub tell: Tell,
}

/// Drives in windows until the operators have had enough.
pub fn drive(options: Options) -> anyhow::Result<()> {
    let Options { map, scenario, seats, calibration, force, foxglove, checkpoint, pictures, study, record, tell } =
        options;
    output::check_file(&record)?;
    let lineup = Lineup::open(&study, &checkpoint, pictures.of_networks(), pictures.inference, scenario.seed)?;
    let plan = Plan {
        about: about(&study, &lineup, &scenario),
        map,
        scenario,
        force,
        foxglove,
        record,
        provenance: study.provenance()?,
        cast: lineup.cast().clone(),
        tell,
        unattended: None,
    };
    let seating = Seating::new(seats, &calibration, &plan.scenario.rules)?;
    let timings = session(plan, seating, lineup, &pictures)?;
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
    let (study, scenario) = (Study::default(), map.scenario(1));
    let lineup = Lineup::open(&study, choice, pictures.of_networks(), pictures.inference, scenario.seed)?;
    let plan = Plan {
        about: about(&study, &lineup, &scenario),
        scenario,
        map,
        force: 0.0,
        foxglove: None,
        record: dir.path().join("trial.mcap"),
        provenance: study.provenance()?,
        cast: lineup.cast().clone(),
        tell: Arc::new(|_, _| Ok(())),
        unattended: Some(Tick::from(seconds) * Tick::from(TICK_HZ)),
    };
    let seating = Seating::new([SeatChoice::Bot, SeatChoice::Bot], &[], &plan.scenario.rules)?;
    session(plan, seating, lineup, pictures)?.figures().context("no picture came onto the semantic driver's screen")
}

/// Opens the windows and drives until the operators, or the plan, have had enough.
fn session(plan: Plan, seating: Seating, lineup: Lineup, pictures: &Pictures) -> anyhow::Result<Timings> {
    let windows = Windows::new()?;
    let network = plan.map.network.clone();
    World::new(&plan.scenario, &network)?;
    let [safety_renderer, semantic_renderer] = [eyes::renderer(&network)?, eyes::renderer(&network)?];

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
        interrupt: Interrupt::listen(),
    };
    let simulation = Simulation::new(plan, seating, links)?;

    let (width, height) = pictures.image_size;
    let cameras = match pictures.screens {
        Screens::Three => Camera::driver_row(width, height).to_vec(),
        Screens::One => vec![Camera::driver(width, height)],
    };
    let imaging = pictures.imaging.in_quality(safety_renderer.quality_for_people());
    let cameras: Vec<_> = cameras.into_iter().map(|camera| camera.at(imaging)).collect();
    std::thread::scope(|scope| {
        scope.spawn({
            let (board, outbox, show) = (&*board, outbox.clone(), waker.to(Wake::Safety));
            let cameras = cameras.clone();
            move || report(&outbox, || eyes::watch_as_safety(board, safety_renderer, &cameras, clock, show))
        });
        scope.spawn({
            let (board, outbox, show) = (&*board, outbox.clone(), waker.to(Wake::Semantic));
            move || report(&outbox, || eyes::watch_as_semantic(board, semantic_renderer, lineup, clock, show))
        });
        let driving = scope.spawn(move || {
            let _over = Over(waker);
            simulation.drive()
        });
        let chart = Arc::new(Chart::of(&network));
        let link = Link { board: board.clone(), outbox: outbox.clone(), clock, chart, screens: cameras.len() };
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

/// What may be shown of a session while it lasts.
fn about(study: &Study, lineup: &Lineup, scenario: &Scenario) -> Arc<About> {
    Arc::new(About {
        checkpoint: lineup.cast().public_name().to_owned(),
        map: scenario.map.clone(),
        rules: scenario.rules,
        operators: study.names(),
        is_familiarisation: study.familiarisation,
    })
}
