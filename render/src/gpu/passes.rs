//! The commands of a frame.

use std::ops::Range;

use super::pipelines::{self, Layouts, Pipelines};
use super::{Gpu, GrowingBuffer, SceneUniform, Targets, readback, textures};
use crate::SemanticTag;
use crate::blob::BlobVertex;
use crate::mesh::{FINISHES, Finish, Vertex};

/// What a frame draws.
pub(crate) struct Draws<'a> {
    pub(crate) uniform: SceneUniform,
    pub(crate) moving_vertices: &'a [Vertex],
    pub(crate) moving_indices: &'a [u32],
    /// Indices of the static world for each finish.
    pub(crate) fixed_indices: [Vec<u32>; FINISHES],
    /// Indices of the static world to draw the shadow map with; `None` keeps the map as it is.
    pub(crate) casters: Option<Vec<u32>>,
    /// Whether moving things are in the shadow map too.
    pub(crate) moving_casts: bool,
    /// Number of the shadow map; a new one is the next in order.
    pub(crate) shadow_map: usize,
    pub(crate) blobs: &'a [BlobVertex],
    /// Whether colours are to be drawn, not classes and instances alone.
    pub(crate) colours: bool,
    /// Whether fog, water or rain is to be drawn.
    pub(crate) weather: bool,
    /// Drops of rain.
    pub(crate) drops: u32,
}

/// Pipelines and the buffers they read.
pub(crate) struct Passes {
    layouts: Layouts,
    shadow_taps: u32,
    dry: Pipelines,
    /// Those for fog, water and rain, made when they are needed first.
    weather: Option<Pipelines>,
    /// The one for pictures without colours, made when it is needed first.
    classes: Option<wgpu::RenderPipeline>,
    uniform: wgpu::Buffer,
    scene_group: wgpu::BindGroup,
    shadow_side: u32,
    shadow_sampler: wgpu::Sampler,
    shadow_maps: Vec<ShadowMap>,
    fixed: wgpu::Buffer,
    moving: GrowingBuffer,
    blobs: GrowingBuffer,
    indices: GrowingBuffer,
}

/// A shadow map, to draw to and to read.
struct ShadowMap {
    view: wgpu::TextureView,
    group: wgpu::BindGroup,
}

