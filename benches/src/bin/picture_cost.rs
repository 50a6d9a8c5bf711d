//! Drives through each bundled map and says what a picture costs on the way: the process's CPU time, as every thread of a
//! software renderer spends it.
//!
//! `picture_cost WIDTH HEIGHT QUALITY SECONDS [MAP]...` prints a line for each map. The ratio is to pictures of nothing of the same
//! size in the same run.

use std::process::ExitCode;
use std::sync::Arc;

use benches::scenes::{self, BusyDrive};
use kernel::map::BUNDLED;
use kernel::time::{CLIP_STRIDE_TICKS, TICK_HZ};
use kernel::{RoadNetwork, SceneSnapshot};
use nix::time::{ClockId, clock_gettime};
use render::{AdapterChoice, Camera, Quality, Renderer};

use ::tests::scenes::{Scene, follow_route, scene};

const USAGE: &str = "usage: picture_cost WIDTH HEIGHT QUALITY SECONDS [MAP]...";
/// Traffic has spread by then.
const WARM_UP_S: u32 = 20;
/// Pictures that are drawn before any is counted.
const WARM_UP_PICTURES: usize = 5;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("{reason}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<(), String> {
    let [width, height, quality, drive_s, maps @ ..] = arguments else { return Err(USAGE.into()) };
    let number = |text: &String| text.parse::<u32>().map_err(|_| format!("{text}: expected a whole number; {USAGE}"));
    let quality: Quality = quality.parse().map_err(|expected| format!("{quality}: {expected}; {USAGE}"))?;
    let camera = Camera::driver(number(width)?, number(height)?).at(quality);
    let drive_s =
        Some(number(drive_s)?).filter(|s| *s > 0).ok_or_else(|| format!("0 seconds; expected 1 or more; {USAGE}"))?;
    let all = BUNDLED.map(String::from);
    println!("{:10} {:>8} {:>8} {:>8} {:>8} {:>8}", "map", "mean ms", "median", "p99", "most", "ratio");
    println!("{:10} {}", "snapshot", snapshot_costs_ms(&camera)?);
    for map in if maps.is_empty() { &all } else { maps } {
        if !BUNDLED.contains(&map.as_str()) {
            return Err(format!("{map}: expected one of {}", BUNDLED.join(", ")));
        }
        let costs = drive_costs_ms(&scene(&format!("map = \"{map}\"\nseed = 1\n")), &camera, drive_s)?;
        println!("{map:10} {costs}");
    }
    Ok(())
}

/// The same of one moment, that of the benchmark `render/frame`, again and again.
fn snapshot_costs_ms(camera: &Camera) -> Result<String, String> {
    let drive = BusyDrive::prepare()?;
    costs_ms(&drive.scene.network, camera, (0..100).map(|_| drive.snapshot.clone()))
}

/// The same of a drive, ten a second.
fn drive_costs_ms(scene: &Scene, camera: &Camera, drive_s: u32) -> Result<String, String> {
    let mut world = scene.world_after(u64::from(WARM_UP_S * TICK_HZ));
    let scenes = (0..u64::from(drive_s * TICK_HZ) / CLIP_STRIDE_TICKS).map(|_| {
        (0..CLIP_STRIDE_TICKS).for_each(|_| drop(world.step(&follow_route(&world))));
        world.scene()
    });
    costs_ms(&scene.network, camera, scenes)
}

/// CPU milliseconds of pictures, as a line of the table.
fn costs_ms(
    network: &Arc<RoadNetwork>,
    camera: &Camera,
    shown: impl Iterator<Item = SceneSnapshot>,
) -> Result<String, String> {
    let open = |network| Renderer::new(network, &AdapterChoice::default()).map_err(|e| e.to_string());
    let (mut renderer, mut bare) = (open(network)?, open(&scenes::bare(network))?);
    let (mut costs, mut bare_costs) = (Vec::new(), Vec::new());
    for mut scene in shown {
        costs.push(cost_ms(|| renderer.draw(&scene, camera))?);
        scene.actors.clear();
        bare_costs.push(cost_ms(|| bare.draw(&scene, camera))?);
    }
    let mean = |costs: &[f64]| costs.iter().sum::<f64>() / costs.len() as f64;
    let (mut costs, bare_costs) = (costs.split_off(WARM_UP_PICTURES), bare_costs.split_off(WARM_UP_PICTURES));
    let (mean_ms, ratio) = (mean(&costs), mean(&costs) / mean(&bare_costs));
    costs.sort_by(f64::total_cmp);
    let [median, p99, most] = [0.5, 0.99, 1.0].map(|share| costs[((costs.len() - 1) as f64 * share) as usize]);
    Ok(format!("{mean_ms:8.2} {median:8.2} {p99:8.2} {most:8.2} {ratio:8.2}"))
}

fn cost_ms<T, E: std::fmt::Display>(draw: impl FnOnce() -> Result<T, E>) -> Result<f64, String> {
    let now_ms = || {
        let now = clock_gettime(ClockId::CLOCK_PROCESS_CPUTIME_ID).map_err(|e| e.to_string())?;
        Ok::<_, String>(now.tv_sec() as f64 * 1e3 + now.tv_nsec() as f64 * 1e-6)
    };
    let before = now_ms()?;
    draw().map_err(|e| e.to_string())?;
    Ok(now_ms()? - before)
}
