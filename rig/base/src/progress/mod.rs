//! How far long work is, on stderr; and how it is interrupted.

mod bar;
mod interrupt;

pub use bar::{Bar, bar};
pub use interrupt::{Interrupt, interrupted, watch_signals};
