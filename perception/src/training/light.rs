//! How a picture looks apart from what it shows: light, colours, and the faults of lens and chip.

use serde::{Deserialize, Serialize};

use super::random::Random;
use crate::metadata::Normalisation;

/// How bytes become the network's input: the usual means and deviations of photographs.
pub(super) const NORMALISATION: Normalisation =
    Normalisation { mean: [0.485, 0.456, 0.406], std: [0.229, 0.224, 0.225] };

/// Largest change of contrast, and of each colour's share, as a fraction.
const CONTRAST: f32 = 0.2;
/// Largest change of brightness, as a fraction of the range.
const BRIGHTNESS: f32 = 0.1;
/// Each of the looks that are asked for is given to so many of the pictures.
const SHARE: f32 = 0.5;
/// Deviations on either side that a blur reaches.
const REACH: f32 = 3.0;

/// Looks beyond contrast, brightness and tint, which every picture gets: how far each goes at most. All 0: none, as
/// networks were trained before there were any. Half of the pictures get each, drawn for each by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Looks {
    /// Gamma, from its inverse to itself as the natural logarithm: above, pictures are dark as at dusk.
    pub gamma: f32,
    /// Saturation, as a fraction.
    pub saturation: f32,
    /// Rotation of all hues, degrees.
    pub hue_deg: f32,
    /// Deviation of a Gaussian blur, pixels of the network's input.
    pub blur_px: f32,
    /// Deviation of each value's noise, as a fraction of the range.
    pub noise: f32,
}

impl Looks {
    /// A sensible choice: dusk, other cameras' colours, a lens out of focus, a chip at night.
    pub const WIDE: Self = Self { gamma: 0.5, saturation: 0.4, hue_deg: 10.0, blur_px: 1.2, noise: 0.05 };

    pub(super) fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// What is asked for and cannot be.
    pub(super) fn refused(&self) -> Option<String> {
        let Self { gamma, saturation, hue_deg, blur_px, noise } = *self;
        let limits = [
            ("gamma", gamma, 2.0),
            ("saturation", saturation, 1.0),
            ("hue_deg", hue_deg, 180.0),
            ("blur_px", blur_px, 16.0),
            ("noise", noise, 1.0),
        ];
        let (name, value, most) = limits.into_iter().find(|(_, value, most)| !(0.0..=*most).contains(value))?;
        Some(format!("look {name} of {value}; expected 0 to {most}"))
    }
}

/// What one picture gets of the looks.
pub(super) struct Look {
    gamma: f32,
    /// Of red, green and blue, row by row, where they change.
    colours: Option<[[f32; 3]; 3]>,
    blur_px: f32,
    noise: f32,
}

impl Look {
    pub(super) fn draw(looks: &Looks, random: &mut Random) -> Self {
        // What is not asked for draws nothing, so that it changes nothing of what follows.
        let mut draw = |most: f32, signed: bool| {
            if most == 0.0 || random.unit() >= SHARE {
                return 0.0;
            }
            most * if signed { random.signed() } else { random.unit() }
        };
        let gamma = draw(looks.gamma, true).exp();
        let (saturation, hue_deg) = (1.0 + draw(looks.saturation, true), draw(looks.hue_deg, true));
        let colours = (saturation != 1.0 || hue_deg != 0.0).then(|| colours(saturation, hue_deg.to_radians()));
        Self { gamma, colours, blur_px: draw(looks.blur_px, false), noise: draw(looks.noise, false) }
    }

    /// The input value of every byte of red, green and blue under a random light.
    pub(super) fn table(&self, random: &mut Random) -> [[f32; 256]; 3] {
        let contrast = 1.0 + CONTRAST * random.signed();
        let brightness = BRIGHTNESS * random.signed();
        let tint: [f32; 3] = std::array::from_fn(|_| 1.0 + CONTRAST / 2.0 * random.signed());
        let plain = NORMALISATION.table();
        std::array::from_fn(|c| {
            std::array::from_fn(|byte| {
                let fraction = (byte as f32 / 255.0 - 0.5) * contrast * tint[c] + 0.5 + brightness;
                let fraction = fraction.clamp(0.0, 1.0);
                let fraction = if self.gamma == 1.0 { fraction } else { fraction.powf(self.gamma) };
                plain[c][(fraction * 255.0).round() as usize]
            })
        })
    }

