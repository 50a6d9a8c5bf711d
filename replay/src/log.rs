//! The content of a recording or case as plain data.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use kernel::arbiter::{Intervention, Outcome};
use kernel::events::Event;
use kernel::time::Tick;
use kernel::{Keyframe, RoadNetwork, Scenario, SceneSnapshot, TickInput};

use crate::{Error, FORMAT_VERSION, Mark, Note, PROGRAM, WRITTEN_BY};

/// Where a run came from, as names and values: seat drivers, checkpoint with its digest, camera,
/// latency. Nothing here steers a replay.
pub type Provenance = BTreeMap<String, String>;

/// What a run started from.
#[derive(Clone, Debug, PartialEq)]
pub struct Manifest {
    /// [`FORMAT_VERSION`](crate::FORMAT_VERSION) of the writer.
    pub format: u16,
    /// [`kernel::identity`] of the writer; only that kernel can drive the log again.
    pub kernel: String,
    /// [`kernel::ENGINES`] of the writer.
    pub engines: String,
    /// The scenario, with the map's name.
    pub scenario: Scenario,
    /// `RoadNetwork::digest`.
    pub map_digest: u128,
    /// The map's file, when it is not a bundled one.
    pub foreign_map: Option<ForeignMap>,
    /// Where the run came from.
    pub provenance: Provenance,
    /// What was cut, when this is a corner case.
    pub case: Option<CaseInfo>,
}

impl Manifest {
    /// The manifest of a new run of this program. `foreign_map` is the map's file when it is not bundled.
    pub fn new(
        scenario: &Scenario,
        network: &RoadNetwork,
        foreign_map: Option<ForeignMap>,
        mut provenance: Provenance,
    ) -> Self {
        provenance.insert(WRITTEN_BY.to_owned(), PROGRAM.to_owned());
        Self {
            format: FORMAT_VERSION,
            kernel: kernel::identity(),
            engines: kernel::ENGINES.to_owned(),
            scenario: scenario.clone(),
            map_digest: network.digest,
            foreign_map,
            provenance,
            case: None,
        }
    }
}

/// The OpenDRIVE file of a map that is not bundled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ForeignMap {
    /// blake3 of its text.
    pub digest: [u8; 32],
    /// Its text; `None` where it should be beside a log's file and is not.
    pub text: Option<Arc<str>>,
    /// Whether it stands in the log's own file, and not beside it as [`ForeignMap::file_name`].
    pub embedded: bool,
}

impl ForeignMap {
    /// A map of this text.
    pub fn new(text: impl Into<Arc<str>>, embedded: bool) -> Self {
        let text = text.into();
        Self { digest: *blake3::hash(text.as_bytes()).as_bytes(), text: Some(text), embedded }
    }

    /// The name of its file beside the recordings that were made on it, as in `map-0123456789abcdef.xodr`.
    pub fn file_name(&self) -> String {
        let digest = &blake3::Hash::from_bytes(self.digest).to_hex()[..16];
        format!("map-{digest}.xodr")
    }
}

impl Log {
    /// The tick at which a run became a corner case: that of its intervention, or the last one where it ended in a
    /// collision that nobody prevented; none where the operators say that it is no corner case.
    pub fn decided_at(&self) -> Option<Tick> {
        if self.annotation.as_ref().is_some_and(|annotation| !annotation.label.is_case()) {
            return None;
        }
        let missed = self.summary.as_ref().filter(|summary| summary.outcome == Some(Outcome::Missed));
        self.intervention.map(|intervention| intervention.tick).or(missed.map(|summary| summary.ticks))
    }

    /// Whether what was driven counts as driven; a run that the operators set aside for a fault or another reason does not.
    pub fn counts(&self) -> bool {
        self.annotation.as_ref().is_none_or(|annotation| annotation.label.counts())
    }

    /// The mask in view when the controls of a tick were given.
    pub fn mask_at(&self, tick: Tick) -> Option<&MaskShown> {
        self.masks[..self.masks.partition_point(|mask| mask.tick_shown <= tick)].last()
    }
}

/// What makes a log a corner case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CaseInfo {
    /// blake3 of the recording it was cut from.
    pub source: [u8; 32],
    /// First tick of the window.
    pub from: Tick,
    /// Last tick of the window: the intervention, the collision of a missed one, or where an operator
    /// ended it.
    pub to: Tick,
}

/// Wall-clock times of a frame in a live drive, microseconds since the session began.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LiveTimes {
    /// The scene was captured.
    pub capture_us: u64,
    /// The prediction was there.
    pub inference_us: u64,
    /// The mask was on the screen.
    pub present_us: u64,
}

/// A mask that came onto the semantic driver's screen. The replayer never reads it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MaskShown {
    /// The first tick whose controls were given with this mask in view.
    pub tick_shown: Tick,
    /// The tick that the mask is a picture of.
    pub tick_of_frame: Tick,
    /// Number of the camera; 0 is the driver's.
    pub camera: u8,
    /// First 8 bytes of a digest of the mask.
    pub digest: u64,
    /// Wall-clock times, in live drives only: simulated recordings compare byte for byte.
    pub times: Option<LiveTimes>,
}

impl MaskShown {
    /// How old the mask's picture is at a tick, ticks.
    pub fn age_at(&self, tick: Tick) -> Tick {
        tick.saturating_sub(self.tick_of_frame)
    }
}

