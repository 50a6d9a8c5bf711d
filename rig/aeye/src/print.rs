//! What a command says on stdout.

use std::fmt::Display;
use std::io::Write;

use anyhow::Context;
use base::json::{Typed, json_line};
use base::say::printable_lines;

/// Prints a result: one line of JSON, or its text.
pub fn result<T: Typed + Display>(json: bool, value: &T) -> anyhow::Result<()> {
    print(json, value, || value.to_string())
}

/// Prints a value: one line of JSON, or this text.
pub fn print<T: Typed>(json: bool, value: &T, text: impl FnOnce() -> String) -> anyhow::Result<()> {
    let line = if json { json_line(value)? } else { printable_lines(&text()) };
    let mut out = std::io::stdout().lock();
    writeln!(out, "{line}").and_then(|()| out.flush()).context("stdout")
}

/// Prints a text as it is.
pub fn text(text: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).context("stdout")
}
