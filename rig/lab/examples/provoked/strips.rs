//! The last seconds before a collision, beside each other.

use std::collections::VecDeque;
use std::path::Path;

use anyhow::{Context, ensure};
use base::scenario_file::ScenarioFile;
use base::{output, png};
use kernel::SceneSnapshot;
use kernel::time::{TICK_HZ, Tick, seconds};
use render::{AdapterChoice, Camera, Renderer};

use super::{Who, drawn, drive};

/// Size of a picture, pixels, and how many there are: one a second.
const SIZE: (u32, u32) = (220, 110);
const PICTURES: usize = 4;

/// Draws the first collision of a car that drives on through a story, as `DIR/STORY.png`.
pub fn strip(file: &Path, seed: u64, folder: &Path) -> anyhow::Result<()> {
    let story = ScenarioFile::read(file)?;
    let kept = seconds(PICTURES as u32 - 1) as usize + 1;
    let mut scenes: VecDeque<SceneSnapshot> = VecDeque::new();
    let renderer = Renderer::new(&story.map.network, &AdapterChoice::default())?;
    let (came, mut renderer) =
        drive(&drawn(&story.scenario, seed)?, &story.map, &Who::On, Tick::MAX, renderer, |scene| {
            scenes.push_back(scene);
            if scenes.len() > kept {
                scenes.pop_front();
            }
        })?;
    ensure!(came.hit && scenes.len() == kept, "{}: nothing is hit", file.display());
    let camera = Camera::driver(SIZE.0, SIZE.1);
    let chosen = scenes.iter().step_by(TICK_HZ as usize);
    let frames = chosen.map(|scene| renderer.draw(scene, &camera)).collect::<Result<Vec<_>, _>>()?;
    let row = 3 * SIZE.0 as usize;
    let rows = (0..SIZE.1 as usize).flat_map(|y| frames.iter().map(move |frame| &frame.rgb[y * row..(y + 1) * row]));
    let picture = png::rgb((SIZE.0 * PICTURES as u32, SIZE.1), &rows.collect::<Vec<_>>().concat())?;
    let stem = file.file_stem().context("a name")?.to_string_lossy();
    output::write_file(&folder.join(format!("{stem}.png")), &picture)
}
