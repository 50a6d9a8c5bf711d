//! The thread that drives: it paces the ticks, listens to everybody, and waits for nobody.

use std::fmt;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::thread::JoinHandle;
use std::time::Duration;

use anyhow::anyhow;
use base::clock::SessionClock;
use base::maps::Map;
use base::progress::Interrupt;
use base::words;
use drivers::session::SessionState;
use kernel::arbiter::Outcome;
use kernel::time::{TICK_HZ, Tick};
use kernel::{Scenario, Seat, TickInput, TickOutput, World};
use replay::{Annotation, Manifest, Provenance, Recording};
use study::{self, Cast};
use viewers::events::Events;
use viewers::feed::{Look, View};

use super::aftermath::{self, Tell};
use super::board::{About, Board, Message, Status, Totals, Wake};
use super::disk::{self, BackgroundFile};
use super::force::Force;
use super::pacing::Pacing;
use super::run::{Run, Screen, car_state};
use super::seating::{self, Seating};
use super::stage::{Dialog, Stage, Wish};
use super::strip::Strip;
use super::terminal::Terminal;
use super::timings::Timings;
use super::traces::Traces;
use crate::units::Polled;

/// While nothing drives, the units are asked this often, microseconds.
const IDLE_US: u64 = 16_667;
/// An unattended session that takes three times as long as it should, and this, has failed, microseconds.
const PATIENCE_US: u64 = 30_000_000;
/// The control centre is drawn anew after so many ticks.
const CENTRE_TICKS: u64 = 6;

/// What a session is about.
pub struct Plan {
    /// Where to drive.
    pub map: Map,
    /// The scenario of the first run; the others follow from its seed.
    pub scenario: Scenario,
    /// Greatest force of wheels, [0, 1].
    pub force: f32,
    /// Where remote control centres are served.
    pub foxglove: Option<SocketAddr>,
    /// Where the recordings go.
    pub record: PathBuf,
    /// What the recordings say about themselves, the checkpoint aside.
    pub provenance: Provenance,
    /// Which seed and which checkpoint a run has.
    pub cast: Cast,
    /// What may be shown of all that.
    pub about: Arc<About>,
    /// Told what each run came to.
    pub tell: Tell,
    /// Runs start by themselves until so much has been driven, ticks; then the session ends.
    pub unattended: Option<Tick>,
}

/// The threads around the simulation.
pub struct Links {
    /// What everybody looks at.
    pub board: Arc<Board>,
    /// What the simulation hears.
    pub inbox: Receiver<Message>,
    /// For its own helpers to speak to it.
    pub outbox: Sender<Message>,
    /// Draws windows anew.
    pub wake: Box<dyn Fn(Wake) + Send>,
    /// Time since the session began.
    pub clock: SessionClock,
    /// Ctrl-C and SIGTERM.
    pub interrupt: Interrupt,
}

/// A session of live runs.
pub struct Simulation {
    plan: Plan,
    links: Links,
    seating: Seating,
    force: Force,
    terminal: Terminal,
    stage: Stage,
    number: u32,
    /// The world of a run that waits for its start.
    next: Option<World>,
    run: Option<Run>,
    pacing: Pacing,
    timings: Timings,
    traces: Traces,
    screen: Option<Screen>,
    /// When the scene of the safety driver's image was captured, microseconds.
    image_of_us: Option<u64>,
    input: TickInput,
    last: Option<TickOutput>,
    events: Events,
    totals: Totals,
    helpers: Vec<JoinHandle<anyhow::Result<()>>>,
}

/// Why a session ends.
enum End {
    Asked,
    Closed,
    Signal,
}

impl End {
    fn words(&self) -> &'static str {
        match self {
            Self::Asked => "the operators ended it",
            Self::Closed => "a window was closed",
            Self::Signal => "it was ended by Ctrl-C or SIGTERM",
        }
    }
}

