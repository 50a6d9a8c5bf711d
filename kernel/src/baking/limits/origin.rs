//! An origin near the roads. National grids count from hundreds or thousands of kilometres away, where 32 bits tell
//! places apart by centimetres to metres, so what such a file places is moved while it still has 64.

use roxmltree::{Attribute, Document, Node};

use super::document::children;
use super::numbers::number;

/// Roads whose middle is no farther from zero stay where they are, metres.
const FAR_M: f64 = 10_000.0;
/// An origin is a multiple of this, metres.
const WHOLE_M: f64 = 1_000.0;

/// What to subtract from a file's coordinates, east and north: zero where its roads are near zero.
pub fn of<'a>(roads: impl Iterator<Item = Node<'a, 'a>>) -> [f64; 2] {
    let plans = roads.filter(has_lanes).flat_map(|road| children(road, "planView"));
    let geometries = plans.flat_map(|plan| children(plan, "geometry"));
    let places = geometries.filter_map(|geometry| Some([number(geometry, "x")?, number(geometry, "y")?]));
    let extent = places.map(|place| [place, place]).reduce(|[low, high], [place, _]| {
        let each = |least: fn(f64, f64) -> f64, corner: [f64; 2]| [0, 1].map(|k| least(corner[k], place[k]));
        [each(f64::min, low), each(f64::max, high)]
    });
    let Some([low, high]) = extent else { return [0.0; 2] };
    let middle = [0, 1].map(|k| (low[k] + high[k]) / 2.0);
    if libm::hypot(middle[0], middle[1]) <= FAR_M {
        return [0.0; 2];
    }
    // Adding 0 leaves no negative zero.
    middle.map(|m| (m / WHOLE_M).round() * WHOLE_M + 0.0)
}

/// Whether a road has lanes: others are left out, wherever they are.
fn has_lanes(road: &Node<'_, '_>) -> bool {
    road.descendants().any(|n| n.has_tag_name("lane") && n.attribute("id").is_some_and(|id| id.trim() != "0"))
}

/// The text of a file with an origin subtracted from every place that it does not tell along a road.
pub fn subtract(document: &Document<'_>, origin_m: [f64; 2]) -> String {
    let text = document.input_text();
    let mut moved = String::with_capacity(text.len());
    let mut copied = 0;
    for node in document.descendants().filter(is_placed) {
        let mut coordinates: Vec<_> = node.attributes().filter_map(|a| coordinate(node, &a, origin_m)).collect();
        coordinates.sort_by_key(|(end, _)| *end);
        for (end, m) in coordinates {
            // A number has no quotes in it.
            let start = text[..end].rfind(['"', '\'']).map_or(end, |quote| quote + 1);
            moved.push_str(&text[copied..start]);
            moved.push_str(&m.to_string());
            copied = end;
        }
    }
    moved.push_str(&text[copied..]);
    moved
}

/// Whether an element has coordinates of the file's own. Elevation grids and objects are placed along a road or the
/// line of a junction.
fn is_placed(node: &Node<'_, '_>) -> bool {
    let is_in_plan = || node.parent().is_some_and(|parent| parent.has_tag_name("planView"));
    node.has_tag_name("positionInertial") || (node.has_tag_name("geometry") && is_in_plan())
}

/// Where the text of a coordinate ends, and what it is about the origin.
fn coordinate(node: Node<'_, '_>, attribute: &Attribute<'_, '_>, origin_m: [f64; 2]) -> Option<(usize, f64)> {
    let axis = ["x", "y"].iter().position(|name| *name == attribute.name())?;
    Some((attribute.range_value().end, number(node, attribute.name())? - origin_m[axis]))
}
