//! Each thing that sounds, a file each: told what is heard, asked for one sample after the other.

mod around;
mod cabin;
mod impact;
mod motor;
mod road;
mod signals;
mod weather;

pub use around::Others;
pub use cabin::Cabin;
pub use impact::Impacts;
pub use motor::Motor;
pub use road::Road;
pub use signals::Signals;
pub use weather::Outside;
