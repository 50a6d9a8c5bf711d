//! How a camera makes its pictures, in words: `standard exposure_ev=-1,noise=4`.

use core::fmt;
use core::str::FromStr;

use crate::{Quality, Sensor};

/// How good pictures are, and what a sensor makes of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Imaging {
    /// How much is drawn.
    pub quality: Quality,
    /// What lens and chip do.
    pub sensor: Sensor,
}

impl Imaging {
    /// That of files which say none.
    pub fn unsaid() -> Self {
        Self { quality: Quality::unsaid(), sensor: Sensor::default() }
    }
}

impl From<Quality> for Imaging {
    fn from(quality: Quality) -> Self {
        Self { quality, sensor: Sensor::default() }
    }
}

/// Nothing is said of an ideal sensor.
impl fmt::Display for Imaging {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.quality.name())?;
        if self.sensor.is_ideal() { Ok(()) } else { write!(f, " {}", self.sensor) }
    }
}

impl FromStr for Imaging {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once(' ') {
            None => Ok(text.parse::<Quality>()?.into()),
            Some((quality, sensor)) => Ok(Self { quality: quality.parse()?, sensor: sensor.parse()? }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn imaging_is_read_as_it_is_said() {
        for quality in Quality::ALL {
            assert_eq!(
                (Imaging::from(quality).to_string().as_str(), quality.name().parse::<Imaging>()),
                (quality.name(), Ok(quality.into()))
            );
            let sensor = "k1=-0.1,vignetting=1".parse().expect("a sensor");
            let imaging = Imaging { quality, sensor };
            assert_eq!(imaging.to_string().parse(), Ok(imaging));
        }
        assert!("noise=4".parse::<Imaging>().is_err() && "plain ".parse::<Imaging>().is_err());
        assert!("plain noise=4 k1=0".parse::<Imaging>().is_err());
    }
}
