//! A session with simulated wheels, from the operators' keys to the recording.

use std::sync::Arc;
use std::sync::mpsc::{self, Sender};
use std::thread::JoinHandle;

use base::clock::SessionClock;
use base::maps::Map;
use base::progress::Interrupt;
use drivers::checkpoint::CheckpointChoice;
use kernel::Seat;
use replay::{Label, NoteKind, Recording};
use study::{Lineup, Study};
use tempfile::TempDir;

use super::about;
use super::board::{Board, Message, Status};
use super::seating::Seating;
use super::simulation::{Links, Plan, Simulation};
use super::stage::{Press, Stage};
use crate::units::source::{AxisRange, DeviceInfo, RawEvent, Simulated};
use crate::units::testing::LAYOUT;
use crate::units::{SeatChoice, Seats};

/// Codes of the simulated wheels, as a gamepad's preset reads them.
const WHEEL: u16 = 0;
const BRAKE: u16 = 2;
const THROTTLE: u16 = 5;
const CENTRE: i32 = 128;

fn path(id: usize) -> String {
    format!("/dev/input/event{}", 30 + id)
}

fn device(id: usize) -> RawEvent {
    RawEvent::Connected(DeviceInfo {
        id,
        path: path(id),
        name: "simulated wheel".into(),
        vendor: 1,
        product: 2,
        axes: [WHEEL, BRAKE, THROTTLE].map(|code| AxisRange { code, min: 0, max: 255 }).into(),
        buttons: vec![0x130],
        layout: Some(LAYOUT),
    })
}

/// A session that drives in a thread of its own.
struct Bench {
    devices: Simulated,
    board: Arc<Board>,
    outbox: Sender<Message>,
    driving: JoinHandle<anyhow::Result<()>>,
    dir: TempDir,
}

impl Bench {
    fn start() -> Self {
        Self::start_in(tempfile::tempdir().unwrap())
    }

    fn start_in(dir: TempDir) -> Self {
        let devices = Simulated::default();
        (0..2).for_each(|id| devices.push(device(id)));
        let choices = [0, 1].map(|id| SeatChoice::Device(path(id)));
        let seats = Seats::with_source(choices.clone(), Vec::new(), Box::new(devices.clone()));
        let map = Map::find("rural").unwrap();
        let (study, scenario) = (Study::default(), map.scenario(1));
        let lineup = Lineup::open(
            &study,
            &CheckpointChoice::Truth,
            (None, render::Imaging::default()),
            perception::Compute::Cpu,
            scenario.seed,
        )
        .unwrap();
        let plan = Plan {
            about: about(&study, &lineup, &scenario),
            cast: lineup.cast().clone(),
            scenario,
            map,
            force: 0.0,
            foxglove: None,
            record: dir.path().join("drive.mcap"),
            provenance: Default::default(),
            tell: std::sync::Arc::new(|_, _| Ok(())),
            unattended: None,
        };
        let (outbox, inbox) = mpsc::channel();
        let board = Arc::new(Board::default());
        let links = Links {
            board: board.clone(),
            inbox,
            outbox: outbox.clone(),
            wake: Box::new(|_| {}),
            clock: SessionClock::starting_now(),
            interrupt: Interrupt::listen(),
        };
        let simulation = Simulation::new(plan, Seating::of(seats, choices), links).unwrap();
        let driving = std::thread::spawn(move || simulation.drive().map(drop));
        let bench = Self { devices, board, outbox, driving, dir };
        (0..2).for_each(|id| bench.arm(id));
        bench.wait(|status| status.units_note.is_none() && status.units[0].contains("armed"));
        bench.press("n");
        bench
    }

    fn press(&self, text: &str) {
        self.outbox
            .send(Message::Press(Press::Text { text: text.into(), command: text.chars().next() }, false))
            .unwrap();
    }

    fn axis(&self, device: usize, code: u16, value: i32) {
        self.devices.push(RawEvent::Axis { device, code, value });
    }

    fn arm(&self, id: usize) {
        for (code, rest) in [(WHEEL, CENTRE), (THROTTLE, 0), (BRAKE, 0)] {
            self.axis(id, code, 255);
            self.axis(id, code, rest);
        }
    }

