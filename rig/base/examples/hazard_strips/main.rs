//! Draws the picture strips of docs/hazards.md: `hazard_strips SCENARIOS OUT [NAME..]` drives the scenario of each hazard,
//! or of those that are named, finds the moment that shows it best, and writes NAME.png. docs/hazard-strips.sh calls it.

mod caption;
mod drive;
mod moments;
mod palette;
mod shots;
mod studio;

use std::path::Path;

use anyhow::{Context, bail};
use base::scenario_file::ScenarioFile;

/// With so many seeds, from the scenario's own on, somebody is looked for who shows the hazard.
const SEEDS: u64 = 8;

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scenarios, out, names @ ..] = &arguments[..] else {
        bail!("expected a folder of scenarios and one for pictures")
    };
    let is_wanted = |shot: &&shots::Shot| names.is_empty() || names.iter().any(|name| name == shot.name);
    for shot in shots::SHOTS.iter().filter(is_wanted) {
        strip(shot, Path::new(scenarios), Path::new(out)).with_context(|| shot.name)?;
    }
    Ok(())
}

/// Drives one scenario and writes its strip.
fn strip(shot: &shots::Shot, scenarios: &Path, out: &Path) -> anyhow::Result<()> {
    let mut file = ScenarioFile::read(&scenarios.join(shot.name).with_extension("toml"))?;
    let mut studio = studio::Studio::new(&file.map.network)?;
    for _ in 0..SEEDS {
        let film = drive::film(&file.scenario, &file.map.network)?;
        let moments = moments::of(shot, &film);
        eprintln!("{}, seed {}: {} moments", shot.name, file.scenario.seed, moments.len());
        if let Some(best) = studio.best(shot, &film, moments)? {
            eprintln!("{}: at {:.1} s", shot.name, film.time_s(best.at));
            let (size, rgb) = studio.strip(shot, &film, &best)?;
            std::fs::write(out.join(shot.name).with_extension("png"), palette::png(size, &rgb)?)?;
            return Ok(());
        }
        file.scenario.seed += 1;
    }
    bail!("nobody shows it in view of the camera")
}
