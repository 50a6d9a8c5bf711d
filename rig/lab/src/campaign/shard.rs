//! `shard.json`: of which campaign the runs in a folder are, and who drove them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow, bail};
use base::files::{self, most};
use base::json::{self, Typed};
use base::maps::Map;
use base::output;
use drivers::vision::Eye;
use render::{Imaging, ModelsId, Quality, Sensor};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::figures::CampaignFigures;
use super::plan::Plan;
use super::until::{Goal, Until};
use crate::machine::{Build, Machine};
use crate::share::Share;

/// The content of `shard.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shard {
    /// Which runs it is to drive.
    #[serde(flatten)]
    pub share: Share,
    /// Of which campaign.
    pub plan: ShardPlan,
    /// The program that drives.
    pub build: Build,
    /// Kinds of machines on which it drove: more than one where it went on on another.
    pub machines: Vec<Machine>,
}

/// `shard.json` of a shard's folder.
impl Typed for Shard {
    const TYPE: &'static str = "aeye.shard";
}

/// All that decides a campaign's runs, and how many of them count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShardPlan {
    /// What the semantic driver sees; each of them drives the same runs.
    pub checkpoints: Vec<Named>,
    /// How good the pictures are that they look at.
    #[serde(default = "Quality::unsaid")]
    pub quality: Quality,
    /// What lens and chip do to them; left out where they are ideal.
    #[serde(default, skip_serializing_if = "Sensor::is_ideal")]
    pub sensor: Sensor,
    /// Digest of models of a user's own; left out where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub models: Option<ModelsId>,
    /// Maps, in turn.
    pub maps: Vec<Named>,
    /// Whether the files of foreign maps stand in the recordings.
    pub embed_map: bool,
    /// BLAKE3 of the scenario that all runs have in common, if there is one.
    pub scenario: Option<String>,
    /// Whether each run draws values for parameters of its story.
    #[serde(default)]
    pub vary: bool,
    /// People on foot, if not as many as the scenario says.
    pub pedestrians: Option<u16>,
    /// How often people at the wheel endanger others, if not as the scenario says.
    pub hazards: Option<String>,
    /// Weather by its name, if not as the scenario says.
    pub weather: Option<String>,
    /// Longest simulated time of a run, seconds.
    pub run_seconds: u32,
    /// Seed of the campaign.
    pub seed: u64,
    /// What is enough, checkpoint by checkpoint.
    pub until: Until,
    /// Runs of each checkpoint that must come to that.
    pub runs: Option<u32>,
}

/// Something, and what it holds.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Named {
    /// Its name.
    pub name: String,
    /// Digest of its content; of ground truth `truth`, of what no file holds `external NAME@VERSION`.
    pub digest: String,
}

impl ShardPlan {
    /// That of a campaign.
    fn new(plan: &Plan, eyes: &[Eye]) -> Self {
        let checkpoint = |eye: &Eye| Named { name: eye.name().to_owned(), digest: eye.digest() };
        let hex = |digest: blake3::Hash| digest.to_hex().to_string();
        let map = |map: &Map| {
            let foreign = map.foreign.as_ref().map(|foreign| hex(foreign.digest.into()));
            let digest = foreign.unwrap_or_else(|| format!("{:032x}", map.network.digest));
            Named { name: map.network.name.clone(), digest }
        };
        let scenario = plan.scenario.as_ref().map(|scenario| hex(blake3::hash(scenario.to_toml().as_bytes())));
        // All of them that look at colours look at the same kind of pictures, and all of them at the same models.
        let imaging = |eye: Option<&Eye>| eye.map(Eye::imaging).unwrap_or_default();
        let Imaging { quality, sensor, .. } = imaging(eyes.iter().find(|eye| eye.needs_colours()));
        let models = imaging(eyes.first()).models;
        Self {
            checkpoints: eyes.iter().map(checkpoint).collect(),
            quality,
            sensor,
            models,
            maps: plan.maps.iter().map(map).collect(),
            embed_map: plan.maps.iter().filter_map(|map| map.foreign.as_ref()).any(|map| map.embedded),
            scenario,
            vary: plan.vary,
            pedestrians: plan.pedestrians,
            hazards: plan.hazards.map(|level| level.name().to_owned()),
            weather: plan.weather.map(|preset| preset.name.to_owned()),
            run_seconds: plan.run_seconds,
            seed: plan.seed,
            until: plan.goal.until,
            runs: plan.goal.most,
        }
    }

