//! Values of a text, with the lines they stand on.

use std::ops::{Bound, RangeBounds};

use toml::Spanned;

use super::fields::ScenarioError;

/// A value that a text may hold.
pub(super) type Given<T> = Option<Spanned<T>>;

/// Takes over given values, checked.
pub(super) struct Reader<'a> {
    pub text: &'a str,
}

impl Reader<'_> {
    /// The line of a place in the text, from 1.
    pub fn line(&self, at: usize) -> usize {
        1 + self.text.bytes().take(at).filter(|&byte| byte == b'\n').count()
    }

    /// Takes a value over that is in its range.
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
