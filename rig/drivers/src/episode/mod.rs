//! A run in which somebody else's program has one of the seats and a bot the other.

mod drive;
mod facts;
mod fleet;
pub mod hud;
mod studio;

use std::borrow::Cow;

use kernel::arbiter::{Outcome, Phase};
use kernel::time::Tick;
use kernel::{Controls, Scenario, Seat, TickInput, World};
use render::{Camera, Frame};
use replay::{Annotation, Manifest};

use crate::crew::Bots;
use crate::indicate;
use crate::readout::Readout;
use crate::vision::{Optics, Screen};
use crate::{MaskView, simulate};
use base::maps::Map;
use drive::Drive;
use facts::Observer;

pub use facts::Facts;
pub use fleet::{Archive, COLUMNS, Fleet, Plan, Row, Start};

/// Ticks that the controls of a step are held for, unless asked otherwise: one new mask a step.
pub const STEP_TICKS: Tick = crate::vision::FRAME_TICKS;
/// Most ticks of a step: a second.
pub const MOST_STEP_TICKS: Tick = 60;

/// A run that an agent drives in one seat, beside a bot in the other.
pub struct Episode {
    seat: Seat,
    drive: Drive,
    bots: Bots,
    screen: Screen,
    looks: bool,
    observer: Observer,
    held: Controls,
}

impl Episode {
    /// At the start of a run. With a manifest it is recorded. Whether `looks`, masks are drawn though neither the other
    /// seat's bot nor the recording needs them.
    pub fn new(
        scenario: &Scenario,
        map: &Map,
        seat: Seat,
        manifest: Option<&Manifest>,
        looks: bool,
    ) -> anyhow::Result<Self> {
        let world = World::new(scenario, &map.network)?;
        let (bots, observer) = (Bots::beside(seat, scenario.seed), Observer::new(&world));
        let looks = looks || bots.needs_mask() || manifest.is_some();
        let drive = Drive::new(world, manifest)?;
        Ok(Self { seat, drive, bots, screen: Screen::default(), looks, observer, held: Controls::default() })
    }

    /// The world at the last tick.
    pub fn world(&self) -> &World {
        self.drive.world()
    }

    /// Whether the run has ended.
    pub fn is_over(&self) -> bool {
        self.world().arbiter().phase == Phase::Done
    }

    /// Holds the agent's controls for so many ticks, or until the run ends. The semantic driver's indicators are those of
    /// the turn that the HUD shows, as the bot's.
    pub fn step(&mut self, optics: &mut Optics, controls: Controls, ticks: Tick) -> anyhow::Result<Facts> {
        self.held = controls;
        let mut facts = Facts::default();
        for _ in 0..ticks {
            if !self.is_over() {
                self.tick(Some(optics), &mut facts)?;
            }
        }
        Ok(facts)
    }

    /// A tick, as [`simulate::drive`] drives it. Without optics nobody looks any more.
    fn tick(&mut self, optics: Option<&mut Optics>, facts: &mut Facts) -> anyhow::Result<()> {
        let mut input = self.agents_input();
        let world = self.drive.world();
        let (mask, mut shown) = match optics.filter(|_| self.looks) {
            Some(optics) => self.screen.look(optics, world).map(|(mask, shown)| (Some(mask), Some(shown)))?,
            None => (None, None),
        };
        shown.iter_mut().for_each(|shown| shown.tick_shown += 1);
        self.bots.act(world, mask, &mut input);
        let output = self.drive.tick(&input, shown)?;
        self.observer.add(self.drive.world(), &output, facts);
        Ok(())
    }

    fn agents_input(&self) -> TickInput {
        match self.seat {
            Seat::Semantic => {
                let flags = self.held.flags | indicate::turn(&Readout::of(&self.world().hud()));
                TickInput { semantic: Controls { flags, ..self.held }, ..TickInput::default() }
            }
            Seat::Safety => TickInput { safety: self.held, ..TickInput::default() },
        }
    }

    /// The mask on the semantic driver's screen.
    pub fn mask(&mut self, optics: &mut Optics) -> anyhow::Result<MaskView<'_>> {
        Ok(self.screen.look(optics, self.drive.world())?.0)
    }

    /// The colours that the safety driver sees through a camera, 3 bytes a pixel: of the present, without delay.
    pub fn image(&mut self, optics: &mut Optics, camera: &Camera) -> anyhow::Result<Cow<'_, [u8]>> {
        let (drive, screen) = (&self.drive, &mut self.screen);
        if self.looks {
            screen.look(optics, drive.world())?;
        }
        match screen.colours_of(drive.world().tick()).filter(|_| optics.eye().camera() == *camera) {
            Some(drawn) => Ok(drawn.into()),
            None => Ok(optics.draw(drive.world(), camera)?.rgb.into()),
        }
    }

    /// What any camera sees.
    pub fn draw(&self, optics: &mut Optics, camera: &Camera) -> anyhow::Result<Frame> {
        optics.draw(self.world(), camera)
    }

    /// Ends the episode and gives its recording, if it is recorded. A run that the safety bot has taken over is driven
    /// to its end first, with the agent's last controls, so that there is a whole corner case.
    pub fn finish(mut self) -> anyhow::Result<Option<Vec<u8>>> {
        while self.drive.is_kept() && self.seat == Seat::Semantic && self.world().arbiter().phase == Phase::TakenOver {
            self.tick(None, &mut Facts::default())?;
        }
        let annotation = self.annotation();
        self.drive.finish(annotation)
    }

    /// Nobody says whose fault it was: the bot at the wheel through true masks would be no answer for the agent's.
    fn annotation(&self) -> Option<Annotation> {
        let is_told = match self.world().arbiter().outcome? {
            Outcome::Intervened => self.seat == Seat::Semantic,
            Outcome::Missed => true,
            Outcome::Censored => false,
        };
        let (label, comment) = self.bots.cause(self.world()).filter(|_| is_told)?;
        Some(Annotation { label, comment, perception_caused: None })
    }
}

/// What the manifest calls who sits in the seats, the semantic driver first.
fn seats(agent: Seat) -> [&'static str; 2] {
    match agent {
        Seat::Semantic => ["agent", simulate::BOT],
        Seat::Safety => [simulate::BOT, "agent"],
    }
}

/// The manifest of an episode.
pub fn manifest(scenario: &Scenario, map: &Map, seat: Seat, eye: &crate::vision::Eye) -> Manifest {
    simulate::manifest_with(seats(seat), scenario, map, eye)
}

#[cfg(test)]
mod tests;
