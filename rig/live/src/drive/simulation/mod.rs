//! The thread that drives: it paces the ticks, listens to everybody, and waits for nobody.

mod agenda;
mod cutters;
mod display;
mod pace;
mod plan;
mod recording;
mod rest;
mod runs;
mod session;
mod sights;
mod status;
mod voice;

use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError};

use base::progress::Interrupt;
use base::words;
use drivers::session::SessionState;
use kernel::RoadNetwork;
use kernel::arbiter::Outcome;
use kernel::time::{TICK_HZ, Tick};

use super::board::{Message, Wake};
use super::force::Driven;
use super::run::car_state;
use super::seating::{self, Seating};
use super::stage::{Pause, Press, Stage, Wish};
use super::timings::Timings;
use crate::units::Polled;
pub use agenda::Agenda;
pub use plan::{Links, Plan};
use session::Session;

/// The control centre is drawn anew after so many ticks.
const CENTRE_TICKS: u64 = 6;

/// A session that is driven.
pub struct Simulation {
    session: Session,
    inbox: Receiver<Message>,
    interrupt: Interrupt,
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

impl Simulation {
    /// Takes the seats and makes the first world.
    pub fn new(plan: Plan, seating: Seating, links: Links) -> anyhow::Result<Self> {
        let Links { board, inbox, outbox, wake, clock, sound, interrupt } = links;
        let session = Session::new(plan, seating, board, wake, (outbox, clock, sound))?;
        Ok(Self { session, inbox, interrupt })
    }

    /// The map of the run that waits.
    pub fn network(&self) -> &Arc<RoadNetwork> {
        &self.session.runs.bill().map.network
    }

    /// Drives until the operators have had enough, and says how well it kept real time. The last
    /// recording is finished whatever happens.
    pub fn drive(mut self) -> anyhow::Result<Timings> {
        let end = self.listen_and_tick();
        let session = &mut self.session;
        session.sound.rest();
        let answered = session.keep_answers();
        let network = session.runs.bill().map.network.clone();
        let unfinished = session.end_run(session.runs.said());
        let cut = session.join_cutters();
        let mut last = Ok(());
        if let (Ok(Some(path)), true) = (&unfinished, session.is_attended()) {
            let why = end.as_ref().map_or("it could not go on", End::words);
            let path_said = path.display();
            session.voice.say(format_args!("the run is over: {why}; its recording is complete: {path_said}"));
            last = session.look_back(path, &network);
        }
        end?;
        unfinished?;
        answered?;
        last?;
        cut?;
        Ok(self.session.timings())
    }

    fn listen_and_tick(&mut self) -> anyhow::Result<End> {
        loop {
            let wait = self.session.pace.wait(self.session.runs.is_driving());
            match self.inbox.recv_timeout(wait) {
                Ok(message) => {
                    if let Some(end) = self.hear(message)? {
                        return Ok(end);
                    }
                }
                Err(RecvTimeoutError::Timeout) => {
                    self.turn()?;
                    if self.session.unattended_over() {
                        return Ok(End::Asked);
                    }
                }
                Err(RecvTimeoutError::Disconnected) => return Ok(End::Asked),
            }
            if self.interrupt.is_raised() {
                return Ok(End::Signal);
            }
        }
    }

    /// A tick is due; between runs, the units are looked after all the same.
    fn turn(&mut self) -> anyhow::Result<()> {
        let session = &mut self.session;
        let car = session.runs.world().map(car_state).unwrap_or_default();
        let (polled, is_news) = session.seating.poll(car);
        if is_news {
            session.show_status(Some(Wake::All));
        }
        session.show_rest();
        for event in &polled.events {
            session.note(seating::event_text(event));
        }
        session.display.input = polled.input();
        let lost = seating::lost(&polled).filter(|_| session.is_attended() && session.runs.is_driving());
        let stands = lost.is_some() || matches!(session.runs.stage, Stage::Paused(_));
        if let Some(run) = session.runs.current().filter(|_| stands) {
            run.note_units(&polled);
        }
        if lost.is_some() {
            session.pause(Pause::UnitLost, lost);
        }
        match &session.runs.stage {
            Stage::Ready if !session.is_attended() && session.sights.screen().is_some() => session.start()?,
            Stage::Driving => tick(session, &polled)?,
            _ => {}
        }
        // Nobody is there to pause the run and to go on.
        if session.runs.is_driving() && !car.taken_over && seating::is_unwatched(&polled) {
            let number = session.runs.number();
            session.voice.say(format_args!("run {number} was ended: the safety driver's unit is lost"));
            session.finish(None)?;
        }
        if !session.runs.is_driving() {
            session.sound.rest();
        }
        match &session.runs.stage {
            Stage::Driving => {}
            // The jolt of the collision that ended the run fades.
            Stage::Labelling(_) => session.force.drive(&Driven::default(), session.seating.armed_devices()),
            Stage::Ready | Stage::Paused(_) | Stage::Asking(_) | Stage::Over => session.force.rest(),
        }
        Ok(())
    }

