//! Drives: what was told is in the recording, up to a second.

use std::fs;
use std::path::Path;

use kernel::time::{TICK_HZ, Tick};
use replay::Recording;

use crate::common::{aeye, run};
use crate::draws::Draws;
use crate::program::{Aim, Start, start};

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_drive_loses_at_most_a_second() {
    let (dir, mut draws) = (tempfile::tempdir().expect("a folder"), Draws::of("drive"));
    let root = dir.path();
    ["whole", "tmp"].iter().for_each(|name| fs::create_dir(root.join(name)).expect("writable"));
    let arguments = "drive --headless --map city --seed 3 --max-time 20s --record run.mcap";
    let within = start(root, "whole", arguments, None).took;
    let whole = fs::read(root.join("whole/run.mcap")).expect("recorded");
    let (mut kills, mut ends) = (0, 0);
    while kills < draws.kills() {
        let folder = root.join("killed");
        fs::create_dir(&folder).expect("writable");
        let aim = Aim { at_change: false, ..draws.aim(within) };
        let started = start(root, "killed", arguments, Some(aim));
        let left = fs::read(folder.join("run.mcap")).unwrap_or_default();
        assert!(whole.starts_with(&left), "it is the same drive");
        assert!(started.was_killed || left == whole, "it came to its end");
        if started.was_killed {
            check(&folder, &started);
        }
        kills += u32::from(started.was_killed);
        ends += u32::from(!started.was_killed);
        fs::remove_dir_all(&folder).expect("writable");
    }
    eprintln!("drive: {kills} kills of drives of {within:.1?}; {ends} ended before");
}

/// What was told before the kill is there and replays.
fn check(folder: &Path, killed: &Start) {
    let told = killed.said.lines().filter_map(|line| line.strip_prefix("tick ")?.parse::<Tick>().ok()).next_back();
    let Some(told) = told else { return };
    let recording = Recording::open(&folder.join("run.mcap")).expect("readable");
    let last = recording.log().last_tick();
    assert!(last + Tick::from(TICK_HZ) >= told, "{told} ticks were told, {last} are kept");
    let (code, out, said) = run(&mut aeye(folder, "verify run.mcap"));
    assert_eq!(code, Some(0), "{said}");
    assert!(out.contains(&format!("{last} ticks identical")) || last < 2, "{out}");
}
