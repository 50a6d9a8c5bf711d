//! Arguments as Python hands them over: what is of another type is refused where the argument's name is known.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyInt, PyString};

use crate::errors::input;

/// What an argument may be.
pub trait Argument<'py>: Sized {
    /// In words, as in "a number".
    fn expected() -> String;

    /// Of what was handed over; or that part of it which is of another type.
    fn of(value: &Bound<'py, PyAny>) -> Result<Self, Bound<'py, PyAny>>;
}

/// An argument, or what stands in its place.
pub struct Given<T>(Result<T, String>);

impl<'a, 'py, T: Argument<'py>> FromPyObject<'a, 'py> for Given<T> {
    type Error = PyErr;

    fn extract(value: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self(match T::of(&value) {
            Ok(argument) => Ok(argument),
            Err(other) => Err(format!("expected {}, got {}", T::expected(), other.get_type().name()?)),
        }))
    }
}

impl<T> Given<T> {
    /// The one that a signature has.
    pub const fn of(argument: T) -> Self {
        Self(Ok(argument))
    }

    /// The argument of this name.
    pub fn named(self, name: &str) -> PyResult<T> {
        self.0.map_err(|refused| PyTypeError::new_err(format!("{name}: {refused}")))
    }
}

/// The argument of this name, where there is one.
pub fn named<T>(given: Option<Given<T>>, name: &str) -> PyResult<Option<T>> {
    given.map(|given| given.named(name)).transpose()
}

/// A whole number of any size, so that one that cannot be is refused with the range of those that can.
#[derive(Clone, Copy)]
pub struct Whole(pub i128);

impl Given<Whole> {
    /// The argument of this name, which has to lie in a range.
    pub fn within<T: Copy + Into<i128> + TryFrom<i128>>(self, name: &str, range: RangeInclusive<T>) -> PyResult<T> {
        let Whole(number) = self.named(name)?;
        let (least, most): (i128, i128) = ((*range.start()).into(), (*range.end()).into());
        let fits = T::try_from(number).ok().filter(|_| (least..=most).contains(&number));
        let has_no_end = T::try_from(most + 1).is_err();
        let words = if has_no_end { format!("{least} or more") } else { format!("{least} to {most}") };
        fits.ok_or_else(|| input(format!("{name}={number}; expected {words}")))
    }
}

/// The argument of this name, where there is one, which has to lie in a range.
pub fn within<T: Copy + Into<i128> + TryFrom<i128>>(
    given: Option<Given<Whole>>,
    name: &str,
    range: RangeInclusive<T>,
) -> PyResult<Option<T>> {
    given.map(|given| given.within(name, range)).transpose()
}

impl<'py> Argument<'py> for Whole {
    fn expected() -> String {
        "a whole number".to_owned()
    }

    fn of(value: &Bound<'py, PyAny>) -> Result<Self, Bound<'py, PyAny>> {
        // Nothing that is asked for comes near to the ends.
        let beyond = || value.is_instance_of::<PyInt>().then(|| value.lt(0).is_ok_and(|is| is));
        let end = |is_negative| if is_negative { i128::MIN } else { i128::MAX - 1 };
        value.extract().ok().or_else(|| beyond().map(end)).map(Self).ok_or_else(|| value.clone())
    }
}

/// Two whole numbers.
pub struct Pair(pub i128, pub i128);

impl<'py> Argument<'py> for Pair {
    fn expected() -> String {
        "two whole numbers".to_owned()
    }

    fn of(value: &Bound<'py, PyAny>) -> Result<Self, Bound<'py, PyAny>> {
        match <[Bound<'py, PyAny>; 2]>::try_from(parts(value)?) {
            Ok([first, second]) => Ok(Self(Whole::of(&first)?.0, Whole::of(&second)?.0)),
            Err(_) => Err(value.clone()),
        }
    }
}

/// One of something, or several.
pub enum OneOrMore<T> {
    One(T),
    More(Vec<T>),
}

impl<T> OneOrMore<T> {
    /// All of them.
    pub fn list(self) -> Vec<T> {
        match self {
            Self::One(one) => vec![one],
            Self::More(more) => more,
        }
    }
}

impl<'py, T: Argument<'py>> Argument<'py> for OneOrMore<T> {
    fn expected() -> String {
        format!("{}, or a list of such", T::expected())
    }

    fn of(value: &Bound<'py, PyAny>) -> Result<Self, Bound<'py, PyAny>> {
        match T::of(value) {
            Ok(one) => Ok(Self::One(one)),
            Err(_) => parts(value)?.iter().map(T::of).collect::<Result<_, _>>().map(Self::More),
        }
    }
}

/// What a list or anything like it holds.
fn parts<'py>(value: &Bound<'py, PyAny>) -> Result<Vec<Bound<'py, PyAny>>, Bound<'py, PyAny>> {
    let whole = |_| value.clone();
    if value.is_instance_of::<PyString>() {
        return Err(value.clone());
    }
    value.try_iter().and_then(Iterator::collect).map_err(whole)
}

impl<'py> Argument<'py> for f64 {
    fn expected() -> String {
        "a number".to_owned()
    }

    fn of(value: &Bound<'py, PyAny>) -> Result<Self, Bound<'py, PyAny>> {
        value.extract().map_err(|_| value.clone())
    }
}

impl<'py> Argument<'py> for String {
    fn expected() -> String {
        "a string".to_owned()
    }

    fn of(value: &Bound<'py, PyAny>) -> Result<Self, Bound<'py, PyAny>> {
        value.extract().map_err(|_| value.clone())
    }
}

impl<'py> Argument<'py> for PathBuf {
    fn expected() -> String {
        "a string or a path".to_owned()
    }

    fn of(value: &Bound<'py, PyAny>) -> Result<Self, Bound<'py, PyAny>> {
        value.extract().map_err(|_| value.clone())
    }
}