    /// Changes a picture of normalised values, `width` pixels a row, in the order in which light meets the camera.
    pub(super) fn apply(&self, values: &mut [f32], width: usize, random: &mut Random) {
        if self.colours.is_none() && self.blur_px == 0.0 && self.noise == 0.0 {
            return;
        }
        let Normalisation { mean, std } = NORMALISATION;
        let pixels = values.as_chunks_mut::<3>().0;
        for pixel in pixels.iter_mut() {
            let fractions: [f32; 3] = std::array::from_fn(|c| pixel[c] * std[c] + mean[c]);
            *pixel = self.colours.map_or(fractions, |rows| rows.map(|row| dot(row, fractions).clamp(0.0, 1.0)));
        }
        if self.blur_px > 0.0 {
            blur(pixels, width, self.blur_px);
        }
        for pixel in pixels {
            *pixel = std::array::from_fn(|c| {
                let noise = if self.noise > 0.0 { self.noise * random.bell() } else { 0.0 };
                ((pixel[c] + noise).clamp(0.0, 1.0) - mean[c]) / std[c]
            });
        }
    }
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The matrix that rotates colours about the axis of greys (Rodrigues) and changes their distance from it.
fn colours(saturation: f32, hue_rad: f32) -> [[f32; 3]; 3] {
    let (sin, cos) = hue_rad.sin_cos();
    let across = saturation * sin / 3.0f32.sqrt();
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let along = (1.0 - saturation * cos) / 3.0;
            match (j + 3 - i) % 3 {
                0 => along + saturation * cos,
                1 => along - across,
                _ => along + across,
            }
        })
    })
}

