//! The map from above as SVG, north up: houses, lanes, the route that was driven, and its end. The
//! page's style gives the colours.

use std::fmt::Write;

use glam::{Vec2, Vec3Swizzles};
use kernel::RoadNetwork;
use kernel::map::{LaneKind, Prop, PropKind};
use kernel::ops;

/// Width and height of the picture, pixels.
const SIZE_PX: f32 = 340.0;
/// Length of the scale bar, metres.
const BAR_M: f32 = 100.0;
/// Room around the roads, metres.
const MARGIN_M: f32 = 15.0;
/// Points of a lane that are closer than this are left out, metres.
const STEP_M: f32 = 3.0;

/// The picture of a map with a route.
pub fn svg(network: &RoadNetwork, route: &[Vec2]) -> String {
    let lanes: Vec<Vec<Vec2>> = lanes(network);
    let (low, high) = bounds(lanes.iter().flatten().chain(route));
    let size = (high - low).max(Vec2::splat(1.0));
    let scale = SIZE_PX / size.max_element();
    let (width, height) = (size.x * scale, size.y * scale);
    let mut out = format!(
        "<svg role=\"img\" aria-label=\"map\" width=\"{width:.0}\" height=\"{height:.0}\" \
         viewBox=\"{:.1} {:.1} {:.1} {:.1}\">",
        low.x, -high.y, size.x, size.y
    );
    for prop in network.props.iter().filter(|prop| prop.kind == PropKind::Building) {
        let inside = prop.position.xy().cmpge(low).all() && prop.position.xy().cmple(high).all();
        if inside {
            polygon(&mut out, prop);
        }
    }
    for lane in &lanes {
        polyline(&mut out, lane, "lane", 3.4);
    }
    // Lines as thick on the screen whatever the map's size.
    let pixel_m = 1.0 / scale;
    polyline(&mut out, route, "route", 3.0 * pixel_m);
    if let Some(end) = route.last() {
        // Writing to a string cannot fail.
        let _ = write!(
            out,
            "<circle class=\"place\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"{:.1}\" stroke-width=\"{:.1}\"/>",
            end.x,
            -end.y,
            6.0 * pixel_m,
            1.5 * pixel_m
        );
    }
    scale_bar(&mut out, low, pixel_m);
    out.push_str("</svg>");
    out
}

/// A bar of [`BAR_M`] in the lower left corner.
fn scale_bar(out: &mut String, low: Vec2, pixel_m: f32) {
    let left = low + 10.0 * pixel_m;
    polyline(out, &[left, left + Vec2::new(BAR_M, 0.0)], "bar", 2.0 * pixel_m);
    let _ = write!(
        out,
        "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"{:.1}\">{BAR_M:.0} m</text>",
        left.x,
        -left.y - 5.0 * pixel_m,
        11.0 * pixel_m
    );
}

/// Centre lines of the driving lanes, thinned out.
fn lanes(network: &RoadNetwork) -> Vec<Vec<Vec2>> {
    let driving = network.lanes.iter().filter(|lane| lane.kind == LaneKind::Driving);
    let thin = |points: &[kernel::map::LanePoint]| {
        let mut kept: Vec<Vec2> = Vec::new();
        for (i, point) in points.iter().enumerate() {
            let place = point.position.xy();
            let far = kept.last().is_none_or(|last| last.distance(place) >= STEP_M);
            if far || i + 1 == points.len() {
                kept.push(place);
            }
        }
        kept
    };
    driving.map(|lane| thin(&lane.points)).collect()
}

fn bounds<'a>(points: impl Iterator<Item = &'a Vec2>) -> (Vec2, Vec2) {
    let grow = |(low, high): (Vec2, Vec2), p: &Vec2| (low.min(*p), high.max(*p));
    let (low, high) = points.fold((Vec2::INFINITY, Vec2::NEG_INFINITY), grow);
    if low.is_finite() { (low - MARGIN_M, high + MARGIN_M) } else { (Vec2::ZERO, Vec2::ONE) }
}

fn polyline(out: &mut String, points: &[Vec2], class: &str, width_m: f32) {
    let _ = write!(out, "<polyline class=\"{class}\" stroke-width=\"{width_m:.1}\" points=\"");
    for p in points {
        let _ = write!(out, "{:.1},{:.1} ", p.x, -p.y);
    }
    out.push_str("\"/>");
}

fn polygon(out: &mut String, prop: &Prop) {
    let forward = Vec2::new(ops::cos(prop.heading_rad), ops::sin(prop.heading_rad)) * (0.5 * prop.size.x);
    let left = Vec2::new(-ops::sin(prop.heading_rad), ops::cos(prop.heading_rad)) * (0.5 * prop.size.y);
    let _ = write!(out, "<polygon class=\"house\" points=\"");
    for corner in [forward + left, forward - left, -forward - left, left - forward] {
        let p = prop.position.xy() + corner;
        let _ = write!(out, "{:.1},{:.1} ", p.x, -p.y);
    }
    out.push_str("\"/>");
}
