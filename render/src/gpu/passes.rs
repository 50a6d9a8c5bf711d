//! The commands of a frame.

use std::collections::BTreeMap;
use std::ops::Range;

use super::attachments::{colour_attachment, depth_attachment};
use super::pipelines::{self, Layouts, Pipelines};
use super::shadow_passes::{CasterRanges, Casters, ShadowDraws, ShadowMap, ShadowPasses};
use super::targets::Samples;
use super::{Gpu, GrowingBuffer, Lighting, SceneUniform, Targets, readback, textures};
use crate::SemanticTag;
use crate::castings::Casting;
use crate::glows::Glow;
use crate::mesh::{FINISHES, Finish, Vertex};
use crate::mirrors::Streak;
use crate::quality::Shadows;
use crate::sieve::{LISTS, Lists, MOVING};
use crate::spray::Puff;

/// Nearest and most covering first: hidden fragments are cheap. Last what writes its depth late, as it discards.
const DRAW_ORDER: [Finish; FINISHES] =
    [Finish::Facade, Finish::Plain, Finish::Asphalt, Finish::Paving, Finish::Grainy, Finish::Grass, Finish::Leafy];

/// What a frame draws.
pub(crate) struct Draws<'a> {
    /// As pixels' middles see it, and as their corners do.
    pub(crate) uniforms: [SceneUniform; 2],
    pub(crate) moving_vertices: &'a [Vertex],
    /// Indices of what pixels' middles see.
    pub(crate) seen: Lists,
    pub(crate) shadows: ShadowDraws,
    pub(crate) shadow_style: Shadows,
    /// Whether colours are to be drawn, not classes and instances alone.
    pub(crate) colours: bool,
    /// Whether fog, water or rain is to be drawn.
    pub(crate) weather: bool,
    /// Drops of rain.
    pub(crate) drops: u32,
    pub(crate) lighting: Lighting,
    /// Texels of the map of lamps' light, where lamps shine.
    pub(crate) light_map: Option<&'a [[u8; 4]]>,
    pub(crate) glows: &'a [Glow],
    /// What wet roads mirror of them.
    pub(crate) streaks: &'a [Streak],
    /// Behind vehicles in rain, the farthest first.
    pub(crate) spray: &'a [Puff],
}

/// Pipelines and the buffers they read.
pub(crate) struct Passes {
    layouts: Layouts,
    /// One for each kind of shadows that was needed.
    styles: Vec<Style>,
    /// Those for pictures without colours, made when they are needed first.
    classes: Option<[wgpu::RenderPipeline; FINISHES]>,
    /// For pixels' middles and for their corners.
    scenes: [SceneBinding; 2],
    shadow_sampler: wgpu::Sampler,
    shadows: ShadowPasses,
    fixed: wgpu::Buffer,
    moving: GrowingBuffer,
    indices: GrowingBuffer,
    light_map: wgpu::Texture,
    glows: GrowingBuffer,
    streaks: GrowingBuffer,
    spray: GrowingBuffer,
}

/// The scene as one grid of samples sees it.
struct SceneBinding {
    uniform: wgpu::Buffer,
    group: wgpu::BindGroup,
}

/// Pipelines and maps for one kind of shadows.
struct Style {
    shadows: Shadows,
    /// With what they are for: whether there is fog, water or rain, and which light; made when they are needed first.
    pipelines: Vec<((bool, Lighting), Pipelines)>,
    /// By their numbers, which all kinds share: a map is made where its number comes up.
    maps: BTreeMap<usize, ShadowMap>,
}

