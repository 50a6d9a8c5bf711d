//! Radial distortion: which place of a pinhole camera's picture each pixel shows.

use std::sync::Arc;

use kernel::ops;

use super::tone::Light;
use crate::{Camera, Frame, Sensor};

/// The least slope of a lens's distortion that is drawn: beyond, a pixel of the edge shows more than five of the middle, and a
/// little further the picture folds.
const LEAST_SLOPE: f32 = 0.15;
/// How far from the middle is drawn at most, focal lengths: 72 degrees.
const FARTHEST: f32 = 3.0;
/// Steps of the inverse of a distortion.
const STEPS: usize = 1024;

/// A camera's lens, and the pinhole camera that sees what it sees.
pub(crate) struct Lens {
    pinhole: Camera,
    bend: Option<Arc<Bend>>,
}

/// All that a [`Bend`] follows from.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Glass {
    size: [u32; 2],
    fov_x_rad: f32,
    distortion: [f32; 2],
}

/// Where the pixels of a picture are in that of the pinhole camera.
pub(super) struct Bend {
    glass: Glass,
    /// Width and height of the pinhole camera's picture, pixels.
    drawn: [u32; 2],
    drawn_fov_x_rad: f32,
    /// Row by row; the middle of the first pixel is at (0.5, 0.5).
    places_px: Vec<[f32; 2]>,
}

impl Glass {
    /// That of a camera; none of one that bends nothing.
    pub(super) fn of(camera: &Camera) -> Option<Self> {
        let Camera { width, height, fov_x_rad, sensor, .. } = camera;
        let size = [*width, *height];
        sensor.distorts().then(|| Self { size, fov_x_rad: *fov_x_rad, distortion: sensor.distortion() })
    }

    fn tan(&self) -> f32 {
        ops::tan(0.5 * self.fov_x_rad)
    }

    /// Of its pixels, focal lengths.
    fn pitch(&self) -> f32 {
        2.0 * self.tan() / self.size[0] as f32
    }

    /// None where the picture folds, or no pinhole camera sees so far.
    fn inverse(&self) -> Option<Inverse> {
        let [width, height] = self.size.map(|side| 0.5 * side as f32);
        Inverse::new(self.distortion, ops::hypot(width, height) * self.pitch())
    }

    /// Whether a pinhole camera can see its picture.
    pub(super) fn is_seen(&self) -> bool {
        self.inverse().is_some()
    }
}

impl Bend {
    /// That of a lens whose picture a pinhole camera can see.
    pub(super) fn of(glass: Glass) -> Option<Self> {
        let inverse = glass.inverse()?;
        let (size, tan, pitch) = (glass.size, glass.tan(), glass.pitch());
        let half = size.map(|side| 0.5 * side as f32);
        let aside = |at: u32, axis: usize| (at as f32 + 0.5 - half[axis]) * pitch;
        // Relative to the middle.
        let pixel = |x: u32, y: u32| {
            let [right, down] = [aside(x, 0), aside(y, 1)];
            let share = inverse.share(ops::sqrt(right * right + down * down)) / pitch;
            [right * share, down * share]
        };
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        let mut places_px: Vec<[f32; 2]> = pixels.map(|(x, y)| pixel(x, y)).collect();
        let reach = places_px.iter().fold([0.0f32; 2], |far, at| [0, 1].map(|axis| far[axis].max(at[axis].abs())));
        // Half a pixel more for what lies between pixels. As many on both sides, so that the middle stays where it is.
        let more = [0, 1].map(|axis| ops::floor(reach[axis] + 1.5 - half[axis]) as i32);
        let drawn = [0, 1].map(|axis| (size[axis] as i32 + 2 * more[axis]).max(2) as u32);
        for place in &mut places_px {
            *place = [place[0] + 0.5 * drawn[0] as f32, place[1] + 0.5 * drawn[1] as f32];
        }
        let drawn_fov_x_rad = 2.0 * ops::atan2(tan * (drawn[0] as f32 / size[0] as f32), 1.0);
        Some(Self { glass, drawn, drawn_fov_x_rad, places_px })
    }

    /// Whether it is that of this lens.
    pub(super) fn is_of(&self, glass: &Glass) -> bool {
        self.glass == *glass
    }

    /// Pixels of the pictures.
    pub(super) fn pixels(&self) -> usize {
        self.places_px.len()
    }
}

impl Lens {
    /// That of a camera, which bends its picture so, or not at all.
    pub(super) fn new(camera: &Camera, bend: Option<Arc<Bend>>) -> Self {
        let mut pinhole = Camera { sensor: Sensor::default(), ..*camera };
        if let Some(bend) = &bend {
            ([pinhole.width, pinhole.height], pinhole.fov_x_rad) = (bend.drawn, bend.drawn_fov_x_rad);
        }
        Self { pinhole, bend }
    }

    /// The camera that sees all of it.
    pub(crate) fn pinhole(&self) -> &Camera {
        &self.pinhole
    }

    /// Whether both bend alike, by what was found once.
    #[cfg(test)]
    pub(super) fn is_the_glass_of(&self, other: &Self) -> bool {
        matches!((&self.bend, &other.bend), (Some(one), Some(other)) if Arc::ptr_eq(one, other))
    }

