//! The renderer: one map on one adapter.

use glam::Vec3;
use kernel::map::LightHead;
use kernel::weather::Water;
use kernel::{RoadNetwork, SceneSnapshot};

use crate::actors::{Cast, Moving};
use crate::castings;
use crate::effects::{self, Lenses};
use crate::glows::{self, Glow};
use crate::gpu::{Draws, Gpu, Lighting, Passes, SceneUniform, ShadowDraws, Targets};
use crate::light::Light;
use crate::light_map::LightMap;
use crate::mirrors::{self, Feet, Streak};
use crate::models::{Models, ModelsId};
use crate::quality::longest_side;
use crate::rain;
use crate::scenery::{Scenery, gone, parked_looks};
use crate::shadow_box::ShadowBox;
use crate::shadows::ShadowMaps;
use crate::sieve::{MOVING, Sieve};
use crate::spray::{self, Puff};
use crate::street_lamps::{self, StreetLamp};
use crate::view::View;
use crate::{AdapterChoice, Camera, Frame, Quality, RenderError};

/// Draws one map on one adapter.
pub struct Renderer {
    gpu: Gpu,
    passes: Passes,
    /// Whether triangles that nobody sees are left out before they are drawn: a GPU does so faster.
    sifts: bool,
    /// Whether corners are drawn that are known.
    #[cfg(test)]
    draws_all_corners: bool,
    sieve: Sieve,
    scenery: Scenery,
    heads: Vec<LightHead>,
    light_groups: usize,
    cast: Cast,
    moving: Moving,
    targets: Option<Targets>,
    shadows: ShadowMaps,
    street_lamps: Vec<StreetLamp>,
    light_map: LightMap,
    glows: Vec<Glow>,
    streaks: Vec<Streak>,
    spray: Vec<Puff>,
    lenses: Lenses,
    /// Whose models the scenery is made of.
    models: Option<ModelsId>,
}

/// Street lamps are seen to shine up to this distance, metres.
const STREET_LAMPS_M: f32 = 400.0;

impl Renderer {
    /// Builds the map's static world on an adapter.
    pub fn new(network: &RoadNetwork, adapter: &AdapterChoice) -> Result<Self, RenderError> {
        let gpu = Gpu::open(adapter)?;
        let scenery = Scenery::new(network);
        let turn = gpu.turn();
        let passes = Passes::new(&gpu, &scenery.vertices);
        drop(turn);
        if let Some(reason) = gpu.failure() {
            return Err(RenderError::Device { adapter: gpu.info.name.clone(), reason });
        }
        Ok(Self {
            sifts: gpu.info.is_cpu,
            gpu,
            passes,
            #[cfg(test)]
            draws_all_corners: false,
            sieve: Sieve::default(),
            scenery,
            heads: network.light_heads.clone(),
            light_groups: network.light_groups.len(),
            cast: Cast::new(parked_looks(network)),
            moving: Moving::default(),
            targets: None,
            shadows: ShadowMaps::new(1),
            street_lamps: street_lamps::all(network),
            light_map: LightMap::default(),
            glows: Vec::new(),
            streaks: Vec::new(),
            spray: Vec::new(),
            lenses: Lenses::default(),
            models: None,
        })
    }

    /// The same with so many shadow maps, for drives that take turns at it: with a map for each, none casts its shadows anew
    /// in every picture. Pictures are the same with any number.
    pub fn with_shadow_maps(self, count: usize) -> Self {
        Self { shadows: ShadowMaps::new(count), ..self }
    }

    /// What people are shown on their screens, which no network sees: the best that a GPU draws in time, the cheapest on a CPU.
    pub fn quality_for_people(&self) -> Quality {
        if self.gpu.info.is_cpu { Quality::Plain } else { Quality::Fine }
    }

    /// Draws a snapshot and reads all planes back.
    pub fn draw(&mut self, scene: &SceneSnapshot, camera: &Camera) -> Result<Frame, RenderError> {
        self.take(scene, camera, true)
    }

    /// The same but the colours: [`Frame::rgb`] is empty. On a CPU it takes some half of the time.
    pub fn draw_classes(&mut self, scene: &SceneSnapshot, camera: &Camera) -> Result<Frame, RenderError> {
        self.take(scene, camera, false)
    }

    /// What the camera's sensor makes of what its pinhole sees.
    fn take(&mut self, scene: &SceneSnapshot, camera: &Camera, colours: bool) -> Result<Frame, RenderError> {
        if camera.sensor.is_ideal() {
            return self.planes(scene, camera, colours);
        }
        self.check(scene, camera)?;
        let lens = self.lenses.of(camera)?;
        self.check(scene, lens.pinhole()).map_err(|error| error.through_lens(camera))?;
        let seen = self.planes(scene, lens.pinhole(), colours)?;
        Ok(effects::take(seen, scene, camera, &lens))
    }

