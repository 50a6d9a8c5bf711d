//! However a drive ends, its recording is readable and the reason is said.

use std::path::{Path, PathBuf};
use std::process::Command;

use kernel::time::TICK_HZ;
use replay::Recording;

use crate::display::Display;
use crate::rig::{AEYE, CENTRE, Rig, SAFETY, aeye, wait_for_tick};

/// Starts a drive of a bot, which nobody ends by a takeover, and waits for its third second.
fn driving(display: &Display, wrapper: &[&str]) -> (Rig, PathBuf) {
    let record = display.folder().join("drive.mcap");
    let rig = Rig::start_with(display, wrapper, &record, &["--semantic", "bot", "--safety", "keyboard"]);
    rig.says("run 1 is ready");
    display.focus(&display.window(CENTRE));
    display.keys(&["key", "n"]);
    wait_for_tick(&record, 2 * u64::from(TICK_HZ));
    (rig, record)
}

fn last_tick(record: &Path) -> u64 {
    Recording::open(record).expect("a readable recording").log().last_tick()
}

#[test]
#[cfg_attr(no_windows, ignore = "needs Xvfb, xdotool and a Vulkan driver")]
fn a_closed_window_ends_the_session() {
    let dir = tempfile::tempdir().expect("a folder");
    let display = Display::open(dir.path());
    let (rig, record) = driving(&display, &[]);
    display.keys(&["windowclose", &display.window(SAFETY)]);
    rig.says("a window was closed");
    rig.exit();
    let contents = aeye(&["inspect"], &record);
    assert_eq!((&contents["finished"], &contents["outcome"]), (&true.into(), &"stopped".into()));
    assert_eq!(aeye(&["verify"], &record)["ok"], true);
}

#[test]
#[cfg_attr(no_windows, ignore = "needs Xvfb, xdotool and a Vulkan driver")]
fn a_killed_rig_leaves_all_but_the_last_second() {
    let dir = tempfile::tempdir().expect("a folder");
    let display = Display::open(dir.path());
    let (mut rig, record) = driving(&display, &[]);
    let told = 5 * u64::from(TICK_HZ);
    rig.says(&format!("tick {told}"));
    rig.child.kill().expect("it runs");
    assert!(!rig.exit().success());
    let kept = last_tick(&record);
    assert!(kept + u64::from(TICK_HZ) >= told, "{kept} of {told}");
    assert_eq!(aeye(&["inspect"], &record)["finished"], false);
    assert_eq!(aeye(&["verify"], &record)["ok"], true);
}

/// A limit on the size of files stands for a disk that is full: the same write fails.
#[test]
#[cfg_attr(no_windows, ignore = "needs Xvfb, xdotool and a Vulkan driver")]
fn a_full_disk_ends_the_drive_and_says_so() {
    let dir = tempfile::tempdir().expect("a folder");
    let display = Display::open(dir.path());
    let limited = "trap '' XFSZ; ulimit -f 40; exec \"$@\"";
    let (rig, record) = driving(&display, &["bash", "-c", limited, "limited"]);
    let said = rig.says("drive.mcap: File too large");
    let told = said.iter().filter_map(|line| line.strip_prefix("tick ")?.parse::<u64>().ok()).max().expect("a tick");
    assert_eq!(rig.exit().code(), Some(1));
    let said = Command::new(AEYE).args(["verify"]).arg(&record).output().expect("aeye runs");
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let kept = last_tick(&record);
    assert!(kept >= 2 * u64::from(TICK_HZ) && kept + u64::from(TICK_HZ) >= told, "{kept} of {told}");
}
