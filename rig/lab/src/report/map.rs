//! The map from above as SVG, north up: houses, lanes, the route that was driven, and its end. The
//! page's style gives the colours.

use std::fmt::Write;

use base::chart::Chart;
use glam::Vec2;
use kernel::RoadNetwork;

/// Width and height of the picture, pixels.
const SIZE_PX: f32 = 340.0;
/// Length of the scale bar, metres.
const BAR_M: f32 = 100.0;

/// The picture of a map with a route.
pub fn svg(network: &RoadNetwork, route: &[Vec2]) -> String {
    let chart = Chart::of(network);
    let low = route.iter().fold(chart.low, |low, p| low.min(*p));
    let high = route.iter().fold(chart.high, |high, p| high.max(*p));
    let size = (high - low).max(Vec2::splat(1.0));
    let scale = SIZE_PX / size.max_element();
    let (width, height) = (size.x * scale, size.y * scale);
    let mut out = format!(
        "<svg role=\"img\" aria-label=\"map\" width=\"{width:.0}\" height=\"{height:.0}\" \
         viewBox=\"{:.1} {:.1} {:.1} {:.1}\">",
        low.x, -high.y, size.x, size.y
    );
    for house in &chart.houses {
        polygon(&mut out, house);
    }
    for lane in &chart.lanes {
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

fn polyline(out: &mut String, points: &[Vec2], class: &str, width_m: f32) {
    let _ = write!(out, "<polyline class=\"{class}\" stroke-width=\"{width_m:.1}\" points=\"");
    for p in points {
        let _ = write!(out, "{:.1},{:.1} ", p.x, -p.y);
    }
    out.push_str("\"/>");
}

fn polygon(out: &mut String, corners: &[Vec2]) {
    let _ = write!(out, "<polygon class=\"house\" points=\"");
    for p in corners {
        let _ = write!(out, "{:.1},{:.1} ", p.x, -p.y);
    }
    out.push_str("\"/>");
}