fn fixed_vertices(gpu: &Gpu, fixed: &[Vertex]) -> wgpu::Buffer {
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: size_of_val(fixed).max(size_of::<Vertex>()) as u64,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(fixed));
    buffer
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, fixed: &[Vertex]) -> Self {
        use wgpu::{BindingResource as R, BufferUsages as U};
        let layouts = Layouts::new(gpu);
        let buffer = |size: usize, usage: U| {
            let usage = usage | U::COPY_DST;
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: size as u64,
                usage,
                mapped_at_creation: false,
            })
        };
        let (noise, noise_sampler) = (textures::noise_view(gpu), textures::noise_sampler(gpu));
        let ground = textures::ground_view(gpu);
        let light_map = textures::light_map(gpu);
        let light_map_view = light_map.create_view(&Default::default());
        let leaves = textures::leaves_view(gpu);
        let scenes = core::array::from_fn(|_| {
            let uniform = buffer(size_of::<SceneUniform>(), U::UNIFORM);
            let [noise, light_map, ground, leaves] = [&noise, &light_map_view, &ground, &leaves].map(R::TextureView);
            let scene = [uniform.as_entire_binding(), noise, R::Sampler(&noise_sampler), light_map, ground, leaves];
            SceneBinding { group: gpu.bind(&layouts.scene, &scene), uniform }
        });
        Self {
            styles: Vec::new(),
            classes: None,
            scenes,
            shadow_sampler: textures::shadow_sampler(gpu),
            shadows: ShadowPasses::new(gpu, &layouts),
            fixed: fixed_vertices(gpu, fixed),
            moving: GrowingBuffer::new(gpu, U::VERTEX),
            indices: GrowingBuffer::new(gpu, U::INDEX),
            light_map,
            glows: GrowingBuffer::new(gpu, U::VERTEX),
            streaks: GrowingBuffer::new(gpu, U::VERTEX),
            spray: GrowingBuffer::new(gpu, U::VERTEX),
            layouts,
        }
    }

    /// Replaces what stands still.
    pub(crate) fn replace_fixed(&mut self, gpu: &Gpu, fixed: &[Vertex]) {
        self.fixed = fixed_vertices(gpu, fixed);
    }

    /// How many shadow maps of so many texels a side there are.
    #[cfg(test)]
    pub(crate) fn shadow_maps(&self, side: u32) -> usize {
        self.styles.iter().filter(|style| style.shadows.side == side).map(|style| style.maps.len()).sum()
    }

    /// Draws a frame and copies its planes to the read-back buffer.
    pub(crate) fn submit(&mut self, gpu: &Gpu, draws: &Draws<'_>, targets: &Targets) {
        for (scene, uniform) in self.scenes.iter().zip(&draws.uniforms) {
            gpu.queue.write_buffer(&scene.uniform, 0, bytemuck::bytes_of(uniform));
        }
        self.moving.write(gpu, draws.moving_vertices);
        if let Some(texels) = draws.light_map {
            textures::write_light_map(gpu, &self.light_map, texels);
        }
        self.glows.write(gpu, draws.glows);
        self.streaks.write(gpu, draws.streaks);
        self.spray.write(gpu, draws.spray);
        let ranges = self.write_indices(gpu, draws);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        if draws.colours {
            self.colour_passes(gpu, &mut encoder, &ranges, draws, targets);
        } else {
            self.class_pass(gpu, &mut encoder, &ranges.seen, targets);
        }
        readback::record(&mut encoder, targets, draws.colours);
        gpu.queue.submit([encoder.finish()]);
    }

    /// Draws the corners of the picture that was submitted last, as far as they are nearer than what is known of them: all that
    /// is drawn leaves an alpha of 1.
    pub(crate) fn submit_corners(
        &mut self,
        gpu: &Gpu,
        draws: &Draws<'_>,
        (seen, known): (&Lists, &[f32]),
        targets: &Targets,
    ) {
        let Some(corners) = &targets.corners else { return };
        let bytes_per_row = Some(4 * corners.known.width());
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None };
        let bytes = bytemuck::cast_slice(known);
        gpu.queue.write_texture(corners.known.as_image_copy(), bytes, layout, corners.known.size());
        let mut all = Vec::new();
        let seen = push_lists(&mut all, seen);
        self.indices.write(gpu, &all);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        if let Some(style) = self.styles.iter().find(|style| style.shadows == draws.shadow_style) {
            let known = self.bind_known(gpu, &corners.known);
            self.main_pass(&mut encoder, style, (&seen, draws), (&corners.samples, &self.scenes[1], Some(&known)));
        }
        readback::record_corners(&mut encoder, corners);
        gpu.queue.submit([encoder.finish()]);
    }

    /// Binds a texture of depths that are known.
    fn bind_known(&self, gpu: &Gpu, known: &wgpu::Texture) -> wgpu::BindGroup {
        let view = known.create_view(&Default::default());
        gpu.bind(&self.layouts.known, &[wgpu::BindingResource::TextureView(&view)])
    }

    fn colour_passes(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        ranges: &Ranges,
        draws: &Draws<'_>,
        targets: &Targets,
    ) {
        let style = self.styles.iter().position(|style| style.shadows == draws.shadow_style);
        let style = style.map(|index| self.styles.swap_remove(index));
        let mut style = style.unwrap_or_else(|| Style {
            shadows: draws.shadow_style,
            pipelines: Vec::new(),
            maps: BTreeMap::new(),
        });
        style.prepare(gpu, &self.layouts, draws, &self.shadow_sampler);
        let map = style.maps.get_mut(&draws.shadows.map).filter(|_| draws.lighting != Lighting::Night);
        if let Some(map) = map {
            let casters = Casters { fixed: &self.fixed, moving: &self.moving.buffer, indices: &self.indices.buffer };
            self.shadows.record(gpu, encoder, map, &draws.shadows, (&ranges.casters, &casters));
        }
        let (seen, middles) = (&ranges.seen, &targets.middles);
        self.main_pass(encoder, &style, (seen, draws), (middles, &self.scenes[0], None));
        self.styles.push(style);
    }

    fn write_indices(&mut self, gpu: &Gpu, draws: &Draws<'_>) -> Ranges {
        let mut all = Vec::new();
        let seen = push_lists(&mut all, &draws.seen);
        let mut push_all = |castings: &[Casting]| castings.iter().map(|it| push(&mut all, &it.casters)).collect();
        let casters = CasterRanges { still: push_all(&draws.shadows.still), moving: push_all(&draws.shadows.moving) };
        self.indices.write(gpu, &all);
        Ranges { seen, casters }
    }

    /// Classes, instances and depth: the sky is where nothing is.
    fn class_pass(&mut self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, seen: &Seen, targets: &Targets) {
        let pipelines = self.classes.get_or_insert_with(|| pipelines::classes(gpu, &self.layouts)).clone();
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let (ids, depth) = (view(&targets.middles.ids), view(&targets.middles.depth));
        let sky = wgpu::Color { r: f64::from(SemanticTag::Sky as u8), ..wgpu::Color::TRANSPARENT };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("classes"),
            color_attachments: &[None, Some(colour_attachment(&ids, sky))],
            depth_stencil_attachment: Some(depth_attachment(&depth, wgpu::LoadOp::Clear(0.0))),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.scenes[0].group, &[]);
        pass.set_pipeline(&pipelines[Finish::Plain as usize]);
        self.draw_mesh(&mut pass, &self.moving.buffer, &seen[MOVING]);
        for finish in DRAW_ORDER {
            pass.set_pipeline(&pipelines[finish as usize]);
            self.draw_mesh(&mut pass, &self.fixed, &seen[finish as usize]);
        }
    }

    fn main_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        style: &Style,
        (seen, draws): (&Seen, &Draws<'_>),
        (samples, scene, known): (&Samples, &SceneBinding, Option<&wgpu::BindGroup>),
    ) {
        let pipelines = style.pipelines();
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let (colour, ids, depth) = (view(&samples.colour), view(&samples.ids), view(&samples.depth));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("main"),
            color_attachments: &[&colour, &ids].map(|view| Some(colour_attachment(view, wgpu::Color::TRANSPARENT))),
            depth_stencil_attachment: Some(depth_attachment(&depth, wgpu::LoadOp::Clear(0.0))),
            ..Default::default()
        });
        if let Some(known) = known {
            pass.set_pipeline(&pipelines.known);
            pass.set_bind_group(0, known, &[]);
            pass.draw(0..3, 0..1);
        }
        pass.set_bind_group(0, &scene.group, &[]);
        pass.set_bind_group(1, &style.maps[&draws.shadows.map].group, &[]);
        pass.set_pipeline(&pipelines.world[Finish::Plain as usize]);
        self.draw_mesh(&mut pass, &self.moving.buffer, &seen[MOVING]);
        for finish in DRAW_ORDER {
            // What is drawn after them mirrors nothing: it is not paved.
            if finish == Finish::Grainy {
                draw_quads(&mut pass, &pipelines.mirror, &self.streaks, draws.streaks.len());
            }
            pass.set_pipeline(&pipelines.world[finish as usize]);
            self.draw_mesh(&mut pass, &self.fixed, &seen[finish as usize]);
        }
        pass.set_pipeline(&pipelines.sky);
        pass.draw(0..3, 0..1);
        draw_quads(&mut pass, &pipelines.spray, &self.spray, draws.spray.len());
        if draws.drops > 0 {
            pass.set_pipeline(&pipelines.rain);
            pass.draw(0..6 * draws.drops, 0..1);
        }
        draw_quads(&mut pass, &pipelines.glow, &self.glows, draws.glows.len());
    }

    fn draw_mesh(&self, pass: &mut wgpu::RenderPass<'_>, vertices: &wgpu::Buffer, range: &Range<u32>) {
        if !range.is_empty() {
            pass.set_vertex_buffer(0, vertices.slice(..));
            pass.set_index_buffer(self.indices.buffer.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(range.clone(), 0, 0..1);
        }
    }
}

