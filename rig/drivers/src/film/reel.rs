//! The run of a log simulated again, at whatever tick one wants.

use std::sync::Arc;

use kernel::arbiter::{Applied, Phase};
use kernel::events::Hud;
use kernel::time::Tick;
use kernel::{RoadNetwork, SceneSnapshot, TickInput};
use replay::{Error, Log, Replayer};

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

#[cfg(test)]
mod tests {
    use super::*;
    use kernel::time::KEYFRAME_TICKS;
    use kernel::{Controls, World};
    use proptest::prelude::*;
    use replay::{Manifest, Provenance, Recorder, Recording};
    use std::sync::OnceLock;

    use base::maps::Map;

    const LAST: Tick = 2 * KEYFRAME_TICKS + 90;

    /// A drive over three keyframes, and what was to be seen at every tick of it.
    fn drive() -> &'static (Recording, Arc<RoadNetwork>, Vec<SceneSnapshot>) {
        static DRIVE: OnceLock<(Recording, Arc<RoadNetwork>, Vec<SceneSnapshot>)> = OnceLock::new();
        DRIVE.get_or_init(|| {
            let map = Map::find("rural").expect("bundled");
            let scenario = map.scenario(4);
            let manifest = Manifest::new(&scenario, &map.network, None, Provenance::default());
            let mut world = World::new(&scenario, &map.network).expect("a world");
            let mut recorder = Recorder::new(Vec::new(), &manifest, &world.initial_keyframe()).expect("a recording");
            let mut scenes = vec![world.scene()];
            while world.tick() < LAST {
                let steer = (world.tick() as f32 / 50.0).sin() * 0.1;
                let semantic = Controls::from_fractions(steer, 0.3, 0.0);
                let input = TickInput { semantic, ..TickInput::default() };
                let output = world.step(&input);
                recorder.tick(&input, &output, &world.part_hashes()).expect("a tick");
                scenes.push(world.scene());
            }
            let bytes = recorder.finish(None).expect("its end");
            (Recording::from_bytes(&bytes).expect("a recording"), map.network, scenes)
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]
        #[test]
        fn wherever_one_goes_there_is_what_was_there(ticks in prop::collection::vec(0..=LAST, 1..6)) {
            let (recording, network, scenes) = drive();
            let mut reel = Reel::new(recording.log(), network).expect("a log");
            for tick in ticks {
                let moment = reel.at(tick).expect("a tick of the log");
                prop_assert!(moment.scene == scenes[tick as usize], "tick {}", tick);
                prop_assert_eq!(moment.applied.is_some(), tick > 0);
            }
        }
    }

    #[test]
    fn a_log_that_was_changed_is_told_and_the_rest_of_it_can_still_be_seen() {
        let (recording, network, scenes) = drive();
        let mut log = recording.log().clone();
        log.inputs[99].semantic.steer ^= 1;
        let mut reel = Reel::new(&log, network).expect("a log");
        assert!(matches!(reel.at(130), Err(Error::Diverged(found)) if found.tick == 100));
        assert!(matches!(reel.at(LAST + 1), Err(Error::Unsuited(_))));
        for tick in [99, 0, LAST] {
            assert!(reel.at(tick).expect("as it was").scene == scenes[tick as usize], "tick {tick}");
        }
    }
}
