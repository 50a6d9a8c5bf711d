//! Parameters with ranges: `<ConstraintGroup>` of a `<ParameterDeclaration>` (OpenSCENARIO 1.2) says from where to where.

use roxmltree::{Document, Node};

use super::document::{line_of, shown};
use crate::ops;
use crate::rng::{self, Stream};
use crate::story::error::StoryError;

/// Random numbers of parameters, as keys: this plus the number of the parameter.
const KEY: u64 = 1 << 32;
/// Values are drawn in such steps of their range.
const STEPS: u32 = 10_000;
/// Types of whole numbers.
const WHOLE: [&str; 4] = ["integer", "int", "unsignedInt", "unsignedShort"];
/// No bound is farther from 0.
const MOST: f32 = 1e9;

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
        let Ok(Some([low, high])) = range(parameter) else { continue };
        let value = low + (high - low) * share(number);
        let is_whole = parameter.attribute("parameterType").is_some_and(|of| WHOLE.contains(&of));
        let value = if is_whole { ops::round(value) } else { value };
        values.push((parameter.attribute_node("value")?.range_value(), value.to_string()));
    }
    let mut varied = text.to_owned();
    // From the last one on, so that places before stay what they are.
    values.sort_by_key(|(place, _)| place.start);
    values.iter().rev().for_each(|(place, value)| varied.replace_range(place.clone(), value));
    (!values.is_empty()).then_some(varied)
}

/// From where to where the first group of constraints lets a parameter be that is a number.
pub fn range(parameter: Node<'_, '_>) -> Result<Option<[f32; 2]>, StoryError> {
    let is_number = parameter.attribute("parameterType").is_some_and(|of| of == "double" || WHOLE.contains(&of));
    let group = parameter.children().find(|n| n.has_tag_name("ConstraintGroup")).filter(|_| is_number);
    let (mut low, mut high) = (None, None);
    for bound in group.into_iter().flat_map(|group| group.children()).filter(|n| n.has_tag_name("ValueConstraint")) {
        let end = match bound.attribute("rule") {
            Some("greaterThan" | "greaterOrEqual") => &mut low,
            Some("lessThan" | "lessOrEqual") => &mut high,
            _ => continue,
        };
        let text = bound.attribute("value").unwrap_or_default().trim();
        let value = text.parse::<f32>().ok().filter(|value| value.abs() <= MOST);
        let Some(value) = value else {
            let expected = format!("expected a number from -{MOST} to {MOST}");
            return Err(StoryError::at(
                line_of(bound),
                format!("value of <ValueConstraint> is {}, {expected}", shown(text)),
            ));
        };
        end.get_or_insert(value);
    }
    match low.zip(high) {
        Some((low, high)) if low > high => {
            let reason = format!("no number is from {low} to {high}, as <ConstraintGroup> asks for");
            Err(StoryError::at(group.map_or(1, line_of), reason))
        }
        range => Ok(range.map(|(low, high)| [low, high])),
    }
}
