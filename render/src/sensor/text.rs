//! A sensor in words: the settings that are not those of an ideal one, as in `exposure_ev=-1,noise=4`.

use core::fmt;
use core::ops::RangeInclusive;
use core::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

use super::Sensor;

/// A setting: its name, what it may be, and where it stands.
struct Setting {
    name: &'static str,
    range: RangeInclusive<f32>,
    of: fn(&mut Sensor) -> &mut f32,
}

const SETTINGS: [Setting; 6] = [
    Setting { name: "exposure_ev", range: -4.0..=4.0, of: |sensor| &mut sensor.exposure_ev },
    Setting { name: "noise", range: 0.0..=32.0, of: |sensor| &mut sensor.noise },
    Setting { name: "k1", range: -1.0..=1.0, of: |sensor| &mut sensor.k1 },
    Setting { name: "k2", range: -1.0..=1.0, of: |sensor| &mut sensor.k2 },
    Setting { name: "motion_blur_s", range: 0.0..=0.1, of: |sensor| &mut sensor.motion_blur_s },
    Setting { name: "vignetting", range: 0.0..=1.0, of: |sensor| &mut sensor.vignetting },
];

fn names() -> String {
    SETTINGS.map(|setting| setting.name).join(", ")
}

impl fmt::Display for Sensor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut copy = *self;
        let mut comma = "";
        for Setting { name, of, .. } in &SETTINGS {
            let value = *of(&mut copy);
            if value != 0.0 {
                write!(f, "{comma}{name}={value}")?;
                comma = ",";
            }
        }
        Ok(())
    }
}

impl FromStr for Sensor {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (mut sensor, mut said) = (Self::default(), Vec::new());
        for part in text.split(',').map(str::trim) {
            let Some((name, value)) = part.split_once('=') else {
                return Err(format!("{part:?} is no setting; expected as in exposure_ev=-1,noise=4, of {}", names()));
            };
            let (name, value) = (name.trim(), value.trim());
            let setting = SETTINGS.iter().find(|setting| setting.name == name);
            let setting = setting.ok_or_else(|| format!("no such setting: {name:?}; expected {}", names()))?;
            if said.contains(&name) {
                return Err(format!("{name} is given twice; expected it once"));
            }
            said.push(name);
            let (low, high) = (setting.range.start(), setting.range.end());
            let number = value.parse::<f32>().ok().filter(|number| setting.range.contains(number));
            let expected = || format!("{name} is {value:?}; expected a number from {low} to {high}");
            // Zero has one sign.
            *(setting.of)(&mut sensor) = number.ok_or_else(expected)? + 0.0;
        }
        Ok(sensor)
    }
}

impl Serialize for Sensor {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Sensor {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Result<Sensor, String> {
        text.parse()
    }

    #[test]
    fn a_sensor_is_read_as_it_is_said() {
        let all = "exposure_ev=-1.5,noise=4,k1=-0.3,k2=0.1,motion_blur_s=0.01,vignetting=0.5";
        let sensor = parsed(all).unwrap();
        assert_eq!(sensor.to_string(), all);
        assert_eq!((sensor.exposure_ev(), sensor.distortion(), sensor.vignetting()), (-1.5, [-0.3, 0.1], 0.5));
        assert_eq!(parsed(" vignetting = 0.5 , noise=4e0").unwrap().to_string(), "noise=4,vignetting=0.5");
        assert_eq!(parsed("noise=0,k1=-0").unwrap(), Sensor::default());
        assert_eq!(parsed("k1=-0").unwrap().to_string(), "", "nothing is said of what is ideal");
    }

    #[test]
    fn every_setting_comes_back_at_its_limits() {
        for Setting { name, range, .. } in &SETTINGS {
            for value in [*range.start(), *range.end(), 0.3 * range.end()] {
                let sensor = parsed(&format!("{name}={value}")).unwrap();
                let said = sensor.to_string();
                assert!(said.is_empty() || parsed(&said) == Ok(sensor), "{said}");
            }
        }
    }

    #[test]
    fn nonsense_is_refused_in_a_sentence() {
        let refused = |text: &str| parsed(text).unwrap_err();
        assert_eq!(refused("noise=NaN"), "noise is \"NaN\"; expected a number from 0 to 32");
        assert_eq!(refused("exposure_ev=inf"), "exposure_ev is \"inf\"; expected a number from -4 to 4");
        assert_eq!(refused("motion_blur_s=0.2"), "motion_blur_s is \"0.2\"; expected a number from 0 to 0.1");
        assert_eq!(refused("noise=4,noise=4"), "noise is given twice; expected it once");
        assert!(refused("iso=400").starts_with("no such setting: \"iso\"; expected exposure_ev, noise, k1,"));
        for (wrong, said) in
            [("", "\"\" is no setting"), ("noise", "\"noise\" is no setting"), ("noise=4,", "\"\" is no")]
        {
            assert!(refused(wrong).contains(said), "{wrong}");
        }
        for wrong in
            ["noise=", "noise=-1", "noise=4=5", "vignetting=1.01", "k1=1e9", "k2=--1", "noise=1e999", "NOISE=4"]
        {
            assert!(parsed(wrong).is_err(), "{wrong}");
        }
        assert!(parsed(&"noise=4,".repeat(100_000)).is_err());
    }
}
