//! Values of a scenario's text, checked.

use std::ops::{Bound, RangeBounds, RangeInclusive};

use toml::Spanned;

use super::fields::ScenarioError;

/// A value with its place in the text, if it is there.
pub(super) type Given<T> = Option<Spanned<T>>;

/// Takes over given values, checked.
pub(super) struct Reader<'a> {
    pub text: &'a str,
}

impl Reader<'_> {
    /// The line of a byte of the text, from 1.
    pub fn line(&self, at: usize) -> usize {
        1 + self.text.bytes().take(at).filter(|&byte| byte == b'\n').count()
    }

    /// Takes over a value, if one is given, or refuses it by line and key.
    pub fn take<T>(
        &self,
        key: &str,
        given: Given<T>,
        range: impl RangeBounds<T>,
        to: &mut T,
    ) -> Result<(), ScenarioError>
    where
        T: PartialOrd + Copy + std::fmt::Display,
    {
        let Some(given) = given else { return Ok(()) };
        let value = *given.get_ref();
        if !range.contains(&value) {
            let (line, range) = (self.line(given.span().start), words(&range));
            return Err(ScenarioError(format!("line {line}: {key} is {value}, expected {range}")));
        }
        *to = value;
        Ok(())
    }

    /// Two numbers, the lower one first.
    pub fn take_range(
        &self,
        key: &str,
        given: Given<[f32; 2]>,
        range: RangeInclusive<f32>,
        to: &mut [f32; 2],
    ) -> Result<(), ScenarioError> {
        let Some(given) = given else { return Ok(()) };
        let [low, high] = *given.get_ref();
        if !(low <= high && range.contains(&low) && range.contains(&high)) {
            let (line, range) = (self.line(given.span().start), words(&range));
            let asked = "expected the lower one first";
            return Err(ScenarioError(format!("line {line}: {key} is [{low}, {high}], {asked}, each {range}")));
        }
        *to = [low, high];
        Ok(())
    }
}

fn words<T: std::fmt::Display>(range: &impl RangeBounds<T>) -> String {
    let low = match range.start_bound() {
        Bound::Included(low) => format!("at least {low}"),
        Bound::Excluded(low) => format!("more than {low}"),
        Bound::Unbounded => String::from("anything"),
    };
    match range.end_bound() {
        Bound::Included(high) => format!("{low} and at most {high}"),
        Bound::Excluded(high) => format!("{low} and less than {high}"),
        Bound::Unbounded => low,
    }
}
