//! Corner cases: self-contained cuts around an intervention.

use std::ops::RangeInclusive;
use std::path::Path;
use std::sync::Arc;

use kernel::time::Tick;
use kernel::{RoadNetwork, SceneSnapshot};

use crate::{CaseInfo, Error, Log, Recording};

/// A self-contained cut of a recording: the keyframe before its window, the inputs from there to after
/// the outcome, and the scene of every clip frame of the window. It verifies as a recording does.
#[derive(Clone, Debug)]
pub struct Case {
    log: Log,
}

impl Case {
    /// The window that a recording's intervention (or the collision nobody prevented) asks for: the
    /// last three seconds up to it. `None` when nothing of the kind happened.
    pub fn window(_log: &Log) -> Option<RangeInclusive<Tick>> {
        todo!()
    }

    /// Cuts a window out of a recording by replaying it; every tick is compared on the way. The last
    /// clip frame is the window's last tick, the others are `CLIP_STRIDE_TICKS` apart before it.
    pub fn cut(
        _recording: &Recording,
        _network: &Arc<RoadNetwork>,
        _window: RangeInclusive<Tick>,
    ) -> Result<Self, Error> {
        todo!()
    }

    /// Reads a case's file; a recording that is no case is refused.
    pub fn open(path: &Path) -> Result<Self, Error> {
        Self::try_from(Recording::open(path)?).map_err(|e| e.within(path))
    }

    /// The bytes of its file.
    pub fn encode(&self) -> Result<Vec<u8>, Error> {
        self.log.encode()
    }

    /// The content, as that of a recording.
    pub fn log(&self) -> &Log {
        &self.log
    }

    /// Where it was cut from.
    pub fn info(&self) -> &CaseInfo {
        todo!()
    }

    /// The scenes of its clip, by ascending tick.
    pub fn scenes(&self) -> &[SceneSnapshot] {
        &self.log.scenes
    }
}

impl TryFrom<Recording> for Case {
    type Error = Error;

    fn try_from(_recording: Recording) -> Result<Self, Error> {
        todo!()
    }
}
