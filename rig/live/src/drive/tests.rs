//! A session with simulated wheels, from the operators' keys to the recording.

use std::sync::Arc;
use std::sync::mpsc::{self, Sender};
use std::thread::JoinHandle;

use base::clock::SessionClock;
use base::maps::Map;
use base::progress::Interrupt;
use drivers::checkpoint::CheckpointChoice;
use drivers::pictures::{Pictures, Screens};
use kernel::Seat;
use replay::{Annotation, Label, NoteKind, Recording};
use study::{Protocol, Study};
use tempfile::TempDir;

use super::board::{Board, Message, Status};
use super::seating::Seating;
use super::simulation::{Links, Simulation};
use super::stage::{Dialog, Pause, Press, Stage};
use super::{Around, Wanted, opened};
use crate::speakers::Sound;
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

fn pictures() -> Pictures {
    Pictures {
        image_size: (64, 32),
        mask_size: None,
        imaging: render::Imaging::default(),
        inference: perception::Compute::Cpu,
        screens: Screens::One,
    }
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
        let map = Map::find("rural").unwrap();
        let scenario = Box::new(map.scenario(1));
        let (checkpoint, study) = (CheckpointChoice::Truth, Study::default());
        let bench = Self::ready(dir, Wanted::Scenario { map, scenario, checkpoint, study });
        bench.press("n");
        bench
    }

    /// A session whose wheels are armed, and that waits.
    fn ready(dir: TempDir, wanted: Wanted) -> Self {
        let devices = Simulated::default();
        (0..2).for_each(|id| devices.push(device(id)));
        let choices = [0, 1].map(|id| SeatChoice::Device(path(id)));
        let seats = Seats::with_source(choices.clone(), Vec::new(), Box::new(devices.clone()));
        let around = Around {
            force: 0.0,
            foxglove: None,
            record: dir.path().join("drive.mcap"),
            tell: Arc::new(|_, _| Ok(())),
            unattended: None,
        };
        let (plan, _) = opened(wanted, &pictures(), around).unwrap();
        let (outbox, inbox) = mpsc::channel();
        let board = Arc::new(Board::default());
        let links = Links {
            board: board.clone(),
            inbox,
            outbox: outbox.clone(),
            wake: Box::new(|_| {}),
            clock: SessionClock::starting_now(),
            sound: Sound::default(),
            interrupt: Interrupt::listen(),
        };
        let simulation = Simulation::new(plan, Seating::of(seats, choices), links).unwrap();
        let driving = std::thread::spawn(move || simulation.drive().map(drop));
        let bench = Self { devices, board, outbox, driving, dir };
        (0..2).for_each(|id| bench.arm(id));
        bench.wait(|status| status.units_note.is_none() && status.units[0].contains("armed"));
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

    fn enter(&self) {
        self.outbox.send(Message::Press(Press::Enter, false)).unwrap();
    }

    /// The semantic driver drives off, and the safety driver brakes.
    fn take_over(&self) {
        self.axis(0, THROTTLE, 200);
        self.wait(|status| status.tick > 190);
        self.axis(1, BRAKE, 60);
        self.wait(|status| status.phase == kernel::arbiter::Phase::TakenOver);
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
        self.outbox.send(Message::Gone).unwrap();
        self.driving.join().unwrap().unwrap();
        self.dir
    }

    /// Quits, and gives what happened to the units of the first run.
    fn notes(self) -> Vec<(NoteKind, Option<Seat>)> {
        let recording = Recording::open(&self.close().path().join("drive.mcap")).unwrap();
        recording.log().notes.iter().map(|note| (note.kind, note.seat)).collect()
    }

    /// Quits, and gives what was said of the first run.
    fn said(self) -> Annotation {
        let recording = Recording::open(&self.close().path().join("drive.mcap")).unwrap();
        recording.log().annotation.clone().unwrap()
    }
}

