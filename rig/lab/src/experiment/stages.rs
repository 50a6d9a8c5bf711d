//! The stages, one after the other.

use std::path::{Path, PathBuf};

use anyhow::bail;
use base::failure::Failed;
use base::output;
use base::progress::Interrupt;
use base::say::say;
use drivers::checkpoint::CheckpointChoice;
use measures::statistics;
use perception::training::{Preset, TrainOptions};

use super::recipe::Recipe;
use super::set::Set;
use super::tables::Tables;
use crate::campaign;
use crate::campaign::CampaignFigures;
use crate::campaign::Until;
use crate::dataset::{Manifest, cases, mix, natural};
use crate::train;

/// Where frames are measured at last, in all datasets.
pub const TEST: &str = "test";
/// Folders of the networks and of the campaigns.
pub const NETWORKS: &str = "networks";
pub const FIRST_CAMPAIGN: &str = "campaign-1";
pub const SECOND_CAMPAIGN: &str = "campaign-2";
/// The network of the first campaign.
pub const DRIVING: &str = "driving";
/// What is added to the experiment's seed for drives that are to share no start.
const POOL_SEED: u64 = 1000;
const SECOND_CAMPAIGN_SEED: u64 = 2000;

/// What an experiment came to.
pub struct Results {
    /// Tables 1 and 2.
    pub tables: Tables,
    /// The drives of the early-stopped network.
    pub first_campaign: CampaignFigures,
    /// Corner cases that were learned from.
    pub training_cases: Vec<PathBuf>,
    /// Corner cases of the safety-critical test.
    pub test_cases: Vec<PathBuf>,
    /// The network of the first campaign, with its curves beside it.
    pub driving: PathBuf,
    /// The first network of each set.
    pub networks: Vec<PathBuf>,
    /// The drives of these.
    pub second_campaign: CampaignFigures,
    /// All datasets, by the names of their folders.
    pub datasets: Vec<(String, Manifest)>,
}

/// An experiment on its way.
pub struct Stages<'a> {
    /// The numbers.
    pub recipe: &'a Recipe,
    /// Where everything goes.
    pub out: &'a Path,
    /// Drives at the same time.
    pub jobs: Option<u16>,
    /// Looked at between steps.
    pub interrupt: Interrupt,
}