    fn planes(&mut self, scene: &SceneSnapshot, camera: &Camera, colours: bool) -> Result<Frame, RenderError> {
        self.check(scene, camera)?;
        self.dress(camera.models)?;
        let view = View::new(camera, &scene.ego);
        let (width, height) = (camera.width, camera.height);
        let corners = view.at_corners(width, height);
        let means = camera.quality.means();
        let takes_corners = colours && means.corners;
        let seen = if takes_corners { corners } else { view };
        let light = Light::new(&scene.weather);
        let horizon = self.scenery.horizon(view.eye);
        let shadow = ShadowBox::ahead_of(view.eye, view.ahead, scene.ego.position, light.sun, means.shadows.reach_m);
        let lamps_shine = colours && light.lamps.is_some();
        let lighting = match (lamps_shine, light.sun_light == Vec3::ZERO) {
            (false, _) => Lighting::Day,
            (true, false) => Lighting::Dusk,
            (true, true) => Lighting::Night,
        };
        let shines = colours && light.sun_light != Vec3::ZERO;
        self.moving.shine = light.lamps.filter(|_| colours).map_or(0.0, |lamps| lamps.shine);
        self.cast.pose(scene, &self.heads, (&seen, horizon), shines.then_some(&shadow), &mut self.moving);
        self.shine(scene, &seen, &light, colours);
        spray::of(scene, &seen, &mut self.spray);
        let samples = [width, height].map(|side| side * means.samples);
        let gone = gone(scene);
        self.sieve.begin(&view, samples, takes_corners, scene, !self.sifts);
        let moving_triangles = core::iter::once((MOVING, &self.moving.indices[..]));
        self.sieve.sift(&self.moving.vertices, 0, moving_triangles);
        self.scenery.sift(&seen, &gone, &mut self.sieve);
        let shadows = if shines { self.cast(&shadow, &gone, means.shadows.side) } else { Default::default() };
        let texel = 1.0 / means.shadows.side as f32;
        let draws = Draws {
            uniforms: [view, corners].map(|view| {
                let uniform = SceneUniform::new(&view, scene, &light).shaded(&shadow, texel);
                uniform.sampled(means.samples).lit(&light, &self.light_map)
            }),
            moving_vertices: &self.moving.vertices,
            seen: self.sieve.seen(),
            shadows,
            shadow_style: means.shadows,
            colours,
            weather: rain::is_drawn(&scene.weather),
            drops: rain::drops(&scene.weather),
            lighting,
            light_map: lamps_shine.then_some(&self.light_map.texels),
            glows: &self.glows,
            streaks: &self.streaks,
            spray: &self.spray,
        };
        let _turn = self.gpu.turn();
        let fits = |t: &Targets| t.is_for(width, height, means);
        let targets = match self.targets.take() {
            Some(targets) if fits(&targets) => targets,
            _ => Targets::new(&self.gpu, width, height, means),
        };
        self.passes.submit(&self.gpu, &draws, &targets);
        let targets = &*self.targets.insert(targets);
        if !takes_corners {
            return targets.read(&self.gpu, scene.tick, colours);
        }
        let (frame, middles) = targets.read_middles(&self.gpu, scene.tick)?;
        #[cfg(test)]
        let middles = if self.draws_all_corners { middles.unknown() } else { middles };
        let seen = self.sieve.seen_by_corners(middles.nearness());
        self.passes.submit_corners(&self.gpu, &draws, (&seen, &middles.known), targets);
        Ok(Frame { rgb: targets.read_corners(&self.gpu, scene.tick, &middles)?, ..frame })
    }

    /// What is to be drawn to a shadow map with so many texels a side.
    fn cast(&mut self, shadow: &ShadowBox, gone: &[usize], side: u32) -> ShadowDraws {
        let (map, lacking) = self.shadows.find(shadow, gone, |car| self.scenery.parked_extent(car));
        let regions = castings::regions(&lacking);
        let casters = self.scenery.casters(&shadow.grid, &regions, gone);
        let still = castings::of_still(shadow, &regions, casters, side);
        let (moving, covered) = castings::of_moving(&self.moving, shadow, side);
        ShadowDraws { map, still, moving, covered }
    }

    /// Takes models of a user's own, or none, for all that is drawn from now on.
    fn dress(&mut self, wanted: Option<ModelsId>) -> Result<(), RenderError> {
        if wanted == self.models {
            return Ok(());
        }
        let missing = |wanted| RenderError::Models { wanted, given: Models::known_ids() };
        let models = wanted.map(|wanted| Models::known(wanted).ok_or_else(|| missing(wanted))).transpose()?;
        self.scenery.dress(models.as_deref());
        self.passes.replace_fixed(&self.gpu, &self.scenery.vertices);
        self.shadows.forget();
        self.cast.dress(models);
        self.models = wanted;
        Ok(())
    }

    /// Makes the map of lamps' light and their glows, where they shine.
    fn shine(&mut self, scene: &SceneSnapshot, view: &View, light: &Light, colours: bool) {
        self.glows.clear();
        self.streaks.clear();
        let Some(lamps) = light.lamps.filter(|_| colours) else { return };
        let near = street_lamps::near(&self.street_lamps, view.eye, STREET_LAMPS_M);
        self.light_map.light(view, scene, &near);
        self.glows.extend_from_slice(&self.moving.glows);
        glows::of_street_lamps(&near, view, lamps.shine, &mut self.glows);
        let wet = Water::of(&scene.weather).wet;
        if wet > 0.0 {
            let feet = Feet::of(scene, &self.heads, &near);
            let seen = (view, self.scenery.horizon(view.eye));
            mirrors::of_glows(&self.glows, &feet, seen, wet, &mut self.streaks);
        }
    }

    fn check(&self, scene: &SceneSnapshot, camera: &Camera) -> Result<(), RenderError> {
        let Camera { width, height, quality, .. } = *camera;
        let limit = longest_side(self.gpu.longest_side(), quality);
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
mod tests;
