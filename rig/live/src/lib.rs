//! What people sit at: wheels and keyboards, the windows of a live drive, and the window that looks at recordings.

pub mod desktop;
pub mod drive;
pub mod speakers;
pub mod units;
pub mod view;
