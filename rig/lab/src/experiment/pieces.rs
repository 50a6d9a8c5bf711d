//! An experiment in pieces: which of them can be done now follows from the recipe and the folder alone.

use anyhow::bail;

use super::piece::{Piece, Work};
use super::set::Set;
use super::stages::{DRIVING, Stages, network};
use crate::campaign;

impl Stages<'_> {
    /// What is not done yet and can be done now; nothing is left to part where it is empty.
    pub fn open_pieces(&self) -> anyhow::Result<Vec<Work>> {
        let has = |dataset: &str| self.dataset(dataset).join("dataset.json").exists();
        // The sets appear at once, this one among them.
        if has("sets/natural") {
            return self.after_the_sets();
        }
        let drawn = [(Work::Natural, has("natural")), (Work::Pool, has("pool"))];
        let mut open: Vec<Work> = drawn.iter().filter(|(_, is_there)| !is_there).map(|(work, _)| *work).collect();
        let is_drawn = open.is_empty();
        if !self.network(DRIVING).exists() {
            open.extend(has("natural").then_some(Work::Driving));
            return Ok(open);
        }
        let runs = campaign::missing_runs(&self.first_campaign())?;
        open.extend((is_drawn && runs.is_empty()).then_some(Work::Sets));
        open.extend(runs.into_iter().map(|(_, run)| Work::FirstRun(run)));
        Ok(open)
    }

    fn after_the_sets(&self) -> anyhow::Result<Vec<Work>> {
        let mut open = Vec::new();
        for set in Set::ALL {
            let first = self.network(&network(set, 1));
            if first.exists() {
                let runs = campaign::missing_runs(&self.second_campaign(vec![first]))?;
                open.extend(runs.into_iter().map(|(_, run)| Work::SecondRun(set, run)));
            }
        }
        // Seed by seed, as one process does it.
        for number in 1..=self.recipe.training.seeds {
            let missing = Set::ALL.into_iter().filter(|set| !self.network(&network(*set, number)).exists());
            open.extend(missing.map(|set| Work::Network(set, number)));
        }
        Ok(open)
    }

    /// Does a piece, unless it is done.
    pub fn do_piece(&self, work: Work) -> anyhow::Result<()> {
        let Piece { piece, needs } = work.piece();
        if let Some(missing) = needs.iter().find(|need| !self.out.join(need).exists()) {
            bail!("{}: is not there; expected it before {piece}", self.out.join(missing).display());
        }
        match work {
            Work::Natural => self.draw_natural(),
            Work::Pool => self.draw_pool(),
            Work::Driving => self.train_driving().map(drop),
            Work::FirstRun(run) => campaign::drive_run(&self.first_campaign(), run, &self.interrupt),
            Work::Sets => self.make_sets().map(drop),
            Work::Network(set, number) => self.train_set(set, number).map(drop),
            Work::SecondRun(set, run) => {
                let networks = vec![self.network(&network(set, 1))];
                campaign::drive_run(&self.second_campaign(networks), run, &self.interrupt)
            }
        }
    }
}