#[test]
fn lost_wheels_let_time_stand_until_the_operators_drive_on() {
    let bench = Bench::start();
    bench.axis(0, THROTTLE, 255);
    bench.wait(|status| status.hud.speed_mps > 2.0);
    bench.devices.push(RawEvent::Lost(0));
    let paused = bench.wait(|status| status.stage == Stage::Paused(Pause::UnitLost));
    let said = bench.wait(|status| status.units_note.is_some()).units_note.clone().unwrap();
    assert_eq!(said, "semantic driver's simulated wheel: lost, plug it in again");
    bench.press("p");
    bench.wait(|status| status.events.lines().any(|line| line.contains("the run cannot go on")));
    bench.devices.push(device(0));
    bench.wait(|status| status.units_note.as_ref().is_some_and(|said| said.contains("to arm it, move the left stick")));
    bench.arm(0);
    let armed = bench.wait(|status| status.units_note.is_none());
    assert_eq!((armed.tick, &armed.stage), (paused.tick, &Stage::Paused(Pause::UnitLost)), "time stands");
    bench.press("p");
    bench.axis(0, THROTTLE, 255);
    bench.wait(|status| status.stage == Stage::Driving && status.hud.speed_mps > 2.5);
    bench.devices.push(RawEvent::Lost(1));
    bench.wait(|status| status.stage == Stage::Paused(Pause::UnitLost));
    use NoteKind::{Paused, Resumed, UnitArmed, UnitLost, UnitReturned};
    let [semantic, safety] = [Some(Seat::Semantic), Some(Seat::Safety)];
    let notes = bench.notes();
    let first =
        [(UnitLost, semantic), (Paused, semantic), (UnitReturned, semantic), (UnitArmed, semantic), (Resumed, None)];
    let all: Vec<_> = first.into_iter().chain([(UnitLost, safety), (Paused, safety)]).collect();
    assert_eq!(notes, all);
}

#[test]
fn a_takeover_whose_wheel_is_lost_is_broken_off_with_its_label() {
    let bench = Bench::start();
    bench.take_over();
    bench.press("1");
    bench.wait(|status| status.events.lines().any(|line| line.contains("labelled walker")));
    bench.devices.push(RawEvent::Lost(1));
    bench.wait(|status| status.stage == Stage::Paused(Pause::UnitLost));
    bench.press("b");
    let asked = bench.wait(|status| matches!(status.stage, Stage::Labelling(_)));
    assert_eq!(asked.stage, Stage::Labelling(Dialog::of_case(Some(Label::Walker))));
    bench.enter();
    let totals = bench.wait(|status| status.run == 2).totals;
    assert_eq!((totals.runs, totals.cases), (1, 1));
    assert_eq!(bench.said().label, Label::Walker);
}

#[test]
fn a_takeover_that_operators_set_aside_is_no_corner_case_and_a_discarded_run_does_not_count() {
    for (key, label, runs) in [("5", Label::DriverError, 1), ("7", Label::Discarded, 0)] {
        let bench = Bench::start();
        bench.take_over();
        bench.wait(|status| matches!(status.stage, Stage::Labelling(_)));
        bench.press(key);
        bench.enter();
        let totals = bench.wait(|status| status.run == 2).totals;
        assert_eq!((totals.runs, totals.cases), (runs, 0), "{label}");
        let dir = bench.close();
        let recording = Recording::open(&dir.path().join("drive.mcap")).unwrap();
        assert!(recording.log().intervention.is_some() && recording.log().decided_at().is_none());
        assert_eq!(recording.log().annotation.as_ref().map(|said| said.label), Some(label));
        assert!(!dir.path().join("drive.case.mcap").exists(), "{label}");
        // The next session counts as this one did.
        let totals = Bench::start_in(dir).wait(|status| status.stage == Stage::Driving).totals;
        assert_eq!((totals.runs, totals.cases), (runs, 0), "{label}");
    }
}

#[test]
fn a_run_is_paused_and_broken_off_by_keys_and_a_closed_window_asks_first() {
    let bench = Bench::start();
    bench.axis(0, THROTTLE, 255);
    bench.wait(|status| status.hud.speed_mps > 1.0);
    bench.press("p");
    let paused = bench.wait(|status| status.stage == Stage::Paused(Pause::Asked));
    bench.press("p");
    bench.wait(|status| status.tick > paused.tick + 30);
    bench.outbox.send(Message::Closed).unwrap();
    bench.wait(|status| status.stage == Stage::Paused(Pause::Ending));
    bench.press("b");
    bench.wait(|status| status.stage == Stage::Labelling(Dialog::of_broken_off()));
    bench.enter();
    let totals = bench.wait(|status| status.run == 2).totals;
    assert_eq!((totals.runs, totals.cases), (1, 0));
    let recording = Recording::open(&bench.close().path().join("drive.mcap")).unwrap();
    let log = recording.log();
    assert_eq!((&log.annotation, log.summary.as_ref().unwrap().outcome), (&None, None), "it was stopped");
}

