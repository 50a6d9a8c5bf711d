//! The run of a log simulated again, at whatever tick one wants.

use std::sync::Arc;

use kernel::arbiter::{Applied, Phase};
use kernel::events::Hud;
use kernel::time::Tick;
use kernel::{RoadNetwork, SceneSnapshot, Seat, TickInput};
use replay::{Error, Log, Replayer};

use crate::desktop::HudText;

/// What there is to know about a tick.
#[derive(Clone, Debug)]
pub struct Moment {
    /// What there is to see.
    pub scene: SceneSnapshot,
    /// What both drivers saw besides the picture.
    pub hud: Hud,
    /// Where the arbitration stood.
    pub phase: Phase,
    /// Both drivers' controls; none at the tick from which the log starts.
    pub input: TickInput,
    /// What reached the car; `None` at the tick from which the log starts.
    pub applied: Option<Applied>,
    /// Distance driven so far, millimetres.
    pub odometer_mm: u64,
}

impl Moment {
    /// The HUD of both drivers.
    pub fn hud_text(&self) -> HudText {
        let seat = |of: fn(&Applied) -> Seat| self.applied.as_ref().map_or(Seat::Semantic, of);
        let is_reverse = self.applied.is_some_and(|applied| applied.controls.has(kernel::Controls::REVERSE));
        HudText::new(&self.hud, seat(|applied| applied.steering), seat(|applied| applied.pedals), is_reverse)
    }
}

/// A log and a world that follows it. Every tick on the way is compared with the log.
pub struct Reel<'a> {
    log: &'a Log,
    network: Arc<RoadNetwork>,
    replayer: Replayer<'a>,
    at: Option<Arc<Moment>>,
}

impl<'a> Reel<'a> {
    /// Stands at the first tick.
    pub fn new(log: &'a Log, network: &Arc<RoadNetwork>) -> Result<Self, Error> {
        Ok(Self { log, network: network.clone(), replayer: Replayer::new(log, network.clone())?, at: None })
    }

    /// The run at a tick; quick when it follows the one before, and from a keyframe otherwise.
    pub fn at(&mut self, tick: Tick) -> Result<Arc<Moment>, Error> {
        if let Some(moment) = self.at.as_ref().filter(|moment| moment.scene.tick == tick) {
            return Ok(moment.clone());
        }
        match self.go(tick) {
            Ok(moment) => Ok(self.at.insert(Arc::new(moment)).clone()),
            Err(error) => {
                // The world is no longer that of the log.
                (self.replayer, self.at) = (Replayer::new(self.log, self.network.clone())?, None);
                Err(error)
            }
        }
    }

    fn go(&mut self, tick: Tick) -> Result<Moment, Error> {
        let applied = if tick > self.log.first_tick() {
            self.replayer.seek(tick - 1)?;
            self.replayer.step()?.map(|output| output.applied)
        } else {
            None
        };
        // Nothing is left to do, unless there is no such tick.
        self.replayer.seek(tick)?;
        let world = self.replayer.world();
        Ok(Moment {
            scene: world.scene(),
            hud: world.hud(),
            phase: world.arbiter().phase,
            input: self.log.input(tick).copied().unwrap_or_default(),
            applied,
            odometer_mm: world.odometer_mm(),
        })
    }
}
