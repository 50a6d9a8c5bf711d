//! How something changes.

use crate::story::error::StoryError;
use crate::story::script::{Dynamics, Shape, Takes};

use super::document::Element;

/// The courses of changes.
pub const SHAPES: &[(&str, Shape)] =
    &[("linear", Shape::Linear), ("cubic", Shape::Cubic), ("sinusoidal", Shape::Sinusoidal), ("step", Shape::Step)];

/// How something changes.
pub fn dynamics(element: Element<'_>) -> Result<Dynamics, StoryError> {
    let shape = element.word("dynamicsShape", SHAPES)?;
    let value = element.amount("value")?;
    let takes = [("time", Takes::Time(value)), ("distance", Takes::Distance(value)), ("rate", Takes::Rate(value))];
    Ok(Dynamics { shape, takes: element.word("dynamicsDimension", &takes)? })
}
