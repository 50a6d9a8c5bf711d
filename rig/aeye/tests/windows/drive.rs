//! A session from the first key to the last.

use std::path::Path;
use std::process::Command;
use std::time::Duration;

use replay::Recording;

use crate::display::Display;
use crate::rig::{AEYE, CENTRE, Rig, SAFETY, SEMANTIC, aeye, wait_for_tick, wait_until};

#[test]
#[cfg_attr(no_windows, ignore = "needs Xvfb, xdotool and a Vulkan driver")]
fn two_people_drive_intervene_label_and_go_on() {
    let dir = tempfile::tempdir().expect("a folder");
    let display = Display::open(dir.path());
    let record = dir.path().join("drive.mcap");
    let rig = Rig::start(&display, &record, &["--semantic", "keyboard", "--safety", "keyboard", "--seed", "3"]);

    rig.says("run 1 is ready");
    let [semantic, safety, centre] = [SEMANTIC, SAFETY, CENTRE].map(|title| display.window(title));
    display.focus(&semantic);
    display.keys(&["key", "n"]);
    display.keys(&["keydown", "w"]);
    wait_for_tick(&record, 60);
    display.keys(&["keyup", "w"]);
    wait_for_tick(&record, 240);
    display.keep("drive");
    check_pictures(&display);
    display.focus(&safety);
    display.keys(&["keydown", "Down"]);
    wait_until(|| Recording::open(&record).is_ok_and(|recording| recording.log().intervention.is_some()));
    std::thread::sleep(Duration::from_millis(200));
    display.keep("takeover");
    rig.says("run 1 has ended");
    display.keys(&["keyup", "Down"]);
    display.focus(&centre);
    display.keys(&["key", "1"]);
    display.keys(&["type", "--delay", "50", "seen too late"]);
    display.keep("label");
    display.keys(&["key", "Return"]);

    rig.says("run 2 is ready");
    let case = dir.path().join("drive.case.mcap");
    wait_until(|| case.exists());
    // The strip of the case: true classes, the road's among them, where it was black before.
    wait_until(|| display.picture().share([128, 64, 128], [360, 780], [480, 50]) > 0.1);
    display.keep("strip");
    display.keys(&["key", "n"]);
    let second = dir.path().join("drive-2.mcap");
    wait_for_tick(&second, 60);
    display.keys(&["key", "Escape"]);
    std::thread::sleep(Duration::from_millis(500));
    display.keep("ending");
    display.keys(&["key", "p"]);
    wait_for_tick(&second, 180);
    display.keys(&["key", "b", "7"]);
    display.keys(&["type", "--delay", "50", "spilt coffee"]);
    display.keep("discard");
    display.keys(&["key", "Return"]);
    rig.says("run 3 is ready");
    display.keys(&["key", "Escape"]);
    assert!(rig.exit().success());

    for file in [&record, &second, &case] {
        let verified = aeye(&["verify"], file);
        assert_eq!(verified["ok"], true, "{verified}");
    }
    let contents = aeye(&["inspect"], &record);
    assert_eq!((&contents["label"], &contents["comment"]), (&"walker".into(), &"seen too late".into()), "{contents}");
    assert_eq!((&contents["outcome"], &contents["intervention"]["by_brake"]), (&"intervened".into(), &true.into()));
    assert!(contents["km"].as_f64().expect("a number") > 0.001, "the car has moved: {contents}");
    check_masks(&record);
    let digests = aeye(&["view", "--digests"], &record);
    assert_eq!((&digests["different"], &digests["equal"]), (&0.into(), &digests["masks"]), "{digests}");
    assert_eq!(aeye(&["inspect"], &case)["comment"], "seen too late");
    let discarded = aeye(&["inspect"], &second);
    assert_eq!((&discarded["outcome"], &discarded["comment"]), (&"discarded".into(), &"spilt coffee".into()));
    let notes = discarded["notes"].as_array().expect("notes");
    let kinds: Vec<&str> = notes.iter().filter_map(|note| note["kind"].as_str()).collect();
    assert_eq!(kinds, ["paused", "resumed"]);
    let counted = aeye(&["statistics"], dir.path());
    let [of_all] = counted["checkpoints"].as_array().expect("checkpoints").as_slice() else { panic!("{counted}") };
    assert_eq!((&of_all["rides"], &of_all["set_aside"][0]["label"]), (&1.into(), &"discarded".into()), "{counted}");
}

/// The semantic driver sees class colours and nothing else of the world, the safety driver the image.
fn check_pictures(display: &Display) {
    let picture = display.picture();
    let road = [128, 64, 128];
    let share = |[x, y]: [usize; 2]| picture.share(road, [x, y], [600, 160]);
    assert!(share([20, 180]) > 0.2, "the semantic driver sees a road: {}", share([20, 180]));
    assert!(share([670, 180]) < 0.01, "the safety driver sees no mask: {}", share([670, 180]));
    assert!(picture.colours([670, 100], [600, 200]) > 200, "the safety driver sees an image");
}

/// Masks were shown, in order, each after its frame.
fn check_masks(record: &Path) {
    let recording = Recording::open(record).expect("a recording");
    let masks = &recording.log().masks;
    assert!(masks.len() > 3, "{}", masks.len());
    assert!(masks.is_sorted_by_key(|m| m.tick_shown));
    for mask in masks {
        let times = mask.times.expect("live drives hold times");
        assert!(mask.tick_of_frame < mask.tick_shown, "{mask:?}");
        assert!(times.capture_us < times.inference_us && times.inference_us < times.present_us, "{mask:?}");
    }
}

#[test]
#[cfg_attr(no_windows, ignore = "needs Xvfb, xdotool and a Vulkan driver")]
fn a_terminated_drive_of_bots_leaves_a_whole_recording() {
    let dir = tempfile::tempdir().expect("a folder");
    let display = Display::open(dir.path());
    let record = dir.path().join("bots.mcap");
    let rig = Rig::start(&display, &record, &["--semantic", "bot", "--safety", "bot"]);
    rig.says("run 1 is ready");
    display.focus(&display.window(CENTRE));
    display.keys(&["key", "n"]);
    wait_for_tick(&record, 120);
    let pid = rig.child.id().to_string();
    assert!(Command::new("kill").args(["-TERM", &pid]).status().expect("kill runs").success());
    rig.says("ended by Ctrl-C or SIGTERM");
    assert_eq!(rig.exit().code(), Some(128 + 15));
    let contents = aeye(&["inspect"], &record);
    assert_eq!((&contents["finished"], &contents["outcome"]), (&true.into(), &"stopped".into()));
    assert_eq!(contents["provenance"]["semantic"], "bot");
    assert_eq!(aeye(&["verify"], &record)["ok"], true);
}

#[test]
fn without_a_display_it_says_what_to_do() {
    let dir = tempfile::tempdir().expect("a folder");
    let record = dir.path().join("drive.mcap");
    let mut command = Command::new(AEYE);
    command.args(["drive", "--record"]).arg(&record).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    let output = command.output().expect("aeye runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("--headless") && said.lines().count() == 1 && !said.contains(".rs:"), "{said}");
    assert!(!record.exists());
}
