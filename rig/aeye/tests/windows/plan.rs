//! A planned session of two people, killed in the middle and continued.

use std::fs;
use std::path::Path;

use replay::Recording;
use serde_json::Value;

use crate::display::Display;
use crate::rig::{CENTRE, Rig, aeye, wait_for_tick, wait_until};

/// Two conditions, each with both arrangements of seats; nothing else has the names of the checkpoints.
const PLAN: &str = r#"
participants = ["P07", "P03"]
blind = true
break_s = 2
questions = "each-half"
[[conditions]]
map = "rural"
checkpoint = "zebra.onnx"
max_time_s = 4
[[conditions]]
map = "city"
checkpoint = "walrus.onnx"
max_time_s = 120
"#;
const EARLY: &[u8] = include_bytes!("../../../../perception/checkpoints/early.onnx");

fn is_taken_over(record: &Path) -> bool {
    Recording::open(record).is_ok_and(|recording| recording.log().intervention.is_some())
}

/// Starts the run that waits and takes over, whoever of both is the safety driver; then labels it.
fn intervene(rig: &Rig, display: &Display, record: &Path, label: &str) {
    display.keys(&["key", "n"]);
    wait_for_tick(record, 200);
    display.keys(&["keydown", "Down", "keydown", "s"]);
    wait_until(|| is_taken_over(record));
    rig.says("has ended: label it");
    display.keys(&["keyup", "Down", "keyup", "s"]);
    display.keys(&["key", label, "Return"]);
}

fn answer(display: &Display) {
    (0..4).for_each(|_| display.keys(&["key", "3", "Return"]));
}

#[test]
#[cfg_attr(no_windows, ignore = "needs Xvfb, xdotool and a Vulkan driver")]
fn a_planned_session_is_killed_in_the_middle_and_continued() {
    let dir = tempfile::tempdir().expect("a folder");
    let [plan, record] = ["plan.toml", "pair.mcap"].map(|name| dir.path().join(name));
    fs::write(&plan, PLAN).expect("written");
    for name in ["zebra.onnx", "walrus.onnx"] {
        fs::write(dir.path().join(name), EARLY).expect("written");
    }
    let run = |number: u32| dir.path().join(format!("pair-{number}.mcap"));
    let display = Display::open(dir.path());

    let rig = Rig::planned(&display, &plan, &record);
    let mut heard = rig.says("run 1 is ready, trial 1 of 4: rural");
    display.focus(&display.window(CENTRE));
    display.keys(&["key", "n"]);
    wait_for_tick(&record, 60);
    display.keys(&["key", "p"]);
    display.keep("plan-paused");
    display.keys(&["key", "p"]);
    heard.extend(rig.says("run 2 is ready, trial 2 of 4: city"));
    display.keys(&["key", "n"]);
    wait_for_tick(&run(2), 60);
    display.keys(&["key", "b", "7", "Return"]);
    heard.extend(rig.says("run 3 is ready, trial 2 of 4: city"));
    intervene(&rig, &display, &run(3), "5");
    heard.extend(rig.says("P03 is the semantic driver, P07 the safety driver"));
    std::thread::sleep(std::time::Duration::from_millis(500));
    display.keep("plan-questions");
    answer(&display);
    wait_until(|| dir.path().join("pair-3.questionnaire.toml").is_file());
    display.keep("plan-break");
    display.keys(&["key", "n"]);
    wait_for_tick(&run(4), 120);
    let mut killed = rig;
    killed.child.kill().expect("killed");
    killed.exit();

    let rig = Rig::planned(&display, &plan, &record);
    heard.extend(rig.says("run 5 is ready, trial 3 of 4: city"));
    display.focus(&display.window(CENTRE));
    intervene(&rig, &display, &run(5), "1");
    heard.extend(rig.says("run 6 is ready, trial 4 of 4: rural"));
    display.keys(&["key", "n"]);
    heard.extend(rig.says("all trials of the plan are driven"));
    answer(&display);
    wait_until(|| dir.path().join("pair-6.questionnaire.toml").is_file());
    display.keep("plan-over");
    display.keys(&["key", "q"]);
    assert!(rig.exit().success());
    assert!(!heard.iter().any(|line| line.contains("zebra") || line.contains("walrus")), "{heard:?}");
    check(&plan, &record, &run(5));
}

/// What the plan says afterwards, and what the recordings hold.
fn check(plan: &Path, record: &Path, case: &Path) {
    let plan = plan.to_str().expect("a plain path");
    let told = aeye(&["drive", "--plan", plan, "--print-plan", "--record"], record);
    let of =
        |key: &str| -> Vec<Value> { told["trials"].as_array().into_iter().flatten().map(|t| t[key].clone()).collect() };
    assert_eq!(of("done"), [true; 4].map(Value::from), "{told}");
    // The killed run counts as far as it was driven.
    assert_eq!(of("runs"), [1, 1, 2, 1].map(Value::from), "{told}");
    assert_eq!(of("cases"), [0, 0, 1, 0].map(Value::from), "{told}");
    assert_eq!(of("semantic"), ["P07", "P07", "P03", "P03"].map(Value::from), "{told}");
    assert_eq!(of("checkpoint"), [Value::Null, Value::Null, Value::Null, Value::Null], "{told}");
    assert_eq!(told["totals"].as_array().map(Vec::len), Some(2), "{told}");
    let contents = aeye(&["inspect"], case);
    assert_eq!((&contents["label"], &contents["provenance"]["safety_name"]), (&"walker".into(), &"P07".into()));
    assert_eq!(aeye(&["verify"], case)["ok"], true);
    let counted = aeye(&["statistics"], record.parent().expect("a folder"));
    assert!(counted.to_string().contains("driver-error"), "{counted}");
}
