//! Parameters with ranges: `<ConstraintGroup>` of a `<ParameterDeclaration>` (OpenSCENARIO 1.2) says from where to where.

use roxmltree::{Document, Node};

use super::document::{self, Element, line_of, shown};
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

/// Reads the declarations of an element's parameters: all are known from the beginning, but their ranges have to be some.
pub fn pass_parameters(owner: Element<'_>) -> Result<(), StoryError> {
    let mut declared = owner.all("ParameterDeclarations").flat_map(|all| all.all("ParameterDeclaration"));
    declared.try_for_each(|one| {
        let groups = one.all("ConstraintGroup");
        groups.flat_map(|group| group.all("ValueConstraint")).for_each(drop);
        range(one.node()).map(drop)
    })
}

/// Names and values of the parameters that have ranges.
pub fn drawn(text: &str) -> Vec<(String, f64)> {
    let Ok(document) = document::parse(text) else { return Vec::new() };
    let ranged = declared(&document).filter(|one| matches!(range(*one), Ok(Some(_))));
    let pair =
        |one: Node<'_, '_>| Some((one.attribute("name")?.to_owned(), one.attribute("value")?.trim().parse().ok()?));
    ranged.filter_map(pair).collect()
}

/// The declarations of the parameters of a whole text.
fn declared<'a>(document: &'a Document<'_>) -> impl Iterator<Item = Node<'a, 'a>> {
    let all = document.root_element().children().filter(|n| n.has_tag_name("ParameterDeclarations"));
    all.flat_map(|n| n.children()).filter(|n| n.has_tag_name("ParameterDeclaration"))
}

/// The text with all such parameters at a share of their ranges, [0, 1].
pub fn with_shares(text: &str, share: impl Fn(usize) -> f32) -> Option<String> {
    let document = document::parse(text).ok()?;
    let mut values = Vec::new();
    for (number, parameter) in declared(&document).enumerate() {
        let Ok(Some([low, high])) = range(parameter) else { continue };
        // Rounding may carry the sum beyond the end.
        let value = (low + (high - low) * share(number)).min(high);
        let value = if is_whole(parameter) { ops::round(value) } else { value };
        values.push((parameter.attribute_node("value")?.range_value(), value.to_string()));
    }
    let mut varied = text.to_owned();
    // From the last one on, so that places before stay what they are.
    values.sort_by_key(|(place, _)| place.start);
    values.iter().rev().for_each(|(place, value)| varied.replace_range(place.clone(), value));
    (!values.is_empty()).then_some(varied)
}

/// From where to where the first group of constraints lets a parameter be that is a number; it needs both ends, and the value
/// without a draw lies between them.
fn range(parameter: Node<'_, '_>) -> Result<Option<[f32; 2]>, StoryError> {
    let is_number = parameter.attribute("parameterType") == Some("double") || is_whole(parameter);
    let group = parameter.children().find(|n| n.has_tag_name("ConstraintGroup")).filter(|_| is_number);
    let Some(group) = group else { return Ok(None) };
    let (mut low, mut high) = (None, None);
    for bound in group.children().filter(|n| n.has_tag_name("ValueConstraint")) {
        let end = match bound.attribute("rule").unwrap_or_default() {
            "greaterThan" | "greaterOrEqual" => &mut low,
            "lessThan" | "lessOrEqual" => &mut high,
            "equalTo" | "notEqualTo" => continue,
            other => {
                let reason =
                    format!("rule of <ValueConstraint> is {}, expected greaterOrEqual or lessOrEqual", shown(other));
                return Err(StoryError::at(line_of(bound), reason));
            }
        };
        // Expressions are no ends of a range that is drawn from.
        if bound.attribute("value").is_some_and(|value| value.trim().starts_with('$')) {
            continue;
        }
        end.get_or_insert(number(bound)?);
    }
    let (Some(low), Some(high)) = (low, high) else { return Ok(None) };
    let (low, high) = if is_whole(parameter) { (low.ceil(), high.floor()) } else { (low, high) };
    let wrong = |reason: String| Err(StoryError::at(line_of(parameter), reason));
    if low > high {
        return wrong(format!("no number is from {low} to {high}, as <ConstraintGroup> asks for"));
    }
    match number(parameter)? {
        value if (low..=high).contains(&value) => Ok(Some([low, high])),
        value => wrong(format!("value of <ParameterDeclaration> is {value}, expected one from {low} to {high}")),
    }
}

fn is_whole(parameter: Node<'_, '_>) -> bool {
    parameter.attribute("parameterType").is_some_and(|of| WHOLE.contains(&of))
}

fn number(of: Node<'_, '_>) -> Result<f32, StoryError> {
    let text = of.attribute("value").unwrap_or_default().trim();
    let value = text.parse::<f32>().ok().filter(|value| value.abs() <= MOST);
    value.ok_or_else(|| {
        let tag = of.tag_name().name();
        let reason = format!("value of <{tag}> is {}, expected a number from -{MOST} to {MOST}", shown(text));
        StoryError::at(line_of(of), reason)
    })
}
