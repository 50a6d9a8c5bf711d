//! The paper from end to end.

use anyhow::Context;
use base::failure::Usage;
use base::maps::Map;
use base::progress::Interrupt;
use lab::experiment::{self, Recipe};

use crate::cli::ExperimentArgs;
use crate::exit::Verdict;
use crate::print::{self, print};

/// Runs `aeye experiment`.
pub fn run(args: &ExperimentArgs, json: bool) -> anyhow::Result<Verdict> {
    let recipe = chosen(args)?;
    if args.print_recipe {
        let text = recipe.to_toml()?;
        print(json, &recipe, || text.trim_end().to_owned())?;
        return Ok(Verdict::Ok);
    }
    let Some(out) = &args.out else { return Err(Usage("expected --out DIR or --print-recipe".into()).into()) };
    if args.pieces {
        experiment::pieces(&recipe, out)?.iter().try_for_each(|piece| print::result(json, piece))?;
        return Ok(Verdict::Ok);
    }
    let interrupt = Interrupt::listen();
    match &args.piece {
        Some(name) => print::result(json, &experiment::piece(&recipe, out, name, args.jobs, &interrupt)?)?,
        None => print::result(json, &experiment::run(&recipe, out, args.jobs, &interrupt)?)?,
    }
    Ok(Verdict::Ok)
}

fn chosen(args: &ExperimentArgs) -> anyhow::Result<Recipe> {
    let recipe = told(args)?;
    Ok(Recipe { models: args.models.or(recipe.models), ..recipe })
}

fn told(args: &ExperimentArgs) -> anyhow::Result<Recipe> {
    match (&args.preset, &args.recipe) {
        (Some(preset), None) => preset.recipe(),
        (None, Some(path)) => {
            let recipe = Recipe::read(path)?;
            Map::find_all(&recipe.maps).with_context(|| format!("{}: maps", path.display()))?;
            Ok(recipe)
        }
        _ => Err(Usage("expected one of --preset and --recipe".into()).into()),
    }
}