    /// Waits for a status.
    fn wait(&self, is_so: impl Fn(&Status) -> bool) -> Arc<Status> {
        let mut seen = 0;
        loop {
            let (number, status) = self.board.status.wait(seen).unwrap();
            if is_so(&status) {
                return status;
            }
            assert!(!self.driving.is_finished(), "the session has ended: {status:?}");
            seen = number;
        }
    }

    /// Quits.
    fn close(self) -> TempDir {
        self.outbox.send(Message::Closed).unwrap();
        self.driving.join().unwrap().unwrap();
        self.dir
    }

    /// Quits, and gives what happened to the units of the first run.
    fn notes(self) -> Vec<(NoteKind, Seat)> {
        let recording = Recording::open(&self.close().path().join("drive.mcap")).unwrap();
        recording.log().notes.iter().map(|note| (note.kind, note.seat)).collect()
    }
}

#[test]
fn lost_wheels_stop_the_car_are_said_and_end_the_run_when_they_are_the_safety_drivers() {
    let bench = Bench::start();
    bench.axis(0, THROTTLE, 255);
    bench.wait(|status| status.hud.speed_mps > 2.0);
    bench.devices.push(RawEvent::Lost(0));
    let said = bench.wait(|status| status.hud.speed_mps < 0.1).units_note.clone().unwrap();
    assert_eq!(said, "semantic driver's simulated wheel: lost, plug it in again");
    bench.devices.push(device(0));
    bench.wait(|status| status.units_note.as_ref().is_some_and(|said| said.contains("to arm it, move the left stick")));
    bench.arm(0);
    bench.axis(0, THROTTLE, 255);
    bench.wait(|status| status.hud.speed_mps > 2.0);
    bench.devices.push(RawEvent::Lost(1));
    let status = bench.wait(|status| status.run == 2);
    assert!(status.stage == Stage::Ready && status.totals.cases == 0, "{status:?}");
    assert!(status.units_note.as_ref().is_some_and(|said| said.starts_with("safety driver's")), "{status:?}");
    use NoteKind::{UnitArmed, UnitLost, UnitReturned};
    let [semantic, safety] = [Seat::Semantic, Seat::Safety];
    let expected = [(UnitLost, semantic), (UnitReturned, semantic), (UnitArmed, semantic), (UnitLost, safety)];
    assert_eq!(bench.notes(), expected);
}

#[test]
fn a_takeover_whose_wheel_is_lost_still_asks_for_its_label() {
    let bench = Bench::start();
    bench.axis(0, THROTTLE, 200);
    bench.wait(|status| status.tick > 190);
    bench.axis(1, BRAKE, 60);
    bench.wait(|status| status.phase == kernel::arbiter::Phase::TakenOver);
    bench.devices.push(RawEvent::Lost(1));
    bench.wait(|status| matches!(status.stage, Stage::Labelling(_)));
    assert_eq!(bench.notes(), [(NoteKind::UnitLost, Seat::Safety)]);
}

#[test]
fn a_label_survives_an_early_end_and_the_next_session_counts_the_case() {
    let bench = Bench::start();
    bench.axis(0, THROTTLE, 200);
    bench.wait(|status| status.tick > 190);
    bench.axis(1, BRAKE, 60);
    bench.wait(|status| matches!(status.stage, Stage::Labelling(_)));
    ["2", "t", "o", "o"].iter().for_each(|key| bench.press(key));
    let dir = bench.close();
    let recording = Recording::open(&dir.path().join("drive.mcap")).unwrap();
    let annotation = recording.log().annotation.clone().unwrap();
    assert_eq!((annotation.label, annotation.comment.as_str()), (Label::Vehicle, "too"));
    assert!(dir.path().join("drive.case.mcap").exists());

    let bench = Bench::start_in(dir);
    let totals = bench.wait(|status| status.stage == Stage::Driving).totals;
    let driven_mm = recording.log().summary.as_ref().unwrap().odometer_mm;
    assert_eq!((totals.runs, totals.cases, totals.odometer_mm), (1, 1, driven_mm));
    bench.close();
}
