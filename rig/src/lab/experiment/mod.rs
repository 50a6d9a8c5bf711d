//! The paper from end to end: a network that was stopped early drives until it has made corner cases;
//! networks learn from them and from other data of the same size; they are measured (Table 1) and drive
//! themselves (Table 2).
//!
//! Every stage leaves its results in a folder of its own and does nothing when they are there, so the same
//! command goes on where it was interrupted, and ends with the same tables.
//!
//! ```text
//! OUT/recipe.toml       the numbers
//! OUT/datasets/         natural, pool, cases, critical, and sets/{natural,pedestrian,corner-case}
//! OUT/networks/         driving.onnx, SET-SEED.onnx
//! OUT/campaign-1/       drives of the early-stopped network
//! OUT/campaign-2/       drives of the three kinds of network
//! OUT/tables.json       Tables 1 and 2
//! OUT/report.html       all of it on one page
//! ```

mod forest;
mod page;
mod paper;
mod pictures;
mod recipe;
mod stages;
mod table_1;
mod text;

use std::path::{Path, PathBuf};

use anyhow::bail;
use render::AdapterChoice;
use serde::Serialize;

pub use recipe::{Preset, Recipe};

use self::stages::Stages;
use crate::cli::ExperimentArgs;
use crate::exit::{Usage, Verdict};
use crate::output;
use crate::progress::Interrupt;
use crate::statistics::CheckpointStatistics;

/// What a network learned from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Set {
    /// Ordinary drives.
    Natural,
    /// With frames that show more pedestrians.
    Pedestrian,
    /// With the frames before takeovers.
    CornerCase,
}

impl Set {
    /// All of them, in the paper's order.
    pub const ALL: [Self; 3] = [Self::Natural, Self::Pedestrian, Self::CornerCase];

    /// As folders and files are called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Natural => "natural",
            Self::Pedestrian => "pedestrian",
            Self::CornerCase => "corner-case",
        }
    }
}

/// The content of `tables.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tables {
    /// How good the networks are.
    pub table_1: Vec<table_1::Row>,
    /// How they drive, a network of each set; the natural one is the reference.
    pub table_2: Vec<CheckpointStatistics>,
}

/// What the command prints.
#[derive(Serialize)]
struct Summary {
    report: PathBuf,
    #[serde(flatten)]
    tables: Tables,
}

/// Runs `aeye experiment`.
pub fn run(args: &ExperimentArgs, json: bool) -> anyhow::Result<Verdict> {
    let recipe = chosen(args)?;
    if args.print_recipe {
        let text = recipe.to_toml()?;
        output::print(json, &recipe, || text.trim_end().to_owned())?;
        return Ok(Verdict::Ok);
    }
    let Some(out) = &args.out else { return Err(Usage("expected --out DIR or --print-recipe".into()).into()) };
    AdapterChoice::default().find()?;
    output::create_folder(out)?;
    keep_recipe(&recipe, &out.join("recipe.toml"))?;
    let stages = Stages { recipe: &recipe, out, jobs: args.jobs, interrupt: Interrupt::listen()? };
    let results = stages.run()?;
    output::write_file(&out.join("tables.json"), output::json_file(&results.tables)?.as_bytes())?;
    let report = out.join("report.html");
    output::write_file(&report, page::render(&recipe, &results)?.as_bytes())?;
    let summary = Summary { report, tables: results.tables };
    output::print(json, &summary, || format!("{}\n\n{}", text::tables(&summary.tables), summary.report.display()))?;
    Ok(Verdict::Ok)
}

fn chosen(args: &ExperimentArgs) -> anyhow::Result<Recipe> {
    match (&args.preset, &args.recipe) {
        (Some(preset), None) => preset.recipe(),
        (None, Some(path)) => Recipe::read(path),
        _ => Err(Usage("expected one of --preset and --recipe".into()).into()),
    }
}

/// A folder belongs to one recipe.
fn keep_recipe(recipe: &Recipe, path: &Path) -> anyhow::Result<()> {
    if !path.exists() {
        return output::write_file(path, recipe.to_toml()?.as_bytes());
    }
    if Recipe::read(path)? != *recipe {
        bail!("{}: is another experiment's; expected a new folder, or this one as --recipe", path.display());
    }
    Ok(())
}