/// A Gaussian blur; beyond an edge the picture goes on as at the edge.
fn blur(pixels: &mut [[f32; 3]], width: usize, deviation_px: f32) {
    let reach = (REACH * deviation_px).ceil() as usize;
    let weight = |i: usize| (-0.5 * ((i as f32 - reach as f32) / deviation_px).powi(2)).exp();
    let weights: Vec<f32> = (0..=2 * reach).map(weight).collect();
    let sum: f32 = weights.iter().sum();
    let weights: Vec<f32> = weights.iter().map(|weight| weight / sum).collect();
    let height = pixels.len() / width;
    let mixed = |from: &[[f32; 3]], last: usize, at: usize, step: usize, start: usize| {
        let mut mean = [0.0; 3];
        for (i, weight) in weights.iter().enumerate() {
            let pixel = from[start + (at + i).saturating_sub(reach).min(last) * step];
            mean.iter_mut().zip(pixel).for_each(|(mean, value)| *mean += weight * value);
        }
        mean
    };
    let rows = |i: usize| mixed(pixels, width - 1, i % width, 1, i / width * width);
    let across: Vec<[f32; 3]> = (0..pixels.len()).map(rows).collect();
    for (i, pixel) in pixels.iter_mut().enumerate() {
        *pixel = mixed(&across, height - 1, i / width, width, i % width);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 32;

    fn normalised(fraction: impl Fn(usize, usize) -> f32) -> Vec<f32> {
        let value = |i: usize| (fraction(i / 3, i % 3) - NORMALISATION.mean[i % 3]) / NORMALISATION.std[i % 3];
        (0..WIDTH * 16 * 3).map(value).collect()
    }

    fn fractions(values: &[f32]) -> Vec<[f32; 3]> {
        let pixel = |p: &[f32; 3]| std::array::from_fn(|c| p[c] * NORMALISATION.std[c] + NORMALISATION.mean[c]);
        values.as_chunks::<3>().0.iter().map(pixel).collect()
    }

    const PLAIN: Look = Look { gamma: 1.0, colours: None, blur_px: 0.0, noise: 0.0 };

    #[test]
    fn no_looks_draw_nothing_and_change_nothing() {
        let mut random = Random::new(&[3]);
        let look = Look::draw(&Looks::default(), &mut random);
        let mut values = normalised(|i, c| (i + c) as f32 / 600.0);
        let before = values.clone();
        look.apply(&mut values, WIDTH, &mut random);
        assert_eq!((values, random.next_u64()), (before, Random::new(&[3]).next_u64()));
    }

    #[test]
    fn a_blur_keeps_the_mean_and_spreads_a_point_by_its_deviation() {
        let mut values = normalised(|i, _| f32::from(u8::from(i == 8 * WIDTH + 16)));
        Look { blur_px: 1.5, ..PLAIN }.apply(&mut values, WIDTH, &mut Random::new(&[1]));
        let seen = fractions(&values);
        let sum: f32 = seen.iter().map(|p| p[0]).sum();
        let spread: f32 = seen.iter().enumerate().map(|(i, p)| p[0] * ((i % WIDTH) as f32 - 16.0).powi(2)).sum();
        assert!((sum - 1.0).abs() < 1e-3 && (spread - 2.25).abs() < 0.1, "{sum} {spread}");
        let mut flat = normalised(|_, c| 0.2 + 0.1 * c as f32);
        let before = flat.clone();
        Look { blur_px: 4.0, ..PLAIN }.apply(&mut flat, WIDTH, &mut Random::new(&[1]));
        assert!(flat.iter().zip(&before).all(|(a, b)| (a - b).abs() < 1e-4), "edges stay as they are");
    }

    #[test]
    fn noise_has_its_deviation_and_stays_in_the_range() {
        let mut values = normalised(|i, _| if i < 256 { 0.5 } else { 1.0 });
        Look { noise: 0.1, ..PLAIN }.apply(&mut values, WIDTH, &mut Random::new(&[1]));
        let seen = fractions(&values);
        let variance = seen[..256].iter().flatten().map(|v| (v - 0.5).powi(2)).sum::<f32>() / 768.0;
        assert!((variance.sqrt() - 0.1).abs() < 0.01, "{variance}");
        assert!(seen.iter().flatten().all(|v| (-1e-6..=1.0 + 1e-6).contains(v)));
    }

    #[test]
    fn hue_and_saturation_leave_greys_and_turn_colours() {
        let near = |a: [[f32; 3]; 3], v: [f32; 3], b: [f32; 3]| {
            a.iter().zip(b).all(|(row, b)| (dot(*row, v) - b).abs() < 1e-5)
        };
        let third = std::f32::consts::TAU / 3.0;
        assert!(near(colours(0.3, 1.0), [0.4; 3], [0.4; 3]));
        assert!(near(colours(1.0, third), [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), "red turns green");
        assert!(near(colours(0.0, 0.0), [0.9, 0.3, 0.0], [0.4; 3]));
        assert!(near(colours(1.0, 0.0), [0.9, 0.3, 0.1], [0.9, 0.3, 0.1]));
    }

    #[test]
    fn gamma_above_1_darkens_all_but_black_and_white() {
        let [plain, dark] = [1.0, 1.6].map(|gamma| Look { gamma, ..PLAIN }.table(&mut Random::new(&[9])));
        assert!(plain[1][128] > dark[1][128] + 0.3);
        assert!(plain.iter().flatten().zip(dark.iter().flatten()).all(|(plain, dark)| dark <= plain));
    }

    #[test]
    fn half_of_the_pictures_get_a_look_and_all_within_its_limits() {
        let mut random = Random::new(&[2]);
        let drawn: Vec<Look> = (0..400).map(|_| Look::draw(&Looks::WIDE, &mut random)).collect();
        let share = |is: &dyn Fn(&Look) -> bool| drawn.iter().filter(|look| is(look)).count();
        for count in [share(&|l| l.gamma != 1.0), share(&|l| l.blur_px > 0.0), share(&|l| l.noise > 0.0)] {
            assert!((150..250).contains(&count), "{count}");
        }
        assert!(drawn.iter().all(|l| l.blur_px < 1.2 && l.noise < 0.05 && (-0.5..=0.5).contains(&l.gamma.ln())));
        assert!(Looks { noise: f32::NAN, ..Looks::WIDE }.refused().is_some() && Looks::WIDE.refused().is_none());
    }
}
