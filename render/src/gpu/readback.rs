//! From targets to a [`Frame`].

use kernel::time::Tick;

use super::targets::stride_bytes;
use super::{Gpu, Targets};
use crate::quincunx::Quincunx;
use crate::{Frame, RenderError, SemanticTag};

/// Distance at which depth is 1, metres; as in `scene.wgsl`.
const NEAR_M: f32 = 0.1;

/// Plane of the corners' colours, behind colours, ids and depth.
const CORNERS: u64 = 3;

/// Records the way from the targets to the read-back buffer.
pub(super) fn record(encoder: &mut wgpu::CommandEncoder, targets: &Targets, colours: bool) {
    let Targets { width, height, ref middles, ref corners, ref readback, ref resolve } = *targets;
    if let Some(resolve) = resolve {
        return resolve.record(encoder, [width, height], readback);
    }
    let mut copy = |plane: u64, texture: &wgpu::Texture| {
        let offset = plane * targets.plane_bytes();
        let bytes_per_row = Some(stride_bytes(texture.width()));
        let layout = wgpu::TexelCopyBufferLayout { offset, bytes_per_row, rows_per_image: None };
        let buffer = wgpu::TexelCopyBufferInfo { buffer: readback, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), buffer, texture.size());
    };
    copy(1, &middles.ids);
    copy(2, &middles.depth);
    if colours {
        copy(0, &middles.colour);
        corners.iter().for_each(|corners| copy(CORNERS, &corners.colour));
    }
}

impl Targets {
    /// Waits for the frame that was submitted last and reads it, with or without its colours.
    pub(crate) fn read(&self, gpu: &Gpu, tick: Tick, colours: bool) -> Result<Frame, RenderError> {
        let failed = |reason: String| RenderError::Readback { tick, reason };
        self.readback.map_async(wgpu::MapMode::Read, .., |_| ());
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| failed(e.to_string()))?;
        if let Some(reason) = gpu.failure() {
            return Err(failed(reason));
        }
        let bytes = self.readback.get_mapped_range(..).map_err(|e| failed(e.to_string()))?;
        let frame = self.frame(tick, &bytes, colours);
        drop(bytes);
        self.readback.unmap();
        Ok(frame)
    }

    fn frame(&self, tick: Tick, bytes: &[u8], colours: bool) -> Frame {
        let pixels = (self.width * self.height) as usize;
        let mut frame = Frame { tick, width: self.width, height: self.height, ..Default::default() };
        if colours {
            frame.rgb = self.rgb(bytes);
        }
        frame.class_ids.reserve_exact(pixels);
        frame.fine_ids.reserve_exact(pixels);
        frame.instance_ids.reserve_exact(pixels);
        frame.depth_m.reserve_exact(pixels);
        let coarse = coarse_table();
        for row in self.rows(bytes, 1) {
            let ids = row.as_chunks::<4>().0;
            frame.fine_ids.extend(ids.iter().map(|&[tag, ..]| tag));
            frame.class_ids.extend(ids.iter().map(|&[tag, ..]| coarse[tag as usize]));
            frame.instance_ids.extend(ids.iter().map(|&[_, _, low, high]| u16::from_le_bytes([low, high])));
        }
        for row in self.rows(bytes, 2) {
            frame.depth_m.extend(row.as_chunks::<4>().0.iter().map(|&depth| NEAR_M / f32::from_le_bytes(depth)));
        }
        frame
    }

    fn rgb(&self, bytes: &[u8]) -> Vec<u8> {
        let mut rgb = vec![0; 3 * (self.width * self.height) as usize];
        let middles = self.rows(bytes, 0).zip(rgb.chunks_exact_mut(3 * self.width as usize));
        let fill = |row: &mut [u8], pixels: &[u8]| {
            let pixels = row.as_chunks_mut::<3>().0.iter_mut().zip(pixels.as_chunks::<4>().0);
            pixels.for_each(|(to, &[r, g, b, _])| *to = [r, g, b]);
        };
        if self.corners.is_none() {
            middles.for_each(|(pixels, row)| fill(row, pixels));
            return rgb;
        }
        let width = self.width + 1;
        let corners = || bytes[(CORNERS * self.plane_bytes()) as usize..].chunks_exact(stride_bytes(width) as usize);
        let corners = corners().zip(corners().skip(1));
        let mut quincunx = Quincunx::default();
        for ((pixels, row), (above, below)) in middles.zip(corners) {
            let [above, below] = [above, below].map(|corners| &corners[..4 * width as usize]);
            fill(row, quincunx.row(pixels, above, below));
        }
        rgb
    }

    fn rows<'a>(&self, bytes: &'a [u8], plane: usize) -> impl Iterator<Item = &'a [u8]> {
        let (size, width) = (self.plane_bytes() as usize, 4 * self.width as usize);
        bytes[plane * size..][..size].chunks_exact(stride_bytes(self.width) as usize).map(move |row| &row[..width])
    }
}

/// CARLA's tag for each fine tag.
fn coarse_table() -> [u8; 256] {
    let mut table = [0; 256];
    for &tag in SemanticTag::ALL {
        table[tag as usize] = tag.coarse() as u8;
    }
    table
}
