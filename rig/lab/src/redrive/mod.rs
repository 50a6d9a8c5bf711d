//! Counterfactuals: corner cases driven on from before the intervention.
//!
//! `OUT/NAME.fork.mcap` for each file (`NAME.fork-1.mcap` and so on for variations), recordings that verify as
//! any other, and `OUT/redrive.jsonl`, a line for each. Forks that are there are found again through
//! `OUT/.redrive`; a folder holds those of the same options alone.

mod counterfactual;
mod fork;
mod judged;
mod near_miss;
mod verdict;

use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

use anyhow::{Context, bail};
use base::files::{self, most};
use base::json::Typed;
use kernel::time::{TICK_HZ, Tick};
use kernel::{RoadNetwork, Scenario};
use render::{AdapterChoice, Renderer};
use replay::{Log, Recording};
use serde::{Deserialize, Serialize};

pub use self::counterfactual::Counterfactual;
use self::fork::{Course, Fork, Harm, Otherwise, from_takeover, takeover};
pub use self::judged::{is_judged, keep_judged};
pub use self::near_miss::{EARLY_TICKS, is_near_miss};
pub use self::verdict::Need;
use super::store::Store;
use crate::machine::Machine;
use crate::share::{Share, ShareDone};
use base::failure::{Failed, Failure, Usage};
use base::json::json_line;
use base::library::{self, Entry, Kind};
use base::progress::{self, Interrupt};
use base::spread::{in_order, jobs};
use base::{maps, output};
use drivers::checkpoint::CheckpointChoice;
use drivers::recorded_eye::RecordedEye;
use drivers::vision::{Eye, Vision};
use measures::criticality::{Extreme, Extremes};

/// A variation lets the safety driver go so much earlier than the one before.
const VARIATION_TICKS: Tick = TICK_HZ as Tick / 10;
/// The table of all forks, in the folder of the results.
const TABLE: &str = "redrive.jsonl";
/// A time to collision up to this is told as a near miss, seconds.
const NEAR_MISS_S: f64 = 1.5;

/// A fork, a line of `redrive.jsonl`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Line {
    /// The file.
    file: String,
    /// 0 is the case itself.
    variation: u16,
    /// Its recording, in the folder of the results.
    recording: String,
    /// What the semantic bot looked through.
    checkpoint: String,
    /// Of the takeover, or of the collision that nobody prevented.
    intervention_tick: Tick,
    /// First tick that may differ from the recorded run.
    fork_tick: Tick,
    /// What it says about the intervention.
    verdict: Need,
    /// The first thing that went wrong.
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

/// A line of `redrive.jsonl`.
impl Typed for Line {
    const TYPE: &'static str = "aeye.redrive.fork";
}

/// What came of it.
#[derive(Debug, Serialize)]
pub struct Forks {
    /// Folder of the forks.
    pub out: String,
    /// Files that were driven on.
    pub files: usize,
    /// The forks.
    pub forks: Vec<Line>,
    /// How many forks came to each verdict.
    pub verdicts: BTreeMap<&'static str, usize>,
    /// Files that were left out, and why.
    pub failed: Vec<Failure>,
}

/// What `aeye redrive` prints.
impl Typed for Forks {
    const TYPE: &'static str = "aeye.redrive";
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
    pub seconds: u32,
    /// Files driven on at the same time (default: one a core); the results do not depend on it.
    pub jobs: Option<u16>,
    /// Folder of the forks' recordings and of `redrive.jsonl`. One that was begun with the same options is completed.
    pub out: PathBuf,
}

/// Everything that a fork follows from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Key {
    /// BLAKE3 of the recording or case.
    log: String,
    without_intervention: bool,
    checkpoint: String,
    variation: u16,
    seconds: u32,
    kernel: String,
    program: String,
    renderer: String,
    machine: Machine,
}

/// What is kept of a fork: its line, and the digest of its recording.
type Kept = (Line, String);

/// Drives every file on; forks that are there already are kept.
pub fn redrive(args: &Options, interrupt: &Interrupt) -> anyhow::Result<Forks> {
    let Driven { forks, files, failed, _store } = drive(args, None, interrupt)?;
    let lines = forks.iter().map(json_line).collect::<anyhow::Result<Vec<_>>>()?;
    output::write_file(&args.out.join(TABLE), (lines.join("\n") + "\n").as_bytes())?;
    let mut verdicts = BTreeMap::new();
    forks.iter().for_each(|line| *verdicts.entry(line.verdict.name()).or_insert(0) += 1);
    Ok(Forks { out: args.out.display().to_string(), files, forks, verdicts, failed })
}

/// Drives a share of the files on and writes no table: a later call finds their forks in the folder.
pub fn redrive_shard(args: &Options, share: Share, interrupt: &Interrupt) -> anyhow::Result<ShareDone> {
    let Driven { files: done, failed, .. } = drive(args, Some(share), interrupt)?;
    Ok(ShareDone { share, out: args.out.display().to_string(), done, failed })
}

