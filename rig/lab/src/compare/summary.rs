//! What `compare.json` holds and the command prints.

use base::failure::Failure;
use base::json::Typed;
use base::library::Entry;
use drivers::vision::{self, Eye};
use kernel::time::Tick;
use perception::{Calibration, ConfusionMatrix};
use serde::Serialize;

use super::super::figures::Figures;
use super::super::pipeline::{Alone, Pace};
use super::super::trust::Trust;
use super::contest::{Change, Contest};
use super::gate::Passage;
use super::looking::Looked;
use super::metrics::{CaseSums, IN_TIME_S, Metric};

/// The content of `compare.json`.
#[derive(Serialize)]
pub struct Scoreboard {
    /// Width and height of the pictures, pixels.
    pub size: (u32, u32),
    /// The graphics adapter that drew them.
    pub adapter: String,
    /// How long before the intervention a hazard must be seen to be seen in time, seconds.
    pub in_time_s: f64,
    /// The first one is the baseline.
    pub checkpoints: Vec<CheckpointLine>,
    /// What each made of each case.
    pub cases: Vec<CaseLine>,
    /// The conditions that were asked for.
    pub gates: Vec<Passage>,
    /// Files that were left out, and why.
    pub failed: Vec<Failure>,
}

/// `compare.json`, which holds no `speed`.
impl Typed for Scoreboard {
    const TYPE: &'static str = "aeye.compare";
}

/// A checkpoint over all cases.
#[derive(Serialize)]
pub struct CheckpointLine {
    /// Its name.
    pub name: String,
    /// Its digest, hexadecimal.
    pub digest: String,
    /// Share of the pixels of people on the path that are predicted as pedestrian.
    pub ped_recall_on_path: Option<f64>,
    /// Share of the hazards that are seen in time.
    pub hazards_seen: Option<f64>,
    /// Mean time from the first sight of the hazard to the intervention, seconds.
    pub first_sight_s: Option<f64>,
    #[serde(flatten)]
    pub figures: Figures,
    /// How far its certainty can be believed; null of one that gives classes only.
    pub trust: Option<Trust>,
    /// Against the baseline; left out for itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub against_baseline: Option<Contest>,
}

/// A case through all checkpoints.
#[derive(Serialize)]
pub struct CaseLine {
    /// Name of the case.
    pub file: String,
    /// BLAKE3 of the file.
    pub digest: String,
    /// Frames that were looked at.
    pub frames: usize,
    /// Whom the intervention is about.
    pub hazard: Option<String>,
    /// What each checkpoint made of it.
    pub checkpoints: Vec<LookLine>,
}

/// A case through one checkpoint.
#[derive(Serialize)]
pub struct LookLine {
    /// Name of the checkpoint.
    pub name: String,
    /// Tick of the first frame in which the hazard is seen.
    pub first_seen_tick: Option<Tick>,
    /// From there to the intervention, seconds; 0 if it is never seen, `None` without a hazard to see.
    pub first_sight_s: Option<f64>,
    /// How much earlier than through the baseline, seconds.
    pub gain_s: Option<f64>,
    /// Against the baseline; `None` for itself.
    pub verdict: Option<Change>,
    /// As over all cases.
    pub ped_recall_on_path: Option<f64>,
    #[serde(flatten)]
    pub figures: Figures,
}

impl Scoreboard {
    /// Without gates.
    pub fn new(size: (u32, u32), cases: &[Entry], eyes: &[Eye], looked: &[Looked], sums: &[Vec<CaseSums>]) -> Self {
        let checkpoint = |number: usize| CheckpointLine::new(number, &eyes[number], looked, sums);
        let case = |(number, case): (usize, &Entry)| CaseLine::new(number, case, eyes, &looked[number], sums);
        Self {
            size,
            adapter: vision::adapter(),
            in_time_s: IN_TIME_S,
            checkpoints: (0..eyes.len()).map(checkpoint).collect(),
            cases: cases.iter().enumerate().map(case).collect(),
            gates: Vec::new(),
            failed: Vec::new(),
        }
    }
}

