//! Makes a library of many corner cases out of a few, to see how an index grows with it.
//!
//! `many_cases FOLDER COUNT OUT [whole]`: copies of the cases in a folder, a thousand to a folder of `OUT`, each of another
//! recording, seed, label and place on the map. Copies have the headers, first state and last scene of their case, or with
//! `whole` all scenes and the log too; nobody can drive them again.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use base::spread::{collect_in_order, jobs};
use replay::{Annotation, Case, Label, Log};

const USAGE: &str = "usage: many_cases FOLDER COUNT OUT [whole]";
/// Copies in a folder.
const IN_A_FOLDER: u64 = 1000;
/// Copies are spread over a square with sides of so many metres.
const SIDE_M: f32 = 4000.0;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let made = match arguments.as_slice() {
        [from, count, out] => copies(Path::new(from), count, Path::new(out), false),
        [from, count, out, "whole"] => copies(Path::new(from), count, Path::new(out), true),
        _ => Err(USAGE.to_owned()),
    };
    match made {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("{reason}");
            ExitCode::FAILURE
        }
    }
}

fn copies(from: &Path, count: &str, out: &Path, whole: bool) -> Result<(), String> {
    let count: usize = count.parse().map_err(|_| format!("{count}: expected a whole number; {USAGE}"))?;
    let mut logs = cases(from)?;
    if !whole {
        logs.iter_mut().for_each(leave_out_the_log);
    }
    let copy = |number: usize| copy(&logs[number % logs.len()], number as u64, out);
    collect_in_order(jobs(None), count, copy).into_iter().collect()
}

fn copy(log: &Log, number: u64, out: &Path) -> Result<(), String> {
    let folder = out.join(format!("{:03}", number / IN_A_FOLDER));
    let path = folder.join(format!("copy-{number}.case.mcap"));
    let mut log = log.clone();
    change(&mut log, number);
    let bytes = log.encode().map_err(|e| format!("{}: {e}", path.display()))?;
    fs::create_dir_all(&folder).and_then(|()| fs::write(&path, bytes)).map_err(|e| format!("{}: {e}", path.display()))
}

fn cases(folder: &Path) -> Result<Vec<Log>, String> {
    let told = |e: &dyn std::fmt::Display| format!("{}: {e}", folder.display());
    let entries = fs::read_dir(folder).map_err(|e| told(&e))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.to_string_lossy().ends_with(".case.mcap"));
    paths.sort();
    if paths.is_empty() {
        return Err(told(&"holds no *.case.mcap"));
    }
    paths.iter().map(|path| Case::open(path).map(|case| case.log().clone()).map_err(|e| e.to_string())).collect()
}

/// Makes a case another one.
fn change(log: &mut Log, number: u64) {
    let drawn = draw(number);
    if let Some(case) = &mut log.manifest.case {
        case.source = std::array::from_fn(|byte| draw(number << 8 | byte as u64) as u8);
    }
    log.manifest.scenario.seed = drawn;
    let label = Label::CASES[drawn as usize % Label::CASES.len()];
    let comment = log.annotation.as_ref().map(|annotation| annotation.comment.clone()).unwrap_or_default();
    log.annotation = Some(Annotation { label, comment, perception_caused: Some(drawn >> 8 & 1 == 1) });
    let part = |shift: u32| (drawn >> shift & 0xffff) as f32 / 65_536.0 - 0.5;
    for scene in &mut log.scenes {
        // Whole metres stay on the grid of the scenes' bytes.
        let moved = (SIDE_M * part(16)).round();
        scene.ego.position.x += moved;
        scene.ego.position.y += (SIDE_M * part(32)).round();
        scene.actors.iter_mut().for_each(|actor| actor.position.x += moved);
    }
}

/// A number that looks drawn (splitmix64).
fn draw(number: u64) -> u64 {
    let mut z = number.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

fn leave_out_the_log(log: &mut Log) {
    log.keyframes.truncate(1);
    log.scenes.drain(..log.scenes.len().saturating_sub(1));
    log.inputs.clear();
    log.hashes.clear();
    log.marks.clear();
    log.events.clear();
    log.masks.clear();
    log.notes.clear();
}
