//! The commands of a frame.

use std::ops::Range;

use super::pipelines::{self, Layouts, Pipelines};
use super::targets::Samples;
use super::{Gpu, GrowingBuffer, SceneUniform, Targets, readback, textures};
use crate::SemanticTag;
use crate::blob::BlobVertex;
use crate::mesh::{FINISHES, Finish, Vertex};
use crate::quality::Shadows;

/// What a frame draws.
pub(crate) struct Draws<'a> {
    /// As pixels' middles see it, and as their corners do.
    pub(crate) uniforms: [SceneUniform; 2],
    pub(crate) moving_vertices: &'a [Vertex],
    pub(crate) moving_indices: &'a [u32],
    /// Indices of the static world for each finish.
    pub(crate) fixed_indices: [Vec<u32>; FINISHES],
    /// Indices of the static world to draw the shadow map with; `None` keeps the map as it is.
    pub(crate) casters: Option<Vec<u32>>,
    pub(crate) shadows: Shadows,
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
    /// With shadows of what stands still and of what moves, made when they are needed first.
    styles: [Option<Style>; 2],
    /// The one for pictures without colours, made when it is needed first.
    classes: Option<wgpu::RenderPipeline>,
    /// For pixels' middles and for their corners.
    scenes: [SceneBinding; 2],
    shadow_sampler: wgpu::Sampler,
    fixed: wgpu::Buffer,
    moving: GrowingBuffer,
    blobs: GrowingBuffer,
    indices: GrowingBuffer,
}

/// The scene as one grid of samples sees it.
struct SceneBinding {
    uniform: wgpu::Buffer,
    group: wgpu::BindGroup,
}