/// Draws two triangles for each of so many instances.
fn draw_quads(
    pass: &mut wgpu::RenderPass<'_>,
    pipeline: &wgpu::RenderPipeline,
    instances: &GrowingBuffer,
    count: usize,
) {
    if count > 0 {
        pass.set_pipeline(pipeline);
        pass.set_vertex_buffer(0, instances.buffer.slice(..));
        pass.draw(0..6, 0..count as u32);
    }
}

impl Style {
    /// Makes what is lacking for a picture.
    fn prepare(&mut self, gpu: &Gpu, layouts: &Layouts, draws: &Draws<'_>, sampler: &wgpu::Sampler) {
        let map = self.maps.entry(draws.shadows.map);
        map.or_insert_with(|| ShadowMap::new(gpu, layouts, self.shadows.side, sampler));
        let wanted = (draws.weather, draws.lighting);
        let known = self.pipelines.iter().position(|(made_for, _)| *made_for == wanted);
        let last = known.unwrap_or_else(|| {
            self.pipelines.push((wanted, Pipelines::new(gpu, layouts, self.shadows.taps, wanted)));
            self.pipelines.len() - 1
        });
        // Those of the picture at hand come first.
        self.pipelines.swap(0, last);
    }

    /// Those of the picture at hand.
    fn pipelines(&self) -> &Pipelines {
        &self.pipelines[0].1
    }
}

/// Where lists lie in the index buffer.
type Seen = [Range<u32>; LISTS];

/// Where each list lies in the index buffer.
struct Ranges {
    /// As [`Draws::seen`].
    seen: Seen,
    casters: CasterRanges,
}

fn push(all: &mut Vec<u32>, list: &[u32]) -> Range<u32> {
    let start = all.len() as u32;
    all.extend_from_slice(list);
    start..all.len() as u32
}

fn push_lists(all: &mut Vec<u32>, lists: &Lists) -> Seen {
    lists.each_ref().map(|list| push(all, list))
}
