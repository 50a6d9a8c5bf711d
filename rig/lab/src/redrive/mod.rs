//! Counterfactuals: corner cases driven on from before the intervention.
//!
//! `OUT/NAME.fork.mcap` for each file (`NAME.fork-1.mcap` and so on for variations), recordings that verify as
//! any other, and `OUT/redrive.jsonl`, a line for each.

mod counterfactual;
mod fork;
mod verdict;

use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, bail};
use kernel::time::{TICK_HZ, Tick};
use kernel::{RoadNetwork, Scenario};
use render::{RenderOptions, Renderer};
use replay::{Log, Recording};
use serde::Serialize;

pub use self::counterfactual::Counterfactual;
use self::fork::{Fork, Harm, Otherwise, from_takeover, takeover};
use self::verdict::Verdict;
use base::failure::Usage;
use base::library;
use base::output::{PendingFolder, json_line};
use base::progress;
use drivers::checkpoint::CheckpointChoice;
use drivers::recorded_eye::RecordedEye;
use drivers::vision::{Eye, Vision};
use measures::criticality::{Extreme, Extremes};

/// A variation lets the safety driver go so much earlier than the one before.
const VARIATION_TICKS: Tick = TICK_HZ as Tick / 10;
/// A time to collision up to this is told as a near miss, seconds.
const NEAR_MISS_S: f64 = 1.5;

/// A fork, a line of `redrive.jsonl`.
#[derive(Debug, Serialize)]
pub struct Line {
    file: String,
    /// 0 is the case itself.
    variation: u16,
    recording: String,
    /// What the semantic bot looked through.
    checkpoint: String,
    /// Of the takeover, or of the collision that nobody prevented.
    intervention_tick: Tick,
    fork_tick: Tick,
    verdict: Verdict,
    harm: Option<Harm>,
    /// From the recorded intervention to the harm, seconds; negative before it.
    harm_after_s: Option<f64>,
    /// The first collision, which may come after other harm.
    collision: Option<Harm>,
    /// From the recorded intervention to the collision, seconds; negative before it.
    collision_after_s: Option<f64>,
    /// The first thing that went wrong in the recorded run from the takeover on.
    recorded_harm: Option<Harm>,
    /// Tick of an intervention in the fork.
    intervention_again: Option<Tick>,
    /// How critical it was from the fork on.
    closest: Extremes,
}

/// What came of it.
#[derive(Debug, Serialize)]
pub struct Summary {
    /// Folder of the forks.
    pub out: String,
    /// The forks.
    pub forks: Vec<Line>,
    /// How many forks came to each verdict.
    pub verdicts: BTreeMap<&'static str, usize>,
}

/// What is driven on, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// Recordings or cases with an intervention (or a collision that nobody prevented, for
    /// `--checkpoint`), or folders with cases anywhere below.
    pub files: Vec<PathBuf>,
    /// The safety driver does nothing from the tick of the intervention on; the semantic driver is a bot
    /// that looks through the recorded checkpoint. What would have happened?
    pub without_intervention: bool,
    /// Bots drive from the first tick at hand, at least 3 s before the intervention, the semantic one
    /// looking through this checkpoint. Is there an intervention again?
    pub checkpoint: Option<CheckpointChoice>,
    /// Where the recorded checkpoint may be found, if it does not come with the program.
    pub recorded: Vec<CheckpointChoice>,
    /// Tell the checkpoint of blind drives.
    pub reveal: bool,
    /// Further forks of each file with other weather of the paper's ranges and, without the
    /// intervention, with the safety driver gone 0.1 s earlier each; through another checkpoint, with
    /// safety drivers of other reaction times.
    pub vary: u16,
    /// How long after the intervention a fork goes on, seconds.
    pub seconds: u16,
    /// Folder of the forks' recordings and of `redrive.jsonl`; must not exist or be empty.
    pub out: PathBuf,
}

