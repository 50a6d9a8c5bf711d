//! What is kept of a run.

use std::path::Path;
use std::sync::Arc;

use kernel::RoadNetwork;
use measures::run_figures::RunFigures;
use measures::statistics::Ride;
use replay::{Label, Recording};
use serde::Serialize;

use crate::redrive::Counterfactual;

/// A run in `campaign.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunLine {
    /// File of the recording, in the campaign's folder.
    pub file: String,
    /// File of the corner case, if there is one.
    pub case: Option<String>,
    /// What the semantic driver looked at.
    pub checkpoint: String,
    /// What would have happened without the intervention, if there was one.
    pub without_intervention: Option<Counterfactual>,
    /// Everything else.
    #[serde(flatten)]
    pub figures: RunFigures,
    /// How it counts.
    #[serde(skip)]
    pub ride: Option<Ride>,
}

impl RunLine {
    /// That of a recording on a map at a path, from which the corner case at another was cut, if there is one.
    pub fn new(
        checkpoint: &str,
        path: &Path,
        (recording, network): (&Recording, &Arc<RoadNetwork>),
        case: Option<&Path>,
    ) -> Self {
        let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Self {
            file: name(path),
            case: case.map(name),
            checkpoint: checkpoint.to_owned(),
            without_intervention: None,
            figures: RunFigures::of(recording, Some(network)),
            ride: Ride::of(recording),
        }
    }

    /// Whether it holds a corner case with the label `walker`.
    pub fn is_pedestrian_case(&self) -> bool {
        self.case.is_some() && self.figures.label == Some(Label::Walker.name())
    }
}
