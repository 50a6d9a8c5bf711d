//! What an experiment consists of, by the names of what is made.

use std::fmt;

use base::json::Typed;
use serde::Serialize;

use super::recipe::Recipe;
use super::set::Set;
use super::stages::{DRIVING, FIRST_CAMPAIGN, NETWORKS, SECOND_CAMPAIGN, network};

/// A piece of an experiment, which any process can do once what it needs is there.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Piece {
    /// What it makes, by its place in the experiment's folder without an ending.
    pub piece: String,
    /// Files and folders that it reads there.
    pub needs: Vec<String>,
}

/// What `aeye experiment --pieces` prints of each that can be done, and `--piece` of the one that it did.
impl Typed for Piece {
    const TYPE: &'static str = "aeye.experiment.piece";
}

impl fmt::Display for Piece {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.piece)
    }
}

/// What a piece does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// Draws the natural data.
    Natural,
    /// Draws the pool.
    Pool,
    /// Trains the network that drives.
    Driving,
    /// Drives a run of the first campaign.
    FirstRun(u32),
    /// Makes the training sets, from all runs of the first campaign.
    Sets,
    /// Trains a set's network, numbered from 1 on.
    Network(Set, u32),
    /// Drives a run of the second campaign through a set's first network.
    SecondRun(Set, u32),
}

impl Work {
    /// That of a piece of an experiment.
    pub fn named(name: &str, recipe: &Recipe) -> Option<Self> {
        let number = name.rsplit('-').next().and_then(|number| number.parse().ok()).unwrap_or_default();
        let of_set = |set| [Self::Network(set, number), Self::SecondRun(set, number)];
        let others = [Self::Natural, Self::Pool, Self::Driving, Self::FirstRun(number), Self::Sets];
        let mut all = others.into_iter().chain(Set::ALL.into_iter().flat_map(of_set));
        let found = all.find(|work| work.name() == name)?;
        let is_one = match found {
            Self::Network(_, number) => (1..=recipe.training.seeds).contains(&number),
            _ => true,
        };
        is_one.then_some(found)
    }

    /// What it makes.
    fn name(self) -> String {
        match self {
            Self::Natural => dataset("natural"),
            Self::Pool => dataset("pool"),
            Self::Driving => format!("{NETWORKS}/{DRIVING}"),
            Self::FirstRun(run) => format!("{FIRST_CAMPAIGN}/{DRIVING}-{run:04}"),
            Self::Sets => dataset("sets"),
            Self::Network(set, number) => format!("{NETWORKS}/{}", network(set, number)),
            Self::SecondRun(set, run) => format!("{SECOND_CAMPAIGN}/{}-{run:04}", network(set, 1)),
        }
    }

    fn needs(self) -> Vec<String> {
        match self {
            Self::Natural | Self::Pool => Vec::new(),
            Self::Driving => vec![dataset("natural")],
            Self::FirstRun(_) => vec![file(DRIVING)],
            Self::Sets => vec![dataset("natural"), dataset("pool"), file(DRIVING), FIRST_CAMPAIGN.into()],
            Self::Network(set, _) => vec![format!("{}/{}", dataset("sets"), set.name())],
            Self::SecondRun(set, _) => vec![file(&network(set, 1))],
        }
    }

    /// As it is told.
    pub fn piece(self) -> Piece {
        Piece { piece: self.name(), needs: self.needs() }
    }
}

fn dataset(name: &str) -> String {
    format!("datasets/{name}")
}

fn file(network: &str) -> String {
    format!("{NETWORKS}/{network}.onnx")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::Preset;

    #[test]
    fn a_piece_is_found_by_its_name_and_by_no_other() {
        let recipe = Preset::Smoke.recipe().expect("valid");
        let runs = [Work::FirstRun(0), Work::FirstRun(12345), Work::SecondRun(Set::CornerCase, 7)];
        let networks = [Work::Driving, Work::Network(Set::CornerCase, 1), Work::Network(Set::Natural, 2)];
        for work in [Work::Natural, Work::Pool, Work::Sets].into_iter().chain(runs).chain(networks) {
            assert_eq!(Work::named(&work.name(), &recipe), Some(work));
        }
        for wrong in ["", "-", "datasets", "networks/natural-0", "networks/natural-3", "networks/natural-01"] {
            assert_eq!(Work::named(wrong, &recipe), None, "{wrong}");
        }
        for wrong in ["campaign-1/driving-1", "campaign-2/natural-2-0001", "../datasets/natural"] {
            assert_eq!(Work::named(wrong, &recipe), None, "{wrong}");
        }
    }
}
