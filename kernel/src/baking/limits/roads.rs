//! Roads: their lengths, their geometry and the profiles along them.

use std::ops::Range;

use roxmltree::Node;

use super::constants::{ASIDE_M, COORDINATE_M, HEIGHT_M, RECORDS, ROAD_M, TILT_RAD, TURN_RAD};
use super::cubic::Profile;
use super::lanes;
use super::numbers::number;
use super::objects::{self, References};
use super::place::refused;
use super::sums::{Sum, Sums, at_most};
use crate::baking::source::BakeError;

/// A road as its lanes need it.
pub struct Along<'a> {
    pub length_m: f64,
    /// Stretches that are not straight.
    bends: Vec<Range<f64>>,
    /// Records of elevation, superelevation and lateral profile, each looked at for every station of a lane.
    pub records: usize,
    pub node: Node<'a, 'a>,
}

impl Along<'_> {
    pub fn is_straight(&self, over: &Range<f64>) -> bool {
        !self.bends.iter().any(|bend| bend.start < over.end && over.start < bend.end)
    }
}

pub fn check<'a>(road: Node<'a, 'a>, references: &References<'_>, sums: &mut Sums) -> Result<(), BakeError> {
    // Without a length it is no road, and left out.
    let Some(length_m) = number(road, "length").filter(|l| *l > 0.0) else { return Ok(()) };
    if length_m > ROAD_M {
        return Err(refused(road, format!("expected a length of at most {ROAD_M} m, but it is {length_m} m")));
    }
    sums.add(Sum::Roads, length_m, road)?;
    let whole = 0.0..length_m;
    let bends = geometry(road, sums)?;
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
    let along = Along { length_m, bends, records, node: road };
    let lanes = lanes::check(&along, sums)?;
    objects::check(road, lanes, references, sums)
}

/// The children of an element with some tag.
pub fn children<'a>(node: Node<'a, 'a>, tag: &'static str) -> impl Iterator<Item = Node<'a, 'a>> + Clone {
    node.children().filter(move |n| n.has_tag_name(tag))
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

/// Checks the geometry of a road, and says where it bends.
fn geometry(road: Node<'_, '_>, sums: &mut Sums) -> Result<Vec<Range<f64>>, BakeError> {
    let mut bends: Vec<Range<f64>> = Vec::new();
    for view in children(road, "planView") {
        at_most(view, children(view, "geometry").count(), RECORDS, "geometries")?;
        for geometry in children(view, "geometry") {
            let (s, length_m) = (number(geometry, "s").unwrap_or(0.0), number(geometry, "length").unwrap_or(0.0));
            sums.add(Sum::Geometry, length_m.max(0.0), geometry)?;
            if turn_rad(geometry, length_m) > TURN_RAD {
                return Err(refused(geometry, format!("expected a geometry to turn by at most {TURN_RAD} rad")));
            }
            if reach_m(geometry, length_m) > COORDINATE_M {
                return Err(refused(geometry, format!("expected a geometry to lead no farther than {COORDINATE_M} m")));
            }
            if !children(geometry, "line").any(|_| true) {
                bends.push(s..s + length_m);
            }
        }
    }
    Ok(bends)
}

/// How far an arc or a spiral may turn.
fn turn_rad(geometry: Node<'_, '_>, length_m: f64) -> f64 {
    let curves = geometry.children().filter(|n| n.is_element());
    let of =
        |node: Node<'_, '_>| ["curvature", "curvStart", "curvEnd"].map(|name| number(node, name).unwrap_or(0.0).abs());
    curves.flat_map(of).fold(0.0, f64::max) * length_m
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
