//! How good networks are that learned from different data.

use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use drivers::checkpoint::CheckpointChoice;

use super::set::Set;
use super::stages::{Stages, TEST};
use super::table_1::{Row, Scenes, test_scores};
use crate::dataset::Manifest;
use crate::eval;

impl Stages<'_> {
    /// Table 1, of the networks of each set.
    pub fn measure(&self, networks: &[Vec<PathBuf>]) -> anyhow::Result<Vec<Row>> {
        let tests = [self.dataset("critical"), self.dataset("natural")];
        let of_test = |of_set: &Vec<PathBuf>, test: &Path| -> anyhow::Result<Vec<Scenes>> {
            of_set.iter().map(|network| self.scenes(network, test)).collect()
        };
        let of_set = |of_set| anyhow::Ok([of_test(of_set, &tests[0])?, of_test(of_set, &tests[1])?]);
        let scenes = networks.iter().map(of_set).collect::<anyhow::Result<Vec<[Vec<Scenes>; 2]>>>()?;
        let row = |(set, of_set): (Set, &[Vec<Scenes>; 2])| -> anyhow::Result<Row> {
            let is_natural = set == Set::Natural;
            Ok(Row {
                set,
                pedestrian_pixels_per_frame: self.pedestrian_pixels(set)?,
                safety_critical: test_scores(&scenes[0][0], &of_set[0], is_natural),
                natural: test_scores(&scenes[0][1], &of_set[1], is_natural),
            })
        };
        Set::ALL.into_iter().zip(&scenes).map(row).collect()
    }

    fn scenes(&self, network: &Path, dataset: &Path) -> anyhow::Result<Scenes> {
        if self.interrupt.is_raised() {
            bail!("interrupted; the same command goes on from there");
        }
        let network = CheckpointChoice::File(network.to_owned());
        let evaluation = eval::evaluate(&network, dataset, TEST, self.jobs, &self.interrupt)?;
        Ok(evaluation.scenes.into_iter().map(|scene| scene.matrix).collect())
    }

    fn pedestrian_pixels(&self, set: Set) -> anyhow::Result<f64> {
        let folder = self.set(set);
        let manifest = Manifest::read(&folder)?;
        manifest.pedestrian_pixels.with_context(|| format!("{}: no training frames", folder.display()))
    }
}
