//! One run, recorded as it goes.

use std::fs::File;
use std::path::Path;

use anyhow::{Context, bail};
use kernel::arbiter::Outcome;
use kernel::{Scenario, World};
use perception::Compute;
use render::{RenderOptions, Renderer};
use replay::{Label, Recording};
use serde::Serialize;

use crate::cli::DriveArgs;
use crate::clock::EverySecond;
use crate::exit::{Usage, Verdict};
use crate::lab::library;
use crate::live;
use crate::live::foxglove::Publisher;
use crate::maps::{Map, read_scenario};
use crate::output;
use crate::progress::Interrupt;
use crate::simulate;
use crate::study::{self, Lineup};
use crate::vision::Vision;

/// Map of a drive when none is named.
const DEFAULT_MAP: &str = "city";

/// What a drive came to, or what a recording holds of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunFigures {
    /// Name of the map.
    pub map: String,
    /// Seed of the run.
    pub seed: u64,
    /// Kilometres driven.
    pub km: f64,
    /// Simulated minutes.
    pub minutes: f64,
    /// `intervened`, `missed`, `censored`, or `stopped` when it was ended from outside.
    pub outcome: &'static str,
    /// Whether it was a drive to get used to the rig, which does not count.
    pub familiarisation: bool,
    /// What kind of corner case, if it is one.
    pub label: Option<&'static str>,
    /// What is to be seen in the corner case.
    pub comment: Option<String>,
    /// Whether true masks avoid the intervention; unknown without one.
    pub perception_caused: Option<bool>,
}

impl RunFigures {
    /// Those of a recording.
    pub fn of(recording: &Recording) -> Self {
        let log = recording.log();
        let outcome = log.summary.as_ref().and_then(|s| s.outcome);
        let annotation = log.annotation.as_ref();
        Self {
            map: log.manifest.scenario.map.clone(),
            seed: log.manifest.scenario.seed,
            km: log.odometer_mm() as f64 / 1e6,
            minutes: log.last_tick() as f64 / f64::from(60 * kernel::time::TICK_HZ),
            outcome: outcome_name(outcome),
            familiarisation: study::is_familiarisation(&log.manifest.provenance),
            label: annotation.map(|a| Label::name(a.label)),
            comment: annotation.map(|a| a.comment.clone()),
            perception_caused: annotation.and_then(|a| a.perception_caused),
        }
    }
}

impl RunFigures {
    /// Prints those of a recording at a path.
    pub fn print(&self, path: &Path, json: bool) -> anyhow::Result<()> {
        output::print(json, self, || {
            let label = self.label.map(|l| format!(" ({l})")).unwrap_or_default();
            let practice = if self.familiarisation { ", familiarisation: does not count" } else { "" };
            let Self { km, minutes, outcome, .. } = self;
            format!("{}: {km:.3} km in {minutes:.1} min, {outcome}{label}{practice}", path.display())
        })
    }
}

fn outcome_name(outcome: Option<Outcome>) -> &'static str {
    match outcome {
        Some(Outcome::Intervened) => "intervened",
        Some(Outcome::Missed) => "missed",
        Some(Outcome::Censored) => "censored",
        None => "stopped",
    }
}

/// Runs `aeye drive`.
pub fn run(args: &DriveArgs, json: bool) -> anyhow::Result<Verdict> {
    if args.headless && args.pictures.is_special() {
        let said =
            "--headless shows no pictures; expected none of --image-size, --mask-size, --inference and --screens";
        return Err(Usage(said.into()).into());
    }
    if library::is_case_name(&args.record) {
        return Err(
            Usage(format!("{}: is named as a corner case; expected another name", args.record.display())).into()
        );
    }
    let (mut scenario, map) = match &args.scenario {
        Some(path) => read_scenario(path)?,
        None => {
            let map = Map::find(args.map.as_deref().unwrap_or(DEFAULT_MAP))?;
            (map.scenario(args.seed.unwrap_or(1)), map)
        }
    };
    scenario.seed = args.seed.unwrap_or(scenario.seed);
    let rules = &mut scenario.rules;
    rules.max_seconds = args.seconds.unwrap_or(rules.max_seconds);
    rules.brake_threshold = args.brake_threshold.unwrap_or(rules.brake_threshold);
    rules.steer_threshold = args.steer_threshold.unwrap_or(rules.steer_threshold);
    if args.headless { headless(args, &scenario, &map, json) } else { live::drive(args, scenario, map, json) }
}

fn headless(args: &DriveArgs, scenario: &Scenario, map: &Map, json: bool) -> anyhow::Result<Verdict> {
    let about = args.study.provenance()?;
    let mut lineup = Lineup::open(&args.study, &args.checkpoint, None, Compute::Cpu, scenario.seed)?;
    let eye = lineup.of_run(1).clone();
    let mut manifest = simulate::manifest(scenario, map, &eye);
    manifest.provenance.extend(lineup.cast().provenance_of_run(1).clone());
    manifest.provenance.extend(about);
    let vision = Vision::new(Renderer::new(&map.network, &RenderOptions::default())?, eye);
    World::new(scenario, &map.network)?;

    let mut publisher = args.foxglove.map(Publisher::bind).transpose()?;
    let path = &args.record;
    if path.is_file() {
        bail!("{}: exists already; expected a new file", path.display());
    }
    let file = File::create(path).with_context(|| path.display().to_string())?;
    let interrupt = Interrupt::listen()?;
    let mut second = EverySecond::new();
    let keep_on = |world: &World| {
        publisher.iter_mut().for_each(|publisher| publisher.show(world));
        if second.is_due() {
            eprintln!("tick {}", world.tick());
        }
        !interrupt.is_raised()
    };
    simulate::drive_as(&manifest, map, vision, file, keep_on).with_context(|| path.display().to_string())?;
    RunFigures::of(&Recording::open(path)?).print(path, json)?;
    Ok(Verdict::Ok)
}
