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
//!
//! It may also be done in pieces, by several processes at once: each takes one, whose results lie where one process would
//! put them, or wait there for the run's turn. Whoever does the whole afterwards finds them.

mod forest;
mod measuring;
mod page;
mod paper;
mod pictures;
mod piece;
mod pieces;
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

pub use piece::Piece;
pub use recipe::{Preset, Recipe};
pub use set::Set;
pub use tables::Tables;

use self::piece::Work;
use self::stages::Stages;
use crate::store::remove_folder;
use base::failure::Usage;
use base::output::{self, OutputFolder};
use base::progress::Interrupt;

/// Holds a folder for each piece that a process is at work on.
const PIECES: &str = ".pieces";

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
    keep_recipe(recipe, out)?;
    let results = Stages { recipe, out, jobs, interrupt: interrupt.clone() }.run()?;
    output::write_file(&out.join("tables.json"), json::json_file(&results.tables)?.as_bytes())?;
    let report = out.join("report.html");
    output::write_file(&report, page::render(recipe, &results)?.as_bytes())?;
    // Processes that were killed leave theirs.
    remove_folder(&out.join(PIECES))?;
    Ok(Outcome { report, tables: results.tables })
}

/// The pieces of an experiment that are not done yet in a folder and can be done now. When none is left, [`run`] does the
/// rest.
pub fn pieces(recipe: &Recipe, out: &Path) -> anyhow::Result<Vec<Piece>> {
    check_recipe(recipe, out)?;
    let stages = Stages { recipe, out, jobs: None, interrupt: Interrupt::default() };
    Ok(stages.open_pieces()?.into_iter().map(Work::piece).collect())
}

/// Does a piece by its name, beside processes that do others; `jobs` drives at the same time.
pub fn piece(
    recipe: &Recipe,
    out: &Path,
    name: &str,
    jobs: Option<u16>,
    interrupt: &Interrupt,
) -> anyhow::Result<Piece> {
    let refused = || Usage(format!("{name}: is no piece of this experiment; expected one that --pieces prints"));
    let work = Work::named(name, recipe).ok_or_else(refused)?;
    if !recipe_file(out).exists() {
        let _folder = OutputFolder::open(out)?;
        keep_recipe(recipe, out)?;
    }
    let _shared = OutputFolder::share(out)?;
    check_recipe(recipe, out)?;
    let _own = OutputFolder::open(&out.join(PIECES).join(name.replace('/', ".")))?;
    Stages { recipe, out, jobs, interrupt: interrupt.clone() }.do_piece(work)?;
    Ok(work.piece())
}

fn recipe_file(out: &Path) -> PathBuf {
    out.join("recipe.toml")
}

/// A folder belongs to one recipe.
fn keep_recipe(recipe: &Recipe, out: &Path) -> anyhow::Result<()> {
    let path = recipe_file(out);
    if !path.exists() {
        return output::write_file(&path, recipe.to_toml()?.as_bytes());
    }
    check_recipe(recipe, out)
}

fn check_recipe(recipe: &Recipe, out: &Path) -> anyhow::Result<()> {
    let path = recipe_file(out);
    if path.exists() && Recipe::read(&path)? != *recipe {
        bail!("{}: is another experiment's; expected a new folder, or this one as --recipe", path.display());
    }
    Ok(())
}