/// Pipelines and maps for one kind of shadows.
struct Style {
    shadows: Shadows,
    dry: Pipelines,
    /// Those for fog, water and rain, made when they are needed first.
    weather: Option<Pipelines>,
    maps: Vec<ShadowMap>,
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
        let vertices = buffer(size_of_val(fixed).max(size_of::<Vertex>()), U::VERTEX);
        gpu.queue.write_buffer(&vertices, 0, bytemuck::cast_slice(fixed));
        let (noise, noise_sampler) = (textures::noise_view(gpu), textures::noise_sampler(gpu));
        let scenes = core::array::from_fn(|_| {
            let uniform = buffer(size_of::<SceneUniform>(), U::UNIFORM);
            let scene = [uniform.as_entire_binding(), R::TextureView(&noise), R::Sampler(&noise_sampler)];
            SceneBinding { group: bind(gpu, &layouts.scene, &scene), uniform }
        });
        Self {
            styles: [None, None],
            classes: None,
            scenes,
            shadow_sampler: textures::shadow_sampler(gpu),
            fixed: vertices,
            moving: GrowingBuffer::new(gpu, U::VERTEX),
            blobs: GrowingBuffer::new(gpu, U::VERTEX),
            indices: GrowingBuffer::new(gpu, U::INDEX),
            layouts,
        }
    }

    /// Draws a frame and copies its planes to the read-back buffer.
    pub(crate) fn submit(&mut self, gpu: &Gpu, draws: &Draws<'_>, targets: &Targets) {
        for (scene, uniform) in self.scenes.iter().zip(&draws.uniforms) {
            gpu.queue.write_buffer(&scene.uniform, 0, bytemuck::bytes_of(uniform));
        }
        self.moving.write(gpu, draws.moving_vertices);
        self.blobs.write(gpu, draws.blobs);
        let ranges = self.write_indices(gpu, draws);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        if draws.colours {
            self.colour_passes(gpu, &mut encoder, &ranges, draws, targets);
        } else {
            self.class_pass(gpu, &mut encoder, &ranges, targets);
        }
        readback::record(&mut encoder, targets, draws.colours);
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
        let index = usize::from(draws.shadows.moving);
        let mut style = self.styles[index].take().unwrap_or_else(|| Style::new(gpu, &self.layouts, draws.shadows));
        style.prepare(gpu, &self.layouts, &self.shadow_sampler, draws);
        if draws.casters.is_some() {
            self.shadow_pass(encoder, &style, ranges, draws);
        }
        for (samples, scene) in
            [Some(&targets.middles), targets.corners.as_ref()].into_iter().flatten().zip(&self.scenes)
        {
            self.main_pass(encoder, &style, ranges, draws, (samples, scene));
        }
        self.styles[index] = Some(style);
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

    fn shadow_pass(&self, encoder: &mut wgpu::CommandEncoder, style: &Style, ranges: &Ranges, draws: &Draws<'_>) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow"),
            depth_stencil_attachment: Some(depth_attachment(&style.maps[draws.shadow_map].view, 1.0)),
            ..Default::default()
        });
        pass.set_pipeline(&style.dry.shadow);
        pass.set_bind_group(0, &self.scenes[0].group, &[]);
        self.draw_mesh(&mut pass, &self.fixed, &ranges.casters);
        if draws.shadows.moving {
            self.draw_mesh(&mut pass, &self.moving.buffer, &ranges.moving);
        }
    }

    /// Classes, instances and depth: the sky is where nothing is.
    fn class_pass(&mut self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, ranges: &Ranges, targets: &Targets) {
        let pipeline = self.classes.get_or_insert_with(|| pipelines::classes(gpu, &self.layouts)).clone();
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let (ids, depth) = (view(&targets.middles.ids), view(&targets.middles.depth));
        let sky = wgpu::Color { r: f64::from(SemanticTag::Sky as u8), ..wgpu::Color::TRANSPARENT };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("classes"),
            color_attachments: &[None, Some(colour_attachment(&ids, sky))],
            depth_stencil_attachment: Some(depth_attachment(&depth, 0.0)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.scenes[0].group, &[]);
        pass.set_pipeline(&pipeline);
        self.draw_mesh(&mut pass, &self.moving.buffer, &ranges.moving);
        for finish in [Finish::Facade, Finish::Plain, Finish::Grainy] {
            self.draw_mesh(&mut pass, &self.fixed, &ranges.fixed[finish as usize]);
        }
    }

    fn main_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        style: &Style,
        ranges: &Ranges,
        draws: &Draws<'_>,
        (samples, scene): (&Samples, &SceneBinding),
    ) {
        let pipelines = style.pipelines(draws);
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let (colour, ids, depth) = (view(&samples.colour), view(&samples.ids), view(&samples.depth));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("main"),
            color_attachments: &[&colour, &ids].map(|view| Some(colour_attachment(view, wgpu::Color::TRANSPARENT))),
            depth_stencil_attachment: Some(depth_attachment(&depth, 0.0)),
            ..Default::default()
        });
        pass.set_bind_group(0, &scene.group, &[]);
        pass.set_bind_group(1, &style.maps[draws.shadow_map].group, &[]);
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

impl Style {
    fn new(gpu: &Gpu, layouts: &Layouts, shadows: Shadows) -> Self {
        Self { shadows, dry: Pipelines::new(gpu, layouts, shadows.taps, false), weather: None, maps: Vec::new() }
    }

    /// Makes what is lacking for a picture.
    fn prepare(&mut self, gpu: &Gpu, layouts: &Layouts, sampler: &wgpu::Sampler, draws: &Draws<'_>) {
        use wgpu::BindingResource as R;
        while self.maps.len() <= draws.shadow_map {
            let view = textures::shadow_view(gpu, self.shadows.side);
            let group = bind(gpu, &layouts.shadow, &[R::TextureView(&view), R::Sampler(sampler)]);
            self.maps.push(ShadowMap { view, group });
        }
        if draws.weather && self.weather.is_none() {
            self.weather = Some(Pipelines::new(gpu, layouts, self.shadows.taps, true));
        }
    }

    fn pipelines(&self, draws: &Draws<'_>) -> &Pipelines {
        self.weather.as_ref().filter(|_| draws.weather).unwrap_or(&self.dry)
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