impl Stages<'_> {
    /// All of them.
    pub fn run(&self) -> anyhow::Result<Results> {
        begin(1, "drawing the natural data and a pool of scenes with more pedestrians");
        self.draw_natural()?;
        self.draw_pool()?;
        begin(2, "training the network that drives, and stopping it early");
        let driving = self.train_driving()?;
        let (first_campaign, training_cases, test_cases) = self.make_sets()?;
        begin(5, "training on each of them");
        let networks = self.train_all()?;
        begin(6, "measuring every network on safety-critical and on natural frames");
        let table_1 = self.measure(&networks)?;
        begin(7, "driving with a network of each set");
        let firsts: Vec<PathBuf> = networks.iter().filter_map(|of_set| of_set.first().cloned()).collect();
        let second_campaign = campaign::drive(&self.second_campaign(firsts.clone()), &self.interrupt)?;
        let folder = self.out.join(SECOND_CAMPAIGN);
        let recordings: Vec<PathBuf> = second_campaign.runs.iter().map(|run| folder.join(&run.file)).collect();
        let choice = statistics::Choice { sampling: second_campaign.until.sampling(), ..Default::default() };
        let of_all = statistics::of_recordings(&recordings, choice, |_, _| true)?;
        Failed::check(&of_all.failed, recordings.len())?;
        let table_2 = of_all.checkpoints;
        begin(8, "writing tables and report");
        let tables = Tables { table_1, table_2 };
        let (networks, datasets) = (firsts, self.datasets()?);
        Ok(Results { tables, first_campaign, training_cases, test_cases, driving, networks, second_campaign, datasets })
    }

    /// Drives the first campaign to its end and makes the training sets of it; gives also the cases of both kinds.
    pub fn make_sets(&self) -> anyhow::Result<(CampaignFigures, Vec<PathBuf>, Vec<PathBuf>)> {
        begin(3, "driving with it until there are enough corner cases with pedestrians");
        let first_campaign = campaign::drive(&self.first_campaign(), &self.interrupt)?;
        let (training_cases, test_cases) = self.share_out(&first_campaign)?;
        begin(4, "making three training sets of equal size");
        self.mix(&training_cases, &test_cases)?;
        Ok((first_campaign, training_cases, test_cases))
    }

    /// The folder of a dataset.
    pub fn dataset(&self, name: &str) -> PathBuf {
        self.out.join("datasets").join(name)
    }

    /// The file of a network.
    pub fn network(&self, name: &str) -> PathBuf {
        self.out.join(NETWORKS).join(format!("{name}.onnx"))
    }

    /// The folder of a training set.
    pub fn set(&self, set: Set) -> PathBuf {
        self.dataset("sets").join(set.name())
    }

    fn datasets(&self) -> anyhow::Result<Vec<(String, Manifest)>> {
        let sets = Set::ALL.map(|set| format!("sets/{}", set.name()));
        let names = ["natural", "pool", "cases", "critical"].map(str::to_owned).into_iter().chain(sets);
        names.map(|name| Ok((format!("datasets/{name}"), Manifest::read(&self.dataset(&name))?))).collect()
    }

    /// Draws the natural data, unless it is there.
    pub fn draw_natural(&self) -> anyhow::Result<()> {
        natural::make(&self.natural(), &self.interrupt).map(drop)
    }

    /// Draws the pool, unless it is there.
    pub fn draw_pool(&self) -> anyhow::Result<()> {
        let pool = &self.recipe.pool;
        let options = natural::Options {
            scenes: pool.scenes,
            val_scenes: 0,
            test_scenes: 0,
            pedestrians: Some(pool.pedestrians),
            seed: self.recipe.seed + POOL_SEED,
            out: self.dataset("pool"),
            ..self.natural()
        };
        natural::make(&options, &self.interrupt).map(drop)
    }

    fn natural(&self) -> natural::Options {
        let n = &self.recipe.natural;
        natural::Options {
            scenes: n.scenes,
            val_scenes: n.val_scenes,
            test_scenes: n.test_scenes,
            frames: n.frames,
            test_frames: n.test_frames,
            size: self.recipe.size,
            imaging: self.recipe.imaging(),
            cameras: None,
            maps: self.recipe.maps.clone(),
            pedestrians: None,
            weather: Vec::new(),
            seed: self.recipe.seed,
            jobs: self.jobs,
            out: self.dataset("natural"),
        }
    }

    /// Trains the network that drives, unless it is there.
    pub fn train_driving(&self) -> anyhow::Result<PathBuf> {
        let driving = &self.recipe.driving;
        self.train(&self.dataset("natural"), DRIVING, self.recipe.seed, driving.epochs, driving.horizon)
    }

    /// Trains a set's network, numbered from 1 on, unless it is there.
    pub fn train_set(&self, set: Set, number: u32) -> anyhow::Result<PathBuf> {
        let (training, seed) = (&self.recipe.training, self.recipe.seed + u64::from(number));
        self.train(&self.set(set), &network(set, number), seed, training.epochs, training.epochs)
    }

    fn train(&self, dataset: &Path, name: &str, seed: u64, epochs: u32, horizon: u32) -> anyhow::Result<PathBuf> {
        let (out, standard) = (self.network(name), TrainOptions::default());
        output::create_folder(&self.out.join(NETWORKS))?;
        let args = train::Options {
            dataset: dataset.to_owned(),
            out: out.clone(),
            epochs,
            seed,
            size: self.recipe.size,
            horizon: Some(horizon),
            patience: None,
            batch: standard.batch as u32,
            replicas: standard.replicas as u32,
            rate: standard.rate,
            preset: Preset::Plain,
            min_height_px: None,
        };
        train::train(&args, &self.interrupt, &mut |epoch| {
            say(format_args!("{name}: {epoch}"));
            Ok(())
        })?;
        Ok(out)
    }

    /// What the network that drives is driven through.
    pub fn first_campaign(&self) -> campaign::Options {
        let c = &self.recipe.first_campaign;
        let until = Until::PedestrianCases(c.training_cases + c.test_cases);
        self.campaign(vec![self.network(DRIVING)], until, FIRST_CAMPAIGN, (c.pedestrians, c.run_seconds))
    }

    /// What networks are compared by.
    pub fn second_campaign(&self, networks: Vec<PathBuf>) -> campaign::Options {
        let c = &self.recipe.second_campaign;
        let plan = self.campaign(networks, Until::Km(c.km), SECOND_CAMPAIGN, (c.pedestrians, c.run_seconds));
        campaign::Options { seed: self.recipe.seed + SECOND_CAMPAIGN_SEED, ..plan }
    }

    fn campaign(
        &self,
        checkpoints: Vec<PathBuf>,
        until: Until,
        name: &str,
        (pedestrians, run_seconds): (Option<u16>, u32),
    ) -> campaign::Options {
        campaign::Options {
            checkpoint: checkpoints.into_iter().map(CheckpointChoice::File).collect(),
            maps: self.recipe.maps.clone(),
            embed_map: false,
            scenario: None,
            goal: until.into(),
            vary: false,
            pedestrians,
            hazards: None,
            weather: None,
            imaging: self.recipe.imaging(),
            run_seconds,
            seed: self.recipe.seed,
            jobs: self.jobs,
            out: self.out.join(name),
        }
    }

    /// The campaign's pedestrian cases: the first ones to learn from, later ones to measure on.
    fn share_out(&self, figures: &CampaignFigures) -> anyhow::Result<(Vec<PathBuf>, Vec<PathBuf>)> {
        let folder = self.out.join(FIRST_CAMPAIGN);
        let pedestrian = figures.runs.iter().filter(|run| run.is_pedestrian_case());
        let mut cases: Vec<PathBuf> = pedestrian.filter_map(|run| Some(folder.join(run.case.as_ref()?))).collect();
        let c = &self.recipe.first_campaign;
        if cases.len() < (c.training_cases + c.test_cases) as usize {
            bail!("{}: {} pedestrian cases are too few", folder.display(), cases.len());
        }
        let test = cases.split_off(c.training_cases as usize);
        Ok((cases, test))
    }

    fn mix(&self, training: &[PathBuf], test: &[PathBuf]) -> anyhow::Result<()> {
        for (files, split, name) in [(training, "train", "cases"), (test, TEST, "critical")] {
            let args = cases::Options {
                files: files.to_vec(),
                label: Vec::new(),
                verdict: Vec::new(),
                split: split.into(),
                size: self.recipe.size,
                imaging: self.recipe.imaging(),
                cameras: None,
                jobs: self.jobs,
                out: self.dataset(name),
            };
            cases::make(&args, &self.interrupt)?;
        }
        let args = mix::Options {
            natural: self.dataset("natural"),
            pool: self.dataset("pool"),
            cases: self.dataset("cases"),
            replace: None,
            seed: self.recipe.seed,
            out: self.dataset("sets"),
        };
        mix::make(&args, &self.interrupt)?;
        Ok(())
    }

    /// The networks of each set, in the order of their seeds.
    fn train_all(&self) -> anyhow::Result<Vec<Vec<PathBuf>>> {
        // Seed by seed, so that an experiment that is looked at early has seen every set.
        let mut networks = vec![Vec::new(); Set::ALL.len()];
        for number in 1..=self.recipe.training.seeds {
            for (set, trained) in Set::ALL.into_iter().zip(&mut networks) {
                trained.push(self.train_set(set, number)?);
            }
        }
        Ok(networks)
    }
}

/// The name of a set's network, numbered from 1 on.
pub fn network(set: Set, number: u32) -> String {
    format!("{}-{number}", set.name())
}

fn begin(stage: u32, what: &str) {
    say(format_args!("{stage}/8 {what}"));
}
