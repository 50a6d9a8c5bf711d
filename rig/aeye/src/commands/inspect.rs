//! Says what is in a recording or case.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::Context;
use base::failure::{Failed, Failure};
use base::json::Typed;
use base::library::{self, Found, Kind};
use base::spread::{in_order, jobs};
use base::words;
use kernel::time::{TICK_HZ, Tick};
use measures::{Criticality, Measures, RunFigures, Tally, human};
use replay::{Note, Recording};
use serde::Serialize;
use study::Questionnaire;

use crate::cli::InspectArgs;
use crate::exit::Verdict;
use crate::print::print;

/// What is printed for a file.
#[derive(Debug, Serialize)]
struct Contents {
    /// The file.
    file: String,
    /// `recording` or `case`.
    kind: &'static str,
    /// Size of the file, bytes.
    bytes: u64,
    /// Version of the kernel that made it.
    kernel: String,
    /// Whether its writer came to its end.
    finished: bool,
    /// Whether the drivers did not know the checkpoint.
    blind: bool,
    /// The first tick.
    first_tick: Tick,
    /// The last tick.
    last_tick: Tick,
    /// Number of keyframes.
    keyframes: usize,
    /// Number of masks that were shown.
    masks: usize,
    #[serde(flatten)]
    figures: RunFigures,
    /// Digest of the map, hexadecimal.
    map_digest: String,
    /// Whether the file holds its map.
    embedded_map: bool,
    /// How it came about, by name.
    provenance: BTreeMap<String, String>,
    /// What the drivers answered.
    questionnaire: Questionnaire,
    /// The intervention, if there was one.
    intervention: Option<Takeover>,
    /// The window, of a corner case.
    window: Option<Window>,
    /// What happened in the world.
    events: Vec<EventLine>,
    /// What happened to the rig.
    notes: Vec<NoteLine>,
    /// How the drivers did.
    measures: Option<Measures>,
    /// Why there are no measures.
    unmeasured: Option<String>,
    /// Of a corner case.
    criticality: Option<Criticality>,
    /// What the run started from, as TOML.
    scenario: String,
}

/// A line of `aeye inspect`, of a file.
impl Typed for Contents {
    const TYPE: &'static str = "aeye.inspect";
}

/// What is printed after several files.
#[derive(Serialize)]
struct Overall {
    /// `overall`.
    kind: &'static str,
    /// Files that it is about.
    files: usize,
    #[serde(flatten)]
    tally: Tally,
    /// Files that were left out, and why.
    failed: Vec<Failure>,
}

/// The last line of `aeye inspect` of several files.
impl Typed for Overall {
    const TYPE: &'static str = "aeye.inspect.overall";
}

/// The intervention.
#[derive(Debug, Serialize)]
struct Takeover {
    /// When.
    tick: Tick,
    /// Whether the brake was beyond its threshold.
    by_brake: bool,
    /// Whether the steering was beyond its threshold.
    by_steering: bool,
    /// Speed of the ego car, m/s.
    speed_mps: f32,
}

/// The window of a corner case.
#[derive(Debug, Serialize)]
struct Window {
    /// The first tick.
    from: Tick,
    /// The last tick.
    to: Tick,
    /// Scenes that the case holds.
    scenes: usize,
    /// BLAKE3 of the recording that it was cut from.
    source: String,
}

/// An event.
#[derive(Debug, Serialize)]
struct EventLine {
    #[serde(skip)]
    words: String,
    /// When.
    tick: Tick,
    /// What.
    kind: String,
    /// Number of the other road user, if there is one.
    actor: u32,
    /// Speed of the ego car, m/s.
    speed_mps: f32,
}

/// Something that happened to the rig.
#[derive(Debug, Serialize)]
struct NoteLine {
    /// When.
    tick: Tick,
    /// What.
    kind: &'static str,
    /// Whose unit: `semantic` or `safety`.
    seat: String,
}

impl NoteLine {
    fn of(note: &Note) -> Self {
        Self { tick: note.tick, kind: note.kind.name(), seat: words::seat(note.seat).into() }
    }
}

/// Runs `aeye inspect`.
pub fn run(args: &InspectArgs, json: bool) -> anyhow::Result<Verdict> {
    let (mut seen, mut verdict) = (Vec::new(), Verdict::Ok);
    let Found { files, mut failed } = library::find(&args.files, Kind::All);
    in_order(
        jobs(args.jobs),
        files.len(),
        |index| look(&files[index].path, args.reveal),
        |index, looked| {
            match looked {
                Ok((recording, contents, diverged)) => {
                    if diverged {
                        verdict = Verdict::CheckFailed;
                    }
                    print(json, &contents, || text(&contents))?;
                    seen.push((recording, contents.measures));
                }
                Err(error) => failed.push(Failure::new(&files[index].path, &error)),
            }
            Ok(())
        },
    )?;
    // A text about several of which one is left would say the same twice.
    if seen.len() > 1 || json && seen.len() + failed.len() > 1 {
        let tally = Tally::of(seen.iter().map(|(recording, measures)| (recording, measures.as_ref())));
        let overall = Overall { kind: "overall", files: seen.len(), tally, failed: failed.clone() };
        print(json, &overall, || paragraph(overall.tally.lines()))?;
    }
    Failed::check(&failed, seen.len())?;
    Ok(verdict)
}