impl CheckpointLine {
    fn new(number: usize, eye: &Eye, looked: &[Looked], sums: &[Vec<CaseSums>]) -> Self {
        let all: Vec<usize> = (0..looked.len()).collect();
        let own = |metric: Metric| metric.of(&sums[number], &all);
        let (mut matrix, mut calibration) = (ConfusionMatrix::default(), Calibration::default());
        for score in looked.iter().map(|case| &case.scores[number]) {
            matrix.merge(&score.matrix);
            calibration.merge(&score.calibration);
        }
        Self {
            name: eye.name().to_owned(),
            digest: eye.digest(),
            ped_recall_on_path: own(Metric::PedRecallOnPath),
            hazards_seen: own(Metric::HazardsSeen),
            first_sight_s: own(Metric::FirstSight),
            figures: (&matrix).into(),
            trust: Trust::of(&calibration),
            against_baseline: (number > 0).then(|| Contest::of(&sums[0], &sums[number])),
        }
    }

    /// A figure of the checkpoint alone; `None` of those that need a baseline.
    pub fn own(&self, metric: Metric) -> Option<f64> {
        let trust = self.trust.as_ref();
        match metric {
            Metric::PedIou => self.figures.pedestrian_iou,
            Metric::Miou => self.figures.miou,
            Metric::PedRecallOnPath => self.ped_recall_on_path,
            Metric::HazardsSeen => self.hazards_seen,
            Metric::FirstSight => self.first_sight_s,
            Metric::Ece => trust?.ece,
            Metric::SurelyWrong => trust?.surely_wrong,
            Metric::PedSurelyWrong => trust?.surely_wrong_of_people(),
            Metric::Fixed | Metric::Broken => None,
        }
    }
}

impl CaseLine {
    fn new(number: usize, case: &Entry, eyes: &[Eye], looked: &Looked, sums: &[Vec<CaseSums>]) -> Self {
        let facts = &looked.facts;
        let baseline_s = sums[0][number].sight_s;
        let look = |(checkpoint, eye): (usize, &Eye)| {
            let (score, sight_s) = (&looked.scores[checkpoint], sums[checkpoint][number].sight_s);
            LookLine {
                name: eye.name().to_owned(),
                first_seen_tick: score.first_seen().map(|frame| facts.ticks[frame]),
                first_sight_s: sight_s,
                gain_s: sight_s.zip(baseline_s).map(|(own, baseline)| own - baseline),
                verdict: (checkpoint > 0).then(|| Change::of(baseline_s, sight_s)),
                ped_recall_on_path: score.people_on_path.share(),
                figures: (&score.matrix).into(),
            }
        };
        Self {
            file: case.name.clone(),
            digest: case.digest.to_hex().to_string(),
            frames: facts.ticks.len(),
            hazard: facts.hazard.as_ref().map(|hazard| hazard.what.clone()),
            checkpoints: eyes.iter().enumerate().map(look).collect(),
        }
    }
}

/// How fast the frames of this call went; those found from earlier calls are not among them.
#[derive(Serialize)]
pub struct Speed {
    /// Frames that were drawn and looked at.
    pub frames: usize,
    /// Checkpoints that looked at them.
    pub checkpoints: usize,
    /// Time that it took, seconds.
    pub seconds: f64,
    /// Frames a second.
    pub frames_per_s: f64,
    /// Each stage with the machine to itself, on the frames of the first cases.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub alone: Option<Alone>,
    /// `frames_per_s` over the slower of both stages alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub share_of_slower: Option<f64>,
}

impl Speed {
    /// `None` if there was nothing left to do.
    pub fn of(pace: Pace, alone: Option<Alone>, checkpoints: usize) -> Option<Self> {
        let share_of_slower = alone.map(|alone| pace.rate() / alone.render_fps.min(alone.inference_fps));
        let Pace { frames, seconds } = pace;
        (frames > 0).then(|| Self { frames, checkpoints, seconds, frames_per_s: pace.rate(), alone, share_of_slower })
    }
}

/// A comparison, and how fast it was.
#[derive(Serialize)]
pub struct Compared {
    /// What `compare.json` holds.
    #[serde(flatten)]
    pub summary: Scoreboard,
    /// Not in `compare.json`; null where everything was there already.
    pub speed: Option<Speed>,
}

/// `compare.json`, and with `speed` what `aeye compare` prints.
impl Typed for Compared {
    const TYPE: &'static str = "aeye.compare";
}

impl Compared {
    /// The gates that were not passed.
    pub fn failed(&self) -> impl Iterator<Item = &Passage> {
        self.summary.gates.iter().filter(|passage| !passage.passed)
    }
}
