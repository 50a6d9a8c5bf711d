//! From targets to a [`Frame`].

use kernel::time::Tick;

use super::targets::Samples;
use super::{Gpu, Targets};
use crate::{Frame, RenderError, SemanticTag};

/// Distance at which depth is 1, metres; as in `scene.wgsl`.
const NEAR_M: f32 = 0.1;

/// Records the way from the targets to the read-back buffer.
pub(super) fn record(encoder: &mut wgpu::CommandEncoder, targets: &Targets, colours: bool) {
    let resolve = targets.resolve.as_ref();
    if let Some(resolve) = resolve.filter(|resolve| colours || resolve.planes > 1) {
        resolve.record(encoder, [targets.width, targets.height], &targets.readback);
    }
    copy(encoder, targets, resolve.map_or(0, |resolve| resolve.planes));
}

/// Copies the planes from the `first` on as they are.
fn copy(encoder: &mut wgpu::CommandEncoder, targets: &Targets, first: u32) {
    let Samples { colour, ids, depth } = &targets.middles;
    for (plane, texture) in (0..).zip([colour, ids, depth]).skip(first as usize) {
        let layout = wgpu::TexelCopyBufferLayout {
            offset: plane * targets.plane_bytes(),
            bytes_per_row: Some(targets.stride_bytes()),
            rows_per_image: None,
        };
        let buffer = wgpu::TexelCopyBufferInfo { buffer: &targets.readback, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), buffer, texture.size());
    }
}

impl Targets {
    /// Waits for the frame that was submitted last and reads it.
    pub(crate) fn read(&self, gpu: &Gpu, tick: Tick) -> Result<Frame, RenderError> {
        let failed = |reason: String| RenderError::Readback { tick, reason };
        self.readback.map_async(wgpu::MapMode::Read, .., |_| ());
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| failed(e.to_string()))?;
        if let Some(reason) = gpu.failure() {
            return Err(failed(reason));
        }
        let bytes = self.readback.get_mapped_range(..).map_err(|e| failed(e.to_string()))?;
        let frame = self.frame(tick, &bytes);
        drop(bytes);
        self.readback.unmap();
        Ok(frame)
    }

    fn frame(&self, tick: Tick, bytes: &[u8]) -> Frame {
        let pixels = (self.width * self.height) as usize;
        let mut frame = Frame { tick, width: self.width, height: self.height, ..Default::default() };
        frame.rgb.reserve_exact(3 * pixels);
        frame.class_ids.reserve_exact(pixels);
        frame.fine_ids.reserve_exact(pixels);
        frame.instance_ids.reserve_exact(pixels);
        frame.depth_m.reserve_exact(pixels);
        let coarse = coarse_table();
        for row in self.rows(bytes, 0) {
            frame.rgb.extend(row.as_chunks::<4>().0.iter().flat_map(|&[r, g, b, _]| [r, g, b]));
        }
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

    fn rows<'a>(&self, bytes: &'a [u8], plane: usize) -> impl Iterator<Item = &'a [u8]> {
        let (size, width) = (self.plane_bytes() as usize, 4 * self.width as usize);
        bytes[plane * size..][..size].chunks_exact(self.stride_bytes() as usize).map(move |row| &row[..width])
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
