//! Numbers that are none, or far beyond any map.

use roxmltree::Node;

use super::constants::{ANGLE_RAD, COORDINATE_M, NAME_BYTES, NUMBER, PLACE_M};
use super::place::{refused, said};
use crate::baking::error::BakeError;

/// What an attribute measures, by its name: the largest number it may hold, either way.
fn largest(name: &str) -> Option<f64> {
    Some(match name {
        "x" | "y" => PLACE_M,
        "s" | "t" | "u" | "v" | "z" | "dz" | "length" | "width" | "height" | "radius" | "distance" => COORDINATE_M,
        "sOffset" | "tOffset" | "zOffset" | "sStart" | "sEnd" | "tStart" | "tEnd" | "space" | "validLength" => {
            COORDINATE_M
        }
        "widthStart" | "widthEnd" | "heightStart" | "heightEnd" | "lengthStart" | "lengthEnd" | "radiusStart"
        | "radiusEnd" | "zOffsetStart" | "zOffsetEnd" | "inner" | "outer" | "gridSpacing" | "transitionLength" => {
            COORDINATE_M
        }
        "hdg" | "hOffset" | "pitch" | "roll" => ANGLE_RAD,
        "a" | "b" | "c" | "d" | "aU" | "bU" | "cU" | "dU" | "aV" | "bV" | "cV" | "dV" | "bT" | "cT" | "dT" | "ds"
        | "curvature" | "curvStart" | "curvEnd" | "max" | "forward" | "back" | "friction" | "roughness" => NUMBER,
        _ => return None,
    })
}

/// What is left out, or lies elsewhere, where one of its numbers is none.
const MEASURED: [&str; 12] = [
    "road",
    "geometry",
    "arc",
    "spiral",
    "poly3",
    "paramPoly3",
    "elevation",
    "superelevation",
    "laneOffset",
    "laneSection",
    "width",
    "border",
];

/// Looks at every number inside a road or junction, and at the length of its ids and names.
pub fn check(node: Node<'_, '_>) -> Result<(), BakeError> {
    for element in node.descendants().filter(|n| n.is_element() && !n.has_tag_name("userData")) {
        for attribute in element.attributes() {
            let (name, text) = (attribute.name(), attribute.value());
            if matches!(name, "id" | "name" | "junction") && text.len() > NAME_BYTES {
                let reason = format!("expected {name} to have at most {NAME_BYTES} bytes, but it has {}", text.len());
                return Err(refused(element, reason));
            }
            let (Some(largest), tag) = (largest(name), element.tag_name().name()) else { continue };
            let expected = match text.trim().parse::<f64>() {
                Ok(number) if (-largest..=largest).contains(&number) => continue,
                Ok(_) => format!("at most {largest:e}"),
                Err(_) if MEASURED.contains(&tag) => "a number".to_owned(),
                Err(_) => continue,
            };
            let reason = format!("expected {name} of <{tag}> to be {expected}, but it is {}", said(text));
            return Err(refused(element, reason));
        }
    }
    Ok(())
}

/// A number, as xodr reads it: none where it is missing or no number.
pub fn number(node: Node<'_, '_>, name: &str) -> Option<f64> {
    node.attribute(name)?.trim().parse().ok().filter(|n: &f64| n.is_finite())
}
