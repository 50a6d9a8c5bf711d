//! What is known of a case without simulating it: from its header, and from what a campaign wrote beside it.

use std::path::Path;

use base::words;
use kernel::time::Tick;
use kernel::traffic::{HazardLevel, HazardRates};
use replay::{CaseHeader, Label};

use super::conditions;
use super::situation::{Situation, Spot, next_ahead};
use crate::redrive::{Counterfactual, Need};

/// Digits of a recording's digest that an identity has.
const IDENTITY_DIGITS: usize = 32;

/// What is known of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Facts {
    /// What stays the same wherever the case is and however often it is cut and labelled: of which recording, and when.
    pub identity: String,
    /// BLAKE3 of its file.
    pub digest: [u8; 32],
    /// What it was labelled as.
    pub label: Option<Label>,
    /// What was said about it.
    pub comment: Option<String>,
    /// Whether true masks avoid it.
    pub perception_caused: Option<bool>,
    /// Name of the checkpoint that was driven with.
    pub checkpoint: Option<String>,
    /// Its digest, hexadecimal, or `truth`.
    pub checkpoint_digest: Option<String>,
    /// Whether the drivers did not know it.
    pub blind: bool,
    /// Name of the map.
    pub map: String,
    /// Seed of the run.
    pub seed: u64,
    /// Version of the kernel that made it.
    pub kernel: String,
    /// How often people at the wheel endangered others: the level's name, or `own`.
    pub hazards: &'static str,
    /// CARLA's name of the weather at the takeover.
    pub weather: Option<&'static str>,
    /// The same in words, as [`conditions::bits`].
    pub conditions: i64,
    /// Tick of the takeover.
    pub tick: Tick,
    /// Who was next ahead, at which distance in metres.
    pub nearest: Option<(&'static str, f64)>,
    /// Digest of the map.
    pub map_digest: [u8; 16],
    /// Where the ego car was.
    pub spot: Option<Spot>,
    /// How fast it was, m/s.
    pub speed_mps: f64,
    /// Whether the takeover was needed, where that was tried.
    pub verdict: Option<Need>,
    /// Least time to collision without the takeover, seconds.
    pub fork_min_ttc_s: Option<f64>,
}

impl Facts {
    /// Those of a file.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let header = CaseHeader::open(path)?;
        Ok(Self::of(&header, Counterfactual::beside(path, &header.info.source).as_ref()))
    }

    /// Those of a case, and of what would have happened without its intervention.
    pub fn of(header: &CaseHeader, counterfactual: Option<&Counterfactual>) -> Self {
        let CaseHeader { manifest, info, annotation, summary, scene, digest } = header;
        let said = |name: &str| manifest.provenance.get(name).cloned();
        let weather = scene.as_ref().map_or_else(|| manifest.scenario.weather_at(info.to), |scene| scene.weather);
        let intervention = summary.as_ref().and_then(|summary| summary.intervention).filter(|i| i.tick == info.to);
        let speed_mps = intervention.map(|intervention| intervention.speed_mps);
        let speed_mps = speed_mps.or_else(|| Some(scene.as_ref()?.ego.speed_mps)).filter(|speed| speed.is_finite());
        let ahead = scene.as_ref().and_then(next_ahead);
        Self {
            identity: identity(&info.source, info.to),
            digest: *digest,
            label: annotation.as_ref().map(|annotation| annotation.label),
            comment: annotation.as_ref().map(|annotation| annotation.comment.clone()).filter(|text| !text.is_empty()),
            perception_caused: annotation.as_ref().and_then(|annotation| annotation.perception_caused),
            checkpoint: said("checkpoint"),
            checkpoint_digest: said("checkpoint_digest"),
            blind: study::is_blind(&manifest.provenance),
            map: manifest.scenario.map.clone(),
            seed: manifest.scenario.seed,
            kernel: manifest.kernel.clone(),
            hazards: level(&manifest.scenario.hazards),
            weather: conditions::preset(&weather),
            conditions: conditions::bits(&weather),
            tick: info.to,
            nearest: ahead.map(|(actor, m)| (words::road_user(actor.kind), m.into())),
            map_digest: manifest.map_digest.to_le_bytes(),
            spot: scene.as_ref().map(Spot::of).filter(Spot::is_finite),
            speed_mps: speed_mps.unwrap_or_default().into(),
            verdict: counterfactual.map(|counterfactual| counterfactual.verdict),
            fork_min_ttc_s: counterfactual.and_then(|it| it.closest.min_ttc_s.as_ref()).map(|extreme| extreme.value),
        }
    }

    /// What it is compared with others by.
    pub fn situation(&self) -> Option<Situation> {
        Some(Situation {
            map_digest: self.map_digest,
            label: self.label.map(|label| label.name().to_owned()),
            nearest: self.nearest.map(|(kind, _)| kind.to_owned()),
            spot: self.spot?,
            speed_mps: self.speed_mps,
        })
    }
}

fn identity(source: &[u8; 32], tick: Tick) -> String {
    format!("{}-{tick}", &blake3::Hash::from_bytes(*source).to_hex()[..IDENTITY_DIGITS])
}

fn level(rates: &HazardRates) -> &'static str {
    HazardLevel::ALL.into_iter().find(|level| level.rates() == *rates).map_or("own", HazardLevel::name)
}
