//! Draws shadow maps.

use std::ops::Range;

use glam::Mat4;

use super::attachments::depth_attachment;
use super::pipelines::{Layouts, ShadowPipelines};
use super::{Gpu, textures};
use crate::castings::{Area, Casting};
use crate::shadow_box::TILES;

/// What is drawn to a shadow map for a picture.
#[derive(Default)]
pub(crate) struct ShadowDraws {
    /// Number of the map; a new one is the next in order.
    pub(crate) map: usize,
    /// What stands still, where the map does not show it yet.
    pub(crate) still: Vec<Casting>,
    pub(crate) moving: Vec<Casting>,
    /// Where what moves may be.
    pub(crate) covered: Vec<Area>,
}

/// Where the casters of [`ShadowDraws::still`] and [`ShadowDraws::moving`] lie in the index buffer.
pub(super) struct CasterRanges {
    pub(super) still: Vec<Range<u32>>,
    pub(super) moving: Vec<Range<u32>>,
}

/// The vertices of what stands still and of what moves, and the indices of both.
pub(super) struct Casters<'a> {
    pub(super) fixed: &'a wgpu::Buffer,
    pub(super) moving: &'a wgpu::Buffer,
    pub(super) indices: &'a wgpu::Buffer,
}

/// A map of what stands still, and one of everything for the picture at hand.
pub(super) struct ShadowMap {
    still: wgpu::TextureView,
    all: wgpu::TextureView,
    still_group: wgpu::BindGroup,
    /// To look up shadows of everything.
    pub(super) group: wgpu::BindGroup,
    /// Where the map of everything shows what moved in the last picture.
    stale: Vec<Area>,
}

impl ShadowMap {
    pub(super) fn new(gpu: &Gpu, layouts: &Layouts, side: u32, sampler: &wgpu::Sampler) -> Self {
        use wgpu::BindingResource as R;
        let [still, all] = [(); 2].map(|()| textures::shadow_map(gpu, side).create_view(&Default::default()));
        Self {
            still_group: gpu.bind(&layouts.still, &[R::TextureView(&still)]),
            group: gpu.bind(&layouts.shadow, &[R::TextureView(&all), R::Sampler(sampler)]),
            still,
            all,
            stale: Vec::new(),
        }
    }
}

/// One matrix is so many bytes after the other.
const STEP: u64 = 256;
/// As many as there may be castings: one for each tile, and one for each map that a box lies in.
const MOST: u64 = (TILES * TILES) as u64 + 4;

/// Draws to any of the maps.
pub(super) struct ShadowPasses {
    pipelines: ShadowPipelines,
    clips: wgpu::Buffer,
    clips_group: wgpu::BindGroup,
}

impl ShadowPasses {
    pub(super) fn new(gpu: &Gpu, layouts: &Layouts) -> Self {
        let clips = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("clips"),
            size: MOST * STEP,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let size = std::num::NonZeroU64::new(size_of::<Mat4>() as u64);
        let one = wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer: &clips, offset: 0, size });
        let clips_group = gpu.bind(&layouts.clip, &[one]);
        Self { pipelines: ShadowPipelines::new(gpu, layouts), clips, clips_group }
    }

    /// Brings a map up to date.
    pub(super) fn record(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        map: &mut ShadowMap,
        draws: &ShadowDraws,
        (ranges, casters): (&CasterRanges, &Casters<'_>),
    ) {
        let clips = draws.still.iter().chain(&draws.moving).flat_map(|casting| {
            let mut bytes = [0; STEP as usize];
            bytes[..size_of::<Mat4>()].copy_from_slice(bytemuck::cast_slice(&casting.clip.to_cols_array()));
            bytes
        });
        gpu.queue.write_buffer(&self.clips, 0, &clips.collect::<Vec<u8>>());
        if !draws.still.is_empty() {
            let mut pass = begin(encoder, &map.still);
            pass.set_pipeline(&self.pipelines.clear);
            draws.still.iter().for_each(|casting| fill(&mut pass, casting.within));
            self.cast(&mut pass, (&draws.still, 0, &ranges.still), (casters.fixed, casters.indices));
        }
        let new = draws.still.iter().map(|casting| casting.within);
        let copied: Vec<Area> = map.stale.drain(..).chain(new).collect();
        if !(copied.is_empty() && draws.moving.is_empty()) {
            let mut pass = begin(encoder, &map.all);
            pass.set_pipeline(&self.pipelines.copy);
            pass.set_bind_group(0, &map.still_group, &[]);
            copied.into_iter().for_each(|area| fill(&mut pass, area));
            let first = draws.still.len();
            self.cast(&mut pass, (&draws.moving, first, &ranges.moving), (casters.moving, casters.indices));
        }
        map.stale.extend_from_slice(&draws.covered);
    }

    /// Draws castings; `first` is the number of the first one's matrix.
    fn cast(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        (castings, first, ranges): (&[Casting], usize, &[Range<u32>]),
        (vertices, indices): (&wgpu::Buffer, &wgpu::Buffer),
    ) {
        if castings.is_empty() {
            return;
        }
        pass.set_pipeline(&self.pipelines.cast);
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        for ((number, casting), range) in (first as u32..).zip(castings).zip(ranges).filter(|(_, r)| !r.is_empty()) {
            set_scissor(pass, casting.within);
            pass.set_bind_group(0, &self.clips_group, &[number * STEP as u32]);
            pass.draw_indexed(range.clone(), 0, 0..1);
        }
    }
}

fn begin<'a>(encoder: &'a mut wgpu::CommandEncoder, map: &wgpu::TextureView) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("shadow"),
        depth_stencil_attachment: Some(depth_attachment(map, wgpu::LoadOp::Load)),
        ..Default::default()
    })
}

fn set_scissor(pass: &mut wgpu::RenderPass<'_>, Area { at, size }: Area) {
    pass.set_scissor_rect(at[0], at[1], size[0], size[1]);
}

fn fill(pass: &mut wgpu::RenderPass<'_>, area: Area) {
    set_scissor(pass, area);
    pass.draw(0..3, 0..1);
}
