//! One live run: both drivers, the world, the recording.

use std::path::PathBuf;
use std::sync::Arc;

use anyhow::Context;
use drivers::crew;
use drivers::readout::Readout;
use drivers::safety::SafetyBot;
use drivers::semantic::SemanticBot;
use drivers::session::{Session, SessionState};
use drivers::{Driver, MaskView, SemanticView};
use kernel::time::Tick;
use kernel::{Controls, Seat, TickInput, TickOutput, World};
use replay::{Annotation, LiveTimes, Manifest, MaskShown, Note, NoteKind};
use viewers::feed::View;

use super::disk::BackgroundFile;
use super::pending::Pending;
use crate::units::{CarState, Polled, SeatChoice};

/// The bots of those seats that no one sits in.
#[derive(Debug, Default)]
pub struct Bots {
    semantic: Option<SemanticBot>,
    safety: Option<SafetyBot>,
}

impl Bots {
    /// For the seats that are to be driven by bots, semantic driver's first, in the run of a seed.
    pub fn new(choices: &[SeatChoice; 2], seed: u64) -> Self {
        let [semantic, safety] = choices.each_ref().map(|choice| *choice == SeatChoice::Bot);
        Self { semantic: semantic.then(|| SemanticBot::drawn(seed)), safety: safety.then(|| SafetyBot::drawn(seed)) }
    }

    /// Replaces the controls of their seats. The semantic bot looks at the mask on the screen; without
    /// one it does nothing. While the other seat's unit is not armed, what brakes the car stays.
    fn act(&mut self, world: &World, screen: Option<&Screen>, ready: bool, input: &mut TickInput) {
        if let (Some(bot), true) = (&mut self.semantic, ready) {
            let view = screen.and_then(Screen::mask).map(|mask| SemanticView { mask, hud: Readout::of(&world.hud()) });
            input.semantic = view.map_or_else(Controls::default, |view| bot.controls(&view));
        }
        if let Some(bot) = &mut self.safety {
            input.safety = bot.controls(world);
        }
    }
}

/// What is on the semantic driver's screen.
#[derive(Clone, Debug)]
pub struct Screen {
    /// The view.
    pub view: Arc<View>,
    /// When it came there, microseconds since the session began.
    pub presented_us: u64,
}

impl Screen {
    fn mask(&self) -> Option<MaskView<'_>> {
        let View { image, mask, .. } = &*self.view;
        mask.as_ref().map(|mask| MaskView { width: image.width, height: image.height, ids: &mask.ids })
    }

    /// What the recording says of it, for controls of a tick.
    fn shown(&self, tick_shown: u64) -> Option<MaskShown> {
        let view = &*self.view;
        let times =
            LiveTimes { capture_us: view.captured_us, inference_us: view.ready_us, present_us: self.presented_us };
        let digest = view.mask.as_ref()?.digest;
        Some(MaskShown { tick_shown, tick_of_frame: view.tick, camera: 0, digest, times: Some(times) })
    }
}

/// A run that is being recorded.
pub struct Run {
    session: Session<BackgroundFile>,
    bots: Bots,
    notes: Pending,
    path: PathBuf,
}

impl Run {
    /// Starts the recording of a world that has not been stepped yet.
    pub fn start(
        world: World,
        manifest: &Manifest,
        bots: Bots,
        path: PathBuf,
        file: BackgroundFile,
    ) -> anyhow::Result<Self> {
        let session = Session::new(world, manifest, file).with_context(|| path.display().to_string())?;
        Ok(Self { session, bots, notes: Pending::default(), path })
    }

    /// The world at the last tick.
    pub fn world(&self) -> &World {
        self.session.world()
    }

    /// Drives a tick with what the units gave and what is on the screen. Gives the controls of both
    /// seats, too.
    pub fn tick(
        &mut self,
        polled: &Polled,
        screen: Option<&Screen>,
    ) -> anyhow::Result<(SessionState, TickOutput, TickInput)> {
        let mut input = polled.input();
        self.bots.act(self.session.world(), screen, polled.ready(), &mut input);
        self.note_units(polled);
        let (state, output) = self.record(screen, &input).with_context(|| self.path.display().to_string())?;
        Ok((state, output, input))
    }

    fn record(&mut self, screen: Option<&Screen>, input: &TickInput) -> anyhow::Result<(SessionState, TickOutput)> {
        self.write_notes()?;
        if let Some(shown) = screen.and_then(|screen| screen.shown(self.next_tick())) {
            self.session.mask_shown(shown)?;
        }
        self.session.tick(input)
    }

    fn write_notes(&mut self) -> anyhow::Result<()> {
        self.notes.drain().try_for_each(|note| Ok(self.session.note(note)?))
    }

    fn next_tick(&self) -> Tick {
        self.world().tick() + 1
    }

    /// Notes that time stood or goes on, and whose unit was the reason.
    pub fn note(&mut self, kind: NoteKind, seat: Option<Seat>) {
        self.notes.take(Note { tick: self.next_tick(), kind, seat });
    }

    /// Notes what happened to the units while time stands; ticks note it themselves.
    pub fn note_units(&mut self, polled: &Polled) {
        let next = self.next_tick();
        polled.events.iter().for_each(|event| self.notes.take(event.note(next)));
    }

    /// What the bot in the safety driver's seat says about the end of the run, if there is one.
    pub fn bots_word(&self) -> Option<Annotation> {
        let (label, comment) = crew::cause(self.bots.safety.as_ref()?, self.world())?;
        Some(Annotation { label, comment, perception_caused: None })
    }

    /// Ends the recording, and waits until it is written.
    pub fn finish(mut self, annotation: Option<Annotation>) -> anyhow::Result<PathBuf> {
        if let Some(annotation) = annotation {
            self.session.annotate(annotation);
        }
        let path = self.path.clone();
        let named = || path.display().to_string();
        self.write_notes().with_context(named)?;
        self.session.finish().and_then(|file| Ok(file.close()?)).with_context(named)?;
        Ok(self.path)
    }
}

/// What the units need to know of the car.
pub fn car_state(world: &World) -> CarState {
    CarState { speed_mps: world.hud().speed_mps, taken_over: world.arbiter().intervention.is_some() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::image::Image;
    use base::maps::Map;
    use viewers::feed::ShownMask;

    #[test]
    fn a_bot_drives_only_while_both_units_are_armed() {
        let map = Map::find("rural").unwrap();
        let world = World::new(&map.scenario(1), &map.network).unwrap();
        let ids = vec![7; 128 * 64];
        let mask = Some(ShownMask { digest: 0, ids });
        let image = Arc::new(Image { width: 128, height: 64, rgb: Vec::new() });
        let view = View { run: 1, tick: 0, image, mask, captured_us: 0, ready_us: 0 };
        let screen = Screen { view: Arc::new(view), presented_us: 0 };
        let mut bots = Bots::new(&[SeatChoice::Bot, SeatChoice::Keyboard], 1);
        let braked = TickInput { semantic: Controls::from_fractions(0.0, 0.0, 0.6), safety: Controls::default() };
        let mut act = |ready| {
            let mut input = braked;
            bots.act(&world, Some(&screen), ready, &mut input);
            input
        };
        assert_eq!(act(false), braked);
        assert_ne!(act(true), braked);
    }
}
