//! What a command says on stdout.

use std::fmt::Display;
use std::io::{ErrorKind, Write};

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
    write(&format!("{line}\n"))
}

/// Prints a text as it is.
pub fn text(text: &str) -> anyhow::Result<()> {
    write(text)
}

fn write(text: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        // Who reads has enough, as `head` after its first lines.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => written.context("stdout"),
    }
}
