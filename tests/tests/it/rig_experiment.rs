//! An experiment's folder belongs to one recipe, and nonsense is refused before anything is done.

use std::fs;

use aeye::cli::Cli;
use aeye::exit;
use base::failure::sentence;
use clap::Parser;
use lab::experiment::{Preset, Recipe};

/// Exit code and sentence of `aeye experiment`.
fn experiment(arguments: &[&str]) -> (u8, String) {
    let cli = Cli::try_parse_from([&["aeye", "experiment"], arguments].concat()).expect("a valid command line");
    let result = aeye::run(&cli);
    (exit::number(&result), result.err().map(|e| sentence(&e)).unwrap_or_default())
}

#[test]
fn a_recipe_is_read_and_refused_by_its_place() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("mine.toml");
    let text = Preset::Smoke.recipe().unwrap().to_toml().unwrap();
    fs::write(&path, &text).unwrap();
    assert_eq!(Recipe::read(&path).unwrap(), Preset::Smoke.recipe().unwrap());
    let (file, out) = (path.to_str().unwrap(), dir.path().join("out"));
    assert_eq!(experiment(&["--recipe", file, "--print-recipe"]), (0, String::new()));
    fs::write(&path, text.replace("[pool]", "[puddle]")).unwrap();
    let (code, sentence) = experiment(&["--recipe", file, "--out", out.to_str().unwrap()]);
    assert!(code == 1 && sentence.contains("mine.toml") && sentence.contains("puddle"), "{sentence}");
    assert!(!out.exists());
    for wrong in [&["--out", "x"][..], &["--preset", "smoke"], &["--preset", "huge", "--out", "x"]] {
        let error = Cli::try_parse_from([&["aeye", "experiment"], wrong].concat()).expect_err("nonsense");
        assert_eq!(error.exit_code(), 2, "{wrong:?}");
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_folder_of_another_recipe_is_left_alone() {
    let dir = tempfile::tempdir().unwrap();
    let recipe = Preset::Desk.recipe().unwrap().to_toml().unwrap();
    fs::write(dir.path().join("recipe.toml"), &recipe).unwrap();
    let (code, sentence) = experiment(&["--preset", "smoke", "--out", dir.path().to_str().unwrap()]);
    assert!(code == 1 && sentence.contains("another experiment"), "{sentence}");
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    assert_eq!(fs::read_to_string(dir.path().join("recipe.toml")).unwrap(), recipe);
}
