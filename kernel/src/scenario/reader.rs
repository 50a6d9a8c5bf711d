//! Sections of a scenario's text, whose values are taken over by key. What does not fit is refused in a sentence that
//! names line and key, and says what would.

use std::fmt::Display;
use std::ops::RangeInclusive;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::fields::ScenarioError;

/// A refusal shows so many characters of a value.
const SHOWN: usize = 40;

/// A section, with the values that were not asked for yet.
pub(super) struct Section<'a> {
    text: &'a str,
    /// As in `weather.later`; nothing for the whole text.
    name: String,
    rest: DeTable<'a>,
    known: Vec<&'static str>,
}

impl<'a> Section<'a> {
    /// The whole text.
    pub fn whole_text(text: &'a str) -> Result<Self, ScenarioError> {
        let refused = |error: toml::de::Error| {
            let at = error.span().map_or(0, |span| span.start);
            refusal(text, at, &error.message().replace('\n', " "))
        };
        let rest = DeTable::parse(text).map_err(refused)?.into_inner();
        Ok(Self { text, name: String::new(), rest, known: Vec::new() })
    }

    /// Reads the section below this one that has a key, if it is there. Who gives something else is told of it
    /// `with` what it would have.
    pub fn section(
        &mut self,
        key: &'static str,
        with: &str,
        read: impl FnOnce(&mut Self) -> Result<(), ScenarioError>,
    ) -> Result<(), ScenarioError> {
        let (text, name) = (self.text, self.path(key));
        let expected = || format!("a section [{name}] with {with}");
        let Some(rest) = self.value(key, expected, |value| value.as_table().cloned())? else { return Ok(()) };
        let mut section = Self { text, name, rest, known: Vec::new() };
        read(&mut section)?;
        section.end()
    }

    /// Takes over a number of a range, if one is given.
    pub fn number(&mut self, key: &'static str, range: RangeInclusive<f32>, to: &mut f32) -> Result<(), ScenarioError> {
        let expected = || format!("a number from {}", words(&range));
        let given = self.value(key, expected, |value| number(value).filter(|number| range.contains(number)))?;
        *to = given.unwrap_or(*to);
        Ok(())
    }

    /// Takes over two numbers of a range, the lower one first, if they are given.
    pub fn pair(
        &mut self,
        key: &'static str,
        range: RangeInclusive<f32>,
        to: &mut [f32; 2],
    ) -> Result<(), ScenarioError> {
        let expected = || format!("a list of two numbers from {}, the lower one first", words(&range));
        let fits = |[low, high]: &[f32; 2]| low <= high && range.contains(low) && range.contains(high);
        let given = self.value(key, expected, |value| pair(value).filter(fits))?;
        *to = given.unwrap_or(*to);
        Ok(())
    }

    /// A whole number of a range, if one is given.
    pub fn whole<T>(&mut self, key: &'static str, range: RangeInclusive<T>) -> Result<Option<T>, ScenarioError>
    where
        T: PartialOrd + TryFrom<i128> + Display,
    {
        let expected = || format!("a whole number from {}", words(&range));
        let read = |value: &DeValue<'_>| T::try_from(whole(value)?).ok().filter(|number| range.contains(number));
        self.value(key, expected, read)
    }

    /// Takes over `true` or `false`, if one is given.
    pub fn switch(&mut self, key: &'static str, to: &mut bool) -> Result<(), ScenarioError> {
        let given = self.value(key, || "true or false".into(), DeValue::as_bool)?;
        *to = given.unwrap_or(*to);
        Ok(())
    }

    /// What a text stands for, if one is given.
    pub fn named<T>(
        &mut self,
        key: &'static str,
        expected: impl FnOnce() -> String,
        find: impl FnOnce(&str) -> Option<T>,
    ) -> Result<Option<T>, ScenarioError> {
        self.value(key, expected, |value| value.as_str().and_then(find))
    }

    /// Refuses what nobody asked for.
    pub fn end(self) -> Result<(), ScenarioError> {
        let Some(stray) = self.rest.keys().min_by_key(|key| key.span().start) else { return Ok(()) };
        let (path, known) = (self.path(stray.get_ref()), self.known.join(", "));
        Err(refusal(self.text, stray.span().start, &format!("unknown key {path}, expected one of {known}")))
    }

    /// What is read from the value of a key, if there is one.
    fn value<T>(
        &mut self,
        key: &'static str,
        expected: impl FnOnce() -> String,
        read: impl FnOnce(&DeValue<'a>) -> Option<T>,
    ) -> Result<Option<T>, ScenarioError> {
        self.known.push(key);
        let Some(given) = self.rest.remove(key) else { return Ok(None) };
        let refused = || {
            let (path, shown) = (self.path(key), self.shown(&given));
            refusal(self.text, given.span().start, &format!("{path} is {shown}, expected {}", expected()))
        };
        read(given.get_ref()).map(Some).ok_or_else(refused)
    }

    fn path(&self, key: &str) -> String {
        if self.name.is_empty() { key.to_owned() } else { format!("{}.{key}", self.name) }
    }

    /// A value as it stands in the text.
    fn shown(&self, given: &Spanned<DeValue<'_>>) -> String {
        if given.get_ref().is_table() {
            return "a section".into();
        }
        let line = self.text.get(given.span()).and_then(|text| text.lines().next()).unwrap_or_default();
        let mut shown: String = line.chars().take(SHOWN).collect();
        if shown.len() < given.span().len() {
            shown.push_str("...");
        }
        shown
    }
}

fn number(value: &DeValue<'_>) -> Option<f32> {
    let float = value.as_float().and_then(|float| float.as_str().parse::<f64>().ok());
    float.map(|float| float as f32).or_else(|| whole(value).map(|whole| whole as f32))
}

fn whole(value: &DeValue<'_>) -> Option<i128> {
    let digits = value.as_integer()?;
    i128::from_str_radix(digits.as_str(), digits.radix()).ok()
}

fn pair(value: &DeValue<'_>) -> Option<[f32; 2]> {
    match &**value.as_array()? {
        [low, high] => Some([number(low.get_ref())?, number(high.get_ref())?]),
        _ => None,
    }
}

fn words(range: &RangeInclusive<impl Display>) -> String {
    format!("{} to {}", range.start(), range.end())
}

fn refusal(text: &str, at: usize, reason: &str) -> ScenarioError {
    let line = 1 + text.bytes().take(at).filter(|&byte| byte == b'\n').count();
    ScenarioError(format!("line {line}: {reason}"))
}