/// Drives every file on.
pub fn redrive(args: &Options) -> anyhow::Result<Summary> {
    let out = PendingFolder::new(&args.out)?;
    let mut forks = Vec::new();
    let files = library::cases(&args.files)?;
    let bar = progress::bar("files", files.len() as u64);
    for path in &files {
        forks.extend(forks_of(args, path, out.path()).with_context(|| path.display().to_string())?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    let lines = forks.iter().map(json_line).collect::<anyhow::Result<Vec<_>>>()?;
    let path = out.path().join("redrive.jsonl");
    fs::write(&path, lines.join("\n") + "\n").with_context(|| path.display().to_string())?;
    out.finish()?;
    let mut verdicts = BTreeMap::new();
    forks.iter().for_each(|line| *verdicts.entry(line.verdict.name()).or_insert(0) += 1);
    Ok(Summary { out: args.out.display().to_string(), forks, verdicts })
}

/// All forks of a file.
fn forks_of(args: &Options, path: &Path, out: &Path) -> anyhow::Result<Vec<Line>> {
    let recording = Recording::open(path)?;
    let network = recording.network()?;
    let log = recording.into_log();
    if args.without_intervention {
        log.intervention.context("holds no intervention that could be left out")?;
    }
    let at = takeover(&log).context("holds nothing that could be avoided: no intervention, no collision")?;
    if study::is_blind(&log.manifest.provenance) && !args.reveal {
        return Err(Usage("a blind drive; expected --reveal, which tells its checkpoint".into()).into());
    }
    let eye = eye_of(args, &log)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.strip_suffix(".mcap").unwrap_or(&name);
    let name = name.strip_suffix(".case").unwrap_or(name);
    let mut vision = Vision::new(Renderer::new(&network, &RenderOptions::default())?, eye.clone());
    let mut lines = Vec::new();
    for variation in 0..=args.vary {
        let fork = variant(args, &log, &network, variation);
        let (course, after) = fork.drive(&log, &network, vision)?;
        vision = after.with_eye(eye.clone());
        let file = if variation == 0 { format!("{name}.fork.mcap") } else { format!("{name}.fork-{variation}.mcap") };
        let to = out.join(&file);
        if to.exists() {
            bail!("two files are named {name}; expected names that differ");
        }
        fs::write(&to, &course.recording).with_context(|| to.display().to_string())?;
        lines.push(Line {
            file: path.display().to_string(),
            variation,
            recording: file,
            checkpoint: eye.name().to_owned(),
            intervention_tick: at,
            fork_tick: course.fork_tick,
            verdict: Verdict::of(&course, fork.otherwise, at),
            harm_after_s: course.harm.as_ref().map(|harm| harm.seconds_after(at)),
            harm: course.harm,
            collision_after_s: course.collision.as_ref().map(|harm| harm.seconds_after(at)),
            collision: course.collision,
            recorded_harm: course.recorded_harm,
            intervention_again: course.intervention,
            closest: course.closest,
        });
    }
    Ok(lines)
}

/// What the semantic bot looks through.
fn eye_of(args: &Options, log: &Log) -> anyhow::Result<Eye> {
    if let Some(choice) = &args.checkpoint {
        return Eye::open(choice);
    }
    let recorded = RecordedEye::of(&log.manifest.provenance)?;
    let found = recorded.find(&args.recorded)?;
    found.with_context(|| format!("was driven through {:?}; expected that file as --recorded", recorded.name))
}

/// The fork itself, or a variation of it; both follow from the file and the number alone.
fn variant(args: &Options, log: &Log, network: &Arc<RoadNetwork>, variation: u16) -> Fork {
    let otherwise = if args.without_intervention {
        Otherwise::NoIntervention { earlier_ticks: Tick::from(variation) * VARIATION_TICKS }
    } else {
        Otherwise::OtherEye { person: variation.into() }
    };
    let seed = log.manifest.scenario.seed.wrapping_add(variation.into());
    let weather = (variation > 0).then(|| Scenario::default_for(&network.name, seed).weather);
    Fork { otherwise, weather, after_ticks: Tick::from(args.seconds) * Tick::from(TICK_HZ) }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.forks.iter().try_for_each(|line| writeln!(f, "{}", line.words()))?;
        let counts: Vec<_> = self.verdicts.iter().map(|(name, count)| format!("{count} {name}")).collect();
        write!(f, "{}: {}", self.out, counts.join(", "))
    }
}

impl Line {
    fn words(&self) -> String {
        let variation = if self.variation == 0 { String::new() } else { format!(" (variation {})", self.variation) };
        let words = |harm: &Option<Harm>, after_s: Option<f64>| Some(harm.as_ref()?.words(after_s?));
        let harm = words(&self.harm, self.harm_after_s).map(|harm| format!(": {harm}"));
        let later = words(&self.collision, self.collision_after_s).filter(|_| self.collision != self.harm);
        let harm = harm.map(|harm| harm + &later.map(|later| format!("; {later}")).unwrap_or_default());
        let what = harm.or_else(|| self.near_miss()).unwrap_or_default();
        let came = self.recorded_harm.as_ref().filter(|_| self.verdict == Verdict::InVain);
        let came =
            came.map(|harm| format!("; with the takeover: {}", harm.words(harm.seconds_after(self.intervention_tick))));
        format!("{}{variation}: {}{what}{}", self.file, self.verdict.name(), came.unwrap_or_default())
    }

    /// How close it came where nothing went wrong and nobody had to take over.
    fn near_miss(&self) -> Option<String> {
        if !matches!(self.verdict, Verdict::Needless | Verdict::Avoided) {
            return None;
        }
        let Extreme { value, tick, with } = self.closest.min_ttc_s.as_ref()?;
        let when = from_takeover((*tick as f64 - self.intervention_tick as f64) / f64::from(TICK_HZ));
        (*value <= NEAR_MISS_S).then(|| format!(", {value:.1} s from a collision with {with} {when}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(verdict: Verdict, min_ttc_s: f64, tick: Tick) -> Line {
        let extreme = Extreme { value: min_ttc_s, tick, with: "bicycle 9".into() };
        Line {
            file: "a.case.mcap".into(),
            variation: 0,
            recording: "a.fork.mcap".into(),
            checkpoint: "early".into(),
            intervention_tick: 600,
            fork_tick: 600,
            verdict,
            harm: None,
            harm_after_s: None,
            collision: None,
            collision_after_s: None,
            recorded_harm: None,
            intervention_again: None,
            closest: Extremes {
                min_ttc_s: Some(extreme),
                min_pret_s: None,
                max_required_deceleration_mps2: None,
                pet_s: None,
            },
        }
    }

    #[test]
    fn a_near_miss_is_told_where_nobody_had_to_take_over() {
        let words = |verdict, ttc, tick| line(verdict, ttc, tick).words();
        let near = "a.case.mcap: needless, 0.4 s from a collision with bicycle 9 0.5 s after the takeover";
        assert_eq!(words(Verdict::Needless, 0.4, 630), near);
        assert!(words(Verdict::Avoided, 1.5, 540).ends_with("1.0 s before the takeover"));
        assert_eq!(words(Verdict::Needless, 1.6, 630), "a.case.mcap: needless");
        assert_eq!(words(Verdict::Again, 0.4, 630), "a.case.mcap: again");
    }
}
