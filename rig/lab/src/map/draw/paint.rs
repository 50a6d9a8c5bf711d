//! What is painted on the road: marks, crosswalks, stop lines, and the directions of lanes.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3Swizzles};
use kernel::geometry::direction;
use kernel::map::{Baked, Lane, LaneKind, LanePoint, MapData, StopKind};

use super::frame::{Key, Swatch};
use super::path::{Path, thinned};
use super::sheet::{Sheet, cm};

/// Depth of a stop line along the road, metres.
const STOP_LINE_M: f32 = 0.5;
/// Stripes of a crosswalk, metres.
const STRIPE_M: f32 = 0.5;

/// Lines, crosswalks and stop lines.
pub fn marks(sheet: &Sheet, baked: &Baked, out: &mut String, keys: &mut Vec<Key>) {
    lines(sheet, baked, out, keys);
    crosswalks(sheet, &baked.map, out, keys);
    let (mut stop, mut wait) = (Path::default(), Path::default());
    for lane in baked.map.lanes.iter().filter(|lane| lane.kind == LaneKind::Driving) {
        let Some(line) = lane.stop else { continue };
        let at = lane.at(line.s_m);
        let across = direction(at.heading_rad).perp() * (at.half_width_m - 0.1).max(0.1);
        let ends = [at.position.xy() - across, at.position.xy() + across];
        match line.kind {
            StopKind::Light(_) | StopKind::Stop => stop.line(sheet, &ends),
            StopKind::Yield => wait.line(sheet, &ends),
        }
    }
    let width = cm(sheet.metres(1.6, f64::from(STOP_LINE_M), 2.0));
    stop.put(out, "stop-line", &format!("stroke=\"#fff\" stroke-width=\"{width}\""));
    wait.put(out, "yield-line", &format!("stroke=\"#fff\" stroke-width=\"{width}\" stroke-dasharray=\"45 30\""));
    keys.extend((!stop.is_empty()).then_some(Key { swatch: Swatch::Bar("#fff", "none"), name: "stop line" }));
    keys.extend((!wait.is_empty()).then_some(Key { swatch: Swatch::Bar("#fff", "4 3"), name: "who gives way" }));
}

/// Road marks by colour, width and pattern.
fn lines(sheet: &Sheet, baked: &Baked, out: &mut String, keys: &mut Vec<Key>) {
    let mut paths: BTreeMap<(&str, i64, [i64; 2]), Path> = BTreeMap::new();
    // No thinner than can be seen.
    let least_m = sheet.metres(0.5, 0.0, 0.4);
    for mark in &baked.told.marks {
        let dash = mark.dash_m.map_or([0, 0], |dash| dash.map(cm));
        let points: Vec<Vec2> = mark.points.iter().map(|point| point.xy()).collect();
        let width = cm(mark.width_m.clamp(least_m, 0.6));
        paths.entry((ink(&mark.colour), width, dash)).or_default().line(sheet, &thinned(&points));
    }
    for ((ink, width, [paint, gap]), path) in &paths {
        let dash = if *gap > 0 { format!(" stroke-dasharray=\"{paint} {gap}\"") } else { String::new() };
        path.put(out, "mark", &format!("stroke=\"{ink}\" stroke-width=\"{width}\"{dash}"));
    }
    let mut inks: Vec<&str> = paths.keys().map(|(ink, ..)| *ink).collect();
    inks.dedup();
    let name = |ink: &str| if ink == WHITE { "road mark" } else { "coloured road mark" };
    keys.extend(inks.into_iter().map(|ink| Key { swatch: Swatch::Bar(ink, "none"), name: name(ink) }));
}

const WHITE: &str = "#f6f6f2";

fn ink(colour: &str) -> &'static str {
    match colour {
        "yellow" => "#f0c419",
        "blue" => "#3f7fd0",
        "red" => "#cf3f3a",
        "green" => "#3f9a58",
        "orange" => "#ee8a2a",
        _ => WHITE,
    }
}

fn crosswalks(sheet: &Sheet, map: &MapData, out: &mut String, keys: &mut Vec<Key>) {
    let mut by_width: BTreeMap<i64, Path> = BTreeMap::new();
    for crosswalk in &map.crosswalks {
        let ends = crosswalk.ends.map(|end| end.xy());
        by_width.entry(cm(2.0 * crosswalk.half_width_m)).or_default().line(sheet, &ends);
    }
    let stripe = cm(STRIPE_M);
    for (width, path) in &by_width {
        let style = format!("stroke=\"#fff\" stroke-width=\"{width}\" stroke-dasharray=\"{stripe}\"");
        path.put(out, "crosswalk", &style);
    }
    keys.extend((!by_width.is_empty()).then_some(Key { swatch: Swatch::Stripes, name: "crosswalk" }));
}

/// Arrows along driving lanes outside junctions, and the ways through these as thin lines.
pub fn arrows(sheet: &Sheet, map: &MapData, out: &mut String, keys: &mut Vec<Key>) {
    let (mut arrows, mut ways) = (Path::default(), Path::default());
    let length_m = sheet.metres(8.0, 1.8, 14.0);
    let pitch_m = sheet.metres(70.0, 25.0, 400.0);
    for lane in map.lanes.iter().filter(|lane| lane.kind == LaneKind::Driving) {
        if lane.junction.is_some() {
            let points: Vec<Vec2> = lane.points.iter().map(|point| point.position.xy()).collect();
            ways.line(sheet, &thinned(&points));
        } else if lane.length_m > 1.5 * length_m {
            along(lane, pitch_m).iter().for_each(|at| arrows.area(sheet, &arrow(at, length_m)));
        }
    }
    let width = cm(sheet.metres(0.7, 0.12, 0.8));
    ways.put(out, "way", &format!("stroke=\"#fff\" stroke-opacity=\".55\" stroke-width=\"{width}\""));
    arrows.put(out, "arrow", "fill=\"#fff\" fill-opacity=\".92\"");
    keys.extend((!arrows.is_empty()).then_some(Key { swatch: Swatch::Arrow, name: "direction of travel" }));
    keys.extend((!ways.is_empty()).then_some(Key { swatch: Swatch::Thin, name: "way through a junction" }));
}

/// Places about so far apart, the same from both ends of a lane.
fn along(lane: &Lane, pitch_m: f32) -> Vec<LanePoint> {
    let count = (lane.length_m / pitch_m).round().max(1.0) as u32;
    (0..count).map(|k| lane.at(lane.length_m * (k as f32 + 0.5) / count as f32)).collect()
}

/// A tip with a notch.
fn arrow(at: &LanePoint, length_m: f32) -> [Vec2; 4] {
    let ahead = direction(at.heading_rad);
    let (along, across) = (ahead * (0.5 * length_m), ahead.perp() * (0.34 * length_m).min(0.75 * at.half_width_m));
    [along, across - along, -0.5 * along, -across - along].map(|corner| at.position.xy() + corner)
}
