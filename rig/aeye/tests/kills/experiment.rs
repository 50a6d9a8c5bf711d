//! The paper from end to end, in its smallest.

use std::fs;
use std::path::Path;

use crate::ordeal::survive;
use crate::street::street;

const RECIPE: &str = include_str!("recipe.toml");

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn an_experiment_goes_on() {
    let arguments = "experiment --recipe ../recipe.toml --jobs 2 --out out";
    let prepare = |root: &Path| {
        street(&root.join("street.xodr"));
        fs::write(root.join("recipe.toml"), RECIPE).expect("writable");
    };
    survive("experiment", arguments, prepare, |_, _| ());
}
