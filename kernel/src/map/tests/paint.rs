//! Paint: lines along the road end at crosswalks and stop lines, and nowhere else.

use glam::Vec2;
use proptest::prelude::*;

use super::broken::straight;
use super::*;
use crate::baking::lines_without_gaps;

/// What overlaps by less touches, metres: paint is rounded.
const TOUCH_M: f32 = 0.005;
/// How far lines keep from what they end at, at most, metres.
const MARGIN_M: f32 = 0.25;

type Triangle = [Vec3; 3];

/// Paint of a map that is of no crosswalk and no stop line: what comes before the first bar, and the blocks after them.
fn lines_and_blocks(map: &MapData) -> (Vec<Triangle>, Vec<Triangle>) {
    let paint = map.surfaces.iter().find(|s| s.kind == SurfaceKind::RoadLine).expect("paint");
    let first = first_bar(&map.crosswalks[0]);
    let is_first = |corners: &[Vec3]| corners.iter().zip(first).all(|(p, q)| p.truncate().distance(q) < TOUCH_M);
    let from = paint.positions.windows(4).position(is_first).expect("the bars of the first crosswalk") as u32;
    let bars: usize = map.crosswalks.iter().map(|c| (ends(c)[0].distance(ends(c)[1]) as usize).max(1)).sum();
    let to = from + 4 * bars as u32;
    let of = |wanted: &dyn Fn(u32) -> bool| -> Vec<Triangle> {
        let triangles = paint.triangles.iter().filter(|t| t.iter().all(|v| wanted(*v)));
        triangles.map(|t| t.map(|v| paint.positions[v as usize])).collect()
    };
    let found = (of(&|v| v < from), of(&|v| v >= to));
    let bars = of(&|v| (from..to).contains(&v));
    assert_eq!(found.0.len() + bars.len() + found.1.len(), paint.triangles.len(), "{}", map.name);
    found
}

fn ends(crosswalk: &Crosswalk) -> [Vec2; 2] {
    crosswalk.ends.map(Vec3::truncate)
}

fn first_bar(crosswalk: &Crosswalk) -> [Vec2; 4] {
    let [a, b] = ends(crosswalk);
    let along = (b - a).normalize();
    let pitch = a.distance(b) / (a.distance(b) as usize).max(1) as f32;
    let (from, to) = (a + along * (0.25 * pitch), a + along * (0.75 * pitch));
    let aside = along.perp() * crosswalk.half_width_m;
    [from - aside, to - aside, to + aside, from + aside]
}

fn outline(crosswalk: &Crosswalk) -> [Vec3; 4] {
    let [a, b] = crosswalk.ends;
    let aside = ((b - a).truncate().normalize().perp() * crosswalk.half_width_m).extend(0.0);
    [a - aside, b - aside, b + aside, a + aside]
}

/// A lane and its borders from its stop line on, if that is painted, for one metre.
fn before_junction(lane: &Lane, blocks: &[Triangle]) -> Option<[Vec3; 4]> {
    let s_m = lane.stop?.s_m;
    let (near, far) = (lane.at(s_m), lane.at(s_m + 0.95));
    let is_painted = blocks.iter().flatten().any(|p| p.distance(near.position) < near.half_width_m);
    let side = |p: &LanePoint, out_m: f32| p.position + (direction(p.heading_rad).perp() * out_m).extend(0.0);
    let (wide, narrow) = (near.half_width_m + 0.1, far.half_width_m + 0.1);
    is_painted.then(|| [side(&near, -wide), side(&far, -narrow), side(&far, narrow), side(&near, wide)])
}

/// Whether two convex outlines overlap by more than they touch (no edge of either parts them), on one storey.
fn overlap(a: &[Vec3], b: &[Vec3]) -> bool {
    let normals = |p: &[Vec3]| -> Vec<Vec2> {
        (0..p.len()).map(|k| (p[(k + 1) % p.len()] - p[k]).truncate().perp().normalize_or_zero()).collect()
    };
    let range = |p: &[Vec3], n: Vec2| {
        let along = p.iter().map(|c| c.truncate().dot(n));
        along.fold((f32::MAX, f32::MIN), |(low, high), v| (low.min(v), high.max(v)))
    };
    let parts = |n: &Vec2| {
        let ((a_low, a_high), (b_low, b_high)) = (range(a, *n), range(b, *n));
        a_low > b_high - TOUCH_M || b_low > a_high - TOUCH_M
    };
    let is_level = (a[0].z - b[0].z).abs() < 3.0;
    is_level && !normals(a).iter().chain(&normals(b)).filter(|n| **n != Vec2::ZERO).any(parts)
}

fn area_m2(triangles: &[Triangle]) -> f32 {
    triangles.iter().map(|[a, b, c]| (*b - *a).truncate().perp_dot((*c - *a).truncate()) / 2.0).sum()
}

fn all_m2(surface: &Surface) -> f32 {
    area_m2(&surface.triangles.iter().map(|t| t.map(|v| surface.positions[v as usize])).collect::<Vec<_>>())
}

