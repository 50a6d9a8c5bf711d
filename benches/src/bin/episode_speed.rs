//! Steps episodes as `aeye.gym` does, but in a plain loop on each thread, and says how many steps a second that were;
//! for `benches/peers/gym.py`, which does the same from Python.
//!
//! `episode_speed DRIVES ROUNDS STEPS JOBS`: in each round so many drives on the map `city` have so many steps of 6 ticks,
//! seen through true masks from the start on, at full throttle.

use std::process::ExitCode;
use std::time::Instant;

use base::maps::Map;
use base::spread;
use drivers::episode::{Episode, STEP_TICKS, hud};
use drivers::readout::Readout;
use drivers::vision::{Eye, Optics};
use kernel::{Controls, Seat};
use render::{AdapterChoice, Renderer};

const USAGE: &str = "usage: episode_speed DRIVES ROUNDS STEPS JOBS";

fn main() -> ExitCode {
    let numbers: Vec<usize> = std::env::args().skip(1).filter_map(|text| text.parse().ok()).collect();
    let said = match numbers.as_slice() {
        [drives, rounds, steps, jobs] => drive(drives * rounds, *steps, *jobs).map_err(|error| format!("{error:#}")),
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

/// One line of JSON.
fn drive(drives: usize, steps: usize, jobs: usize) -> anyhow::Result<String> {
    let map = Map::find("city")?;
    // Devices are made before the clock starts, as they are kept from reset to reset.
    let made: Result<Vec<_>, _> = (0..jobs).map(|_| Renderer::new(&map.network, &AdapterChoice::default())).collect();
    let devices = std::sync::Mutex::new(made?);
    let begin = Instant::now();
    let device = || {
        let renderer = devices.lock().expect("no panic").pop().expect("one for each job");
        (Optics::new(renderer, Eye::Truth), Vec::new())
    };
    spread::on_threads(jobs, drives, device, |(optics, mask): &mut (Optics, Vec<u8>), seed| {
        let mut episode = Episode::new(&map.scenario(seed as u64), &map, Seat::Semantic, None, true)?;
        observe(&mut episode, optics, mask)?;
        for _ in 0..steps {
            episode.step(optics, Controls::from_fractions(0.0, 1.0, 0.0), STEP_TICKS)?;
            observe(&mut episode, optics, mask)?;
        }
        Ok(())
    })?;
    let seconds = begin.elapsed().as_secs_f64();
    Ok(format!("{{\"steps\": {}, \"steps_a_second\": {:.1}}}", drives * steps, (drives * steps) as f64 / seconds))
}

/// As after a reset or a step of `aeye.gym`.
fn observe(episode: &mut Episode, optics: &mut Optics, mask: &mut Vec<u8>) -> anyhow::Result<()> {
    mask.clear();
    mask.extend_from_slice(episode.mask(optics)?.ids);
    std::hint::black_box((&mask, hud::row(&Readout::of(&episode.world().hud()))));
    Ok(())
}
