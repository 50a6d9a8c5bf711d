//! Images on a window without egui's shader: that weighs, tints and blends every pixel, and on a CPU
//! half of a drive's work would be that.

use std::collections::HashMap;
use std::sync::Arc;

use base::image::Image;
use egui::{PaintCallbackInfo, Rect, Shape};
use egui_wgpu::{Callback, CallbackResources, CallbackTrait, RenderState, ScreenDescriptor, wgpu};

const SHADER: &str = "
@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var image_sampler: sampler;

struct Corner { @builtin(position) position: vec4<f32>, @location(0) at: vec2<f32> }

@vertex fn corner(@builtin(vertex_index) i: u32) -> Corner {
    let at = vec2(f32(i % 2u), f32(i / 2u)) * 2.0;
    return Corner(vec4(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y, 0.0, 1.0), at);
}

@fragment fn texel(corner: Corner) -> @location(0) vec4<f32> {
    return textureSample(image, image_sampler, corner.at);
}
";

/// How pixels between those of the image look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// Like the nearest one.
    Sharp,
    /// Like a mixture.
    Smooth,
}

/// What fills `rect` with an image; `slot` names the texture that holds it in this window.
pub fn shape(rect: Rect, slot: u64, image: &Arc<Image>, filter: Filter) -> Shape {
    Shape::Callback(Callback::new_paint_callback(rect, Blit { slot, image: image.clone(), filter }))
}

/// Lets a window show images.
pub fn install(state: &RenderState) {
    let blitter = Blitter::new(&state.device, state.target_format);
    state.renderer.write().callback_resources.insert(blitter);
}

struct Blit {
    slot: u64,
    image: Arc<Image>,
    filter: Filter,
}

/// A window's pipeline and textures.
struct Blitter {
    pipeline: wgpu::RenderPipeline,
    format: wgpu::TextureFormat,
    loaded: HashMap<u64, Loaded>,
}

struct Loaded {
    image: Arc<Image>,
    texture: wgpu::Texture,
    bindings: wgpu::BindGroup,
}

impl CallbackTrait for Blit {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        _: &ScreenDescriptor,
        _: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if let Some(blitter) = resources.get_mut::<Blitter>() {
            blitter.load(device, queue, self);
        }
        Vec::new()
    }

    fn paint(&self, _: PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, resources: &CallbackResources) {
        let Some(blitter) = resources.get::<Blitter>() else { return };
        let Some(loaded) = blitter.loaded.get(&self.slot) else { return };
        pass.set_pipeline(&blitter.pipeline);
        pass.set_bind_group(0, &loaded.bindings, &[]);
        pass.draw(0..3, 0..1);
    }
}

impl Blitter {
    fn new(device: &wgpu::Device, target: wgpu::TextureFormat) -> Self {
        let source = wgpu::ShaderSource::Wgsl(SHADER.into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("blit"), source });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("blit"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("texel"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(target.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        // Bytes reach the screen as they are, whether or not the window counts in linear light.
        let srgb = target.is_srgb();
        let format = if srgb { wgpu::TextureFormat::Rgba8UnormSrgb } else { wgpu::TextureFormat::Rgba8Unorm };
        Self { pipeline, format, loaded: HashMap::new() }
    }

    fn load(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, blit: &Blit) {
        let size = |image: &Image| (image.width, image.height);
        let fits = |loaded: &&mut Loaded| size(&loaded.image) == size(&blit.image);
        match self.loaded.get_mut(&blit.slot).filter(fits) {
            Some(loaded) if Arc::ptr_eq(&loaded.image, &blit.image) => {}
            Some(loaded) => {
                write(queue, &loaded.texture, &blit.image);
                loaded.image = blit.image.clone();
            }
            None => {
                let loaded = self.create(device, blit);
                write(queue, &loaded.texture, &blit.image);
                self.loaded.insert(blit.slot, loaded);
            }
        }
    }

    fn create(&self, device: &wgpu::Device, blit: &Blit) -> Loaded {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("image"),
            size: extent(&blit.image),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: self.format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let filter = match blit.filter {
            Filter::Sharp => wgpu::FilterMode::Nearest,
            Filter::Smooth => wgpu::FilterMode::Linear,
        };
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: filter,
            min_filter: filter,
            ..wgpu::SamplerDescriptor::default()
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("image"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) },
            ],
        });
        Loaded { image: blit.image.clone(), texture, bindings }
    }
}

fn extent(image: &Image) -> wgpu::Extent3d {
    wgpu::Extent3d { width: image.width as u32, height: image.height as u32, depth_or_array_layers: 1 }
}

fn write(queue: &wgpu::Queue, texture: &wgpu::Texture, image: &Image) {
    let rgba: Vec<[u8; 4]> = image.rgb.as_chunks::<3>().0.iter().map(|&[r, g, b]| [r, g, b, 255]).collect();
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(4 * image.width as u32),
        rows_per_image: Some(image.height as u32),
    };
    queue.write_texture(texture.as_image_copy(), rgba.as_flattened(), layout, extent(image));
}