    /// When the campaign is over.
    pub fn goal(&self) -> Goal {
        Goal { until: self.until, most: self.runs }
    }

    /// The same runs, though others of them count.
    fn up_to(&self, other: &Self) -> Self {
        Self { until: other.until, runs: other.runs, ..self.clone() }
    }
}

impl Shard {
    /// Begins or goes on with a share of a campaign in its folder. Its goal may be another than it was.
    pub fn enter(plan: &Plan, eyes: &[Eye], share: Share) -> anyhow::Result<Self> {
        let mut shard =
            Self { share, plan: ShardPlan::new(plan, eyes), build: Build::this(), machines: vec![Machine::this()] };
        let known = Self::read(&plan.out)?;
        if let Some(known) = &known {
            shard.check_goes_on(known, &plan.out)?;
            let other = known.machines.iter().filter(|machine| **machine != shard.machines[0]);
            shard.machines = other.cloned().chain([shard.machines[0].clone()]).collect();
        }
        if known.is_none() && plan.out.join(CampaignFigures::FILE).exists() {
            bail!("{}: holds a whole campaign; expected a folder for each shard", plan.out.display());
        }
        if known.as_ref() != Some(&shard) {
            output::write_file(&path(&plan.out), json::json_file(&shard)?.as_bytes())?;
        }
        Ok(shard)
    }

    fn check_goes_on(&self, known: &Self, folder: &Path) -> anyhow::Result<()> {
        let path = path(folder);
        let path = path.display();
        if known.share != self.share {
            bail!("{path}: is of shard {}, this is {}; expected a folder for each shard", known.share, self.share);
        }
        if let Some((key, there, here)) = known.plan.up_to(&self.plan).difference(&self.plan)? {
            bail!("{path}: {key} is {there} there, {here} here; expected an empty folder or this campaign's");
        }
        if known.build != self.build {
            bail!(
                "{path}: was driven by {}, this is {}; expected an empty folder or that program",
                known.build,
                self.build
            );
        }
        Ok(())
    }

    /// That of a folder, if it is the folder of a shard.
    pub fn read(folder: &Path) -> anyhow::Result<Option<Self>> {
        let path = path(folder);
        let Some(text) = files::read_text_if_there(&path, most::TEXT)? else { return Ok(None) };
        let shard: Self = json::read_json(&text).with_context(|| path.display().to_string())?;
        if !(1..=shard.share.of).contains(&shard.share.shard) {
            bail!("{}: is of shard {}, expected a number from 1 to that of all", path.display(), shard.share);
        }
        let mut names = shard.plan.checkpoints.iter().map(|checkpoint| files::check_name(&checkpoint.name));
        names.try_for_each(|name| name.map_err(|reason| anyhow!("{}: {reason}", path.display())))?;
        Ok(Some(shard))
    }

    /// Graphics adapters that it drove with.
    pub fn adapters(&self) -> Vec<String> {
        self.machines.iter().map(|machine| machine.adapter.clone()).collect()
    }
}

impl ShardPlan {
    /// The first of its values that another has otherwise: its name, and both.
    pub fn difference(&self, other: &Self) -> anyhow::Result<Option<(String, Value, Value)>> {
        let [these, mut those] = [fields(self)?, fields(other)?];
        let mut pairs = these.into_iter().map(|(name, value)| {
            let other = those.remove(&name).unwrap_or_default();
            (name, value, other)
        });
        Ok(pairs.find(|(_, value, other)| value != other))
    }
}

fn fields(plan: &ShardPlan) -> anyhow::Result<BTreeMap<String, Value>> {
    Ok(serde_json::from_value(serde_json::to_value(plan)?)?)
}

fn path(folder: &Path) -> PathBuf {
    folder.join("shard.json")
}
