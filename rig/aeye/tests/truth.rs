//! The loop itself: through true masks the drivers of this program need next to no takeovers.
//!
//! `AEYE_LOOP_KM` kilometres instead of the few of `make test`: `make campaign-check`.

mod common;

use common::{aeye, run};
use serde_json::Value;

/// What is driven where nobody asks for more, km.
const QUICK_KM: f64 = 4.0;
/// Corner cases a kilometre that are aimed at.
const AIMED_PER_KM: f64 = 0.05;

#[test]
fn takeovers_are_at_most_twice_as_frequent_as_aimed_at() {
    let asked = std::env::var("AEYE_LOOP_KM").map(|km| km.parse().expect("a number of kilometres"));
    let km: f64 = asked.unwrap_or(QUICK_KM);
    let folder = tempfile::tempdir().expect("writable");
    let line = format!("campaign --json --checkpoint truth --maps all --km {km} --max-time 1m --seed 4242 --out runs");
    let (code, out, said) = run(&mut aeye(folder.path(), &line));
    assert_eq!(code, Some(0), "{said}");
    let figures: Value = serde_json::from_str(&out).expect("it is JSON");
    let cases = figures["cases"].as_f64().expect("a number");
    let driven_km = figures["km"].as_f64().expect("a number");
    assert!(driven_km >= km, "{driven_km} of {km} km: {out}");
    let most = (2.0 * AIMED_PER_KM * driven_km).max(1.0);
    assert!(cases <= most, "{cases} cases where {most:.1} would be twice as many as aimed at: {out}");
}
