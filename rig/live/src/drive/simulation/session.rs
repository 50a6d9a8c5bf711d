//! A session from run to run: how a run is prepared, started, ended, and what is shown of it.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::Sender;

use base::clock::SessionClock;
use base::maps;
use base::output;
use base::room::NoRoom;
use kernel::time::{TICK_HZ, Tick};
use kernel::{RoadNetwork, Seat};
use replay::{Annotation, Label, NoteKind, Recording};
use viewers::feed::View;

use super::cutters::Cutters;
use super::display::Display;
use super::pace::Pace;
use super::plan::Plan;
use super::recording;
use super::rest::Rest;
use super::runs::Runs;
use super::sights::Sights;
use super::status::Parts;
use super::voice::Voice;
use crate::drive::aftermath;
use crate::drive::board::{Board, Message, Wake};
use crate::drive::force::Force;
use crate::drive::run::Run;
use crate::drive::seating::Seating;
use crate::drive::stage::{Form, Pause, Stage};
use crate::drive::timings::Timings;
use crate::speakers::Sound;

/// An unattended session that takes three times as long as it should, and this, has failed, microseconds.
const PATIENCE_US: u64 = 30_000_000;

/// A session of live runs.
pub struct Session {
    /// Goes first, so that nobody waits for it while the others end.
    pub display: Display,
    pub seating: Seating,
    pub force: Force,
    pub sound: Sound,
    pub voice: Voice,
    pub runs: Runs,
    pub pace: Pace,
    pub sights: Sights,
    no_room: NoRoom,
    rest: Rest,
    /// Where people are to answer questions about the run before.
    link: Option<String>,
    /// The recording that the questions are about.
    asked_about: Option<PathBuf>,
    plan: Plan,
    cutters: Cutters,
    outbox: Sender<Message>,
}

impl Session {
    /// Takes the seats and makes the first world.
    pub fn new(
        plan: Plan,
        seating: Seating,
        board: Arc<Board>,
        wake: Box<dyn Fn(Wake) + Send>,
        (outbox, clock, sound): (Sender<Message>, SessionClock, Sound),
    ) -> anyhow::Result<Self> {
        let voice = Voice::new(plan.unattended.is_none());
        seating.setup().iter().for_each(|line| voice.say(format_args!("{line}")));
        let force = Force::new(plan.force, &outbox);
        let (runs, not_counted) = Runs::after_earlier_ones(&plan)?;
        not_counted.iter().for_each(|line| voice.say(format_args!("{line}")));
        let mut session = Self {
            display: Display::new(board.clone(), wake),
            seating,
            force,
            sound,
            voice,
            runs,
            pace: Pace::new(clock),
            sights: Sights::default(),
            no_room: NoRoom::default(),
            rest: Rest::default(),
            link: None,
            asked_about: None,
            cutters: Cutters::new(board, outbox.clone(), plan.tell.clone()),
            plan,
            outbox,
        };
        session.prepare()?;
        Ok(session)
    }

    /// How well it kept real time.
    pub fn timings(self) -> Timings {
        self.pace.timings(self.sound.late_count())
    }

    /// Whether people attend it.
    pub fn is_attended(&self) -> bool {
        self.plan.unattended.is_none()
    }

    /// Whether nobody attends it, and all has been driven that was to be driven.
    pub fn unattended_over(&self) -> bool {
        // A display that shows nothing would keep it waiting for ever.
        let is_stuck = |ticks: Tick| self.pace.now_us() > PATIENCE_US + 3 * ticks * 1_000_000 / Tick::from(TICK_HZ);
        self.plan.unattended.is_some_and(|ticks| self.runs.driven_ticks() >= ticks || is_stuck(ticks))
    }

    /// Makes the world of the next run and shows it.
    fn prepare(&mut self) -> anyhow::Result<()> {
        let world = self.runs.prepare(&self.plan)?;
        self.display.begin(world);
        self.no_room.of_world(world).into_iter().for_each(|line| self.voice.say(format_args!("{line}")));
        let number = self.runs.number();
        match (&self.runs.about().trial, &self.runs.stage) {
            (_, Stage::Over) => self.voice.say(format_args!("all trials of the plan are driven")),
            (Some(trial), _) => self.voice.say(format_args!("run {number} is ready, {trial}: N starts it")),
            (None, _) => self.voice.say(format_args!("run {number} is ready: N starts it")),
        }
        self.seating.seats().set_takeover_steer(self.runs.bill().scenario.rules.steer_threshold);
        self.sit_as_planned();
        self.sights = Sights::default();
        self.pace.restart();
        self.show_scene();
        self.show_status(Some(Wake::All));
        Ok(())
    }

