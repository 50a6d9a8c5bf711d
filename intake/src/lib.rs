//! What comes from outside: files of bounded length, and names that become parts of paths.

mod files;
mod names;

pub use files::{most, read, read_part, read_text};
pub use names::check_name;
