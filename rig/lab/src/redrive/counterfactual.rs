//! The verdict on an intervention, kept beside its recording.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::Context;
use base::files::{self, most};
use base::json::{self, Typed};
use drivers::simulate::FORK_AFTER_TICKS;
use drivers::vision::Vision;
use kernel::RoadNetwork;
use kernel::time::Tick;
use measures::criticality::Extremes;
use replay::Recording;
use serde::{Deserialize, Serialize};

use super::fork::{Fork, Harm, Otherwise};
use super::verdict::Need;

/// Raised when verdicts are given otherwise.
const VERDICTS: u32 = 3;

/// What would have happened without an intervention.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Counterfactual {
    /// Whether the intervention was necessary, a near miss, early, needless, or in vain.
    pub verdict: Need,
    /// The first thing that goes wrong without it.
    pub harm: Option<Harm>,
    /// From the intervention to the harm, seconds.
    pub harm_after_s: Option<f64>,
    /// The first collision, which may come after other harm.
    pub collision: Option<Harm>,
    /// From the intervention to the collision, seconds.
    pub collision_after_s: Option<f64>,
    /// The first thing that went wrong all the same with it.
    pub recorded_harm: Option<Harm>,
    /// How close it came to harm without it, whatever the verdict.
    pub closest: Extremes,
    /// What it follows from.
    key: Key,
}

/// `NAME.counterfactual.json` of a campaign.
impl Typed for Counterfactual {
    const TYPE: &'static str = "aeye.counterfactual";
}

/// Everything that decides a counterfactual.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Key {
    /// Digest of the recording, which names the checkpoint.
    recording: String,
    /// Version of the kernel.
    kernel: String,
    /// Version of the renderer.
    renderer: String,
    /// How long after the intervention the fork goes on.
    after_ticks: Tick,
    /// Version of how verdicts are given.
    verdicts: u32,
}

impl Key {
    fn of(recording: &Recording) -> Self {
        let digest = blake3::Hash::from_bytes(recording.digest()).to_hex();
        Self {
            recording: digest.to_string(),
            kernel: kernel::identity(),
            renderer: render::identity(),
            after_ticks: FORK_AFTER_TICKS,
            verdicts: VERDICTS,
        }
    }
}

impl Counterfactual {
    /// Drives a recording's fork without the intervention. Vision is that of the recorded run.
    pub fn of(recording: &Recording, network: &Arc<RoadNetwork>, vision: Vision) -> anyhow::Result<(Self, Vision)> {
        let otherwise = Otherwise::NoIntervention { earlier_ticks: 0 };
        let at = recording.log().intervention.context("holds no intervention")?.tick;
        let fork = Fork { otherwise, weather: None, after_ticks: FORK_AFTER_TICKS };
        let (course, vision) = fork.drive(recording.log(), network, vision)?;
        let found = Self {
            verdict: Need::of(&course, otherwise, at),
            harm_after_s: course.harm.as_ref().map(|harm| harm.seconds_after(at)),
            harm: course.harm,
            collision_after_s: course.collision.as_ref().map(|harm| harm.seconds_after(at)),
            collision: course.collision,
            recorded_harm: course.recorded_harm,
            closest: course.closest,
            key: Key::of(recording),
        };
        Ok((found, vision))
    }

    /// What was found before; `None` if nothing was, or of another recording.
    pub fn read(path: &Path, recording: &Recording) -> anyhow::Result<Option<Self>> {
        let bytes = files::read_if_there(path, most::TABLE)?;
        Ok(bytes.and_then(|bytes| Self::decode(&bytes, recording)))
    }

    /// As it is in a file, unless that is of another recording.
    pub fn decode(bytes: &[u8], recording: &Recording) -> Option<Self> {
        let known = serde_json::from_slice::<Self>(bytes).ok();
        known.filter(|known| known.key == Key::of(recording))
    }

    /// Where that of a run lies, by its corner case or its recording.
    pub fn place(file: &Path) -> PathBuf {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let run = name.strip_suffix(".mcap").unwrap_or(&name);
        file.with_file_name(format!("{}.counterfactual.json", run.strip_suffix(".case").unwrap_or(run)))
    }

    /// The one beside a corner case; what is not about its recording, or cannot be read, says nothing about it.
    pub fn beside(case: &Path, source: &[u8; 32]) -> Option<Self> {
        let bytes = files::read_if_there(&Self::place(case), most::TABLE).ok().flatten()?;
        Self::of_source(&bytes, source)
    }

    /// As it is in a file, whatever program wrote it, if it is about the recording of this digest.
    fn of_source(bytes: &[u8], source: &[u8; 32]) -> Option<Self> {
        let digest = blake3::Hash::from_bytes(*source).to_hex();
        serde_json::from_slice::<Self>(bytes).ok().filter(|known| known.key.recording == digest.as_str())
    }

    /// As a file.
    pub fn encode(&self) -> anyhow::Result<Vec<u8>> {
        Ok(json::json_file(self)?.into_bytes())
    }
}