impl Drop for Simulation {
    /// Nobody waits for what does not come any more.
    fn drop(&mut self) {
        self.links.board.feed.scene.close();
        self.links.board.status.close();
    }
}

impl Simulation {
    /// Takes the seats and makes the first world.
    pub fn new(plan: Plan, seating: Seating, links: Links) -> anyhow::Result<Self> {
        let terminal = Terminal::new(plan.unattended.is_none());
        seating.setup().iter().for_each(|line| terminal.say(line.clone()));
        let force = Force::new(plan.force, &links.outbox);
        let mut simulation = Self {
            plan,
            links,
            seating,
            force,
            terminal,
            stage: Stage::Ready,
            number: 0,
            next: None,
            run: None,
            pacing: Pacing::starting_at(0),
            timings: Timings::default(),
            traces: Traces::default(),
            screen: None,
            image_of_us: None,
            input: TickInput::default(),
            last: None,
            events: Events::default(),
            totals: Totals::default(),
            helpers: Vec::new(),
        };
        simulation.count_earlier_runs();
        simulation.prepare()?;
        Ok(simulation)
    }

    /// A campaign goes on in a new session under the same name, with the runs after the last one.
    fn count_earlier_runs(&mut self) {
        for number in disk::numbers(&self.plan.record) {
            self.number = number;
            let path = disk::numbered(&self.plan.record, number);
            match Recording::open(&path) {
                Ok(recording) => self.totals.add_recorded(recording.log()),
                Err(error) => self.say(format_args!("not counted: {error:#}")),
            }
        }
    }

    /// Drives until the operators have had enough, and says how well it kept real time. The last
    /// recording is finished whatever happens.
    pub fn drive(mut self) -> anyhow::Result<Timings> {
        let end = self.listen_and_tick();
        let unfinished = self.end_run(self.stage.annotation());
        let gone = |_| Err(anyhow!("a thread that cut a corner case panicked"));
        let helpers = std::mem::take(&mut self.helpers).into_iter();
        let cut: Vec<_> = helpers.map(|helper| helper.join().unwrap_or_else(gone)).collect();
        let is_attended = self.plan.unattended.is_none();
        let mut last = Ok(None);
        if let (Ok(Some(path)), true) = (&unfinished, is_attended) {
            let why = end.as_ref().map_or("it could not go on", End::words);
            self.say(format_args!("the run is over: {why}; its recording is complete: {}", path.display()));
            last = aftermath::of(path, &*self.plan.tell);
        }
        end?;
        unfinished?;
        last?;
        cut.into_iter().collect::<anyhow::Result<()>>()?;
        Ok(std::mem::take(&mut self.timings))
    }

    fn listen_and_tick(&mut self) -> anyhow::Result<End> {
        loop {
            let now_us = self.links.clock.now_us();
            let wait_us = if self.stage == Stage::Driving { self.pacing.wait_us(now_us) } else { IDLE_US };
            match self.links.inbox.recv_timeout(Duration::from_micros(wait_us)) {
                Ok(message) => {
                    if let Some(end) = self.hear(message)? {
                        return Ok(end);
                    }
                }
                Err(RecvTimeoutError::Timeout) => {
                    self.turn()?;
                    if self.unattended_over() {
                        return Ok(End::Asked);
                    }
                }
                Err(RecvTimeoutError::Disconnected) => return Ok(End::Asked),
            }
            if self.links.interrupt.is_raised() {
                return Ok(End::Signal);
            }
        }
    }

