//! What lies on the ground: scenery, lanes by kind, junctions.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3Swizzles};
use kernel::geometry::direction;
use kernel::map::{Baked, Junction, Lane, LaneKind, LanePoint, MapData, Prop, PropKind, SurfaceKind};

use super::frame::{Key, Swatch};
use super::path::{Path, thinned};
use super::sheet::{Sheet, cm};

/// Junctions whose mouths lie farther apart have no area that could be drawn, metres.
const WIDEST_M: f32 = 160.0;
/// As far apart those may lie that the world paves as a whole, metres.
const PAVED_M: f32 = 60.0;

/// A kind of lane in the picture: a class, a colour, what it is called, and which lanes are of it.
struct Kind {
    class: &'static str,
    fill: &'static str,
    name: &'static str,
    is: fn(&Lane, &str) -> bool,
}

/// Strips of land, on which trees stand, in the order in which they are drawn.
const STRIPS: [Kind; 2] = [
    Kind {
        class: "verge",
        fill: "#cfd8c0",
        name: "median, verge",
        is: |l, t| l.kind == LaneKind::Other && is_green(t),
    },
    Kind { class: "other", fill: "#c6c3bd", name: "other lane", is: |l, t| l.kind == LaneKind::Other && !is_green(t) },
];

/// What has a surface, in the order in which it is drawn.
const KINDS: [Kind; 6] = [
    Kind { class: "shoulder", fill: "#b3b1a8", name: "shoulder", is: |l, _| l.kind == LaneKind::Shoulder },
    Kind { class: "sidewalk", fill: "#ddd3c2", name: "sidewalk", is: |l, _| l.kind == LaneKind::Sidewalk },
    Kind { class: "parking", fill: "#a9a4c4", name: "parking", is: |l, _| l.kind == LaneKind::Parking },
    Kind {
        class: "driving",
        fill: "#878c93",
        name: "driving lane",
        is: |l, t| l.kind == LaneKind::Driving && t != "bus",
    },
    Kind { class: "bus", fill: "#b08f6a", name: "bus lane", is: |l, t| l.kind == LaneKind::Driving && t == "bus" },
    Kind { class: "biking", fill: "#c4796b", name: "bicycle lane", is: |l, _| l.kind == LaneKind::Biking },
];

fn is_green(lane_type: &str) -> bool {
    ["none", "median", "unknown"].contains(&lane_type)
}

/// Houses, trees, hedges and fences.
pub fn scenery(sheet: &Sheet, map: &MapData, out: &mut String, keys: &mut Vec<Key>) {
    let (mut houses, mut hedges, mut fences) = (Path::default(), Path::default(), Path::default());
    // Crowns by their diameter in metres.
    let mut trees: BTreeMap<i64, Path> = BTreeMap::new();
    for prop in map.props.iter().filter(|prop| sheet.holds(prop.position.xy(), prop.size.xy().length() / 2.0)) {
        match prop.kind {
            PropKind::Building => houses.area(sheet, &corners(prop)),
            PropKind::Hedge => hedges.area(sheet, &corners(prop)),
            // Decks, piers and roofs are wider.
            PropKind::Bridge | PropKind::Tunnel if prop.size.y > 0.5 => {}
            PropKind::Fence | PropKind::Wall | PropKind::GuardRail | PropKind::Bridge | PropKind::Tunnel => {
                let along = direction(prop.heading_rad) * (prop.size.x / 2.0);
                fences.line(sheet, &[prop.position.xy() - along, prop.position.xy() + along]);
            }
            PropKind::Tree => {
                trees.entry(prop.size.x.round().max(1.0) as i64).or_default().dot(sheet, prop.position.xy());
            }
            _ => {}
        }
    }
    hedges.put(out, "hedge", "fill=\"#b9cda0\"");
    houses.put(out, "building", "fill=\"#d8cbbb\" stroke=\"#bfae99\" stroke-width=\"20\"");
    let width = cm(sheet.metres(0.6, 0.15, 0.6));
    fences.put(out, "fence", &format!("stroke=\"#a59f90\" stroke-width=\"{width}\""));
    for (diameter, path) in &trees {
        let style = "stroke=\"#a9c48c\" stroke-opacity=\".75\" stroke-linecap=\"round\"";
        path.put(out, "tree", &format!("{style} stroke-width=\"{}\"", 100 * diameter));
    }
    let mut key = |path: bool, swatch, name| keys.extend(path.then_some(Key { swatch, name }));
    key(!houses.is_empty(), Swatch::Area("#d8cbbb"), "building");
    key(!trees.is_empty(), Swatch::Disc("#a9c48c"), "tree");
    key(!hedges.is_empty(), Swatch::Area("#b9cda0"), "hedge");
    key(!fences.is_empty(), Swatch::Line("#a59f90"), "fence, wall, rail");
}

/// Lakes and rivers.
pub fn water(sheet: &Sheet, map: &MapData, out: &mut String, keys: &mut Vec<Key>) {
    let mut path = Path::default();
    for surface in map.surfaces.iter().filter(|surface| surface.kind == SurfaceKind::Water) {
        for triangle in &surface.triangles {
            path.area(sheet, &triangle.map(|corner| surface.positions[corner as usize].xy()));
        }
    }
    path.put(out, "water", "fill=\"#a8c6dc\" stroke=\"#a8c6dc\" stroke-width=\"6\"");
    keys.extend((!path.is_empty()).then_some(Key { swatch: Swatch::Area("#a8c6dc"), name: "water" }));
}

