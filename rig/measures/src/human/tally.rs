//! Measures over several recordings. Familiarisation drives are counted, and left out of the rest.

use std::collections::BTreeSet;

use kernel::arbiter::Outcome;
use replay::{Label, Recording};
use serde::Serialize;

use super::{HazardTimes, Measures, Spread};

/// What several recordings have in common.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Tally {
    /// Runs that count.
    pub runs: u32,
    /// Runs that do not: drives for familiarisation.
    pub familiarisation_runs: u32,
    /// Runs that operators discarded, or in which the rig failed.
    pub discarded_runs: u32,
    /// Runs that ended by an intervention.
    pub interventions: u32,
    /// Of these, those with a label.
    pub labelled: u32,
    /// Of these, those out of boredom.
    pub boredom: u32,
    /// `boredom` of `labelled`; `None` without labels.
    pub boredom_share: Option<f64>,
    /// Kilometres over which hazards were counted.
    pub km: f64,
    /// Hazards.
    pub hazards: u32,
    /// Hazards a kilometre; `None` without kilometres.
    pub hazards_per_km: Option<f64>,
    /// Of the hazards, those that a mistake of another brought about.
    pub hazards_by_mistakes: u32,
    /// These a kilometre.
    pub hazards_by_mistakes_per_km: Option<f64>,
    /// From a hazard to the semantic driver's first reaction.
    pub semantic_reaction_ms: Option<Spread>,
    /// From a hazard to the semantic driver's "I see it".
    pub semantic_seen_ms: Option<Spread>,
    /// From a hazard to the safety driver's first reaction.
    pub safety_reaction_ms: Option<Spread>,
    /// From a hazard to the safety driver's "I see it".
    pub safety_seen_ms: Option<Spread>,
    /// From a hazard to the intervention.
    pub intervention_ms: Option<Spread>,
}

impl Tally {
    /// That of recordings and cases with their measures, where these are known. A case counts as the
    /// recording that it was cut from, once: by the recording if that is among them, else by a cut with
    /// the intervention.
    pub fn of<'a>(files: impl IntoIterator<Item = (&'a Recording, Option<&'a Measures>)>) -> Self {
        let (mut tally, mut counted, mut hazards) = (Self::default(), BTreeSet::new(), Vec::new());
        let mut files: Vec<_> = files.into_iter().collect();
        files.sort_by_key(|(recording, _)| {
            let log = recording.log();
            (log.manifest.case.is_some(), log.intervention.is_none())
        });
        for (recording, measures) in files {
            let log = recording.log();
            if !counted.insert(recording.source()) {
                continue;
            }
            if study::is_familiarisation(&log.manifest.provenance) {
                tally.familiarisation_runs += 1;
                continue;
            }
            if !log.counts() {
                tally.discarded_runs += 1;
                continue;
            }
            tally.add_run(recording);
            tally.km += measures.map_or(0.0, |m| m.km);
            hazards.extend(measures.into_iter().flat_map(|m| &m.hazards));
        }
        tally.boredom_share = (tally.labelled > 0).then(|| f64::from(tally.boredom) / f64::from(tally.labelled));
        tally.add_hazards(&hazards);
        tally
    }

    fn add_run(&mut self, recording: &Recording) {
        let log = recording.log();
        let outcome = log.summary.as_ref().and_then(|summary| summary.outcome);
        self.runs += 1;
        if log.decided_at().is_none() || log.intervention.is_none() || outcome == Some(Outcome::Missed) {
            return;
        }
        self.interventions += 1;
        if let Some(annotation) = &log.annotation {
            self.labelled += 1;
            self.boredom += u32::from(annotation.label == Label::Boredom);
        }
    }

    pub(super) fn add_hazards(&mut self, hazards: &[&HazardTimes]) {
        let spread = |time: &dyn Fn(&HazardTimes) -> Option<u64>| {
            Spread::of(hazards.iter().filter_map(|hazard| time(hazard)).map(|ms| ms as f64).collect())
        };
        let per_km = |n: u32| (self.km > 0.0).then(|| f64::from(n) / self.km);
        self.hazards = hazards.len() as u32;
        self.hazards_by_mistakes = hazards.iter().filter(|h| h.episode.mistake.is_some()).count() as u32;
        self.hazards_per_km = per_km(self.hazards);
        self.hazards_by_mistakes_per_km = per_km(self.hazards_by_mistakes);
        self.semantic_reaction_ms = spread(&|h| h.semantic.reaction_ms);
        self.semantic_seen_ms = spread(&|h| h.semantic.seen_ms);
        self.safety_reaction_ms = spread(&|h| h.safety.reaction_ms);
        self.safety_seen_ms = spread(&|h| h.safety.seen_ms);
        self.intervention_ms = spread(&|h| h.intervention_ms);
    }
}
