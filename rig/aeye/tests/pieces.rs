//! An experiment in pieces: whichever processes do them in whatever order, together they are what one process gives.

mod common;
#[allow(dead_code, reason = "kills use all of it")]
#[path = "kills/contents.rs"]
mod contents;
#[path = "kills/street.rs"]
mod street;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::thread;

use base::output::OutputFolder;
use common::{aeye, run};
use contents::{assert_same, contents};
use kernel::rng::{self, Stream};
use serde_json::Value;
use street::street;

const RECIPE: &str = include_str!("kills/recipe.toml");
const PROCESSES: u64 = 2;
/// No room at this moment: somebody else is at work there.
const LATER: Option<i32> = Some(75);

/// `aeye experiment` in a folder of this one, which goes well unless another process is in its way.
fn experiment(root: &Path, tail: &str) -> (Option<i32>, String) {
    let command = format!("experiment --recipe recipe.toml --jobs 1 {tail}");
    let (code, out, said) = run(&mut aeye(root, &command));
    assert!(code == Some(0) || code == LATER, "{tail}: {code:?}: {said}");
    (code, out)
}

fn open_pieces(root: &Path) -> Vec<Value> {
    let (_, lines) = experiment(root, "--out parted --pieces --json");
    lines.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

/// Takes one piece after the other by chance, until none is left; gives those that it did.
fn do_pieces(root: &Path, process: u64) -> Vec<String> {
    let mut done = Vec::new();
    for turn in 0.. {
        let open = open_pieces(root);
        if open.is_empty() {
            break;
        }
        let draw = rng::bits(process, Stream::Scenario, turn, 0) >> 32;
        let piece = open[draw as usize % open.len()]["piece"].as_str().expect("a name");
        if experiment(root, &format!("--out parted --piece {piece}")).0 == Some(0) {
            done.push(piece.to_owned());
        }
    }
    done
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn pieces_come_to_what_one_process_gives() {
    let dir = tempfile::tempdir().expect("a folder");
    let root = dir.path();
    street(&root.join("street.xodr"));
    let recipe = RECIPE.replace("../street", "street").replace("seeds = 1", "seeds = 2");
    fs::write(root.join("recipe.toml"), recipe).expect("writable");
    assert_eq!(experiment(root, "--out alone").0, Some(0));

    let first = open_pieces(root);
    let names: Vec<&Value> = first.iter().map(|piece| &piece["piece"]).collect();
    assert_eq!(names, ["datasets/natural", "datasets/pool"]);
    assert!(!root.join("parted").exists(), "asking makes nothing");
    let done: Vec<String> = thread::scope(|scope| {
        let threads: Vec<_> = (0..PROCESSES).map(|process| scope.spawn(move || do_pieces(root, process))).collect();
        threads.into_iter().flat_map(|thread| thread.join().expect("no panic")).collect()
    });
    let alone = contents(&root.join("alone"));
    let expected = |folder: &str, ending: &str| -> BTreeSet<String> {
        let stem = |path: &String| path.strip_suffix(ending).map(str::to_owned);
        alone.keys().filter_map(stem).filter(|name| name.starts_with(folder) && !name.ends_with(".case")).collect()
    };
    let done: BTreeSet<String> = done.into_iter().collect();
    let runs = &expected("campaign-1", ".mcap") | &expected("campaign-2", ".mcap");
    let networks = expected("networks", ".onnx");
    assert!(runs.len() > 4 && networks.len() == 7, "{runs:?} {networks:?}");
    let datasets = ["datasets/natural", "datasets/pool", "datasets/sets"].map(str::to_owned).into();
    assert_eq!(done, &(&runs | &networks) | &datasets);

    let trained =
        |name: &str| fs::metadata(root.join("parted").join(name)).and_then(|file| file.modified()).expect("there");
    let before = trained("networks/natural-2.onnx");
    let shared = OutputFolder::share(&root.join("parted")).expect("free");
    assert_eq!(experiment(root, "--out parted").0, LATER, "somebody does a piece");
    drop(shared);
    assert_eq!(experiment(root, "--out parted").0, Some(0));
    assert_eq!(before, trained("networks/natural-2.onnx"), "is not trained twice");
    assert_same(&contents(&root.join("parted")), &alone, "in pieces");
}

#[test]
fn a_piece_waits_for_what_it_needs_and_must_be_one() {
    let dir = tempfile::tempdir().expect("a folder");
    let refused =
        |name: &str| run(&mut aeye(dir.path(), &format!("experiment --preset smoke --out out --piece {name}")));
    let (code, _, said) = refused("networks/natural-3");
    assert!(code == Some(2) && said.contains("networks/natural-3: is no piece of this experiment"), "{said}");
    assert!(!dir.path().join("out").exists());
    let (code, _, said) = refused("networks/natural-2");
    let expected = "out/datasets/sets/natural: is not there; expected it before networks/natural-2";
    assert!(code == Some(1) && said.contains(expected), "{said}");
    let other = run(&mut aeye(dir.path(), "experiment --preset small --out out --pieces"));
    assert!(other.0 == Some(1) && other.2.contains("is another experiment's"), "{}", other.2);
}