    fn hear(&mut self, message: Message) -> anyhow::Result<Option<End>> {
        let session = &mut self.session;
        match message {
            // What is typed into a comment drives nothing.
            Message::SeatKey(_, true) if matches!(session.runs.stage, Stage::Labelling(_) | Stage::Asking(_)) => {}
            Message::SeatKey(key, pressed) => session.seating.seats().key(key, pressed),
            Message::KeysReleased => session.seating.seats().release_keys(),
            Message::Focus(is_ours) => session.seating.seats().focus(is_ours),
            Message::Press(press, repeated) => return obey(session, &press, repeated),
            Message::Shown(seat, view, presented_us) => session.shown(seat, view, presented_us),
            Message::Note(text) => session.note(text),
            // Who closes a window while the car drives is asked first.
            Message::Closed if session.is_attended() && session.runs.is_driving() => session.pause(Pause::Ending, None),
            Message::Closed | Message::Gone => return Ok(Some(End::Closed)),
            Message::Failed(error) => return Err(error),
        }
        Ok(None)
    }
}

/// Does what an operator's key asks for.
fn obey(session: &mut Session, press: &Press, repeated: bool) -> anyhow::Result<Option<End>> {
    match session.runs.stage.press(press, repeated) {
        Wish::Nothing => session.show_status(Some(Wake::Centre)),
        Wish::Start => session.start()?,
        Wish::Swap => session.swap(),
        Wish::Force => {
            session.force.toggle();
            session.show_status(Some(Wake::Centre));
        }
        Wish::Mute => {
            session.sound.toggle();
            session.show_status(Some(Wake::Centre));
        }
        Wish::Pause(why) => session.pause(why, None),
        Wish::Resume => session.resume(),
        Wish::BreakOff => session.break_off(),
        Wish::Label(label) => session.label(label),
        Wish::Finish(annotation) => session.finish(annotation)?,
        Wish::Answered => session.answered()?,
        Wish::Quit => return Ok(Some(End::Asked)),
    }
    Ok(None)
}

/// Drives a tick with what the units gave, and shows what it came to.
fn tick(session: &mut Session, polled: &Polled) -> anyhow::Result<()> {
    let Some(run) = session.runs.current() else { return Ok(()) };
    session.pace.begin_tick();
    let (state, output, input) = run.tick(polled, session.sights.screen())?;
    let driven = Driven {
        speed_mps: run.world().hud().speed_mps,
        aligning_torque_nm: run.world().aligning_torque_nm(),
        events: &output.events,
    };
    session.force.drive(&driven, session.seating.armed_devices());
    session.sound.tick(run.world(), &output);
    for event in &output.events {
        session.voice.note(words::event_at(output.tick, event));
    }
    let tick = output.tick;
    session.display.tick(run.world(), input, output);
    session.show_scene();
    match state {
        SessionState::Driving => {}
        SessionState::Labelling(_) | SessionState::Done(Outcome::Missed) => session.ask()?,
        SessionState::Done(_) => session.finish(None)?,
    }
    if tick.is_multiple_of(Tick::from(TICK_HZ)) {
        session.voice.say(format_args!("tick {tick}"));
    }
    let is_due = tick.is_multiple_of(CENTRE_TICKS);
    if is_due {
        session.display.show_traces();
    }
    session.show_status(is_due.then_some(Wake::Centre));
    Ok(())
}