    /// A tick is due; between runs, the units are looked after all the same.
    fn turn(&mut self) -> anyhow::Result<()> {
        let car = self.world().map(car_state).unwrap_or_default();
        let (polled, is_news) = self.seating.poll(car);
        if is_news {
            self.show_status(Some(Wake::All));
        }
        for event in &polled.events {
            self.note(seating::event_text(event));
        }
        self.input = polled.input();
        match &self.stage {
            Stage::Ready if self.plan.unattended.is_some() && self.screen.is_some() => self.start()?,
            Stage::Driving => self.tick(&polled)?,
            _ => {}
        }
        // After a takeover the car is braked to standstill instead, and the case asks for its label.
        if self.stage == Stage::Driving && !car.taken_over && seating::is_unwatched(&polled) {
            self.say(format_args!("run {} was ended: the safety driver's unit is lost", self.number));
            self.finish(None)?;
        }
        match &self.stage {
            Stage::Driving => {}
            // The jolt of the collision that ended the run fades.
            Stage::Labelling(_) => self.force.drive(0.0, &[], self.seating.armed_devices()),
            Stage::Ready => self.force.rest(),
        }
        Ok(())
    }

    fn tick(&mut self, polled: &Polled) -> anyhow::Result<()> {
        let Some(run) = &mut self.run else { return Ok(()) };
        self.pacing.begin_tick(self.links.clock.now_us());
        self.timings.tick(self.pacing.late_us());
        let (state, output, input) = run.tick(polled, self.screen.as_ref())?;
        self.force.drive(run.world().hud().speed_mps, &output.events, self.seating.armed_devices());
        self.traces.tick(run.world(), &input, &output);
        for event in &output.events {
            self.events.push(words::event_at(output.tick, event));
        }
        let tick = output.tick;
        self.input = input;
        self.last = Some(output);
        self.show_scene();
        match state {
            SessionState::Driving => {}
            SessionState::Labelling(_) | SessionState::Done(Outcome::Missed) => self.ask()?,
            SessionState::Done(_) => self.finish(None)?,
        }
        if tick.is_multiple_of(Tick::from(TICK_HZ)) {
            self.say(format_args!("tick {tick}"));
        }
        let is_due = tick.is_multiple_of(CENTRE_TICKS);
        if is_due {
            self.links.board.traces.put(self.traces.clone());
        }
        self.show_status(is_due.then_some(Wake::Centre));
        Ok(())
    }

    /// Asks the operators for a label; a bot in the safety driver's seat knows it.
    fn ask(&mut self) -> anyhow::Result<()> {
        match self.run.as_ref().and_then(Run::bots_word) {
            Some(annotation) => self.finish(Some(annotation)),
            None => {
                self.say(format_args!("run {} has ended: label it in the control centre", self.number));
                self.stage = Stage::Labelling(Dialog::default());
                self.show_status(Some(Wake::All));
                Ok(())
            }
        }
    }

    fn hear(&mut self, message: Message) -> anyhow::Result<Option<End>> {
        match message {
            // What is typed into a comment drives nothing.
            Message::SeatKey(_, true) if matches!(self.stage, Stage::Labelling(_)) => {}
            Message::SeatKey(key, pressed) => self.seating.seats().key(key, pressed),
            Message::KeysReleased => self.seating.seats().release_keys(),
            Message::Focus(is_ours) => self.seating.seats().focus(is_ours),
            Message::Press(press, repeated) => match self.stage.press(&press, repeated) {
                Wish::Nothing => self.show_status(Some(Wake::Centre)),
                Wish::Start => self.start()?,
                Wish::Swap => self.swap(),
                Wish::Force => {
                    self.force.toggle();
                    self.show_status(Some(Wake::Centre));
                }
                Wish::Annotate(annotation) => self.finish(Some(annotation))?,
                Wish::Quit => return Ok(Some(End::Asked)),
            },
            Message::Shown(seat, view, presented_us) => self.shown(seat, view, presented_us),
            Message::Note(text) => self.note(text),
            Message::Closed => return Ok(Some(End::Closed)),
            Message::Failed(error) => return Err(error),
        }
        Ok(None)
    }

    /// Ages are those of the pictures that the drivers drove by; a picture of another run is none.
    fn shown(&mut self, seat: Seat, view: Arc<View>, presented_us: u64) {
        if view.run != self.number {
            return;
        }
        if self.stage == Stage::Driving {
            self.timings.shown(seat, presented_us.saturating_sub(view.captured_us));
        }
        match seat {
            Seat::Semantic => self.screen = Some(Screen { view, presented_us }),
            Seat::Safety => self.image_of_us = Some(view.captured_us),
        }
    }

