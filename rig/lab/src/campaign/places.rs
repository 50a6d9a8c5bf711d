//! Where the files of a run lie.

use std::path::{Path, PathBuf};

use super::run_line::RunLine;

/// The files of a run, of which only the first is always there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Places {
    /// Its recording.
    pub recording: PathBuf,
    /// Its corner case.
    pub case: PathBuf,
    /// What would have happened without its intervention.
    pub counterfactual: PathBuf,
}

impl Places {
    /// Those of a run through a checkpoint in a folder.
    pub fn new(folder: &Path, checkpoint: &str, run: u32) -> Self {
        let place = |ending| folder.join(format!("{checkpoint}-{run:04}.{ending}"));
        Self { recording: place("mcap"), case: place("case.mcap"), counterfactual: place("counterfactual.json") }
    }

    /// Those that a run has which came to this, the recording first.
    pub fn of(&self, line: &RunLine) -> impl Iterator<Item = &Path> {
        let case = line.case.as_ref().map(|_| self.case.as_path());
        let counterfactual = line.without_intervention.as_ref().map(|_| self.counterfactual.as_path());
        [Some(self.recording.as_path()), case, counterfactual].into_iter().flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::redrive::Counterfactual;

    #[test]
    fn a_counterfactual_is_found_by_its_case() {
        let places = Places::new(Path::new("runs"), "early", 7);
        assert_eq!(Counterfactual::place(&places.case), places.counterfactual);
        assert_eq!(Counterfactual::place(&places.recording), places.counterfactual);
    }
}
