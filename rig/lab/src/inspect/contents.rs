//! What there is to say about a recording or case, and about several.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use anyhow::Context;
use base::failure::Failure;
use base::json::Typed;
use base::words;
use kernel::RoadNetwork;
use kernel::time::Tick;
use measures::{Criticality, Measures, RunFigures, Tally};
use replay::{Note, Recording};
use serde::Serialize;
use study::Questionnaire;

/// What is printed for a file.
#[derive(Debug, Serialize)]
pub struct Contents {
    /// The file.
    pub file: String,
    /// `recording` or `case`.
    pub kind: &'static str,
    /// Size of the file, bytes.
    pub bytes: u64,
    /// Version of the kernel that made it.
    pub kernel: String,
    /// Whether its writer came to its end.
    pub finished: bool,
    /// Whether the drivers did not know the checkpoint.
    pub blind: bool,
    /// The first tick.
    pub first_tick: Tick,
    /// The last tick.
    pub last_tick: Tick,
    /// Number of keyframes.
    pub keyframes: usize,
    /// Number of masks that were shown.
    pub masks: usize,
    /// What its run came to.
    #[serde(flatten)]
    pub figures: RunFigures,
    /// Digest of the map, hexadecimal.
    pub map_digest: String,
    /// Whether the file holds its map.
    pub embedded_map: bool,
    /// How it came about, by name.
    pub provenance: BTreeMap<String, String>,
    /// What the drivers answered.
    pub questionnaire: Questionnaire,
    /// The intervention, if there was one.
    pub intervention: Option<Takeover>,
    /// The window, of a corner case.
    pub window: Option<Window>,
    /// What happened in the world.
    pub events: Vec<EventLine>,
    /// What happened to the rig.
    pub notes: Vec<NoteLine>,
    /// How the drivers did.
    pub measures: Option<Measures>,
    /// Why there are no measures.
    pub unmeasured: Option<String>,
    /// Of a corner case.
    pub criticality: Option<Criticality>,
    /// What the run started from, as TOML.
    pub scenario: String,
}

/// A line of `aeye inspect`, of a file.
impl Typed for Contents {
    const TYPE: &'static str = "aeye.inspect";
}

/// What is printed after several files.
#[derive(Serialize)]
pub struct Overall {
    /// `overall`.
    pub kind: &'static str,
    /// Files that it is about.
    pub files: usize,
    /// What they have in common.
    #[serde(flatten)]
    pub tally: Tally,
    /// Files that were left out, and why.
    pub failed: Vec<Failure>,
}

/// The last line of `aeye inspect` of several files.
impl Typed for Overall {
    const TYPE: &'static str = "aeye.inspect.overall";
}

/// The intervention.
#[derive(Debug, Serialize)]
pub struct Takeover {
    /// When.
    pub tick: Tick,
    /// Whether the brake was beyond its threshold.
    pub by_brake: bool,
    /// Whether the steering was beyond its threshold.
    pub by_steering: bool,
    /// Speed of the ego car, m/s.
    pub speed_mps: f32,
}

/// The window of a corner case.
#[derive(Debug, Serialize)]
pub struct Window {
    /// The first tick.
    pub from: Tick,
    /// The last tick.
    pub to: Tick,
    /// Scenes that the case holds.
    pub scenes: usize,
    /// BLAKE3 of the recording that it was cut from.
    pub source: String,
}

/// An event.
#[derive(Debug, Serialize)]
pub struct EventLine {
    #[serde(skip)]
    pub(super) words: String,
    /// When.
    pub tick: Tick,
    /// What.
    pub kind: String,
    /// Number of the other road user, if there is one.
    pub actor: u32,
    /// Speed of the ego car, m/s.
    pub speed_mps: f32,
}

/// Something that happened to the rig.
#[derive(Debug, Serialize)]
pub struct NoteLine {
    /// When.
    pub tick: Tick,
    /// What.
    pub kind: &'static str,
    /// Whose unit: `semantic` or `safety`; absent where it happened to all of the rig.
    pub seat: Option<&'static str>,
}

impl NoteLine {
    fn of(note: &Note) -> Self {
        Self { tick: note.tick, kind: note.kind.name(), seat: note.seat.map(words::seat) }
    }
}

impl Contents {
    /// Those of a file that holds this recording, with its map where that is there, and its measures or why there are
    /// none.
    pub(super) fn read(
        file: &Path,
        recording: &Recording,
        (network, measured): (Option<&Arc<RoadNetwork>>, Result<Measures, replay::Error>),
        reveal: bool,
    ) -> anyhow::Result<Self> {
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
        Ok(Self {
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
            figures: RunFigures::of(recording, network),
            map_digest: format!("{:032x}", manifest.map_digest),
            embedded_map: manifest.foreign_map.as_ref().is_some_and(|map| map.embedded),
            provenance: study::tellable(&manifest.provenance, reveal),
            questionnaire: study::answers_of(file, recording)?,
            intervention,
            window,
            events: events.collect(),
            notes: log.notes.iter().map(NoteLine::of).collect(),
            unmeasured: measured.as_ref().err().map(ToString::to_string),
            measures: measured.ok(),
            criticality: network.and_then(|network| Criticality::of_case(log, network).ok().flatten()),
            scenario: manifest.scenario.to_toml(),
        })
    }
}
