//! Textures that are filled once.

use std::sync::OnceLock;

use super::Gpu;
use crate::{ground_textures, leaves, light_map, noise, tile};

/// The noise texture with its mip levels.
pub(super) fn noise_view(gpu: &Gpu) -> wgpu::TextureView {
    let texture = tiles(gpu, "noise", wgpu::TextureFormat::Rg8Unorm, noise::SIDE, &[noise::levels()]);
    texture.create_view(&Default::default())
}

/// The textures of ground, a layer each.
pub(super) fn ground_view(gpu: &Gpu) -> wgpu::TextureView {
    static LAYERS: OnceLock<Vec<Vec<Vec<u8>>>> = OnceLock::new();
    let (side, layers) = (tile::SIDE as u32, LAYERS.get_or_init(|| ground_textures::layers().into()));
    all_layers(&tiles(gpu, "ground", wgpu::TextureFormat::Rgba8Unorm, side, layers))
}

/// The textures of leaves, a layer each.
pub(super) fn leaves_view(gpu: &Gpu) -> wgpu::TextureView {
    static LAYERS: OnceLock<Vec<Vec<Vec<u8>>>> = OnceLock::new();
    let layers = LAYERS.get_or_init(leaves::layers);
    all_layers(&tiles(gpu, "leaves", wgpu::TextureFormat::Rg8Unorm, leaves::SIDE, layers))
}

fn all_layers(texture: &wgpu::Texture) -> wgpu::TextureView {
    let dimension = Some(wgpu::TextureViewDimension::D2Array);
    texture.create_view(&wgpu::TextureViewDescriptor { dimension, ..Default::default() })
}

/// A square texture with its mip levels, as many in each of its layers.
fn tiles(gpu: &Gpu, label: &str, format: wgpu::TextureFormat, side: u32, layers: &[Vec<Vec<u8>>]) -> wgpu::Texture {
    let size = |level: usize, depth_or_array_layers: u32| wgpu::Extent3d {
        width: side >> level,
        height: side >> level,
        depth_or_array_layers,
    };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: size(0, layers.len() as u32),
        mip_level_count: layers.iter().map(Vec::len).max().unwrap_or(1) as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let of_layer = |(z, levels): (u32, &'_ Vec<Vec<u8>>)| {
        for (level, texels) in levels.iter().enumerate() {
            let origin = wgpu::Origin3d { z, ..wgpu::Origin3d::ZERO };
            let mip_level = level as u32;
            let target = wgpu::TexelCopyTextureInfo { mip_level, origin, ..texture.as_image_copy() };
            let bytes_per_row = Some(texels.len() as u32 / (side >> level));
            let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None };
            gpu.queue.write_texture(target, texels, layout, size(level, 1));
        }
    };
    (0..).zip(layers).for_each(of_layer);
    texture
}

/// The texture for the map of lamps' light.
pub(super) fn light_map(gpu: &Gpu) -> wgpu::Texture {
    let side = light_map::SIDE as u32;
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("light map"),
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Writes all of it.
pub(super) fn write_light_map(gpu: &Gpu, texture: &wgpu::Texture, texels: &[[u8; 4]]) {
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * texture.width()), rows_per_image: None };
    gpu.queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(texels), layout, texture.size());
}

/// A depth texture that can be drawn to and sampled.
pub(super) fn shadow_map(gpu: &Gpu, side: u32) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("shadow"),
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth32Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

/// Bilinear and repeating, with a hard choice of the mip level.
pub(super) fn noise_sampler(gpu: &Gpu) -> wgpu::Sampler {
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("noise"),
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::Repeat,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Nearest,
        ..Default::default()
    })
}

/// Bilinear over comparisons: soft edges from one sample. Repeating, as a map goes on over its edges.
pub(super) fn shadow_sampler(gpu: &Gpu) -> wgpu::Sampler {
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("shadow"),
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::Repeat,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        compare: Some(wgpu::CompareFunction::LessEqual),
        ..Default::default()
    })
}