/// Medians, verges and other strips.
pub fn strips(sheet: &Sheet, baked: &Baked, out: &mut String, keys: &mut Vec<Key>) {
    areas(sheet, baked, &STRIPS, out, keys);
}

/// All other lanes; what is driven on lies on the rest.
pub fn lanes(sheet: &Sheet, baked: &Baked, out: &mut String, keys: &mut Vec<Key>) {
    let mut floors = Path::default();
    for junction in &baked.map.junctions {
        floors.area(sheet, &hull(&baked.map, junction, PAVED_M));
    }
    floors.put(out, "floor", "fill=\"#9a9ea4\"");
    areas(sheet, baked, &KINDS, out, keys);
}

fn areas(sheet: &Sheet, baked: &Baked, kinds: &[Kind], out: &mut String, keys: &mut Vec<Key>) {
    for &Kind { class, fill, name, is } in kinds {
        let mut path = Path::default();
        for (lane, lane_type) in baked.map.lanes.iter().zip(&baked.told.lane_types) {
            // Strips without a function lie across the lanes of a junction.
            if is(lane, lane_type) && !(class == "verge" && lane.junction.is_some()) {
                path.area(sheet, &outline(&lane.points));
            }
        }
        // A thin edge of the same colour closes the seams between sections.
        path.put(out, class, &format!("fill=\"{fill}\" stroke=\"{fill}\" stroke-width=\"6\""));
        keys.extend((!path.is_empty()).then_some(Key { swatch: Swatch::Area(fill), name }));
    }
}

/// The areas of junctions, over their lanes.
pub fn junctions(sheet: &Sheet, map: &MapData, out: &mut String, keys: &mut Vec<Key>) {
    let mut path = Path::default();
    for junction in &map.junctions {
        path.area(sheet, &hull(map, junction, WIDEST_M));
    }
    let width = cm(sheet.metres(1.0, 0.15, 1.0));
    let style = "fill=\"#2f6fb5\" fill-opacity=\".12\" stroke=\"#2f6fb5\" stroke-opacity=\".6\"";
    path.put(out, "junction", &format!("{style} stroke-width=\"{width}\""));
    keys.extend((!path.is_empty()).then_some(Key { swatch: Swatch::Tint("#2f6fb5"), name: "junction" }));
}

/// Parked cars.
pub fn parked(sheet: &Sheet, map: &MapData, out: &mut String, keys: &mut Vec<Key>) {
    let mut path = Path::default();
    for prop in map.props.iter().filter(|prop| prop.kind == PropKind::ParkedCar) {
        path.area(sheet, &corners(prop));
    }
    path.put(out, "parked", "fill=\"#4d5a78\"");
    keys.extend((!path.is_empty()).then_some(Key { swatch: Swatch::Area("#4d5a78"), name: "parked car" }));
}

/// Both edges of a lane: there on the left, back on the right.
fn outline(points: &[LanePoint]) -> Vec<Vec2> {
    let edge = |side: f32| -> Vec<Vec2> {
        let at = |p: &LanePoint| p.position.xy() + direction(p.heading_rad).perp() * (side * p.half_width_m);
        points.iter().map(at).collect()
    };
    let mut outline = thinned(&edge(1.0));
    let mut right = thinned(&edge(-1.0));
    right.reverse();
    outline.extend(right);
    outline
}

fn corners(prop: &Prop) -> [Vec2; 4] {
    let forward = direction(prop.heading_rad);
    let (forward, left) = (forward * (0.5 * prop.size.x), forward.perp() * (0.5 * prop.size.y));
    [forward + left, left - forward, -forward - left, forward - left].map(|corner| prop.position.xy() + corner)
}

/// The convex hull of the mouths of a junction (Andrew's monotone chain); nothing of one that is so wide.
fn hull(map: &MapData, junction: &Junction, widest_m: f32) -> Vec<Vec2> {
    let lanes = junction.lanes.iter().map(|&lane| &map.lanes[lane as usize]);
    let sides = |p: &LanePoint| {
        let left = direction(p.heading_rad).perp() * p.half_width_m;
        [p.position.xy() - left, p.position.xy() + left]
    };
    let mut points: Vec<Vec2> = lanes.flat_map(|lane| [lane.start(), lane.end()]).flat_map(sides).collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let far = points.iter().any(|a| points.iter().any(|b| a.distance(*b) > widest_m));
    if junction.lanes.len() < 2 || points.len() < 3 || far {
        return Vec::new();
    }
    let mut corners = chain(points.iter().copied());
    corners.extend(chain(points.iter().rev().copied()));
    corners
}

/// One side of a hull, without its last point, with which the other side begins.
fn chain(points: impl Iterator<Item = Vec2>) -> Vec<Vec2> {
    let mut chain: Vec<Vec2> = Vec::new();
    for point in points {
        while let [.., a, b] = chain[..] {
            if (b - a).perp_dot(point - b) > 0.0 {
                break;
            }
            chain.pop();
        }
        chain.push(point);
    }
    chain.pop();
    chain
}
