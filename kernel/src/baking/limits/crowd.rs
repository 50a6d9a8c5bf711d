//! Roads on a heap: whatever asks about a place looks at all lanes there, so that time and memory grow
//! with the square of how many there are. And torn ones: a jump is as long as a road.

use std::collections::BTreeMap;

use roxmltree::Node;

use super::constants::{GAP_M, PAIRS};
use super::document::children;
use super::numbers::number;
use super::place::refused;
use crate::baking::error::BakeError;

/// Side of a square, metres.
const SQUARE_M: f64 = 10.0;
/// From one place on a road that is looked at to the next, metres.
const STEP_M: f64 = 8.0;
/// A curve is followed in steps of this, metres.
const PART_M: f64 = 2.0;

/// Stretches of lanes by the square of the plane that they lie in, and the last road there.
#[derive(Default)]
pub struct Crowd<'a>(BTreeMap<(i64, i64), (f64, Node<'a, 'a>)>);

impl<'a> Crowd<'a> {
    /// Adds a road with so many lanes beside each other; refused where its line is torn.
    pub fn add(&mut self, road: Node<'a, 'a>, lanes: f64) -> Result<(), BakeError> {
        let mut parts: Vec<_> = children(road, "planView").flat_map(|view| children(view, "geometry")).collect();
        parts.sort_by(|a, b| number(*a, "s").unwrap_or(0.0).total_cmp(&number(*b, "s").unwrap_or(0.0)));
        let mut end: Option<[f64; 2]> = None;
        for geometry in parts {
            let places = places(geometry);
            if let (Some([x0, y0]), Some([x, y])) = (end, places.first()) {
                let gap_m = libm::hypot(x - x0, y - y0);
                if gap_m > GAP_M {
                    let reason = format!("expected geometries that join, but from one to the next it is {gap_m:.0} m");
                    return Err(refused(geometry, reason));
                }
            }
            end = places.last().copied().or(end);
            for [x, y] in places {
                let square = ((x / SQUARE_M).floor() as i64, (y / SQUARE_M).floor() as i64);
                let (count, holder) = self.0.entry(square).or_insert((0.0, road));
                *count += lanes;
                *holder = road;
            }
        }
        Ok(())
    }

    /// Refuses too many pairs of stretches in the same squares.
    pub fn check(&self) -> Result<(), BakeError> {
        let pairs: f64 = self.0.values().map(|(count, _)| count * count).sum();
        let fullest = self.0.values().max_by(|a, b| a.0.total_cmp(&b.0));
        match fullest.filter(|_| pairs > PAIRS) {
            None => Ok(()),
            Some((count, road)) => {
                let reason =
                    format!("expected roads beside each other, but here {count:.0} stretches of lanes lie on a heap");
                Err(refused(*road, reason))
            }
        }
    }
}

/// Places along a geometry.
fn places(geometry: Node<'_, '_>) -> Vec<[f64; 2]> {
    let of = |node: Node<'_, '_>, name: &str| number(node, name).unwrap_or(0.0);
    let [x, y, hdg, length_m] = ["x", "y", "hdg", "length"].map(|name| of(geometry, name));
    let polynomial = geometry.children().find(|n| n.has_tag_name("poly3") || n.has_tag_name("paramPoly3"));
    let Some(node) = polynomial else {
        let curve = geometry.children().find(|n| n.has_tag_name("arc") || n.has_tag_name("spiral"));
        return along([x, y, hdg], length_m, curve.map_or([0.0; 2], ends));
    };
    let is_param = node.has_tag_name("paramPoly3");
    let by_length = !is_param || node.attribute("pRange").is_some_and(|range| range.eq_ignore_ascii_case("arclength"));
    let last = if by_length { length_m } else { 1.0 };
    let cubic = |names: [&str; 4], p: f64| {
        let [a, b, c, d] = names.map(|name| of(node, name));
        a + p * (b + p * (c + p * d))
    };
    let parts = (length_m.max(0.0) / STEP_M) as usize + 1;
    let place = |k: usize| {
        let p = last * k as f64 / parts as f64;
        let (u, v) = match is_param {
            true => (cubic(["aU", "bU", "cU", "dU"], p), cubic(["aV", "bV", "cV", "dV"], p)),
            false => (p, cubic(["a", "b", "c", "d"], p)),
        };
        let (sin, cos) = (libm::sin(hdg), libm::cos(hdg));
        [x + u * cos - v * sin, y + u * sin + v * cos]
    };
    (0..parts).map(place).collect()
}

/// The curvatures of an arc or a spiral at its ends.
fn ends(curve: Node<'_, '_>) -> [f64; 2] {
    let of = |name| number(curve, name);
    let constant = of("curvature").unwrap_or(0.0);
    ["curvStart", "curvEnd"].map(|name| of(name).unwrap_or(constant))
}

/// Places along a curve whose curvature changes evenly.
fn along([mut x, mut y, hdg]: [f64; 3], length_m: f64, [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let parts = (length_m.max(0.0) / PART_M) as usize + 1;
    let part_m = length_m.max(0.0) / parts as f64;
    let mut places = Vec::new();
    for k in 0..parts {
        if k % (STEP_M / PART_M) as usize == 0 {
            places.push([x, y]);
        }
        let at = (k as f64 + 0.5) * part_m;
        let heading = hdg + at * (from + 0.5 * (to - from) * at / length_m.max(1e-9));
        (x, y) = (x + libm::cos(heading) * part_m, y + libm::sin(heading) * part_m);
    }
    places
}
