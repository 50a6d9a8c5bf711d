//! The drive that a case comes from, with its drivers and its measures.

use std::path::{Path, PathBuf};

use measures::{self, Measures};
use replay::{Log, Recording};
use study::{self, Questionnaire};

use super::fact::Fact;

/// The recording of a case's drive, or the case where that is not there.
pub struct Drive {
    /// The file's content.
    pub recording: Recording,
    /// Its measures, unless another kernel made it.
    pub measures: Option<Measures>,
    answers: Questionnaire,
}

impl Drive {
    /// That of a case at a path.
    pub fn of(path: &Path) -> anyhow::Result<Self> {
        let given = Recording::open(path)?;
        let recording = recording_beside(path, given.log()).unwrap_or(given);
        let measures = recording.network().and_then(|network| Measures::of(recording.log(), &network)).ok();
        let answers = study::answers_of(path, &recording)?;
        Ok(Self { recording, measures, answers })
    }

    /// Whether it was a drive to get used to the rig.
    pub fn is_familiarisation(&self) -> bool {
        study::is_familiarisation(&self.recording.log().manifest.provenance)
    }

    /// What is known of the drivers and how they worked together.
    pub fn facts(&self) -> Vec<Fact> {
        let mut facts = Vec::new();
        let mut add = |name, value: String| facts.push(Fact { name, value });
        let provenance = &self.recording.log().manifest.provenance;
        for (name, key) in [("Semantic driver", "semantic_name"), ("Safety driver", "safety_name")] {
            provenance.get(key).into_iter().for_each(|pseudonym| add(name, pseudonym.clone()));
        }
        let answers: Vec<String> = self.answers.answers().map(|(key, answer)| format!("{key} {answer}")).collect();
        if !answers.is_empty() {
            add("Questionnaire", answers.join("; "));
        }
        let Some(measures) = &self.measures else { return facts };
        let hazard = match self.recording.log().intervention {
            Some(_) => measures.decisive(),
            None => measures.hazards.last(),
        };
        add("Hazard", hazard.map_or_else(|| "none was predicted then".into(), |hazard| hazard.words()));
        for (name, value) in measures::human::lines(measures) {
            match name {
                "mask age" => add("Mask age", value),
                "reversals" => add("Steering reversals", value),
                _ => {}
            }
        }
        facts
    }
}

/// `NAME.mcap` beside `NAME.case.mcap`, if the case was cut from it.
fn recording_beside(path: &Path, log: &Log) -> Option<Recording> {
    let name = path.file_name()?.to_str()?.strip_suffix(".case.mcap")?;
    let beside: PathBuf = path.with_file_name(format!("{name}.mcap"));
    let recording = Recording::open(&beside).ok()?;
    (recording.digest() == log.manifest.case.as_ref()?.source).then_some(recording)
}
