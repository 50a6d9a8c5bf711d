//! The noise of a chip: of the light's quanta (shot noise) and of the electronics (read noise).

use kernel::SceneSnapshot;
use xxhash_rust::xxh3::{xxh3_64, xxh3_64_with_seed};

use super::tone::{Light, colour_of, light_of};
use crate::Camera;

/// The colour at which a sensor's noise is what its setting says.
const MID_GREY: f32 = 127.5;
/// Share of the read noise in the variance there.
const READ_SHARE: f32 = 0.02;
/// The tone curve has no slope at black, which a camera's has: noise is shown no steeper than at this colour.
const STEEPEST: f32 = 24.0;

/// The picture of a light with noise of this deviation, in steps of 8 bits.
pub(super) fn developed(light: &Light, noise: f32, seed: u64) -> Vec<u8> {
    let deviations = deviations(noise);
    let mut rgb = Vec::with_capacity(3 * light.0.len());
    for (at, value) in (0u64..).zip(light.0.iter().flatten()) {
        let colour = colour_of(*value);
        let grain = if noise > 0.0 {
            deviations[(colour as usize).min(255)] * normal(xxh3_64_with_seed(&at.to_le_bytes(), seed))
        } else {
            0.0
        };
        rgb.push((colour + grain + 0.5).clamp(0.0, 255.0) as u8);
    }
    rgb
}

/// What the noise of a picture follows from, beside the pixels' numbers: its tick, the ego car's place, without which all drives
/// had the same, and the camera's, without which all cameras of a car had.
pub(super) fn seed(scene: &SceneSnapshot, camera: &Camera) -> u64 {
    let numbers = scene.ego.position.to_array().into_iter().chain(camera.position.to_array());
    let places: Vec<u8> = numbers.chain(camera.rotation.to_array()).flat_map(f32::to_le_bytes).collect();
    xxh3_64(&[&scene.tick.to_le_bytes()[..], &places].concat())
}

/// The deviation for each colour, in steps of 8 bits. Shot noise has a variance that is proportional to the light, and
/// read noise the same one everywhere.
fn deviations(noise: f32) -> [f32; 256] {
    let mid = light_of(MID_GREY);
    core::array::from_fn(|colour| {
        let light = light_of(colour as f32);
        let variance = (1.0 - READ_SHARE) * light / mid + READ_SHARE;
        noise * variance.sqrt() * slope(colour as f32) / slope(MID_GREY)
    })
}

/// Steps of colour for a light that is greater by 1.
fn slope(colour: f32) -> f32 {
    let light = light_of(colour.max(STEEPEST));
    let small = 1e-3 * light;
    (colour_of(light + small) - colour_of(light - small)) / (2.0 * small)
}

/// Mean 0, deviation 1, and nearly normal: the sum of four even numbers.
fn normal(bits: u64) -> f32 {
    let sum = (0..4).map(|part| (bits >> (16 * part)) as u16).map(u32::from).sum::<u32>();
    // Each has a mean of 32767.5 and a variance of (65536^2 - 1) / 12.
    (sum as f32 - 131_070.0) / 37_837.23
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use kernel::scene::{EgoScene, Weather};

    use super::*;

    fn grey(colour: f32) -> Light {
        Light(vec![[light_of(colour); 3]; 40_000])
    }

    fn mean_and_deviation(rgb: &[u8]) -> (f64, f64) {
        let count = rgb.len() as f64;
        let mean = rgb.iter().map(|byte| f64::from(*byte)).sum::<f64>() / count;
        let variance = rgb.iter().map(|byte| (f64::from(*byte) - mean).powi(2)).sum::<f64>() / count;
        (mean, variance.sqrt())
    }

    #[test]
    fn noise_has_the_mean_and_the_deviation_that_are_promised() {
        for noise in [1.0, 4.0, 16.0] {
            let (mean, deviation) = mean_and_deviation(&developed(&grey(MID_GREY), noise, 7));
            assert!((mean - 127.5).abs() < 0.06 * f64::from(noise).max(1.0), "{noise}: {mean}");
            // Rounding adds a variance of 1/12.
            let expected = (f64::from(noise).powi(2) + 1.0 / 12.0).sqrt();
            assert!((deviation / expected - 1.0).abs() < 0.02, "{noise}: {deviation}");
        }
    }

    #[test]
    fn shadows_are_noisier_than_highlights() {
        let of = |colour: f32| mean_and_deviation(&developed(&grey(colour), 4.0, 7)).1;
        let [dark, mid, bright] = [30.0, 127.5, 220.0].map(of);
        assert!(dark > mid && mid > bright && bright > 1.0 && dark < 10.0, "{dark} {mid} {bright}");
    }

    #[test]
    fn noise_depends_on_its_seed_alone() {
        let of = |seed: u64| developed(&grey(100.0), 4.0, seed);
        assert_eq!(of(1), of(1));
        let (one, other) = (of(1), of(2));
        let same = one.iter().zip(&other).filter(|(a, b)| a == b).count();
        assert!(same < one.len() / 8, "{same} of {}", one.len());
        let correlation: f64 =
            one.iter().zip(&other).map(|(a, b)| (f64::from(*a) - 100.0) * (f64::from(*b) - 100.0)).sum();
        assert!((correlation / one.len() as f64).abs() < 0.5, "{correlation}");
    }

    #[test]
    fn each_tick_and_each_camera_has_noise_of_its_own() {
        let ego =
            EgoScene { position: Vec3::ONE, rotation: Quat::IDENTITY, speed_mps: 0.0, wheel_angle_rad: 0.0, lamps: 0 };
        let scene = |tick| SceneSnapshot {
            tick,
            ego,
            actors: Vec::new(),
            lights: Vec::new(),
            weather: Weather::dry(0.0, 0.0, 40.0, 0.0),
        };
        let driver = Camera::driver(64, 32);
        let turned = Camera { rotation: Quat::from_rotation_z(1.0), ..driver };
        let seeds = [seed(&scene(1), &driver), seed(&scene(2), &driver), seed(&scene(1), &turned)];
        assert_eq!(seeds[0], seed(&scene(1), &driver));
        assert!(seeds[0] != seeds[1] && seeds[0] != seeds[2] && seeds[1] != seeds[2]);
    }

    #[test]
    fn without_noise_colours_come_back() {
        let rgb: Vec<u8> = (0..=255).flat_map(|byte| [byte; 3]).collect();
        assert_eq!(developed(&Light::of(&rgb), 0.0, 7), rgb);
    }
}