    fn unattended_over(&self) -> bool {
        let driven = self.totals.ticks + self.run.as_ref().map_or(0, |run| run.world().tick());
        // A display that shows nothing would keep it waiting for ever.
        let is_stuck =
            |ticks: Tick| self.links.clock.now_us() > PATIENCE_US + 3 * ticks * 1_000_000 / Tick::from(TICK_HZ);
        self.plan.unattended.is_some_and(|ticks| driven >= ticks || is_stuck(ticks))
    }

    /// Makes the world of the next run and shows it.
    fn prepare(&mut self) -> anyhow::Result<()> {
        self.number += 1;
        let seed = self.plan.cast.seed_of_run(self.number);
        let scenario = Scenario { seed, ..self.plan.scenario.clone() };
        let world = World::new(&scenario, &self.plan.map.network)?;
        self.traces = Traces::of(&world);
        self.links.board.traces.put(self.traces.clone());
        self.next = Some(world);
        self.say(format_args!("run {} is ready: N starts it", self.number));
        self.run = None;
        self.screen = None;
        self.image_of_us = None;
        self.last = None;
        self.pacing = Pacing::starting_at(self.links.clock.now_us());
        self.stage = Stage::Ready;
        self.show_scene();
        self.show_status(Some(Wake::All));
        Ok(())
    }

    fn start(&mut self) -> anyhow::Result<()> {
        if !self.seating.is_ready() {
            let why = self.seating.note();
            self.note(format!("the run cannot start: {}", why.as_deref().unwrap_or("the units are not known yet")));
            return Ok(());
        }
        let Some(world) = self.next.take() else { return Ok(()) };
        let Plan { map, record, cast, .. } = &self.plan;
        let swapped = || study::swapped(&self.plan.provenance);
        let mut provenance = if self.seating.is_swapped() { swapped() } else { self.plan.provenance.clone() };
        provenance.insert("live".into(), "true".into());
        provenance.extend(cast.provenance_of_run(self.number).clone());
        provenance.extend(self.seating.provenance());
        let manifest = Manifest::new(world.scenario(), &map.network, map.foreign.clone(), provenance);
        let (path, file) = disk::create(record, self.number)?;
        self.say(format_args!("run {}: recording {}", self.number, path.display()));
        let (outbox, name) = (self.links.outbox.clone(), path.display().to_string());
        // When nobody listens any more the session is over, and meets the error itself.
        let file = BackgroundFile::new(file, move |error| {
            drop(outbox.send(Message::Failed(anyhow!("{name}: {error}"))));
        });
        self.run = Some(Run::start(world, &manifest, self.seating.bots(), path, file)?);
        self.pacing = Pacing::starting_at(self.links.clock.now_us());
        self.events.clear();
        self.seating.seats().engage_forward();
        self.stage = Stage::Driving;
        self.show_status(Some(Wake::All));
        Ok(())
    }

    /// The units change seats, between runs.
    fn swap(&mut self) {
        let said = self.seating.swap();
        self.say(format_args!("{said}"));
        self.note(said);
        self.show_status(Some(Wake::All));
    }

    /// Ends the run's recording; its case is cut while the next run waits.
    fn finish(&mut self, annotation: Option<Annotation>) -> anyhow::Result<()> {
        let Some(path) = self.end_run(annotation)? else { return Ok(()) };
        self.note(format!("recorded {}", path.display()));
        if self.plan.unattended.is_none() {
            self.cut(&path);
        }
        self.prepare()
    }

