//! Errors of the crates below as exceptions of the package, each with its one sentence.

use std::io;

use anyhow::Error;
use base::failure::{Usage, is_divergence, sentence};
use lab::campaign::TooFew;
use perception::PerceptionError;
use pyo3::prelude::*;
use render::RenderError;

/// The names of the exceptions in `aeye/_errors.py`.
const FILE: &str = "FileError";
const INPUT: &str = "InputError";
const ENGINE: &str = "EngineError";
const DIVERGED: &str = "DivergedError";
const MISSING_RUNS: &str = "MissingRunsError";

/// The exception that stands for an error.
pub fn raise(error: &Error) -> PyErr {
    exception(kind(error), sentence(error))
}

/// A file or folder is not there.
pub fn file(sentence: String) -> PyErr {
    exception(FILE, sentence)
}

/// What was handed over is not what is expected.
pub fn input(sentence: String) -> PyErr {
    exception(INPUT, sentence)
}

/// It cannot be computed here.
pub fn engine(sentence: String) -> PyErr {
    exception(ENGINE, sentence)
}

/// A replay is not the run that was recorded.
pub fn diverged(sentence: String) -> PyErr {
    exception(DIVERGED, sentence)
}

fn exception(name: &str, sentence: String) -> PyErr {
    Python::attach(|py| {
        let made = py.import("aeye._errors").and_then(|errors| errors.call_method1(name, (sentence,)));
        made.map_or_else(|error| error, PyErr::from_value)
    })
}

fn kind(error: &Error) -> &'static str {
    if is_divergence(error) {
        return DIVERGED;
    }
    error.chain().find_map(kind_of_cause).unwrap_or(ENGINE)
}

fn kind_of_cause(cause: &(dyn std::error::Error + 'static)) -> Option<&'static str> {
    let of_perception = |error: &PerceptionError| match error {
        PerceptionError::Io { .. } => FILE,
        PerceptionError::Compute { .. } | PerceptionError::Inference { .. } => ENGINE,
        _ => INPUT,
    };
    let of_render = |error: &RenderError| match error {
        RenderError::ImageSize { .. } | RenderError::OtherMap { .. } => INPUT,
        _ => ENGINE,
    };
    None.or_else(|| cause.is::<Usage>().then_some(INPUT))
        .or_else(|| cause.is::<TooFew>().then_some(MISSING_RUNS))
        .or_else(|| cause.is::<io::Error>().then_some(FILE))
        .or_else(|| cause.downcast_ref().map(of_log))
        .or_else(|| cause.downcast_ref().map(of_perception))
        .or_else(|| cause.downcast_ref().map(of_render))
}

fn of_log(error: &replay::Error) -> &'static str {
    use replay::Error;
    match error {
        Error::In { error, .. } => of_log(error),
        Error::Io(_) | Error::NoMap { .. } => FILE,
        Error::Kernel { .. } | Error::Diverged(_) => ENGINE,
        _ => INPUT,
    }
}