    /// Everybody sits where the plan has them, and rests before the second half.
    fn sit_as_planned(&mut self) {
        let Some(protocol) = self.plan.agenda.protocol() else { return };
        let trial = self.runs.bill().trial;
        let planned = &protocol.trials[trial];
        let is_first = self.runs.progress().of_trial(trial).next().is_none();
        let rests = planned.begins_half && is_first && self.runs.stage == Stage::Ready;
        self.rest.begin(self.pace.now_us(), if rests { protocol.break_s } else { 0 });
        if planned.is_swapped != self.seating.is_swapped() {
            self.seating.swap();
            let [semantic, safety] = self.names();
            let said = format!(
                "the seats are swapped by the plan: {semantic} is the semantic driver, {safety} the safety driver"
            );
            self.voice.say(format_args!("{said}"));
            self.voice.note(said);
        }
    }

    /// Counts a break down.
    pub fn show_rest(&mut self) {
        if self.rest.is_news(self.pace.now_us()) {
            self.show_status(Some(Wake::All));
        }
    }

    /// Starts the run that waits, if the units are armed.
    pub fn start(&mut self) -> anyhow::Result<()> {
        if !self.seating.is_ready() {
            let why = self.seating.note();
            self.note(format!("the run cannot start: {}", why.as_deref().unwrap_or("the units are not known yet")));
            return Ok(());
        }
        let Some(world) = self.runs.take_next() else { return Ok(()) };
        let seed = world.scenario().seed;
        let number = self.runs.number();
        let bill = self.runs.bill();
        let manifest = recording::manifest(&self.plan, &self.seating, &self.sound, bill, &world);
        maps::put_beside(bill.map.foreign.as_ref(), &self.plan.record)?;
        let (path, file) = recording::create(&self.plan.record, number, self.outbox.clone())?;
        self.voice.say(format_args!("run {number}: recording {}", path.display()));
        self.runs.start(Run::start(world, &manifest, self.seating.bots(seed), path, file)?);
        self.pace.restart();
        self.rest.end();
        self.voice.forget();
        self.seating.seats().engage_forward();
        self.show_status(Some(Wake::All));
        Ok(())
    }

    /// The units change seats, between runs.
    pub fn swap(&mut self) {
        if self.plan.agenda.protocol().is_some() {
            return self.note("the plan says who sits where".into());
        }
        let said = self.seating.swap();
        self.voice.say(format_args!("{said}"));
        self.note(said);
        self.show_status(Some(Wake::All));
    }

    /// Time stands from now on; `seat` is whose unit is lost, if it is for that.
    pub fn pause(&mut self, why: Pause, seat: Option<Seat>) {
        match self.runs.stage {
            Stage::Driving => {
                self.pace.pause();
                self.note_run(NoteKind::Paused, seat);
                self.seating.seats().release_keys();
            }
            // Who asks for the end while time stands is asked once.
            Stage::Paused(_) => {}
            Stage::Ready | Stage::Labelling(_) | Stage::Asking(_) | Stage::Over => return,
        }
        self.runs.stage = Stage::Paused(why);
        self.show_status(Some(Wake::All));
    }

    /// Time goes on, if the units are armed.
    pub fn resume(&mut self) {
        if !self.seating.is_ready() {
            let why = self.seating.note();
            self.note(format!("the run cannot go on: {}", why.as_deref().unwrap_or("the units are not known yet")));
            return;
        }
        self.pace.resume();
        self.note_run(NoteKind::Resumed, None);
        self.runs.stage = Stage::Driving;
        self.show_status(Some(Wake::All));
    }

    fn note_run(&mut self, kind: NoteKind, seat: Option<Seat>) {
        self.voice.note(kind.name().into());
        if let Some(run) = self.runs.current() {
            run.note(kind, seat);
        }
    }

    /// The run ends here, and the operators are asked why.
    pub fn break_off(&mut self) {
        self.runs.break_off();
        self.show_status(Some(Wake::All));
    }

    /// The takeover that is on is of this kind.
    pub fn label(&mut self, label: Label) {
        if self.runs.label(label) {
            self.note(format!("the takeover is labelled {label}"));
        }
    }

