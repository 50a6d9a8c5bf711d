//! An hour of driving fits into 4 MB.

use std::fs;
use std::path::Path;

use aeye::cli::Cli;
use clap::Parser;
use replay::Recording;

/// Most bytes an hour, with 100 to 150 actors (design: CARLA writes about 200 MB, poses only).
const BYTES_AN_HOUR: f64 = 4e6;

/// Drives with bots in both seats and a mask ten times a second; bytes and ticks of the recording.
fn driven(map: &str, seconds: u32, folder: &Path) -> (usize, u64) {
    let path = folder.join(format!("{map}-{seconds}.mcap"));
    let options = format!("--checkpoint truth --seed 77 --hazards none --max-time {seconds}s");
    let line = format!("aeye --json drive --headless --map {map} {options} --record");
    let words = line.split(' ').chain([path.to_str().expect("UTF-8")]);
    aeye::run(&Cli::try_parse_from(words).expect("a valid command line")).expect("a drive");
    let bytes = fs::read(&path).expect("a recording");
    (bytes.len(), Recording::from_bytes(&bytes).expect("a recording").log().last_tick())
}

fn fits_into_4_mb(map: &str) {
    let dir = tempfile::tempdir().expect("a folder");
    let [(start, from), (end, to)] = [10, 70].map(|seconds| driven(map, seconds, dir.path()));
    assert!(to - from >= 1800, "the run ended after {to} ticks");
    let an_hour = (end - start) as f64 / (to - from) as f64 * 3600.0 * 60.0;
    assert!(an_hour <= BYTES_AN_HOUR, "{an_hour:.0} bytes an hour from tick {from} to {to}");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn an_hour_in_the_city_fits_into_4_mb() {
    fits_into_4_mb("city");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn an_hour_in_the_country_fits_into_4_mb() {
    fits_into_4_mb("rural");
}
