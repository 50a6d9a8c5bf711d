//! Parameters with ranges: `<ConstraintGroup>` of a `<ParameterDeclaration>` (OpenSCENARIO 1.2) says from where to where.

use roxmltree::{Document, Node};

use crate::ops;
use crate::rng::{self, Stream};

/// Random numbers of parameters, as keys: this plus the number of the parameter.
const KEY: u64 = 1 << 32;
/// Values are drawn in such steps of their range.
const STEPS: u32 = 10_000;

/// The text with a value drawn for each parameter that has a range; nothing where none has.
pub fn varied(text: &str, seed: u64) -> Option<String> {
    let share =
        |number: usize| rng::below(seed, Stream::Scenario, KEY + number as u64, 0, STEPS + 1) as f32 / STEPS as f32;
    with_shares(text, share)
}

/// The text with all such parameters at a share of their ranges, [0, 1].
pub fn with_shares(text: &str, share: impl Fn(usize) -> f32) -> Option<String> {
    let document = Document::parse(text).ok()?;
    let declared = document.root_element().children().filter(|n| n.has_tag_name("ParameterDeclarations"));
    let declared = declared.flat_map(|n| n.children()).filter(|n| n.has_tag_name("ParameterDeclaration"));
    let mut values = Vec::new();
    for (number, parameter) in declared.enumerate() {
        let Some([low, high]) = range(parameter) else { continue };
        let value = low + (high - low) * share(number);
        let is_whole = matches!(parameter.attribute("parameterType"), Some("integer" | "int" | "unsignedInt"));
        let value = if is_whole { ops::round(value) } else { value };
        values.push((parameter.attribute_node("value")?.range_value(), value.to_string()));
    }
    let mut varied = text.to_owned();
    // From the last one on, so that places before stay what they are.
    values.sort_by_key(|(place, _)| place.start);
    values.iter().rev().for_each(|(place, value)| varied.replace_range(place.clone(), value));
    (!values.is_empty()).then_some(varied)
}

/// From where to where the first group of constraints lets a parameter be.
fn range(parameter: Node<'_, '_>) -> Option<[f32; 2]> {
    let group = parameter.children().find(|n| n.has_tag_name("ConstraintGroup"))?;
    let bound = |among: [&str; 2]| {
        let is_one = |n: &Node<'_, '_>| n.attribute("rule").is_some_and(|rule| among.contains(&rule));
        let constraint = group.children().filter(|n| n.has_tag_name("ValueConstraint")).find(is_one)?;
        constraint.attribute("value")?.trim().parse::<f32>().ok().filter(|value| value.is_finite())
    };
    let range = [bound(["greaterThan", "greaterOrEqual"])?, bound(["lessThan", "lessOrEqual"])?];
    (range[0] <= range[1]).then_some(range)
}