    /// A view came onto a driver's screen. Ages are those of the pictures that the drivers drove by; a
    /// picture of another run is none.
    pub fn shown(&mut self, seat: Seat, view: Arc<View>, presented_us: u64) {
        if view.run != self.runs.number() {
            return;
        }
        if self.runs.is_driving() {
            self.pace.shown(seat, presented_us.saturating_sub(view.captured_us));
        }
        self.sights.take(seat, view, presented_us);
    }

    /// Asks the operators for a label; a bot in the safety driver's seat knows it.
    pub fn ask(&mut self) -> anyhow::Result<()> {
        match self.runs.bots_word() {
            Some(annotation) => self.finish(Some(annotation)),
            None => {
                let number = self.runs.number();
                self.voice.say(format_args!("run {number} has ended: label it in the control centre"));
                self.runs.ask();
                self.show_status(Some(Wake::All));
                Ok(())
            }
        }
    }

    /// Ends the run's recording; its case is cut while the next run waits. A trial that is done is followed by questions where
    /// the plan has some.
    pub fn finish(&mut self, annotation: Option<Annotation>) -> anyhow::Result<()> {
        let (number, trial) = (self.runs.number(), self.runs.bill().trial);
        let network = self.runs.bill().map.network.clone();
        let names = self.names();
        self.sound.rest();
        let Some(path) = self.end_run(annotation)? else { return Ok(()) };
        self.note(format!("recorded {}", path.display()));
        if self.is_attended() {
            self.cutters.cut(&path, network);
        }
        let protocol = self.plan.agenda.protocol();
        self.link = protocol.and_then(|protocol| protocol.link(trial, number));
        let progress = self.runs.progress();
        let asks = protocol.is_some_and(|protocol| protocol.asks_after(trial) && progress.is_done(protocol, trial));
        self.prepare()?;
        if asks {
            self.asked_about = Some(path);
            self.runs.stage = Stage::Asking(Form::about(names));
            self.show_status(Some(Wake::All));
        }
        Ok(())
    }

    /// What the drivers go by, semantic driver's first.
    fn names(&self) -> [String; 2] {
        let [semantic, safety] = self.seating.seated(self.plan.operators.clone());
        [semantic.unwrap_or_else(|| "semantic driver".into()), safety.unwrap_or_else(|| "safety driver".into())]
    }

    /// The questions are answered: the next run waits for its start.
    pub fn answered(&mut self) -> anyhow::Result<()> {
        let kept = self.keep_answers();
        self.runs.wait_for_start();
        self.show_status(Some(Wake::All));
        kept
    }

    /// Writes what was answered so far beside the recording that it is about.
    pub fn keep_answers(&mut self) -> anyhow::Result<()> {
        let (Stage::Asking(form), Some(path)) = (&self.runs.stage, self.asked_about.take()) else { return Ok(()) };
        let answers = form.answers();
        if answers.is_empty() {
            return Ok(());
        }
        let (beside, text) = study::attached(&path, &Recording::open(&path)?, answers)?;
        output::write_file(&beside, text.as_bytes())?;
        self.voice.note(format!("answers in {}", beside.display()));
        Ok(())
    }

    /// Ends the run that is on, as far as there is one, and gives where its recording is.
    pub fn end_run(&mut self, annotation: Option<Annotation>) -> anyhow::Result<Option<PathBuf>> {
        let Some(recorded) = self.runs.end(annotation, &self.plan) else { return Ok(None) };
        self.pace.end_run();
        recorded.map(Some)
    }

    /// What follows the last run of the session, on a map, for which nobody waits any more.
    pub fn look_back(&self, path: &Path, network: &Arc<RoadNetwork>) -> anyhow::Result<()> {
        aftermath::of(path, network, &*self.plan.tell).map(drop)
    }

    /// Waits until the cases of all runs but the last are cut.
    pub fn join_cutters(&mut self) -> anyhow::Result<()> {
        self.cutters.join()
    }

    /// Adds to what the control centre lists.
    pub fn note(&mut self, text: String) {
        self.voice.note(text);
        self.show_status(Some(Wake::Centre));
    }

    /// Shows what there is to see.
    pub fn show_scene(&self) {
        let Some(world) = self.runs.world() else { return };
        self.display.show_scene(self.runs.number(), self.runs.bill().eye, world, self.pace.now_us());
    }

    /// Shows how the session is, and has windows drawn anew.
    pub fn show_status(&self, wake: Option<Wake>) {
        let Self { display, seating, force, sound, voice, runs, pace, sights, rest, link, .. } = self;
        let parts = Parts { rest, link: link.as_ref(), seating, force, sound, voice, display, runs, pace, sights };
        display.show_status(parts.status(), wake);
    }
}