    fn end_run(&mut self, annotation: Option<Annotation>) -> anyhow::Result<Option<PathBuf>> {
        let Some(run) = self.run.take() else { return Ok(None) };
        if !self.plan.about.is_familiarisation {
            self.totals.add(run.world());
        }
        self.timings.run(self.pacing.driven_us(), self.pacing.slowed_us());
        run.finish(annotation).map(Some)
    }

    fn cut(&mut self, path: &Path) {
        let (path, outbox, tell) = (path.to_owned(), self.links.outbox.clone(), self.plan.tell.clone());
        let board = self.links.board.clone();
        self.helpers.push(std::thread::spawn(move || {
            // When nobody listens any more the session is over, and says itself what failed.
            let note = |text: String| drop(outbox.send(Message::Note(text)));
            let cut = aftermath::of(&path, &*tell);
            match &cut {
                Ok(Some(case)) => {
                    // A note draws the control centre anew, with the strip.
                    let shown = Strip::of(case).map(|strip| board.strip.put(strip));
                    note(format!("corner case {}", case.display()));
                    shown.unwrap_or_else(|error| note(format!("its pictures cannot be shown: {error:#}")));
                }
                Ok(None) => {}
                Err(error) => note(format!("the corner case was not cut: {error:#}")),
            }
            cut.map(drop)
        }));
    }

    fn say(&self, words: fmt::Arguments<'_>) {
        self.terminal.say(words.to_string());
    }

    fn note(&mut self, text: String) {
        self.events.push(text);
        self.show_status(Some(Wake::Centre));
    }

    fn world(&self) -> Option<&World> {
        self.run.as_ref().map(Run::world).or(self.next.as_ref())
    }

    fn show_scene(&self) {
        let Some(world) = self.world() else { return };
        let captured_us = self.links.clock.now_us();
        self.links.board.feed.scene.put(Look { run: self.number, scene: world.scene(), captured_us });
    }

    fn show_status(&mut self, wake: Option<Wake>) {
        if let Some(status) = self.status() {
            self.links.board.feed.telemetry.put(status.telemetry());
            self.links.board.status.put(status);
        }
        if let Some(wake) = wake {
            (self.links.wake)(wake);
        }
    }

    /// Who sits in the seats, as far as that is to be known, and how their units are.
    fn operators(&self) -> [String; 2] {
        let mut names = self.plan.about.operators.clone();
        if self.seating.is_swapped() {
            names.swap(0, 1);
        }
        let [semantic, safety] = self.seating.words();
        let [named, other] = names;
        let with = |name: Option<String>, unit: String| name.map_or(unit.clone(), |name| format!("{name}, {unit}"));
        [with(named, semantic), with(other, safety)]
    }

    fn status(&self) -> Option<Status> {
        let world = self.world()?;
        let now_us = self.links.clock.now_us();
        let applied = self.last.as_ref().map(|output| output.applied);
        let seat = |by: Option<Seat>| by.unwrap_or(Seat::Semantic);
        let is_driving = self.stage == Stage::Driving;
        let age_us = |of_us: Option<u64>| of_us.filter(|_| is_driving).map(|us| now_us.saturating_sub(us));
        Some(Status {
            stage: self.stage.clone(),
            run: self.number,
            tick: world.tick(),
            hud: world.hud(),
            phase: world.arbiter().phase,
            steering: seat(applied.map(|a| a.steering)),
            pedals: seat(applied.map(|a| a.pedals)),
            is_reverse: applied.is_some_and(|a| a.controls.has(kernel::Controls::REVERSE)),
            input: self.input,
            odometer_mm: world.odometer_mm(),
            totals: self.totals,
            late_us: self.pacing.late_us(),
            slowed_us: self.pacing.slowed_us(),
            mask_age_us: age_us(self.screen.as_ref().map(|screen| screen.view.captured_us)),
            image_age_us: age_us(self.image_of_us),
            events: self.events.clone(),
            units: self.operators(),
            units_note: self.seating.note(),
            setup: self.seating.setup(),
            force: self.force.words(),
            about: self.plan.about.clone(),
        })
    }
}
