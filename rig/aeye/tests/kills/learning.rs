//! Datasets and trainings.

use crate::common::dataset;
use crate::ordeal::survive;

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_natural_dataset_goes_on() {
    let arguments = "dataset natural --maps rural,city --scenes 4 --val-scenes 2 --test-scenes 1 --frames 6 \
                     --test-frames 4 --size 128x64 --jobs 2 --out out";
    survive("natural", arguments, |_| (), |_, _| ());
}

#[test]
fn a_training_goes_on_from_its_last_epoch() {
    let mut told = 0;
    let arguments = "--json train --dataset ../data --epochs 8 --size 64x32 --batch 4 --out c.onnx";
    survive(
        "train",
        arguments,
        |root| dataset(&root.join("data"), 24, 4),
        |start, is_fresh| {
            let done = start.said.lines().find_map(|line| line.split_once("; ")?.1.strip_suffix(" done"));
            let done = done.map(|epochs| epochs.split(' ').next().unwrap_or_default().parse().expect("a number"));
            told = if is_fresh { 0 } else { told };
            assert!(
                done.is_none_or(|done: u64| done >= told),
                "{done:?} epochs are done, {told} were told: {}",
                start.said
            );
            let epochs = start.out.lines().map(|line| serde_json::from_str(line).expect("JSON"));
            let last = epochs.filter_map(|line: serde_json::Value| line["epoch"].as_u64()).next_back();
            told = last.unwrap_or(told);
        },
    );
}
