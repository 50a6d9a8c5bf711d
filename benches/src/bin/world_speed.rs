//! Drives a world with so many road users and says how much faster than real time that went, for
//! `benches/peers`, which drives the same with simulators of others.
//!
//! `world_speed town COLUMNS ROWS` prints a map of that size; `world_speed drive MAP.xodr CARS MOTORCYCLES BICYCLES
//! PEDESTRIANS SECONDS` drives it from 20 s on and prints one line of JSON.

use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

use kernel::time::{TICK_HZ, seconds};
use kernel::{Scenario, TickInput, World};

use ::tests::scenes::{Scene, follow_route};
use ::tests::town::Town;

const USAGE: &str = "usage: world_speed town COLUMNS ROWS | world_speed drive MAP.xodr CARS MOTORCYCLES BICYCLES \
                     PEDESTRIANS SECONDS";
/// Traffic has spread by then.
const WARM_UP_S: u32 = 20;
const SEED: u64 = 1;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let said = match arguments.as_slice() {
        ["town", columns, rows] => town(columns, rows),
        ["drive", map, counts @ .., seconds] if counts.len() == 4 => drive(map, counts, seconds),
        _ => Err(USAGE.to_owned()),
    };
    match said {
        Ok(text) => {
            println!("{text}");
            ExitCode::SUCCESS
        }
        Err(reason) => {
            eprintln!("{reason}");
            ExitCode::FAILURE
        }
    }
}

fn number(text: &str) -> Result<u32, String> {
    text.parse().map_err(|_| format!("{text}: expected a whole number; {USAGE}"))
}

fn town(columns: &str, rows: &str) -> Result<String, String> {
    let (columns, rows) = (number(columns)? as usize, number(rows)? as usize);
    Ok(Town { columns, rows, pitch_m: 130.0 }.text())
}

fn drive(map: &str, counts: &[&str], drive_s: &str) -> Result<String, String> {
    let text = std::fs::read_to_string(map).map_err(|e| format!("{map}: {e}"))?;
    let network = Arc::new(kernel::map::bake("peer", &text).map_err(|e| format!("{map}: {e}"))?);
    let [cars, motorcycles, bicycles, pedestrians] = [0, 1, 2, 3].map(|k| number(counts[k]));
    let scenario = format!(
        "map = \"peer\"\nseed = {SEED}\n[traffic]\ncars = {}\nmotorcycles = {}\nbicycles = {}\npedestrians = {}\n",
        cars?, motorcycles?, bicycles?, pedestrians?
    );
    let scenario = Scenario::from_toml(&scenario).map_err(|e| e.to_string())?;
    let drive_s = number(drive_s)?;
    let mut world = Scene { scenario, network }.world_after(seconds(WARM_UP_S));
    let placed = world.scene().actors.len();
    // The driver looks at the whole scene, which is not the kernel's work.
    let mut ahead = world.clone();
    let inputs: Vec<TickInput> = (0..drive_s * TICK_HZ).map(|_| step(&mut ahead)).collect();
    let begin = Instant::now();
    inputs.iter().for_each(|input| drop(world.step(input)));
    let factor = f64::from(drive_s) / begin.elapsed().as_secs_f64();
    Ok(format!("{{\"placed\": {placed}, \"real_time_factor\": {factor:.1}, \"state_bytes\": {}}}", world.state_bytes()))
}

fn step(world: &mut World) -> TickInput {
    let input = follow_route(world);
    world.step(&input);
    input
}