/// What was said of how a run ended: what kind of corner case it was (paper, section 3), or that it is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Label {
    /// A walker was overlooked.
    Walker = 0,
    /// A vehicle was overlooked.
    Vehicle = 1,
    /// Traffic rules were disregarded.
    Rules = 2,
    /// The safety driver intervened out of boredom.
    Boredom = 3,
    /// No corner case: the semantic driver erred at what the mask showed well. What was driven counts.
    DriverError = 4,
    /// No corner case: the rig failed. The run does not count.
    TechnicalFault = 5,
    /// No corner case: the run does not count for another reason, which the comment says.
    Discarded = 6,
}

impl Label {
    /// The kinds of corner cases, in the order of their codes.
    pub const CASES: [Self; 4] = [Self::Walker, Self::Vehicle, Self::Rules, Self::Boredom];
    /// Why a run is no corner case, in the order of their codes.
    pub const SET_ASIDE: [Self; 3] = [Self::DriverError, Self::TechnicalFault, Self::Discarded];

    /// Every label, in the order of their codes.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::CASES.into_iter().chain(Self::SET_ASIDE)
    }

    /// Whether it is a kind of corner case.
    pub fn is_case(self) -> bool {
        Self::CASES.contains(&self)
    }

    /// Whether what was driven counts as driven.
    pub fn counts(self) -> bool {
        !matches!(self, Self::TechnicalFault | Self::Discarded)
    }

    /// The name that files and commands use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Walker => "walker",
            Self::Vehicle => "vehicle",
            Self::Rules => "rules",
            Self::Boredom => "boredom",
            Self::DriverError => "driver-error",
            Self::TechnicalFault => "technical-fault",
            Self::Discarded => "discarded",
        }
    }
}

impl fmt::Display for Label {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Label {
    type Err = Error;

    /// The kind of corner case with a name.
    fn from_str(text: &str) -> Result<Self, Error> {
        let label = Self::CASES.into_iter().find(|l| l.name() == text);
        label.ok_or_else(|| Error::Unsuited(format!("label {text:?}: expected walker, vehicle, rules or boredom")))
    }
}

/// What the operators, or the truth, say about the end of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Annotation {
    /// What kind of corner case, or why none.
    pub label: Label,
    /// Anything worth saying; may be empty.
    pub comment: String,
    /// Whether the run needs no intervention when driven by true masks; unknown when nobody tried.
    pub perception_caused: Option<bool>,
}

/// How a run went.
#[derive(Clone, Debug, PartialEq)]
pub struct RunSummary {
    /// Last tick.
    pub ticks: Tick,
    /// Distance driven, millimetres.
    pub odometer_mm: u64,
    /// The intervention, if there was one.
    pub intervention: Option<Intervention>,
    /// How the run ended; `None` when it was stopped from outside.
    pub outcome: Option<Outcome>,
}

/// Everything a recording or case holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Log {
    /// What the run started from.
    pub manifest: Manifest,
    /// States by ascending tick. The first is the start; the log's ticks follow it.
    pub keyframes: Vec<Keyframe>,
    /// The input of each tick after the first keyframe.
    pub inputs: Vec<TickInput>,
    /// The low 32 bits of the hash of each of these ticks.
    pub hashes: Vec<u32>,
    /// Full hashes: after every second, at an intervention, and at the end.
    pub marks: Vec<Mark>,
    /// Events with their ticks, by ascending tick.
    pub events: Vec<(Tick, Event)>,
    /// The intervention, if there was one.
    pub intervention: Option<Intervention>,
    /// Masks shown, by ascending tick.
    pub masks: Vec<MaskShown>,
    /// What happened to the rig, by ascending tick.
    pub notes: Vec<Note>,
    /// What was said about the intervention.
    pub annotation: Option<Annotation>,
    /// How the run went; `None` in a file whose writer was stopped.
    pub summary: Option<RunSummary>,
    /// Snapshots of the window of a corner case, by ascending tick; empty in recordings.
    pub scenes: Vec<SceneSnapshot>,
}

impl Log {
    /// The tick of the first keyframe; 0 in recordings.
    pub fn first_tick(&self) -> Tick {
        self.keyframes.first().map_or(0, |k| k.tick)
    }

    /// The last tick.
    pub fn last_tick(&self) -> Tick {
        self.first_tick() + self.inputs.len() as Tick
    }

    /// Millimetres driven, as far as the file says.
    pub fn odometer_mm(&self) -> u64 {
        let last_mark = || self.marks.last().map_or(0, |mark| mark.odometer_mm);
        self.summary.as_ref().map_or_else(last_mark, |summary| summary.odometer_mm)
    }

    /// The input of a tick after the first.
    pub fn input(&self, tick: Tick) -> Option<&TickInput> {
        self.inputs.get(self.index(tick)?)
    }

    /// The low 32 bits of the hash of a tick after the first.
    pub fn hash(&self, tick: Tick) -> Option<u32> {
        self.hashes.get(self.index(tick)?).copied()
    }

    /// The keyframe of a tick, if there is one.
    pub fn keyframe(&self, tick: Tick) -> Option<&Keyframe> {
        let at = self.keyframes.binary_search_by_key(&tick, |k| k.tick).ok()?;
        Some(&self.keyframes[at])
    }

    /// The mark at a tick, if there is one.
    pub fn mark(&self, tick: Tick) -> Option<&Mark> {
        let at = self.marks.binary_search_by_key(&tick, |m| m.tick).ok()?;
        Some(&self.marks[at])
    }

    fn index(&self, tick: Tick) -> Option<usize> {
        usize::try_from(tick.checked_sub(self.first_tick() + 1)?).ok()
    }
}
