//! Says what is in a recording or case.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use anyhow::Context;
use kernel::time::{TICK_HZ, Tick};
use replay::{Note, Recording};
use serde::Serialize;

use super::drive::RunFigures;
use crate::cli::InspectArgs;
use crate::exit::Verdict;
use crate::output;

/// What is printed for a file.
#[derive(Debug, Serialize)]
struct Contents {
    file: String,
    kind: &'static str,
    bytes: u64,
    kernel: String,
    finished: bool,
    first_tick: Tick,
    last_tick: Tick,
    keyframes: usize,
    masks: usize,
    #[serde(flatten)]
    figures: RunFigures,
    map_digest: String,
    embedded_map: bool,
    provenance: BTreeMap<String, String>,
    intervention: Option<Takeover>,
    window: Option<Window>,
    events: Vec<EventLine>,
    notes: Vec<NoteLine>,
    scenario: String,
}

/// The intervention.
#[derive(Debug, Serialize)]
struct Takeover {
    tick: Tick,
    by_brake: bool,
    by_steering: bool,
    speed_mps: f32,
}

/// The window of a corner case.
#[derive(Debug, Serialize)]
struct Window {
    from: Tick,
    to: Tick,
    scenes: usize,
    source: String,
}

/// An event.
#[derive(Debug, Serialize)]
struct EventLine {
    tick: Tick,
    kind: String,
    actor: u32,
    speed_mps: f32,
}

/// Something that happened to the rig.
#[derive(Debug, Serialize)]
struct NoteLine {
    tick: Tick,
    kind: &'static str,
    seat: String,
}

impl NoteLine {
    fn of(note: &Note) -> Self {
        Self { tick: note.tick, kind: note.kind.name(), seat: format!("{:?}", note.seat).to_lowercase() }
    }
}

/// Runs `aeye inspect`.
pub fn run(args: &InspectArgs, json: bool) -> anyhow::Result<Verdict> {
    for file in &args.files {
        let contents = read(file)?;
        output::print(json, &contents, || text(&contents))?;
    }
    Ok(Verdict::Ok)
}

fn read(file: &Path) -> anyhow::Result<Contents> {
    let recording = Recording::open(file)?;
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
        first_tick: log.first_tick(),
        last_tick: log.last_tick(),
        keyframes: log.keyframes.len(),
        masks: log.masks.len(),
        figures: RunFigures::of(&recording),
        map_digest: format!("{:032x}", manifest.map_digest),
        embedded_map: manifest.foreign_map.is_some(),
        provenance: manifest.provenance.clone(),
        intervention,
        window,
        events: events.collect(),
        notes: log.notes.iter().map(NoteLine::of).collect(),
        scenario: manifest.scenario.to_toml(),
    })
}

fn text(c: &Contents) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<12} {value}");
    };
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
        let actor = if e.actor == 0 { String::new() } else { format!(", actor {}", e.actor) };
        line("event", format!("{}: {} at {:.1} km/h{actor}", at(e.tick), e.kind, 3.6 * e.speed_mps));
    }
    for n in &c.notes {
        line("note", format!("{}: {} ({} driver)", at(n.tick), n.kind, n.seat));
    }
    text.truncate(text.trim_end().len());
    text
}