fn bind(gpu: &Gpu, layout: &wgpu::BindGroupLayout, resources: &[wgpu::BindingResource<'_>]) -> wgpu::BindGroup {
    let entries: Vec<_> =
        (0..).zip(resources).map(|(binding, r)| wgpu::BindGroupEntry { binding, resource: r.clone() }).collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, fixed: &[Vertex], shadow_side: u32, shadow_taps: u32) -> Self {
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
        let uniform = buffer(size_of::<SceneUniform>(), U::UNIFORM);
        let vertices = buffer(size_of_val(fixed).max(size_of::<Vertex>()), U::VERTEX);
        gpu.queue.write_buffer(&vertices, 0, bytemuck::cast_slice(fixed));
        let (noise, noise_sampler) = (textures::noise_view(gpu), textures::noise_sampler(gpu));
        let scene = [uniform.as_entire_binding(), R::TextureView(&noise), R::Sampler(&noise_sampler)];
        Self {
            dry: Pipelines::new(gpu, &layouts, shadow_taps, false),
            weather: None,
            classes: None,
            shadow_taps,
            scene_group: bind(gpu, &layouts.scene, &scene),
            shadow_side,
            shadow_sampler: textures::shadow_sampler(gpu),
            shadow_maps: Vec::new(),
            uniform,
            fixed: vertices,
            moving: GrowingBuffer::new(gpu, U::VERTEX),
            blobs: GrowingBuffer::new(gpu, U::VERTEX),
            indices: GrowingBuffer::new(gpu, U::INDEX),
            layouts,
        }
    }

    /// Draws a frame and copies its planes to the read-back buffer.
    pub(crate) fn submit(&mut self, gpu: &Gpu, draws: &Draws<'_>, targets: &Targets) {
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&draws.uniform));
        self.moving.write(gpu, draws.moving_vertices);
        self.blobs.write(gpu, draws.blobs);
        let ranges = self.write_indices(gpu, draws);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        if draws.colours {
            self.colour_passes(gpu, &mut encoder, &ranges, draws, targets);
        } else {
            self.class_pass(gpu, &mut encoder, &ranges, targets);
        }
        readback::record(&mut encoder, targets);
        gpu.queue.submit([encoder.finish()]);
    }

    fn colour_passes(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        ranges: &Ranges,
        draws: &Draws<'_>,
        targets: &Targets,
    ) {
        while self.shadow_maps.len() <= draws.shadow_map {
            self.shadow_maps.push(self.new_shadow_map(gpu));
        }
        if draws.weather && self.weather.is_none() {
            self.weather = Some(Pipelines::new(gpu, &self.layouts, self.shadow_taps, true));
        }
        let pipelines = self.weather.as_ref().filter(|_| draws.weather).unwrap_or(&self.dry);
        if draws.casters.is_some() {
            self.shadow_pass(encoder, ranges, draws);
        }
        self.main_pass(encoder, pipelines, ranges, draws, targets);
    }

    fn write_indices(&mut self, gpu: &Gpu, draws: &Draws<'_>) -> Ranges {
        let mut all = draws.moving_indices.to_vec();
        let mut push = |list: &[u32]| {
            let start = all.len() as u32;
            all.extend_from_slice(list);
            start..all.len() as u32
        };
        let fixed = core::array::from_fn(|finish| push(&draws.fixed_indices[finish]));
        let casters = push(draws.casters.as_deref().unwrap_or_default());
        self.indices.write(gpu, &all);
        Ranges { moving: 0..draws.moving_indices.len() as u32, fixed, casters }
    }

    fn new_shadow_map(&self, gpu: &Gpu) -> ShadowMap {
        use wgpu::BindingResource as R;
        let view = textures::shadow_view(gpu, self.shadow_side);
        let group = bind(gpu, &self.layouts.shadow, &[R::TextureView(&view), R::Sampler(&self.shadow_sampler)]);
        ShadowMap { view, group }
    }

    fn shadow_pass(&self, encoder: &mut wgpu::CommandEncoder, ranges: &Ranges, draws: &Draws<'_>) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow"),
            depth_stencil_attachment: Some(depth_attachment(&self.shadow_maps[draws.shadow_map].view, 1.0)),
            ..Default::default()
        });
        pass.set_pipeline(&self.dry.shadow);
        pass.set_bind_group(0, &self.scene_group, &[]);
        self.draw_mesh(&mut pass, &self.fixed, &ranges.casters);
        if draws.moving_casts {
            self.draw_mesh(&mut pass, &self.moving.buffer, &ranges.moving);
        }
    }

    /// Classes, instances and depth: the sky is where nothing is.
    fn class_pass(&mut self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, ranges: &Ranges, targets: &Targets) {
        let pipeline = self.classes.get_or_insert_with(|| pipelines::classes(gpu, &self.layouts)).clone();
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let (ids, depth) = (view(&targets.ids), view(&targets.depth));
        let sky = wgpu::Color { r: f64::from(SemanticTag::Sky as u8), ..wgpu::Color::TRANSPARENT };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("classes"),
            color_attachments: &[None, Some(colour_attachment(&ids, sky))],
            depth_stencil_attachment: Some(depth_attachment(&depth, 0.0)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.scene_group, &[]);
        pass.set_pipeline(&pipeline);
        self.draw_mesh(&mut pass, &self.moving.buffer, &ranges.moving);
        for finish in [Finish::Facade, Finish::Plain, Finish::Grainy] {
            self.draw_mesh(&mut pass, &self.fixed, &ranges.fixed[finish as usize]);
        }
    }

    fn main_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipelines: &Pipelines,
        ranges: &Ranges,
        draws: &Draws<'_>,
        targets: &Targets,
    ) {
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let (colour, ids, depth) = (view(&targets.colour), view(&targets.ids), view(&targets.depth));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("main"),
            color_attachments: &[&colour, &ids].map(|view| Some(colour_attachment(view, wgpu::Color::TRANSPARENT))),
            depth_stencil_attachment: Some(depth_attachment(&depth, 0.0)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.scene_group, &[]);
        pass.set_bind_group(1, &self.shadow_maps[draws.shadow_map].group, &[]);
        // Nearest and most covering first: hidden fragments are cheap.
        pass.set_pipeline(&pipelines.world[Finish::Plain as usize]);
        self.draw_mesh(&mut pass, &self.moving.buffer, &ranges.moving);
        for finish in [Finish::Facade, Finish::Plain, Finish::Grainy] {
            pass.set_pipeline(&pipelines.world[finish as usize]);
            self.draw_mesh(&mut pass, &self.fixed, &ranges.fixed[finish as usize]);
        }
        let blobs = draws.blobs.len() as u32;
        if blobs > 0 {
            pass.set_pipeline(&pipelines.blob);
            pass.set_vertex_buffer(0, self.blobs.buffer.slice(..));
            pass.draw(0..blobs, 0..1);
        }
        pass.set_pipeline(&pipelines.sky);
        pass.draw(0..3, 0..1);
        if draws.drops > 0 {
            pass.set_pipeline(&pipelines.rain);
            pass.draw(0..6 * draws.drops, 0..1);
        }
    }

    fn draw_mesh(&self, pass: &mut wgpu::RenderPass<'_>, vertices: &wgpu::Buffer, range: &Range<u32>) {
        if !range.is_empty() {
            pass.set_vertex_buffer(0, vertices.slice(..));
            pass.set_index_buffer(self.indices.buffer.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(range.clone(), 0, 0..1);
        }
    }
}

/// Where each list lies in the index buffer.
struct Ranges {
    moving: Range<u32>,
    fixed: [Range<u32>; FINISHES],
    casters: Range<u32>,
}

fn colour_attachment(view: &wgpu::TextureView, clear: wgpu::Color) -> wgpu::RenderPassColorAttachment<'_> {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store };
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
}

fn depth_attachment(view: &wgpu::TextureView, clear: f32) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store };
    wgpu::RenderPassDepthStencilAttachment { view, depth_ops: Some(ops), stencil_ops: None }
}
