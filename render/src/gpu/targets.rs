//! The textures a frame is drawn to and the buffer it is read back from, for one image size.

use super::Gpu;
use super::resolve::Resolve;
use crate::quality::Means;

/// Formats of the colour, id and depth targets.
pub(super) const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
pub(super) const IDS: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
pub(super) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// What is drawn of one grid of samples.
pub(super) struct Samples {
    pub(super) colour: wgpu::Texture,
    pub(super) ids: wgpu::Texture,
    pub(super) depth: wgpu::Texture,
}

/// Targets of the corners of pixels: one column and one row more.
pub(super) struct CornerTargets {
    pub(super) samples: Samples,
    /// What is drawn has a depth above this.
    pub(super) known: wgpu::Texture,
    /// Colours, that the processor can read.
    pub(super) readback: wgpu::Buffer,
}

/// Targets of one image size. All three planes take four bytes a pixel.
pub(crate) struct Targets {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(super) middles: Samples,
    pub(super) corners: Option<CornerTargets>,
    /// Three planes, one after the other, that the processor can read.
    pub(super) readback: wgpu::Buffer,
    /// Where pixels are means of samples, or depth cannot be copied.
    pub(super) resolve: Option<Resolve>,
}

impl Samples {
    fn new(gpu: &Gpu, width: u32, height: u32) -> Self {
        let texture = |format: wgpu::TextureFormat| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::COPY_SRC
                    | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        };
        Self { colour: texture(COLOUR), ids: texture(IDS), depth: texture(DEPTH) }
    }
}

impl CornerTargets {
    fn new(gpu: &Gpu, width: u32, height: u32) -> Self {
        let known = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("known depth"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::R32Float,
            usage: wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let samples = Samples::new(gpu, width, height);
        Self { samples, known, readback: readback(gpu, plane_bytes(width, height)) }
    }
}

fn readback(gpu: &Gpu, size: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

impl Targets {
    pub(crate) fn new(gpu: &Gpu, width: u32, height: u32, means: Means) -> Self {
        let Means { samples, corners, .. } = means;
        let readback = readback(gpu, 3 * plane_bytes(width, height));
        let middles = Samples::new(gpu, width * samples, height * samples);
        let corners = corners.then(|| CornerTargets::new(gpu, width + 1, height + 1));
        let bytes = [stride_bytes(width), plane_bytes(width, height) as u32];
        let Samples { colour, ids, depth } = &middles;
        let resolve =
            (samples > 1 || !gpu.copies_depth).then(|| Resolve::new(gpu, samples, [colour, ids, depth], bytes));
        Self { width, height, middles, corners, readback, resolve }
    }

    /// Whether pictures of this size and quality can be drawn to them.
    pub(crate) fn is_for(&self, width: u32, height: u32, means: Means) -> bool {
        let samples = [self.middles.colour.width(), self.middles.colour.height()];
        let fits = samples == [width, height].map(|side| side * means.samples);
        fits && (self.width, self.height) == (width, height) && self.corners.is_some() == means.corners
    }

    /// Bytes a plane takes in the read-back buffer.
    pub(super) fn plane_bytes(&self) -> u64 {
        plane_bytes(self.width, self.height)
    }
}

/// Bytes that a row of so many samples takes in the read-back buffer.
pub(super) fn stride_bytes(width: u32) -> u32 {
    (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

fn plane_bytes(width: u32, height: u32) -> u64 {
    u64::from(stride_bytes(width)) * u64::from(height)
}
