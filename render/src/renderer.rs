//! The renderer: one map on one adapter.

use kernel::map::LightHead;
use kernel::{RoadNetwork, SceneSnapshot};

use crate::actors::{Cast, Moving};
use crate::blob::{self, BlobVertex};
use crate::gpu::{Draws, Gpu, Passes, SceneUniform, Targets};
use crate::light::{Light, ShadowBox};
use crate::rain;
use crate::scenery::{Scenery, gone, parked_looks};
use crate::shadows::ShadowMaps;
use crate::sieve::Sieve;
use crate::view::View;
use crate::{AdapterChoice, Camera, Frame, RenderError};

/// How much to draw. Classes, instances and depth are the same in both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Preset {
    /// [`Preset::Cheap`] on CPU adapters, [`Preset::Full`] on GPUs.
    #[default]
    Auto,
    /// Shadow of the static world, blobs under moving things, one sample a pixel.
    Cheap,
    /// Shadow of everything, nine colour samples a pixel.
    Full,
}

/// How to draw.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RenderOptions {
    /// With what.
    pub adapter: AdapterChoice,
    /// How much.
    pub preset: Preset,
}

/// What a preset stands for.
#[derive(Clone, Copy)]
struct Quality {
    /// Samples a pixel along each axis; odd, so that one lies in the pixel's middle.
    samples: u32,
    shadow_side: u32,
    shadow_taps: u32,
    shadow_reach_m: f32,
    moving_shadows: bool,
}

const CHEAP: Quality =
    Quality { samples: 1, shadow_side: 1024, shadow_taps: 1, shadow_reach_m: 64.0, moving_shadows: false };
const FULL: Quality =
    Quality { samples: 3, shadow_side: 4096, shadow_taps: 3, shadow_reach_m: 128.0, moving_shadows: true };

/// Draws one map on one adapter.
pub struct Renderer {
    gpu: Gpu,
    passes: Passes,
    quality: Quality,
    /// Whether triangles that nobody sees are left out before they are drawn: a GPU does so faster.
    sifts: bool,
    scenery: Scenery,
    heads: Vec<LightHead>,
    light_groups: usize,
    cast: Cast,
    moving: Moving,
    blobs: Vec<BlobVertex>,
    targets: Option<Targets>,
    shadows: ShadowMaps,
}

impl Renderer {
    /// Builds the map's static world on an adapter.
    pub fn new(network: &RoadNetwork, options: &RenderOptions) -> Result<Self, RenderError> {
        let gpu = Gpu::open(&options.adapter)?;
        let full = options.preset == Preset::Full || options.preset == Preset::Auto && !gpu.info.is_cpu;
        let quality = if full { FULL } else { CHEAP };
        let scenery = Scenery::new(network);
        let Quality { shadow_side, shadow_taps, .. } = quality;
        let passes = Passes::new(&gpu, &scenery.vertices, shadow_side, shadow_taps);
        if let Some(reason) = gpu.failure() {
            return Err(RenderError::Device { adapter: gpu.info.name.clone(), reason });
        }
        Ok(Self {
            // Shadows also come from what the picture does not show.
            sifts: gpu.info.is_cpu && !quality.moving_shadows,
            gpu,
            passes,
            quality,
            scenery,
            heads: network.light_heads.clone(),
            light_groups: network.light_groups.len(),
            cast: Cast::new(parked_looks(network)),
            moving: Moving::default(),
            blobs: Vec::new(),
            targets: None,
            shadows: ShadowMaps::new(1),
        })
    }

    /// The same with so many shadow maps, for drives that take turns at it: with a map for each, none casts its shadows anew
    /// in every picture. Pictures are the same with any number.
    pub fn with_shadow_maps(self, count: usize) -> Self {
        // Shadows of what moves are cast in every picture.
        let count = if self.quality.moving_shadows { 1 } else { count };
        Self { shadows: ShadowMaps::new(count), ..self }
    }

    /// Draws a snapshot and reads all planes back.
    pub fn draw(&mut self, scene: &SceneSnapshot, camera: &Camera) -> Result<Frame, RenderError> {
        self.planes(scene, camera, true)
    }

    /// The same but the colours: [`Frame::rgb`] is empty. On a CPU it takes some half of the time.
    pub fn draw_classes(&mut self, scene: &SceneSnapshot, camera: &Camera) -> Result<Frame, RenderError> {
        let frame = self.planes(scene, camera, false)?;
        Ok(Frame { rgb: Vec::new(), ..frame })
    }