    /// Classes, instances and depth of the pixel of the pinhole camera's picture that each pixel's middle shows.
    pub(super) fn labels(&self, seen: Frame) -> Frame {
        let Some(bend) = &self.bend else { return seen };
        let [last_x, last_y] = [seen.width - 1, seen.height - 1];
        let index = |[x, y]: &[f32; 2]| ((*y as u32).min(last_y) * seen.width + (*x as u32).min(last_x)) as usize;
        let places: Vec<usize> = bend.places_px.iter().map(index).collect();
        let [width, height] = bend.glass.size;
        Frame {
            tick: seen.tick,
            width,
            height,
            rgb: seen.rgb,
            class_ids: places.iter().map(|at| seen.class_ids[*at]).collect(),
            fine_ids: places.iter().map(|at| seen.fine_ids[*at]).collect(),
            instance_ids: places.iter().map(|at| seen.instance_ids[*at]).collect(),
            depth_m: places.iter().map(|at| seen.depth_m[*at]).collect(),
        }
    }

    /// The light that falls on each pixel: of four pixels of the pinhole camera, by how near they are.
    pub(super) fn bent(&self, light: Light) -> Light {
        let Some(bend) = &self.bend else { return light };
        let [width, height] = [self.pinhole.width as usize, self.pinhole.height as usize];
        let along = |at: f32, side: usize| {
            let at = (at - 0.5).clamp(0.0, (side - 1) as f32);
            let first = (at as usize).min(side - 2);
            (first, at - first as f32)
        };
        let mixed = |[x, y]: &[f32; 2]| {
            let ((x, right), (y, down)) = (along(*x, width), along(*y, height));
            let rows = [y, y + 1].map(|y| {
                let [left, next] = [light.0[y * width + x], light.0[y * width + x + 1]];
                core::array::from_fn::<f32, 3, _>(|i| left[i] + right * (next[i] - left[i]))
            });
            core::array::from_fn(|i| rows[0][i] + down * (rows[1][i] - rows[0][i]))
        };
        Light(bend.places_px.iter().map(mixed).collect())
    }
}

/// Where a point is seen that is at the distance `r` from the middle, focal lengths, and how that grows with `r`.
fn distorted([k1, k2]: [f32; 2], r: f32) -> (f32, f32) {
    let r2 = r * r;
    (r * (1.0 + r2 * (k1 + r2 * k2)), 1.0 + r2 * (3.0 * k1 + r2 * 5.0 * k2))
}

/// From the distance at which a point is seen to that at which it is.
struct Inverse {
    steps_per_unit: f32,
    /// The one as a multiple of the other, at even steps of the one.
    shares: Vec<f32>,
}

impl Inverse {
    /// For distances up to that of a corner; none for what folds before it.
    fn new(k: [f32; 2], corner: f32) -> Option<Self> {
        let step = corner / STEPS as f32;
        let mut r = 0.0;
        let mut shares = vec![1.0];
        // One step more than to the corner, to look up the corner itself.
        for number in 1..=STEPS + 1 {
            let seen = step * number as f32;
            // Newton's method from the step before.
            for _ in 0..8 {
                let (at, slope) = distorted(k, r);
                if slope < LEAST_SLOPE {
                    return None;
                }
                r += (seen - at) / slope;
            }
            let (at, slope) = distorted(k, r);
            if r > FARTHEST || slope < LEAST_SLOPE || (at - seen).abs() > 1e-3 * step {
                return None;
            }
            shares.push(r / seen);
        }
        Some(Self { steps_per_unit: 1.0 / step, shares })
    }

    fn share(&self, seen: f32) -> f32 {
        let at = seen * self.steps_per_unit;
        let first = (at as usize).min(STEPS);
        let [one, next] = [self.shares[first], self.shares[first + 1]];
        one + (at - first as f32) * (next - one)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_bent_comes_back() {
        for k in [[-0.1, 0.0], [-0.3, 0.1], [0.2, 0.0], [0.5, -0.05], [0.0, 0.3], [1e-4, 0.0]] {
            let inverse = Inverse::new(k, 1.118).expect("does not fold");
            for step in 1..=100 {
                let seen = 0.01118 * step as f32;
                let there = distorted(k, seen * inverse.share(seen)).0;
                assert!((there - seen).abs() < 1e-5, "{k:?}: {seen} {there}");
            }
        }
    }

    #[test]
    fn what_folds_is_refused() {
        let folds = |k: [f32; 2]| Inverse::new(k, 1.118).is_none();
        assert!(folds([-0.3, 0.0]) && folds([-1.0, 0.0]) && folds([-1.0, -1.0]) && folds([0.5, -1.0]));
        assert!(!folds([-0.11, 0.0]) && !folds([1.0, 1.0]) && !folds([-0.35, 0.12]));
    }

    #[test]
    fn the_pinhole_camera_sees_all_that_the_lens_shows() {
        for (text, size) in
            [("k1=-0.1", [256, 128]), ("k1=-0.3,k2=0.1", [211, 133]), ("k1=0.3", [256, 128]), ("k1=1,k2=1", [8, 8])]
        {
            let sensor = text.parse().expect("a sensor");
            let camera = Camera { sensor, ..Camera::driver(size[0], size[1]) };
            let bend = Arc::new(Bend::of(Glass::of(&camera).expect("bends")).expect("does not fold"));
            let lens = Lens::new(&camera, Some(bend.clone()));
            let pinhole = lens.pinhole();
            let [width, height] = [pinhole.width as f32, pinhole.height as f32];
            let inside = |[x, y]: &[f32; 2]| (0.5..=width - 0.5).contains(x) && (0.5..=height - 0.5).contains(y);
            assert!(bend.places_px.iter().all(inside), "{text}");
            assert!(
                (width, height) == (size[0] as f32, size[1] as f32) || (width > size[0] as f32) == text.contains('-')
            );
            let focal = |camera: &Camera| camera.intrinsics()[0];
            assert!((focal(pinhole) / focal(&camera) - 1.0).abs() < 1e-5, "{text}");
        }
    }
}
