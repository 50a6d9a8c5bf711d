//! Textures that are filled once.

use super::Gpu;
use crate::{leaves, light_map, noise};

/// The noise texture with its mip levels.
pub(super) fn noise_view(gpu: &Gpu) -> wgpu::TextureView {
    two_bytes(gpu, "noise", noise::SIDE, &[noise::levels()]).create_view(&Default::default())
}

/// The textures of leaves, a layer each, with their mip levels.
pub(super) fn leaves_view(gpu: &Gpu) -> wgpu::TextureView {
    let dimension = Some(wgpu::TextureViewDimension::D2Array);
    let view = wgpu::TextureViewDescriptor { dimension, ..Default::default() };
    two_bytes(gpu, "leaves", leaves::SIDE, &leaves::layers()).create_view(&view)
}

/// A square texture of two bytes a texel, of layers with their mip levels.
fn two_bytes(gpu: &Gpu, label: &str, side: u32, layers: &[Vec<Vec<u8>>]) -> wgpu::Texture {
    let size = |level: u32, depth_or_array_layers: u32| wgpu::Extent3d {
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
        format: wgpu::TextureFormat::Rg8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (layer, levels) in (0..).zip(layers) {
        for (level, texels) in (0..).zip(levels) {
            let origin = wgpu::Origin3d { x: 0, y: 0, z: layer };
            let target = wgpu::TexelCopyTextureInfo { mip_level: level, origin, ..texture.as_image_copy() };
            let bytes_per_row = Some(2 * (side >> level));
            let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None };
            gpu.queue.write_texture(target, texels, layout, size(level, 1));
        }
    }
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

/// A depth texture that can be drawn to, copied and sampled.
pub(super) fn shadow_map(gpu: &Gpu, side: u32) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("shadow"),
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth32Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC
            | wgpu::TextureUsages::COPY_DST,
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

/// Bilinear over comparisons: soft edges from one sample.
pub(super) fn shadow_sampler(gpu: &Gpu) -> wgpu::Sampler {
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("shadow"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        compare: Some(wgpu::CompareFunction::LessEqual),
        ..Default::default()
    })
}
