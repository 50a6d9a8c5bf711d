//! Lenses that are kept from picture to picture: finding where a lens shows each pixel takes as long as bending the picture.

use std::sync::Arc;

use super::lens::{Bend, Glass, Lens};
use crate::{Camera, RenderError};

/// Pixels of all that are kept together: cameras that take turns keep theirs, as far as these reach (8 bytes each).
const KEPT_PX: usize = 1 << 23;

/// What is known of lenses. It follows from what each was asked for alone.
#[derive(Default)]
pub(crate) struct Lenses {
    /// The one that was used last at the end.
    kept: Vec<Arc<Bend>>,
}

impl Lenses {
    /// That of a camera; one whose picture a pinhole camera cannot see is refused.
    pub(crate) fn of(&mut self, camera: &Camera) -> Result<Lens, RenderError> {
        let Some(glass) = Glass::of(camera) else { return Ok(Lens::new(camera, None)) };
        let bend = match self.kept.iter().position(|bend| bend.is_of(&glass)) {
            Some(at) => self.kept.remove(at),
            None => {
                let bend = Bend::of(glass).ok_or(RenderError::Distortion { sensor: camera.sensor })?;
                self.make_room(bend.pixels());
                Arc::new(bend)
            }
        };
        self.kept.push(bend.clone());
        Ok(Lens::new(camera, Some(bend)))
    }

    /// Forgets those that were used longest ago, so that there is room for so many pixels.
    fn make_room(&mut self, more_px: usize) {
        let mut pixels = more_px + self.kept.iter().map(|bend| bend.pixels()).sum::<usize>();
        while pixels > KEPT_PX && !self.kept.is_empty() {
            pixels -= self.kept.remove(0).pixels();
        }
    }
}

/// Refuses a camera's lens through which no picture can be taken, before anything is drawn.
pub fn check_lens(camera: &Camera) -> Result<(), RenderError> {
    let is_seen = Glass::of(camera).is_none_or(|glass| glass.is_seen());
    if is_seen { Ok(()) } else { Err(RenderError::Distortion { sensor: camera.sensor }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(width: u32, sensor: &str) -> Camera {
        Camera { sensor: sensor.parse().expect("a sensor"), ..Camera::driver(width, width / 2) }
    }

    #[test]
    fn a_lens_is_kept_by_what_it_depends_on_alone() {
        let mut lenses = Lenses::default();
        let one = camera(64, "k1=-0.1");
        let [first, wide] = [one, camera(128, "k1=-0.1")].map(|camera| lenses.of(&camera).expect("does not fold"));
        // Who has another place, exposure and quality has the same lens.
        let other = Camera { position: glam::Vec3::X, ..camera(64, "k1=-0.1,noise=4") };
        let again = lenses.of(&other).expect("does not fold");
        assert!(again.is_the_glass_of(&first) && !wide.is_the_glass_of(&first));
        assert_eq!((again.pinhole().position, again.pinhole().width), (other.position, first.pinhole().width));
        let others = [camera(64, "k1=-0.1,k2=0.01"), Camera { fov_x_rad: 1.2, ..one }, camera(66, "k1=-0.1")];
        for other in others {
            assert!(!lenses.of(&other).expect("does not fold").is_the_glass_of(&first));
        }
        assert_eq!(lenses.kept.len(), 5);
        assert!(
            check_lens(&camera(64, "k1=-0.5")).is_err()
                && check_lens(&one).is_ok()
                && check_lens(&camera(64, "noise=4")).is_ok()
        );
        assert!(lenses.of(&camera(64, "k1=-0.5")).is_err() && lenses.of(&camera(64, "noise=4")).is_ok());
        assert_eq!(lenses.kept.len(), 5);
    }

    #[test]
    fn lenses_of_large_pictures_are_not_kept_without_end() {
        let mut lenses = Lenses::default();
        for width in (1024..1034).step_by(2).chain([4096]) {
            lenses.of(&camera(width, "k1=0.1")).expect("does not fold");
        }
        let pixels = lenses.kept.iter().map(|bend| bend.pixels()).sum::<usize>();
        assert_eq!((pixels, lenses.kept.len()), (4096 * 2048, 1));
    }
}