    fn planes(&mut self, scene: &SceneSnapshot, camera: &Camera, colours: bool) -> Result<Frame, RenderError> {
        self.check(scene, camera)?;
        let view = View::new(camera, &scene.ego);
        let light = Light::new(&scene.weather);
        let horizon = self.scenery.horizon(view.eye);
        self.cast.pose(scene, &self.heads, &view, horizon, &mut self.moving);
        self.blobs.clear();
        if colours && !self.quality.moving_shadows {
            for (frame, size) in &self.moving.shadows {
                blob::append(&mut self.blobs, frame, *size, light.sun);
            }
        }
        let samples = [camera.width, camera.height].map(|side| side * self.quality.samples);
        let sieve = Sieve::new(&view, samples, scene);
        let mut sieve = if self.sifts { sieve } else { sieve.open() };
        let shadow = ShadowBox::ahead_of(view.eye, view.ahead, light.sun, self.quality.shadow_reach_m);
        let gone = gone(scene);
        let (shadow_map, is_cast) = if colours { self.shadows.find(shadow, gone.clone()) } else { (0, true) };
        let stale = colours && (self.quality.moving_shadows || !is_cast);
        let texel = 1.0 / self.quality.shadow_side as f32;
        let draws = Draws {
            uniform: SceneUniform::new(&view, scene, &light, shadow.matrix(), texel),
            moving_vertices: &self.moving.vertices,
            moving_indices: &sieve.sifted(&self.moving.vertices, &self.moving.indices),
            fixed_indices: self.scenery.visible(&view, &gone, &mut sieve),
            casters: stale.then(|| self.scenery.near_line(shadow.centre, light.sun, 1.42 * shadow.reach_m, &gone)),
            moving_casts: self.quality.moving_shadows,
            shadow_map,
            blobs: &self.blobs,
            colours,
            weather: rain::is_drawn(&scene.weather),
            drops: rain::drops(&scene.weather),
        };
        let (width, height) = (camera.width, camera.height);
        let fits = |t: &Targets| t.width == width && t.height == height;
        let targets = match self.targets.take() {
            Some(targets) if fits(&targets) => targets,
            _ => Targets::new(&self.gpu, width, height, self.quality.samples),
        };
        self.passes.submit(&self.gpu, &draws, &targets);
        self.targets.insert(targets).read(&self.gpu, scene.tick)
    }

    fn check(&self, scene: &SceneSnapshot, camera: &Camera) -> Result<(), RenderError> {
        let limit = self.gpu.longest_side() / self.quality.samples;
        let Camera { width, height, .. } = *camera;
        if width == 0 || height == 0 || width.max(height) > limit {
            return Err(RenderError::ImageSize { width, height, limit });
        }
        if scene.lights.len() != self.light_groups {
            return Err(RenderError::OtherMap { expected: self.light_groups, got: scene.lights.len() });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use glam::Quat;
    use kernel::scene::EgoScene;
    use kernel::{Scenario, World, map};

    use super::*;

    /// From places all over a map, in a storm that bends trees.
    #[test]
    fn what_is_left_out_before_it_is_drawn_is_in_no_picture() {
        for name in ["old_town", "rural"] {
            let network = map::bundled(name).expect("it is bundled");
            let world = World::new(&Scenario::default_for(name, 7), &network).expect("it fits");
            let cheap = RenderOptions { preset: Preset::Cheap, ..Default::default() };
            let mut renderer = Renderer::new(&network, &cheap).expect("an adapter");
            let step = network.lanes.len() / 8;
            for (i, lane) in (0..network.lanes.len()).step_by(step).enumerate() {
                let mut scene = world.scene();
                scene.weather.wind_pct = 90.0;
                let point = network.lane_point(lane as u32, 0.3 * network.lanes[lane].length_m);
                let rotation = Quat::from_rotation_z(point.heading_rad + 0.1 * i as f32);
                scene.ego = EgoScene { position: point.position, rotation, ..scene.ego };
                let camera = if i % 2 == 0 { Camera::driver(256, 128) } else { Camera::chase(211, 133) };
                let mut draw = |sifts: bool| {
                    renderer.sifts = sifts;
                    renderer.draw(&scene, &camera).expect("drawn")
                };
                assert!(draw(true) == draw(false), "{name}, lane {lane}");
            }
        }
    }
}
