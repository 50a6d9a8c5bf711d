//! Drives in steps, for `aeye.gym`: an agent in Python has one of the seats.

mod arrays;
mod episodes;
mod setting;

pub use episodes::Episodes;
pub use setting::Setting;
