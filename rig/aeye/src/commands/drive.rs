//! One run, recorded as it goes.

use std::fs::{self, File};
use std::path::Path;

use anyhow::{Context, bail};
use base::clock::Every;
use base::failure::Usage;
use base::json::Typed;
use base::library;
use base::library::case_path;
use base::maps::{self, Map};
use base::output;
use base::progress::Interrupt;
use base::room::NoRoom;
use base::say::say;
use base::setting::{Changes, Setting};
use base::words;
use drivers::simulate;
use drivers::vision::Vision;
use kernel::scenario::{EgoStart, driving_lanes};
use kernel::{Scenario, World};
use measures::RunFigures;
use perception::Compute;
use render::{AdapterChoice, Renderer};
use replay::Recording;
use serde::Serialize;
use study::{Lineup, Protocol, Study};
use viewers::server::Publisher;

use super::{plan, windows};
use crate::cli::DriveArgs;
use crate::exit::Verdict;
use crate::print::{self, print};

/// Lanes, or ranges of them, in a line of the comment that lists them.
const LANES_A_LINE: usize = 12;

/// Runs `aeye drive`.
pub fn run(args: &DriveArgs, json: bool) -> anyhow::Result<Verdict> {
    if args.headless && args.pictures.is_special() {
        let said =
            "--headless shows no pictures; expected none of --image-size, --mask-size, --inference and --screens";
        return Err(Usage(said.into()).into());
    }
    if args.study.blind.len() == 1 {
        return Err(
            Usage("--blind draws one of several; expected two or more checkpoints, as in early,full".into()).into()
        );
    }
    if library::is_case_name(args.record()) {
        return Err(
            Usage(format!("{}: is named as a corner case; expected another name", args.record().display())).into()
        );
    }
    if let Some(path) = &args.plan {
        let protocol = Protocol::read(path)?;
        return if args.print_plan {
            plan::print(&protocol, args.record(), json)
        } else {
            planned(args, protocol, json)
        };
    }
    let (scenario, map) = scenario(args)?;
    if args.print_scenario {
        print::text(&as_driven(scenario, &map)?)?;
        return Ok(Verdict::Ok);
    }
    output::check_file(args.record())?;
    if args.headless {
        headless(args, &scenario, &map, json)?;
    } else {
        windows::drive(args, scenario, map, move |path, figures| tell(path, figures, json))?;
    }
    Ok(Verdict::Ok)
}

/// Drives the trials of a protocol that are not driven yet.
fn planned(args: &DriveArgs, protocol: Protocol, json: bool) -> anyhow::Result<Verdict> {
    windows::drive_planned(args, protocol, move |path, figures| tell(path, figures, json))?;
    Ok(Verdict::Ok)
}

/// What the run starts from, and where.
fn scenario(args: &DriveArgs) -> anyhow::Result<(Scenario, Map)> {
    let setting = Setting::of(args.scenario.as_deref(), args.map.as_deref())?;
    let setting = if args.embed_map { setting.embedded() } else { setting };
    let changes = Changes {
        hazards: args.hazards,
        weather: args.weather,
        pedestrians: None,
        max_seconds: args.seconds,
        brake_threshold: args.brake_threshold,
        steer_threshold: args.steer_threshold,
    };
    Ok((setting.scenario(args.seed, &changes), setting.map))
}

/// The text of a scenario with the place where its seed puts the car, and the lanes that there are to choose from.
fn as_driven(mut scenario: Scenario, map: &Map) -> anyhow::Result<String> {
    let (lane, s_m) = scenario.start_on(&map.network)?;
    scenario.ego = EgoStart { lane: Some(lane), s_m };
    if let Some(path) = &map.path {
        // What is printed may be kept anywhere.
        scenario.map = fs::canonicalize(path).unwrap_or_else(|_| path.clone()).to_string_lossy().into_owned();
    }
    let lanes = driving_lanes(&map.network);
    let comment: String = lanes.chunks(LANES_A_LINE).map(|lanes| format!("# {}\n", lanes.join(", "))).collect();
    Ok(format!("{}\n# Driving lanes of {}, for ego.lane:\n{comment}", scenario.to_toml(), scenario.map))
}

/// What is printed of a run.
#[derive(Serialize)]
struct Driven<'a> {
    /// The recording.
    recording: String,
    /// The corner case beside it; none of drives without one, and without windows.
    case: Option<String>,
    /// What it came to.
    #[serde(flatten)]
    figures: &'a RunFigures,
}

/// A line of `aeye drive`, of a run.
impl Typed for Driven<'_> {
    const TYPE: &'static str = "aeye.drive";
}

/// Prints what a recording at a path holds.
fn tell(path: &Path, figures: &RunFigures, json: bool) -> anyhow::Result<()> {
    let case = case_path(path);
    let case = case.is_file().then(|| case.display().to_string());
    let driven = Driven { recording: path.display().to_string(), case, figures };
    print(json, &driven, || format!("{}: {figures}", path.display()))
}

fn headless(args: &DriveArgs, scenario: &Scenario, map: &Map, json: bool) -> anyhow::Result<()> {
    let study = Study::from(&args.study);
    let about = study.provenance()?;
    let pictures = (None, args.pictures.imaging.into());
    let lineup = Lineup::open(&study.candidates(&args.checkpoint), true, pictures, Compute::Cpu)?;
    let drawn = lineup.cast().draw(scenario.seed).eye_of_run(1);
    let eye = lineup.eye(drawn).clone();
    let mut manifest = simulate::manifest(scenario, map, &eye);
    manifest.provenance.extend(lineup.cast().provenance(drawn).clone());
    manifest.provenance.extend(about);
    let vision = Vision::new(Renderer::new(&map.network, &AdapterChoice::default())?, eye);
    let no_room = NoRoom::default().of_run(scenario, map)?;

    let mut publisher = args.foxglove().map(Publisher::bind).transpose()?;
    let path = args.record();
    if path.is_file() {
        bail!("{}: exists already; expected a new file", path.display());
    }
    maps::put_beside(map.foreign.as_ref(), path)?;
    let file = File::create(path).with_context(|| path.display().to_string())?;
    no_room.into_iter().for_each(say);
    let interrupt = Interrupt::listen();
    let mut second = Every::second();
    let mut waiting: Option<(String, usize)> = None;
    let keep_on = |world: &World| {
        let mut events = world.waiting_events();
        waiting = events.next().map(|first| (first.to_owned(), 1 + events.count()));
        publisher.iter_mut().for_each(|publisher| publisher.show(world));
        if second.is_due() {
            say(format_args!("tick {}", world.tick()));
        }
        !interrupt.is_raised()
    };
    simulate::drive_as(&manifest, map, vision, file, keep_on).with_context(|| path.display().to_string())?;
    if let Some((first, count)) = waiting {
        say(format_args!(
            "{}: {} of its story never began: {first:?}{}",
            path.display(),
            words::count(count, "event"),
            if count > 1 { " and others" } else { "" }
        ));
    }
    tell(path, &RunFigures::of(&Recording::open(path)?, Some(&map.network)), json)
}
