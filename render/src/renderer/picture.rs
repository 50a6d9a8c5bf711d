//! What follows from scene and camera alone, before anything is put in its place.

use glam::Vec3;
use kernel::SceneSnapshot;

use crate::gpu::Lighting;
use crate::light::Light;
use crate::quality::Means;
use crate::shadow_box::ShadowBox;
use crate::view::View;
use crate::{Camera, rain};

/// What a picture is to show, and in which light.
pub(super) struct Picture {
    /// As pixels' middles see it, and as their corners do.
    pub(super) views: [View; 2],
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) means: Means,
    /// Whether it has colours, not classes and instances alone.
    pub(super) colours: bool,
    pub(super) light: Light,
    pub(super) shadow: ShadowBox,
    /// Whether there is fog, water or rain, and how many drops.
    pub(super) weather: bool,
    pub(super) drops: u32,
}

impl Picture {
    pub(super) fn new(scene: &SceneSnapshot, camera: &Camera, colours: bool) -> Self {
        let Camera { width, height, quality, .. } = *camera;
        let (view, means, light) = (View::new(camera, &scene.ego), quality.means(), Light::new(&scene.weather));
        let reach_m = means.shadows.reach_m;
        Self {
            views: [view, view.at_corners(width, height)],
            width,
            height,
            means,
            colours,
            light,
            shadow: ShadowBox::ahead_of(view.eye, view.ahead, scene.ego.position, light.sun, reach_m),
            weather: rain::is_drawn(&scene.weather),
            drops: rain::drops(&scene.weather),
        }
    }

    /// Whether the pixels' corners are drawn, too.
    pub(super) fn takes_corners(&self) -> bool {
        self.colours && self.means.corners
    }

    /// All that any of its samples sees.
    pub(super) fn seen(&self) -> &View {
        &self.views[usize::from(self.takes_corners())]
    }

    /// Samples along both axes.
    pub(super) fn samples(&self) -> [u32; 2] {
        [self.width, self.height].map(|side| side * self.means.samples)
    }

    /// Whether lamps are seen to shine.
    pub(super) fn lamps_shine(&self) -> bool {
        self.colours && self.light.lamps.is_some()
    }

    /// Whether the sun is, and things cast shadows.
    pub(super) fn sun_shines(&self) -> bool {
        self.colours && self.light.sun_light != Vec3::ZERO
    }

    pub(super) fn lighting(&self) -> Lighting {
        match (self.lamps_shine(), self.light.sun_light == Vec3::ZERO) {
            (false, _) => Lighting::Day,
            (true, false) => Lighting::Dusk,
            (true, true) => Lighting::Night,
        }
    }
}
