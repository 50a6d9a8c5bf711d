//! Whatever becomes of an OpenDRIVE text, it bakes to a sound map or is refused in one sentence.
//! `tests/fuzz.sh` looks longer.
#![allow(clippy::disallowed_methods, reason = "tests may read files and the environment")]

#[path = "common/mutate.rs"]
mod mutate;
#[path = "../../tests/src/roads.rs"]
#[allow(dead_code, reason = "others use the rest")]
mod roads;

use kernel::RoadNetwork;
use kernel::map::{LaneKind, bake_with_notes};
use mutate::{Mutation, mutated, mutations};
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;

/// Real and made maps, small ones first.
fn origins() -> Vec<String> {
    let maps = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/maps/");
    let cross =
        ["cross_none", "cross_lights", "cross_stop", "cross_yield", "cross_hill", "cross_wide", "cross_references"];
    let read = |path: String| std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    let track = roads::winding(1, 60.0).replace("</lane>", "<material sOffset=\"21.5\" surface=\"gravel\"/></lane>");
    let mut texts = vec![roads::winding(2, 60.0), roads::crossing(2, 60.0), track];
    texts.extend(cross.map(|name| read(format!("{maps}{name}.xodr"))));
    texts.push(read(concat!(env!("CARGO_MANIFEST_DIR"), "/maps/rural.xodr").to_owned()));
    // A folder of further maps to start from.
    if let Some(folder) = std::env::var_os("AEYE_MUTATE") {
        let files = std::fs::read_dir(&folder).expect("AEYE_MUTATE names a folder");
        texts.extend(files.map(|file| read(file.expect("the folder lists").path().display().to_string())));
    }
    texts
}

fn check_sound(map: &RoadNetwork) {
    for lane in &map.lanes {
        assert!(lane.points.len() >= 2 && lane.length_m > 0.0, "lane {} has a length", lane.name);
        assert!(lane.points.iter().all(|p| p.position.is_finite() && p.half_width_m.is_finite()), "lane {}", lane.name);
        let middle = lane.at(lane.length_m / 2.0).position;
        assert!(lane.kind != LaneKind::Driving || map.nearest_lane(middle, lane.kind, None, 1.0).is_some());
        let _ = map.ground(middle);
    }
    for surface in &map.surfaces {
        assert!(surface.positions.iter().all(|p| p.is_finite()), "{:?}", surface.kind);
    }
    assert!(map.props.iter().all(|p| p.position.is_finite() && p.size.is_finite()));
}

fn check(text: &str) -> TestCaseResult {
    hunt::trying(&[("mutated.xodr", text.as_bytes())]);
    match bake_with_notes("mutated", text) {
        Ok(baked) => {
            for group in &baked.passed_over {
                let is_line = |text: &str| text.len() < 1000 && !text.contains(char::is_control);
                assert!(group.count > 0 && is_line(&group.what) && is_line(&group.first), "{group:?}");
            }
            assert!(baked.told.marks.iter().all(|mark| mark.points.iter().all(|p| p.is_finite())));
            assert_eq!(baked.told.lane_types.len(), baked.map.lanes.len());
            assert_eq!(baked.told.controls.len(), baked.map.junctions.len());
            check_sound(&baked.map.into());
        }
        Err(refusal) => {
            let said = refusal.to_string();
            prop_assert!(
                said.contains("expected") && !said.contains('\n') && said.len() < 400,
                "one sentence: {}",
                said
            );
        }
    }
    Ok(())
}

#[test]
fn a_changed_map_bakes_or_is_refused() {
    let origins = origins();
    hunt::hunt("map", 200, (any::<prop::sample::Index>(), mutations()), |(origin, mutations)| {
        check(&mutated(&origins[origin.index(origins.len())], &mutations))
    });
}

#[test]
fn every_kind_of_change_changes_something() {
    let text = roads::winding(1, 20.0);
    let at = || any::<prop::sample::Index>();
    proptest!(ProptestConfig { cases: 20, failure_persistence: None, ..ProptestConfig::default() }, |(a in at())| {
        for change in [
            Mutation::Number(a, "7e7"), Mutation::Forget(a), Mutation::Delete(a), Mutation::Repeat(a, 2), Mutation::Cut(a),
        ] {
            prop_assert!(mutated(&text, std::slice::from_ref(&change)) != text, "{:?}", change);
        }
    });
}