fn check_lines(map: &MapData) {
    let (lines, blocks) = lines_and_blocks(map);
    let places: Vec<[Vec3; 4]> = map.crosswalks.iter().map(outline).collect();
    let stops: Vec<[Vec3; 4]> = map.lanes.iter().filter_map(|lane| before_junction(lane, &blocks)).collect();
    for place in places.iter().chain(&stops) {
        for line in lines.iter().filter(|line| line[0].distance(place[0]) < 90.0) {
            assert!(!overlap(line, place), "{}: a line {line:?} runs through {place:?}", map.name);
        }
    }
}

#[test]
fn no_line_runs_through_a_crosswalk_or_past_a_stop_line() {
    for name in BUNDLED {
        check_lines(&bundled(name).unwrap());
    }
}

#[test]
fn lines_are_whole_elsewhere() {
    for name in BUNDLED {
        let map = bundled(name).unwrap();
        let whole = all_m2(&lines_without_gaps(bundled_text(name).unwrap()));
        let share = area_m2(&lines_and_blocks(&map).0) / whole;
        // In the city there are 67 crosswalks on 14 km of lines.
        assert!((0.93..1.0).contains(&share), "{name}: {share}");
    }
}

/// A road of 100 m with a line along its edge, and a crosswalk over it.
fn crossed(mark: &str, s_m: f32, heading_rad: f32, width_m: f32) -> String {
    let crosswalk = format!(
        "<objects><object id=\"1\" type=\"crosswalk\" s=\"{s_m}\" t=\"-1.75\" zOffset=\"0\" hdg=\"{heading_rad}\" \
         length=\"{width_m}\" width=\"12\" height=\"0\"/></objects>"
    );
    let mark = format!("<roadMark sOffset=\"0\" type=\"{mark}\" color=\"white\" width=\"0.12\"/></lane></right>");
    straight("100", "3.5", &crosswalk).replace("</lane></right>", &mark)
}

/// A road with a line and so many crosswalks, each so far from the one before.
fn crowded(length: &str, count: usize, apart_m: f32) -> String {
    let crosswalk = |k: usize| {
        let s_m = 20.5 + k as f32 * apart_m;
        format!(
            "<object id=\"{k}\" type=\"crosswalk\" s=\"{s_m}\" t=\"-1.75\" zOffset=\"0\" hdg=\"0\" length=\"0.2\" \
             width=\"6\" height=\"0\"/>"
        )
    };
    let crosswalks: String = (0..count).map(crosswalk).collect();
    let mark = "<roadMark sOffset=\"0\" type=\"solid\" color=\"white\" width=\"0.12\"/></lane></right>";
    straight(length, "3.5", &format!("<objects>{crosswalks}</objects>")).replace("</lane></right>", mark)
}

#[test]
fn crosswalks_on_a_heap_are_refused() {
    let refused = bake("heap", &crowded("100", 20_000, 0.0)).expect_err("a heap").to_string();
    let expected = "lane 1/-1: expected at most 500 crosswalks around one place, but on this lane 20000 meet";
    assert_eq!(refused, expected);
}

#[test]
fn crosswalks_all_along_a_road_bake() {
    let map = bake("long", &crowded("20100", 20_000, 1.0)).expect("a map");
    assert_eq!(map.crosswalks.len(), 20_000);
    let paint = map.surfaces.iter().find(|s| s.kind == SurfaceKind::RoadLine).expect("paint");
    // Six stripes of each, and at most one piece of the line beside it, bent at most once.
    assert!(paint.triangles.len() < 20_000 * (2 * 6 + 4) + 100, "{}", paint.triangles.len());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// At any angle a line is as much shorter as the crosswalk is wide there, and a broken one has no scraps.
    #[test]
    fn a_line_ends_at_both_sides_of_a_crosswalk(s_m in 20f32..80.0, skew_rad in -0.5f32..0.5, width_m in 2f32..5.0) {
        for mark in ["solid", "broken"] {
            let text = crossed(mark, s_m, skew_rad, width_m);
            let map = bake("crossed", &text).expect("a map");
            prop_assert_eq!(map.crosswalks.len(), 1);
            check_lines(&map);
            let whole = all_m2(&lines_without_gaps(&text));
            let lost_m = (whole - area_m2(&lines_and_blocks(&map).0)) / 0.12;
            let slant = (1.0 / crate::ops::cos(skew_rad), crate::ops::sin(skew_rad).abs() / crate::ops::cos(skew_rad));
            let most_m = (width_m + 2.0 * MARGIN_M) * slant.0 + 0.12 * slant.1;
            if mark == "solid" {
                prop_assert!((width_m * slant.0..most_m + 0.01).contains(&lost_m), "{} of {} to {}", lost_m, width_m, most_m);
            } else {
                prop_assert!(lost_m < most_m + 1.01, "{}", lost_m);
            }
        }
    }
}
