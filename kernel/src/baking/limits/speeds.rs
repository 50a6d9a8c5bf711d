//! Speed limits: numbers, or the words that OpenDRIVE knows.

use roxmltree::Node;

use super::constants::SHOWN;
use super::document::children;
use super::numbers::number;
use super::place::{refused, said};
use crate::baking::catalogue;
use crate::baking::error::BakeError;

/// What `max` may say instead of a number.
const WORDS: [&str; 2] = ["no limit", "undefined"];
/// What a limit may be in; m/s where a file does not say.
const UNITS: [&str; 3] = ["m/s", "km/h", "mph"];

/// Checks the limits that a road, its lanes and its signs tell.
pub fn check(road: Node<'_, '_>) -> Result<(), BakeError> {
    let tells = |node: &Node<'_, '_>| node.parent().is_some_and(|n| n.has_tag_name("type") || n.has_tag_name("lane"));
    road.descendants().filter(|n| n.has_tag_name("speed")).filter(tells).try_for_each(of_record)?;
    children(road, "signals").flat_map(|signals| children(signals, "signal")).try_for_each(of_sign)
}

fn of_record(speed: Node<'_, '_>) -> Result<(), BakeError> {
    let max = speed.attribute("max").unwrap_or_default();
    if max.trim().is_empty() || WORDS.contains(&max) {
        return Ok(());
    }
    if number(speed, "max").is_none_or(|max| max < 0.0) {
        let words = WORDS.join(" or ");
        let reason = format!("expected max of <speed> to be a number above 0, {words}, but it is {}", said(max));
        return Err(refused(speed, reason));
    }
    let unit = speed.attribute("unit").unwrap_or(UNITS[0]);
    if !UNITS.contains(&unit) {
        let reason = format!("expected unit of <speed> to be one of {}, but it is {}", UNITS.join(", "), said(unit));
        return Err(refused(speed, reason));
    }
    Ok(())
}

fn of_sign(signal: Node<'_, '_>) -> Result<(), BakeError> {
    let told = |name| signal.attribute(name).unwrap_or_default();
    let value = told("value").trim();
    if value.is_empty() || !catalogue::is_limit(told("country"), told("type"), told("subtype")) {
        return Ok(());
    }
    // Files write -1 or 0 where a sign shows no number.
    match number(signal, "value") {
        Some(shown) if shown == -1.0 || (0.0..SHOWN).contains(&shown) => Ok(()),
        _ => {
            let reason =
                format!("expected value of this speed limit to be from 0 to below {SHOWN}, but it is {}", said(value));
            Err(refused(signal, reason))
        }
    }
}
