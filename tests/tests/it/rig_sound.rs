//! What was heard of a recording is a WAV file, as long as its window, louder while the car speeds up, the same each time.

use std::fs;
use std::path::Path;

use kernel::time::Tick;
use replay::{Recording, Replayer};
use tests::command::aeye;
use tests::recordings::{ALONE, record};
use tests::scenes::busy_city;

const TICKS: Tick = 600;
const SAMPLES_A_TICK: usize = 800;
/// What sounded last rings on for a second.
const TAIL: usize = 48_000;

fn export(options: &str, recording: &Path, out: &Path) -> (u8, String) {
    aeye(&format!("export {options}"), &[recording], out)
}

/// Left and right of a file of 16 bits, by the layout of RIFF alone.
fn samples(path: &Path) -> Vec<[i16; 2]> {
    let bytes = fs::read(path).unwrap();
    let number =
        |at: usize, size: usize| bytes[at..at + size].iter().rev().fold(0_usize, |n, b| n << 8 | usize::from(*b));
    assert_eq!((&bytes[..4], &bytes[8..16], &bytes[36..40]), (&b"RIFF"[..], &b"WAVEfmt "[..], &b"data"[..]));
    assert_eq!((number(20, 2), number(22, 2), number(24, 4), number(34, 2)), (1, 2, 48_000, 16));
    assert_eq!((number(4, 4), number(40, 4)), (bytes.len() - 8, bytes.len() - 44));
    let side = |two: &[u8]| i16::from_le_bytes([two[0], two[1]]);
    bytes[44..].chunks_exact(4).map(|frame| [side(&frame[..2]), side(&frame[2..])]).collect()
}

fn power(samples: &[[i16; 2]]) -> f64 {
    samples.iter().flatten().map(|s| f64::from(*s) * f64::from(*s)).sum::<f64>() / samples.len() as f64
}

#[test]
fn what_was_heard_is_as_long_as_its_window_and_loud_where_the_car_speeds_up() {
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("a.mcap");
    fs::write(&recording, record(&busy_city(), TICKS, ALONE)).unwrap();
    let wav = folder.path().join("a.wav");
    let (code, said) = export("--jobs 1", &recording, &wav);
    assert_eq!(code, 0, "{said}");
    let heard = samples(&wav);
    assert_eq!(heard.len(), TICKS as usize * SAMPLES_A_TICK + TAIL);

    // By halves of a second: those in which the car speeds up, and those in which it rolls.
    let read = Recording::open(&recording).unwrap();
    let mut replayer = Replayer::new(read.log(), read.network().unwrap()).unwrap();
    let mut last_mps = 0.0;
    let (mut pulls, mut rolls) = (Vec::new(), Vec::new());
    for part in heard[..heard.len() - TAIL].chunks_exact(30 * SAMPLES_A_TICK) {
        replayer.run_to(replayer.world().tick() + 30).unwrap();
        let mps = replayer.world().scene().ego.speed_mps;
        if mps > last_mps + 1.0 {
            pulls.push(power(part));
        } else if mps > 1.0 && (mps - last_mps).abs() < 0.2 {
            rolls.push(power(part));
        }
        last_mps = mps;
    }
    let mean = |powers: &[f64]| powers.iter().sum::<f64>() / powers.len() as f64;
    assert!(pulls.len() > 1 && rolls.len() > 1, "{pulls:?} {rolls:?}");
    assert!(mean(&pulls) > 1.5 * mean(&rolls) && mean(&rolls) > 1000.0, "{pulls:?} {rolls:?}");

    let (code, said) = export("--jobs 1", &recording, &wav);
    assert_eq!((code, samples(&wav) == heard), (0, true), "kept, as it is the same: {said}");
    let (code, said) = export("--from 2s --to 4s", &recording, &wav);
    assert!(code != 0 && said.contains("exists already"), "{said}");
    let part = folder.path().join("part.wav");
    assert_eq!(export("--from 2s --to 4s", &recording, &part).0, 0);
    assert_eq!(samples(&part).len(), 121 * SAMPLES_A_TICK + TAIL, "both ends belong to it");
}
