//! A recorded drive of the expert, from which frames are taken.

use base::maps::Map;
use drivers::Driver;
use drivers::expert::Expert;
use drivers::session::Session;
use kernel::arbiter::Phase;
use kernel::events::EventKind;
use kernel::time::{DATASET_STRIDE_TICKS, Tick, seconds};
use kernel::{Scenario, TickInput, World};
use replay::{Manifest, Provenance};

/// Frames in a row that may show the car standing; further ones are left out.
const STANDING_FRAMES: u32 = 4;
/// A car that stands so long is in a jam.
const JAM_TICKS: Tick = seconds(40);
/// Speed below which the car stands, m/s.
const STANDING_MPS: f32 = 0.2;

/// A drive that ends with a collision, in a jam, or when its time is up.
pub struct ExpertDrive {
    session: Session<Vec<u8>>,
    expert: Expert,
    standing_frames: u32,
    stood: Tick,
    collided: bool,
}

impl ExpertDrive {
    /// Starts it.
    pub fn new(scenario: &Scenario, map: &Map) -> anyhow::Result<Self> {
        let world = World::new(scenario, &map.network)?;
        let provenance: Provenance = [("semantic".to_owned(), "expert".to_owned())].into();
        let manifest = Manifest::new(scenario, &map.network, map.foreign.clone(), provenance);
        let session = Session::new(world, &manifest, Vec::new())?;
        Ok(Self { session, expert: Expert, standing_frames: 0, stood: 0, collided: false })
    }

    /// The world at the last tick.
    pub fn world(&self) -> &World {
        self.session.world()
    }

    /// Goes on to the next frame worth keeping; false when the drive is over.
    pub fn next_frame(&mut self) -> anyhow::Result<bool> {
        while self.step()? {
            if !self.world().tick().is_multiple_of(DATASET_STRIDE_TICKS) {
                continue;
            }
            self.standing_frames = if self.stood > 0 { self.standing_frames + 1 } else { 0 };
            if self.standing_frames <= STANDING_FRAMES {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Advances by a tick; false when the drive is over.
    fn step(&mut self) -> anyhow::Result<bool> {
        if self.collided || self.stood >= JAM_TICKS || self.world().arbiter().phase == Phase::Done {
            return Ok(false);
        }
        let semantic = self.expert.controls(self.session.world());
        let (_, output) = self.session.tick(&TickInput { semantic, ..TickInput::default() })?;
        let hit = |kind| matches!(kind, EventKind::CollisionActor | EventKind::CollisionScenery);
        self.collided = output.events.iter().any(|event| hit(event.kind));
        self.stood = if self.world().hud().speed_mps.abs() < STANDING_MPS { self.stood + 1 } else { 0 };
        Ok(!self.collided)
    }

    /// The bytes of its recording.
    pub fn into_recording(self) -> anyhow::Result<Vec<u8>> {
        self.session.finish()
    }
}
