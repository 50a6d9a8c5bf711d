//! From where a tick can be looked at.

use std::str::FromStr;

use base::failure::Usage;
use render::Camera;

/// Ground from left to right in the view from above, metres.
const TOP_SPAN_M: f32 = 70.0;

/// From where a tick is looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Viewpoint {
    /// As both drivers see.
    #[default]
    Driver,
    /// From behind and above the car.
    Chase,
    /// Straight down, north up.
    Top,
}

impl Viewpoint {
    /// The one that follows, in a circle.
    pub fn next(self) -> Self {
        match self {
            Self::Driver => Self::Chase,
            Self::Chase => Self::Top,
            Self::Top => Self::Driver,
        }
    }

    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Driver => "driver",
            Self::Chase => "chase",
            Self::Top => "from above",
        }
    }

    /// The camera there, for pictures of one size.
    pub fn camera(self, (width, height): (u32, u32)) -> Camera {
        match self {
            Self::Driver => Camera::driver(width, height),
            Self::Chase => Camera::chase(width, height),
            Self::Top => Camera::top(width, height, TOP_SPAN_M),
        }
    }
}

impl FromStr for Viewpoint {
    type Err = Usage;

    fn from_str(text: &str) -> Result<Self, Usage> {
        match text {
            "driver" => Ok(Self::Driver),
            "chase" => Ok(Self::Chase),
            "top" => Ok(Self::Top),
            _ => Err(Usage(format!("no such camera: {text:?}; expected driver, chase or top"))),
        }
    }
}
