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
mod set;
mod stages;
mod table_1;
mod tables;
mod text;

use std::fmt;
use std::path::{Path, PathBuf};

use anyhow::bail;
use base::json::{self, Typed};
use render::AdapterChoice;
use serde::Serialize;

pub use recipe::{Preset, Recipe};
pub use set::Set;
pub use tables::Tables;

use self::stages::Stages;
use base::output::{self, OutputFolder};
use base::progress::Interrupt;

/// `tables.json` of `aeye experiment`.
impl Typed for Tables {
    const TYPE: &'static str = "aeye.experiment.tables";
}

/// What an experiment came to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// The page about it.
    pub report: PathBuf,
    /// Its figures.
    #[serde(flatten)]
    pub tables: Tables,
}

/// What `aeye experiment` prints.
impl Typed for Outcome {
    const TYPE: &'static str = "aeye.experiment";
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}

{}",
            text::tables(&self.tables),
            self.report.display()
        )
    }
}

/// Does what a recipe says in a folder, or what is left of it there; `jobs` drives at the same time.
pub fn run(recipe: &Recipe, out: &Path, jobs: Option<u16>, interrupt: &Interrupt) -> anyhow::Result<Outcome> {
    AdapterChoice::default().find()?;
    let _folder = OutputFolder::open(out)?;
    keep_recipe(recipe, &out.join("recipe.toml"))?;
    let results = Stages { recipe, out, jobs, interrupt: interrupt.clone() }.run()?;
    output::write_file(&out.join("tables.json"), json::json_file(&results.tables)?.as_bytes())?;
    let report = out.join("report.html");
    output::write_file(&report, page::render(recipe, &results)?.as_bytes())?;
    Ok(Outcome { report, tables: results.tables })
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