/// Files that were driven on.
struct Driven {
    forks: Vec<Line>,
    files: usize,
    failed: Vec<Failure>,
    /// Nobody else works in the folder for as long.
    _store: Store,
}

/// Drives on what is missing of a share, or of all.
fn drive(args: &Options, share: Option<Share>, interrupt: &Interrupt) -> anyhow::Result<Driven> {
    AdapterChoice::default().find()?;
    let store = Store::open(&args.out, "redrive")?;
    store.hold(&options(args)?)?;
    let found = library::find(&args.files, Kind::Cases).apart_from(TABLE).or_failed()?;
    let mut stems = stems(&found.files);
    if let Some(share) = share {
        share.keep(&mut stems);
    }
    let library::Found { files: entries, mut failed } = match share {
        Some(share) => share.pick(found),
        None => found,
    };
    // That of an earlier call would not be about these files.
    let table = args.out.join(TABLE);
    if share.is_none() && table.exists() {
        fs::remove_file(&table).with_context(|| table.display().to_string())?;
    }
    let bar = progress::bar("files", entries.len() as u64);
    let (mut forks, mut files) = (Vec::new(), 0);
    let fork = |index: usize| forks_of(args, (&entries[index], &stems[index]), (&store, interrupt));
    in_order(jobs(args.jobs), entries.len(), fork, |index, lines| {
        let path = &entries[index].path;
        let place = || path.display().to_string();
        match lines {
            Ok(lines) => {
                forks.extend(lines);
                files += 1;
            }
            Err(error) if interrupt.is_raised() || error.is::<Usage>() => return Err(error).with_context(place),
            Err(error) => failed.push(Failure::new(path, &error.context(place()))),
        }
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    if files == 0 && !failed.is_empty() {
        return Err(Failed::new(failed).into());
    }
    Ok(Driven { forks, files, failed, _store: store })
}

/// The options that forks in a folder have in common, as they are given.
fn options(args: &Options) -> anyhow::Result<Vec<String>> {
    let course = match &args.checkpoint {
        None => "--without-intervention".to_owned(),
        Some(choice) => {
            let eye = Eye::open(choice)?;
            let digest = eye.digest();
            let short = if matches!(eye, Eye::External(_)) { None } else { digest.get(..8) };
            format!("--checkpoint {} ({})", eye.name(), short.unwrap_or(&digest))
        }
    };
    Ok(vec![course, format!("--vary {}", args.vary), format!("--after {}s", args.seconds)])
}

/// What the forks of each file are called.
fn stems(files: &[Entry]) -> Vec<String> {
    (0..files.len()).map(|index| stem(files, index).to_owned()).collect()
}

/// What the forks of a file are called: without `.case`, unless its recording is among the files.
fn stem(files: &[Entry], index: usize) -> &str {
    let name = &files[index].name;
    let short = name.strip_suffix(".case").unwrap_or(name);
    if files.iter().enumerate().any(|(other, file)| other != index && file.name == short) { name } else { short }
}

/// All forks of a file.
fn forks_of(
    args: &Options,
    (file, name): (&Entry, &str),
    (store, interrupt): (&Store, &Interrupt),
) -> anyhow::Result<Vec<Line>> {
    store.check(&mark(name, 0), file)?;
    let recording = Recording::open(&file.path)?;
    let network = recording.network()?;
    let digest = file.digest.to_hex().to_string();
    let log = recording.into_log();
    if args.without_intervention {
        log.intervention.context("holds no intervention that could be left out")?;
    }
    let at = takeover(&log).context("holds nothing that could be avoided: no intervention, no collision")?;
    if study::is_blind(&log.manifest.provenance) && !args.reveal {
        return Err(Usage("a blind drive; expected --reveal, which tells its checkpoint".into()).into());
    }
    let eye = eye_of(args, &log)?;
    let mut vision = None;
    let mut lines = Vec::new();
    for variation in 0..=args.vary {
        let (mark, key) = (mark(name, variation), key(args, &digest, &eye, variation));
        let to = library::fork_name(name, variation);
        if let Some(line) = kept(args, store, &mark, &key) {
            lines.push(Line { file: file.path.display().to_string(), recording: to, ..line });
            continue;
        }
        if interrupt.is_raised() {
            bail!("interrupted; the same command goes on from there");
        }
        let seeing = match vision.take() {
            Some(vision) => vision,
            None => Vision::new(Renderer::new(&network, &AdapterChoice::default())?, eye.clone()),
        };
        let (course, after) = variant(args, &log, &network, variation).drive(&log, &network, seeing)?;
        vision = Some(after.with_eye(eye.clone()));
        let path = args.out.join(&to);
        store.make(path.parent().unwrap_or(&args.out))?;
        maps::put_beside(log.manifest.foreign_map.as_ref(), &path)?;
        output::write_file(&path, &course.recording)?;
        let recorded = blake3::hash(&course.recording).to_hex().to_string();
        let made = line(file, (variation, to), &eye, at, course, args);
        store.keep(&mark, key.clone(), (made, recorded))?;
        // As a later call finds it: numbers lose their last digits in JSON.
        let found = kept(args, store, &mark, &key);
        lines.push(found.with_context(|| format!("{}: was changed while it was written", path.display()))?);
    }
    Ok(lines)
}

/// The name of what is kept of a fork.
fn mark(name: &str, variation: u16) -> String {
    format!("{name}/{variation}")
}

fn key(args: &Options, log: &str, eye: &Eye, variation: u16) -> Key {
    Key {
        log: log.to_owned(),
        without_intervention: args.without_intervention,
        checkpoint: eye.digest(),
        variation,
        seconds: args.seconds,
        kernel: kernel::identity(),
        program: env!("CARGO_PKG_VERSION").to_owned(),
        renderer: render::identity(),
        machine: Machine::this(),
    }
}

/// A fork that an earlier call left whole.
fn kept(args: &Options, store: &Store, mark: &str, key: &Key) -> Option<Line> {
    let (line, digest): Kept = store.find(mark, key)?;
    let bytes = files::read(&args.out.join(&line.recording), most::RECORDING).ok()?;
    (blake3::hash(&bytes).to_hex().to_string() == digest).then_some(line)
}

/// What came of a fork.
fn line(
    file: &Entry,
    (variation, recording): (u16, String),
    eye: &Eye,
    at: Tick,
    course: Course,
    args: &Options,
) -> Line {
    let otherwise = otherwise(args, variation);
    Line {
        file: file.path.display().to_string(),
        variation,
        recording,
        checkpoint: eye.name().to_owned(),
        intervention_tick: at,
        fork_tick: course.fork_tick,
        verdict: Need::of(&course, otherwise, at),
        harm_after_s: course.harm.as_ref().map(|harm| harm.seconds_after(at)),
        harm: course.harm,
        collision_after_s: course.collision.as_ref().map(|harm| harm.seconds_after(at)),
        collision: course.collision,
        recorded_harm: course.recorded_harm,
        intervention_again: course.intervention,
        closest: course.closest,
    }
}

/// What the semantic bot looks through.
fn eye_of(args: &Options, log: &Log) -> anyhow::Result<Eye> {
    let recorded = RecordedEye::of(&log.manifest.provenance)?;
    if let Some(choice) = &args.checkpoint {
        // The pictures are made as they were, so that the network alone is another.
        return Ok(Eye::open(choice)?.at(recorded.camera.imaging()));
    }
    let found = recorded.find(&args.recorded)?;
    found.with_context(|| recorded.not_found("--recorded-checkpoint"))
}

/// What a variation does otherwise than the recording.
fn otherwise(args: &Options, variation: u16) -> Otherwise {
    if args.without_intervention {
        Otherwise::NoIntervention { earlier_ticks: Tick::from(variation) * VARIATION_TICKS }
    } else {
        Otherwise::OtherEye { person: variation.into() }
    }
}

/// The fork itself, or a variation of it; both follow from the file and the number alone.
fn variant(args: &Options, log: &Log, network: &Arc<RoadNetwork>, variation: u16) -> Fork {
    let otherwise = otherwise(args, variation);
    let seed = log.manifest.scenario.seed.wrapping_add(variation.into());
    let weather = (variation > 0).then(|| Scenario::default_for(&network.name, seed).weather);
    Fork { otherwise, weather, after_ticks: Tick::from(args.seconds) * Tick::from(TICK_HZ) }
}

impl fmt::Display for Forks {
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
        let came = self.recorded_harm.as_ref().filter(|_| self.verdict == Need::InVain);
        let came =
            came.map(|harm| format!("; with the takeover: {}", harm.words(harm.seconds_after(self.intervention_tick))));
        format!("{}{variation}: {}{what}{}", self.file, self.verdict.name(), came.unwrap_or_default())
    }

    /// How close it came where nothing went wrong and nobody had to take over.
    fn near_miss(&self) -> Option<String> {
        if !matches!(self.verdict, Need::NearMiss | Need::Needless | Need::Avoided) {
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

    fn line(verdict: Need, min_ttc_s: f64, tick: Tick) -> Line {
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
    fn a_recording_and_its_case_have_forks_of_their_own() {
        let digest = blake3::hash(b"");
        let entry = |name: &str| Entry { is_case: true, path: name.into(), name: name.into(), digest };
        let both = [entry("x"), entry("x.case"), entry("y.case")];
        assert_eq!([0, 1, 2].map(|index| stem(&both, index)), ["x", "x.case", "y"]);
    }

    #[test]
    fn a_near_miss_is_told_where_nobody_had_to_take_over() {
        let words = |verdict, ttc, tick| line(verdict, ttc, tick).words();
        let near = "a.case.mcap: needless, 0.4 s from a collision with bicycle 9 0.5 s after the takeover";
        assert_eq!(words(Need::Needless, 0.4, 630), near);
        assert!(words(Need::Avoided, 1.5, 540).ends_with("1.0 s before the takeover"));
        assert_eq!(words(Need::Needless, 1.6, 630), "a.case.mcap: needless");
        assert_eq!(words(Need::Again, 0.4, 630), "a.case.mcap: again");
    }
}
