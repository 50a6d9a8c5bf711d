//! How good a picture is, by name: the same name draws the same picture on every adapter.

use core::str::FromStr;

use serde::{Deserialize, Serialize};

/// How much is drawn. Classes, instances and depth are those of the pixels' middles in all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Quality {
    /// One sample a pixel, shadows within 64 m.
    Plain,
    /// The same, and colours are smoothed: half of a pixel is the sample in its middle, half those at its corners, which it
    /// shares with its neighbours (quincunx; NVIDIA 2001, "HRAA: High-resolution antialiasing"). Two samples a pixel come close to
    /// what four on a grid show.
    #[default]
    Standard,
    /// Nine samples a pixel and finer shadows, for GPUs.
    Fine,
}

impl Quality {
    /// Every one, from the cheapest.
    pub const ALL: [Self; 3] = [Self::Plain, Self::Standard, Self::Fine];

    /// That of files which say none. Programs from before there were names drew the like of `fine` on GPUs and did not say so.
    pub fn unsaid() -> Self {
        Self::Plain
    }

    /// Its name on the command line and in recordings.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Standard => "standard",
            Self::Fine => "fine",
        }
    }

    /// Longest side of a picture, pixels, on adapters that have textures of 16384 texels, as most do.
    pub fn longest_side(self) -> u32 {
        longest_side(16_384, self)
    }

    pub(crate) fn means(self) -> Means {
        match self {
            Self::Plain => Means { samples: 1, corners: false, shadows: COARSE },
            Self::Standard => Means { samples: 1, corners: true, shadows: COARSE },
            Self::Fine => Means { samples: 3, corners: false, shadows: FINE },
        }
    }
}

impl FromStr for Quality {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let known = Self::ALL.into_iter().find(|quality| quality.name() == name);
        known.ok_or_else(|| "expected plain, standard or fine".into())
    }
}

/// The same on adapters whose textures have other sides.
pub(crate) fn longest_side(texels: u32, quality: Quality) -> u32 {
    let Means { samples, corners, .. } = quality.means();
    texels / samples - u32::from(corners)
}

/// What a quality stands for.
#[derive(Clone, Copy)]
pub(crate) struct Means {
    /// Samples a pixel along each axis; odd, so that one lies in the pixel's middle.
    pub(crate) samples: u32,
    /// Whether colours are taken at the pixels' corners too.
    pub(crate) corners: bool,
    pub(crate) shadows: Shadows,
}

/// How the sun's shadows are drawn.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Shadows {
    /// Of the map, texels.
    pub(crate) side: u32,
    /// Samples of the map along each axis.
    pub(crate) taps: u32,
    pub(crate) reach_m: f32,
}

const COARSE: Shadows = Shadows { side: 1024, taps: 1, reach_m: 64.0 };
const FINE: Shadows = Shadows { side: 4096, taps: 3, reach_m: 128.0 };

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quality_is_found_by_its_name() {
        assert!(Quality::ALL.iter().all(|quality| quality.name().parse() == Ok(*quality)));
        assert_eq!(Quality::ALL.map(Quality::longest_side), [16_384, 16_383, 5_461]);
        assert_eq!("best".parse::<Quality>(), Err("expected plain, standard or fine".into()));
    }
}
