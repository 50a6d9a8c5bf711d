//! The renderer: one map on one adapter.

mod picture;

use std::sync::Arc;

use kernel::map::LightHead;
use kernel::weather::Water;
use kernel::{RoadNetwork, SceneSnapshot};

use crate::actors::{Cast, Moving};
use crate::castings;
use crate::effects::{self, Lenses};
use crate::glows::{self, Glow};
use crate::gpu::{Draws, Gpu, Passes, SceneUniform, ShadowDraws, Targets};
use crate::horizon::Horizon;
use crate::light_map::LightMap;
use crate::mirrors::{self, Feet, Streak};
use crate::models::{Models, ModelsId};
use crate::quality::longest_side;
use crate::scenery::{Scenery, gone, parked_looks};
use crate::shadow_box::ShadowBox;
use crate::shadows::ShadowMaps;
use crate::sieve::{MOVING, Sieve};
use crate::spray::{self, Puff};
use crate::street_lamps::{self, StreetLamp};
use crate::{AdapterChoice, Camera, Frame, Quality, RenderError};

use picture::Picture;

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
            street_lamps: street_lamps::all(&network.props, None),
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

    /// Draws what a pinhole sees. What went wrong with one picture is no matter of the next: targets that were not read back cannot
    /// be drawn to, and tiles of shadow maps that were to be drawn may not have been.
    fn planes(&mut self, scene: &SceneSnapshot, camera: &Camera, colours: bool) -> Result<Frame, RenderError> {
        self.check(scene, camera)?;
        self.dress(camera.models)?;
        let picture = Picture::new(scene, camera, colours);
        let shadows = self.stage(scene, &picture);
        let frame = self.paint(scene, &picture, shadows);
        if frame.is_err() {
            self.targets = None;
            self.shadows.forget();
        }
        frame
    }

    /// Puts all in its place that is to be drawn; gives what is lacking on the shadow map.
    fn stage(&mut self, scene: &SceneSnapshot, picture: &Picture) -> ShadowDraws {
        let (seen, gone) = (picture.seen(), gone(scene));
        let horizon = self.scenery.horizon(seen.eye);
        let shadow = picture.sun_shines().then_some(&picture.shadow);
        self.moving.shine = picture.light.lamps.filter(|_| picture.colours).map_or(0.0, |lamps| lamps.shine);
        self.cast.pose(scene, &self.heads, (seen, horizon.clone()), shadow, &mut self.moving);
        self.shine(scene, picture, &horizon);
        self.spray.clear();
        if picture.colours {
            spray::of(scene, seen, &mut self.spray);
        }
        self.sieve.begin(&picture.views[0], picture.samples(), picture.takes_corners(), scene, !self.sifts);
        let moving_triangles = core::iter::once((MOVING, &self.moving.indices[..]));
        self.sieve.sift(&self.moving.vertices, 0, moving_triangles);
        self.scenery.sift((seen, horizon), &gone, &mut self.sieve);
        shadow.map_or_else(Default::default, |shadow| self.cast(shadow, &gone, picture.means.shadows.side))
    }

    /// Draws what is in its place and reads it back.
    fn paint(&mut self, scene: &SceneSnapshot, picture: &Picture, shadows: ShadowDraws) -> Result<Frame, RenderError> {
        let Picture { width, height, means, colours, ref light, .. } = *picture;
        let texel = 1.0 / means.shadows.side as f32;
        let draws = Draws {
            uniforms: picture.views.map(|view| {
                let uniform = SceneUniform::new(&view, scene, light).shaded(&picture.shadow, texel);
                uniform.sampled(means.samples).lit(light, &self.light_map)
            }),
            moving_vertices: &self.moving.vertices,
            seen: self.sieve.seen(),
            shadows,
            shadow_style: means.shadows,
            colours,
            weather: picture.weather,
            drops: picture.drops,
            lighting: picture.lighting(),
            light_map: picture.lamps_shine().then_some(&self.light_map.texels),
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
        if !picture.takes_corners() {
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
        let dressed = self.wear(models);
        if dressed.is_err() {
            // What there was before is no longer on the adapter; without any it is as it began.
            self.wear(None)?;
        }
        dressed
    }

    /// Puts the scenery up anew, and on the adapter.
    fn wear(&mut self, models: Option<Arc<Models>>) -> Result<(), RenderError> {
        self.scenery.dress(models.as_deref());
        self.street_lamps = street_lamps::all(self.scenery.objects(), models.as_deref());
        let turn = self.gpu.turn();
        self.passes.replace_fixed(&self.gpu, &self.scenery.vertices);
        drop(turn);
        self.shadows.forget();
        self.models = models.as_deref().map(Models::id);
        self.cast.dress(models);
        let adapter = || self.gpu.info.name.clone();
        self.gpu.failure().map_or(Ok(()), |reason| Err(RenderError::Scenery { adapter: adapter(), reason }))
    }

    /// Makes the map of lamps' light and their glows, where they shine.
    fn shine(&mut self, scene: &SceneSnapshot, picture: &Picture, horizon: &Horizon) {
        self.glows.clear();
        self.streaks.clear();
        let Some(lamps) = picture.light.lamps.filter(|_| picture.colours) else { return };
        let view = picture.seen();
        let near = street_lamps::near(&self.street_lamps, view.eye, STREET_LAMPS_M);
        self.light_map.light(view, scene, &near);
        self.glows.extend_from_slice(&self.moving.glows);
        glows::of_street_lamps(&near, view, lamps.shine, &mut self.glows);
        let wet = Water::of(&scene.weather).wet;
        if wet > 0.0 {
            let feet = Feet::of(scene, &self.heads, &near);
            mirrors::of_glows(&self.glows, &feet, (view, horizon.clone()), wet, &mut self.streaks);
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