#[test]
fn a_label_survives_an_early_end_and_the_next_session_counts_the_case() {
    let bench = Bench::start();
    bench.take_over();
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

/// Two maps, each for four seconds in both arrangements of seats.
const PLAN: &str = r#"
participants = ["P07", "P03"]
blind = true
break_s = 300
questions = "each-half"
link = "https://forms.test/{participants}/{trial}/{run}"
[[conditions]]
map = "rural"
max_time_s = 4
[[conditions]]
map = "city"
checkpoint = "early"
max_time_s = 4
"#;

impl Bench {
    /// The plan's session in a folder, where it was left.
    fn planned(dir: TempDir) -> Self {
        let path = dir.path().join("plan.toml");
        std::fs::write(&path, PLAN).unwrap();
        Self::ready(dir, Wanted::Trials(Protocol::read(&path).unwrap()))
    }

    /// Starts a run of a trial, and waits for its end.
    fn drive_trial(&self, run: u32, trial: &str) -> Arc<Status> {
        let ready = self.wait(|status| status.run == run && status.stage == Stage::Ready);
        assert_eq!(ready.about.trial.as_deref(), Some(trial));
        self.press("n");
        self.wait(|status| status.run == run + 1)
    }

    /// Answers all questions with a digit.
    fn answer(&self, digit: &str) {
        for _ in 0..4 {
            self.press(digit);
            self.enter();
        }
    }
}

#[test]
fn a_plan_is_driven_trial_by_trial_and_goes_on_where_it_was_left() {
    let bench = Bench::planned(tempfile::tempdir().unwrap());
    let second = bench.drive_trial(1, "trial 1 of 4: rural");
    assert_eq!((second.about.map.as_str(), second.about.checkpoint.as_str()), ("city", "blind, one of 2"));
    // A run that does not count is driven again.
    bench.press("n");
    bench.wait(|status| status.stage == Stage::Driving);
    bench.press("b");
    bench.wait(|status| matches!(status.stage, Stage::Labelling(_)));
    bench.press("7");
    bench.enter();
    let asked = bench.drive_trial(3, "trial 2 of 4: city");
    assert_eq!(asked.link.as_deref(), Some("https://forms.test/P07,P03/2/3"));
    bench.wait(|status| matches!(&status.stage, Stage::Asking(form) if form.asks().0 == "P07"));
    bench.answer("4");
    let half = bench.wait(|status| status.stage == Stage::Ready);
    assert!(half.rest_s.is_some_and(|left_s| left_s > 250) && half.units[0].starts_with("P03"), "{half:?}");
    bench.press("x");
    bench.wait(|status| status.events.lines().any(|line| line.contains("the plan says who sits where")));
    assert!(half.tally.len() == 1 && half.tally[0].starts_with("P07 semantic, P03 safety: 2 runs"), "{half:?}");
    assert!(super::hud::text(&half, Seat::Semantic).note.starts_with("Break: "), "{half:?}");

    let bench = Bench::planned(bench.close());
    let again = bench.wait(|status| status.units[0].starts_with("P03"));
    assert_eq!((again.run, again.totals.runs, again.rest_s.is_some()), (4, 2, true));
    bench.drive_trial(4, "trial 3 of 4: city");
    bench.drive_trial(5, "trial 4 of 4: rural");
    bench.answer("2");
    let over = bench.wait(|status| status.stage == Stage::Over);
    assert_eq!((over.totals.runs, over.tally.len()), (4, 2));
    bench.press("n");
    let dir = bench.close();
    let told = |name: &str, key: &str| {
        let recording = Recording::open(&dir.path().join(name)).unwrap();
        recording.log().manifest.provenance.get(key).cloned()
    };
    let (third, fourth) = ("drive-3.mcap", "drive-4.mcap");
    let trials = ["drive.mcap", "drive-2.mcap", third, fourth, "drive-5.mcap"].map(|name| told(name, "plan_trial"));
    assert_eq!(trials, ["1", "2", "2", "3", "4"].map(|trial| Some(trial.to_owned())));
    let pair = |name: &str| ["semantic_name", "safety_name", "checkpoint"].map(|key| told(name, key).unwrap());
    assert_eq!(
        (pair(third), pair(fourth)),
        (["P07", "P03", "early"].map(Into::into), ["P03", "P07", "early"].map(Into::into))
    );
    let answers = std::fs::read_to_string(dir.path().join("drive-3.questionnaire.toml")).unwrap();
    assert!(answers.contains("fatigue = 4") && answers.contains("stress = 4"), "{answers}");
    assert!(dir.path().join("drive-5.questionnaire.toml").is_file() && !dir.path().join("drive-6.mcap").exists());

    let bench = Bench::planned(dir);
    bench.wait(|status| status.stage == Stage::Over && status.totals.runs == 4);
    bench.close();
}

#[test]
fn a_plan_does_not_go_on_among_recordings_of_anything_else() {
    let bench = Bench::start();
    bench.wait(|status| status.tick > 10);
    let dir = bench.close();
    let path = dir.path().join("plan.toml");
    std::fs::write(&path, PLAN).unwrap();
    let protocol = Protocol::read(&path).unwrap();
    let refused = study::protocol::Recorded::under(&dir.path().join("drive.mcap"), |of| protocol.trial_of(of));
    let said = format!("{:#}", refused.unwrap_err());
    assert!(said.ends_with("drive.mcap: was not driven by a plan; expected another --record"), "{said}");
}
