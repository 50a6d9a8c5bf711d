//! Roads: their lengths, their geometry and the profiles along them.

use std::ops::Range;

use roxmltree::Node;

use super::constants::{ASIDE_M, COORDINATE_M, HEIGHT_M, RECORDS, ROAD_M, TILT_RAD, TURN_RAD};
use super::crowd::Crowd;
use super::cubic::Profile;
use super::document::children;
use super::lanes;
use super::numbers::number;
use super::objects::{self, References};
use super::place::refused;
use super::stretch::{Along, BENT_PER_M, POINT_RAD, STRAIGHT_PER_M};
use super::sums::{Sum, Sums, at_most};
use crate::baking::error::BakeError;

pub fn check<'a>(
    road: Node<'a, 'a>,
    references: &References<'_>,
    sums: &mut Sums,
    crowd: &mut Crowd<'a>,
) -> Result<(), BakeError> {
    // Without a length it is no road, and left out.
    let Some(length_m) = number(road, "length").filter(|l| *l > 0.0) else { return Ok(()) };
    if length_m > ROAD_M {
        return Err(refused(road, format!("expected a length of at most {ROAD_M} m, but it is {length_m} m")));
    }
    sums.add(Sum::Roads, length_m, road)?;
    let whole = 0.0..length_m;
    let stations = geometry(road, sums)?;
    let mut records = profile(road, "elevationProfile", "elevation", &whole, HEIGHT_M, "a height", "m")?;
    records += profile(road, "lateralProfile", "superelevation", &whole, TILT_RAD, "a superelevation", "rad")?;
    for lateral in children(road, "lateralProfile") {
        let shapes = lateral.descendants().filter(|n| n.is_element()).count();
        at_most(lateral, shapes, RECORDS, "elements of a lateral profile")?;
        records += shapes;
    }
    for lanes in children(road, "lanes") {
        Profile::read(lanes, "laneOffset", "s")?.within(&whole, ASIDE_M, "a lane offset", "m", true)?;
    }
    let along = Along { length_m, stations, records, node: road };
    let lanes = lanes::check(&along, sums)?;
    crowd.add(road, lanes.per_m)?;
    objects::check(road, lanes.count, references, sums)
}

/// Checks a profile of a road, and says how many records it has.
fn profile(
    road: Node<'_, '_>,
    parent: &'static str,
    tag: &str,
    whole: &Range<f64>,
    most: f64,
    what: &str,
    unit: &str,
) -> Result<usize, BakeError> {
    let mut records = 0;
    for node in children(road, parent) {
        let profile = Profile::read(node, tag, "s")?;
        profile.within(whole, most, what, unit, true)?;
        records += profile.len();
    }
    Ok(records)
}

/// Checks the geometry of a road, and says how densely lanes along it have points.
fn geometry(road: Node<'_, '_>, sums: &mut Sums) -> Result<Vec<(Range<f64>, f64)>, BakeError> {
    let mut stations: Vec<(Range<f64>, f64)> = Vec::new();
    for view in children(road, "planView") {
        at_most(view, children(view, "geometry").count(), RECORDS, "geometries")?;
        for geometry in children(view, "geometry") {
            let (s, length_m) = (number(geometry, "s").unwrap_or(0.0), number(geometry, "length").unwrap_or(0.0));
            sums.add(Sum::Geometry, length_m.max(0.0), geometry)?;
            let curvature = curvature(geometry);
            if curvature * length_m > TURN_RAD {
                return Err(refused(geometry, format!("expected a geometry to turn by at most {TURN_RAD} rad")));
            }
            if reach_m(geometry, length_m) > COORDINATE_M {
                return Err(refused(geometry, format!("expected a geometry to lead no farther than {COORDINATE_M} m")));
            }
            let is_polynomial = geometry.children().any(|n| n.has_tag_name("poly3") || n.has_tag_name("paramPoly3"));
            let per_m = if is_polynomial { BENT_PER_M } else { curvature / POINT_RAD };
            stations.push((s..s + length_m, per_m.clamp(STRAIGHT_PER_M, BENT_PER_M)));
        }
    }
    Ok(stations)
}

/// The sharpest curvature of an arc or a spiral, 1/m.
fn curvature(geometry: Node<'_, '_>) -> f64 {
    let curves = geometry.children().filter(|n| n.is_element());
    let of =
        |node: Node<'_, '_>| ["curvature", "curvStart", "curvEnd"].map(|name| number(node, name).unwrap_or(0.0).abs());
    curves.flat_map(of).fold(0.0, f64::max)
}

/// How far a polynomial may lead from where its geometry starts.
fn reach_m(geometry: Node<'_, '_>, length_m: f64) -> f64 {
    let of = |node: Node<'_, '_>, names: [&str; 4], p: f64| {
        let [a, b, c, d] = names.map(|name| number(node, name).unwrap_or(0.0).abs());
        a + b * p + c * p * p + d * p * p * p
    };
    let poly3 = children(geometry, "poly3").map(|node| of(node, ["a", "b", "c", "d"], length_m));
    let param = children(geometry, "paramPoly3").map(|node| {
        let by_length = node.attribute("pRange").is_some_and(|range| range.eq_ignore_ascii_case("arclength"));
        let p = if by_length { length_m } else { 1.0 };
        of(node, ["aU", "bU", "cU", "dU"], p) + of(node, ["aV", "bV", "cV", "dV"], p)
    });
    poly3.chain(param).fold(0.0, f64::max)
}
