//! Which program made a log, so that its kernel can be found again.

/// Where provenance names the program that made a log, as in `aeye 0.1.0`: its releases can be found by it.
pub const WRITTEN_BY: &str = "program";
/// This program and its version.
pub const PROGRAM: &str = concat!("aeye ", env!("CARGO_PKG_VERSION"));

/// Where the kernel of a log is to be found, as the end of a sentence; nothing where the log does not name its program.
pub fn release(program: Option<&str>) -> String {
    match program {
        None => String::new(),
        Some(PROGRAM) => format!(", which is that of another build of {PROGRAM}"),
        Some(program) => format!(", which is that of {program}"),
    }
}
