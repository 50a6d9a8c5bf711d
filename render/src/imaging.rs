//! How a camera makes its pictures, in words: `standard exposure_ev=-1,noise=4`, with models of a user's own
//! `standard models=0123...`.

use core::fmt;
use core::str::FromStr;

use crate::models::ModelsId;
use crate::{Quality, Sensor};

/// What comes before the digest of models.
const MODELS: &str = "models=";

/// How good pictures are, what a sensor makes of them, and whose models stand for what is in them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Imaging {
    /// How much is drawn.
    pub quality: Quality,
    /// What lens and chip do.
    pub sensor: Sensor,
    /// Models of a user's own.
    pub models: Option<ModelsId>,
}

impl Imaging {
    /// That of labels, which are the same whatever the quality, and seen through no lens.
    pub fn of_truth(self) -> Self {
        Self { models: self.models, ..Self::unsaid() }
    }

    /// The same scene in another quality, by an ideal sensor.
    pub fn in_quality(self, quality: Quality) -> Self {
        Self { quality, ..self.of_truth() }
    }

    /// That of files which say none.
    pub fn unsaid() -> Self {
        Self { quality: Quality::unsaid(), ..Self::default() }
    }
}

impl From<Quality> for Imaging {
    fn from(quality: Quality) -> Self {
        Self { quality, ..Self::default() }
    }
}

/// Nothing is said of an ideal sensor, and of the renderer's own models.
impl fmt::Display for Imaging {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.quality.name())?;
        if !self.sensor.is_ideal() {
            write!(f, " {}", self.sensor)?;
        }
        self.models.map_or(Ok(()), |models| write!(f, " {MODELS}{models}"))
    }
}

impl FromStr for Imaging {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (text, models) = match text.split_once(MODELS) {
            None => (text, None),
            Some((text, models)) => (text.strip_suffix(' ').ok_or("expected a space before models")?, Some(models)),
        };
        let models = models.map(str::parse).transpose()?;
        let (quality, sensor) = text.split_once(' ').map_or((text, None), |(quality, sensor)| (quality, Some(sensor)));
        let sensor = sensor.map_or(Ok(Sensor::default()), str::parse)?;
        Ok(Self { quality: quality.parse()?, sensor, models })
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
            let imaging = Imaging { quality, sensor, models: None };
            assert_eq!(imaging.to_string().parse(), Ok(imaging));
            let models = Some(ModelsId::from([7; 16]));
            for imaging in [Imaging { models, ..imaging }, Imaging { models, ..quality.into() }] {
                assert_eq!(imaging.to_string().parse(), Ok(imaging));
            }
        }
        assert!("noise=4".parse::<Imaging>().is_err() && "plain ".parse::<Imaging>().is_err());
        assert!("plain noise=4 k1=0".parse::<Imaging>().is_err());
        let digest = "07".repeat(16);
        for wrong in ["models=", "plain models=", "plainmodels=", "plain models=07 noise=4"] {
            assert!(format!("{wrong}{digest} ").parse::<Imaging>().is_err(), "{wrong}");
        }
        assert!(
            "plain models=07".parse::<Imaging>().is_err()
                && format!("plainmodels={digest}").parse::<Imaging>().is_err()
        );
    }
}
