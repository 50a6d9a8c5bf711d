//! From several samples a pixel to one.

use super::{Gpu, shaders};

/// Brings several samples a pixel down to one.
pub(super) struct Resolve {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    /// The three planes, as the read-back buffer has them.
    planes: wgpu::Buffer,
}

impl Resolve {
    /// `samples` are the colour, id and depth textures.
    pub(super) fn new(gpu: &Gpu, samples: [&wgpu::Texture; 3], stride_bytes: u32, plane_bytes: u64) -> Self {
        let text = shaders::source("resolve").unwrap_or_default();
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("resolve"),
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let constants = [("STRIDE", f64::from(stride_bytes / 4))];
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("resolve"),
            layout: None,
            module: &module,
            entry_point: Some("resolve"),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            cache: None,
        });
        let planes = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("planes"),
            size: 3 * plane_bytes,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let views = samples.map(|t| t.create_view(&Default::default()));
        let size = std::num::NonZeroU64::new(plane_bytes);
        let inputs = views.iter().map(wgpu::BindingResource::TextureView);
        let outputs = (0..3).map(|plane| {
            let offset = plane * plane_bytes;
            wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer: &planes, offset, size })
        });
        let entries: Vec<_> = (0..)
            .zip(inputs.chain(outputs))
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let layout = &pipeline.get_bind_group_layout(0);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries });
        Self { pipeline, group, planes }
    }

    /// Records the way from the samples to the read-back buffer of a picture.
    pub(super) fn record(&self, encoder: &mut wgpu::CommandEncoder, size: [u32; 2], readback: &wgpu::Buffer) {
        let [width, height] = size;
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.dispatch_workgroups(width.div_ceil(8), height.div_ceil(8), 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&self.planes, 0, readback, 0, self.planes.size());
    }
}
