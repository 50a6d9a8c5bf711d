//! From samples to pixels, where these are means of several or depth cannot be copied.

use super::{Gpu, shaders};

/// A compute pass that reads textures of samples and writes the planes of a picture.
pub(super) struct Resolve {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    /// What it writes, as the read-back buffer has it.
    written: wgpu::Buffer,
}

const PLANES: u64 = 3;

impl Resolve {
    /// Of colours, ids and depth with so many samples a pixel along each axis.
    pub(super) fn new(
        gpu: &Gpu,
        samples: u32,
        inputs: [&wgpu::Texture; 3],
        [stride_bytes, plane_bytes]: [u32; 2],
    ) -> Self {
        let shader = "resolve";
        let text = shaders::source(shader).unwrap_or_default();
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(shader),
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let constants = [("STRIDE", f64::from(stride_bytes / 4)), ("SIDE", f64::from(samples))];
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(shader),
            layout: None,
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            cache: None,
        });
        let plane_bytes = u64::from(plane_bytes);
        let written = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("planes"),
            size: PLANES * plane_bytes,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let views = inputs.map(|t| t.create_view(&Default::default()));
        let inputs = views.iter().map(wgpu::BindingResource::TextureView);
        let outputs = (0..PLANES).map(|plane| {
            let (offset, size) = (plane * plane_bytes, std::num::NonZeroU64::new(plane_bytes));
            wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer: &written, offset, size })
        });
        let entries: Vec<_> = (0..)
            .zip(inputs.chain(outputs))
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let layout = &pipeline.get_bind_group_layout(0);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries });
        Self { pipeline, group, written }
    }

    /// Records the way from the samples to the read-back buffer of a picture.
    pub(super) fn record(&self, encoder: &mut wgpu::CommandEncoder, size: [u32; 2], readback: &wgpu::Buffer) {
        let [width, height] = size;
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.dispatch_workgroups(width.div_ceil(8), height.div_ceil(8), 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&self.written, 0, readback, 0, self.written.size());
    }
}
