//! Weather of a run, and what follows from it for the road and for those who are on it.

mod change;
mod conditions;
mod fields;
mod presets;
mod water;

pub use change::WeatherChange;
pub use conditions::Conditions;
pub use fields::Weather;
pub use presets::{PRESETS, WeatherPreset};
pub use water::Water;