/// A file, what is printed for it, and whether its replay is not the run that was recorded.
fn look(file: &Path, reveal: bool) -> anyhow::Result<(Recording, Contents, bool)> {
    let recording = Recording::open(file)?;
    let measured = measure(&recording);
    let diverged = matches!(measured, Err(replay::Error::Diverged(_)));
    let contents = read(file, &recording, measured, reveal)?;
    Ok((recording, contents, diverged))
}

/// The measures of a recording, or why there are none.
fn measure(recording: &Recording) -> Result<Measures, replay::Error> {
    Measures::of(recording.log(), &recording.network()?)
}

fn read(
    file: &Path,
    recording: &Recording,
    measured: Result<Measures, replay::Error>,
    reveal: bool,
) -> anyhow::Result<Contents> {
    let bytes = std::fs::metadata(file).with_context(|| file.display().to_string())?.len();
    let log = recording.log();
    let manifest = &log.manifest;
    let window = manifest.case.as_ref().map(|case| Window {
        from: case.from,
        to: case.to,
        scenes: log.scenes.len(),
        source: case.source.iter().map(|b| format!("{b:02x}")).collect(),
    });
    let intervention = log.intervention.map(|i| Takeover {
        tick: i.tick,
        by_brake: i.by_brake,
        by_steering: i.by_steering,
        speed_mps: i.speed_mps,
    });
    let events = log.events.iter().map(|(tick, e)| EventLine {
        words: words::event(e),
        tick: *tick,
        kind: format!("{:?}", e.kind),
        actor: e.actor,
        speed_mps: e.speed_mps,
    });
    Ok(Contents {
        file: file.display().to_string(),
        kind: if window.is_some() { "case" } else { "recording" },
        bytes,
        kernel: manifest.kernel.clone(),
        finished: recording.finished(),
        blind: study::is_blind(&manifest.provenance),
        first_tick: log.first_tick(),
        last_tick: log.last_tick(),
        keyframes: log.keyframes.len(),
        masks: log.masks.len(),
        figures: RunFigures::of(recording),
        map_digest: format!("{:032x}", manifest.map_digest),
        embedded_map: manifest.foreign_map.is_some(),
        provenance: study::tellable(&manifest.provenance, reveal),
        questionnaire: study::answers_of(file, recording)?,
        intervention,
        window,
        events: events.collect(),
        notes: log.notes.iter().map(NoteLine::of).collect(),
        unmeasured: measured.as_ref().err().map(ToString::to_string),
        measures: measured.ok(),
        criticality: recording.network().and_then(|network| Criticality::of_case(log, &network)).ok().flatten(),
        scenario: manifest.scenario.to_toml(),
    })
}

/// Names and values as lines.
fn paragraph(lines: Vec<(impl AsRef<str>, String)>) -> String {
    let lines: Vec<String> = lines.iter().map(|(name, value)| format!("{:<12} {value}", name.as_ref())).collect();
    lines.join("\n")
}

fn text(c: &Contents) -> String {
    let mut lines: Vec<(String, String)> = Vec::new();
    let mut line = |name: &str, value: String| lines.push((name.to_owned(), value));
    let at = |tick: Tick| format!("tick {tick} ({:.2} s)", tick as f64 / f64::from(TICK_HZ));
    line("file", format!("{} ({}, {} bytes)", c.file, c.kind, c.bytes));
    line("map", format!("{}{}", c.figures.map, if c.embedded_map { " (embedded)" } else { "" }));
    line("seed", c.figures.seed.to_string());
    line("ticks", format!("{} to {}{}", c.first_tick, c.last_tick, if c.finished { "" } else { " (cut off)" }));
    line("driven", format!("{:.3} km, {:.2} min, {}", c.figures.km, c.figures.minutes, c.figures.outcome));
    line("holds", format!("{} keyframes, {} masks, {} events", c.keyframes, c.masks, c.events.len()));
    for (name, value) in &c.provenance {
        line(name, value.clone());
    }
    if c.figures.familiarisation {
        line("counts", "no: a drive to get used to the rig".into());
    }
    for (question, answer) in c.questionnaire.answers() {
        line("answer", format!("{question} = {answer}"));
    }
    if let Some(i) = &c.intervention {
        line("takeover", format!("{} at {:.1} km/h", at(i.tick), 3.6 * i.speed_mps));
    }
    if let (Some(label), Some(comment)) = (c.figures.label, &c.figures.comment) {
        let by = match c.figures.perception_caused {
            Some(true) => ", caused by perception",
            Some(false) => ", not caused by perception",
            None => "",
        };
        line("label", format!("{label}: {comment}{by}"));
    }
    if let Some(w) = &c.window {
        line("window", format!("ticks {} to {}, {} scenes", w.from, w.to, w.scenes));
    }
    for e in &c.events {
        line("event", format!("{}: {}", at(e.tick), e.words));
    }
    for n in &c.notes {
        line("note", format!("{}: {} ({} driver)", at(n.tick), n.kind, n.seat));
    }
    match (&c.measures, &c.unmeasured) {
        (Some(measures), _) => human::lines(measures).into_iter().for_each(|(name, value)| line(name, value)),
        (None, why) => line("measures", format!("none: {}", why.as_deref().unwrap_or_default())),
    }
    for (name, value) in c.criticality.iter().flat_map(Criticality::lines) {
        line(name, value);
    }
    paragraph(lines)
}
