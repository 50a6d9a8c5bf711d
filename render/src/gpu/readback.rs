//! From targets to a [`Frame`].

use kernel::time::Tick;

use super::targets::{CornerTargets, stride_bytes};
use super::{Gpu, Targets};
use crate::corners::{Corners, Row};
use crate::quincunx::Quincunx;
use crate::{Frame, RenderError, SemanticTag};

/// Distance at which depth is 1, metres; as in `scene.wgsl`.
pub(crate) const NEAR_M: f32 = 0.1;

/// What pixels' middles say of their corners.
pub(crate) struct Middles {
    /// Depth of each corner, as far as they agree on it, else 0.
    pub(crate) known: Vec<f32>,
    /// Their colours, four bytes each.
    colours: Vec<u8>,
}

impl Middles {
    /// The same with nothing known of corners.
    #[cfg(test)]
    pub(crate) fn unknown(self) -> Self {
        Self { known: vec![0.0; self.known.len()], ..self }
    }

    /// What is known of the corners, 1 over metres ahead of the eye.
    pub(crate) fn nearness(&self) -> impl Iterator<Item = f32> {
        self.known.iter().map(|depth| depth * (1.0 / NEAR_M))
    }
}

/// Records the way from the targets to the read-back buffer.
pub(super) fn record(encoder: &mut wgpu::CommandEncoder, targets: &Targets, colours: bool) {
    let Targets { width, height, ref middles, ref readback, ref resolve, .. } = *targets;
    if let Some(resolve) = resolve {
        return resolve.record(encoder, [width, height], readback);
    }
    let mut copy = |plane: u64, texture: &wgpu::Texture| {
        copy(encoder, texture, readback, plane * targets.plane_bytes());
    };
    copy(1, &middles.ids);
    copy(2, &middles.depth);
    if colours {
        copy(0, &middles.colour);
    }
}

/// Records the way from the corners' colours to their read-back buffer.
pub(super) fn record_corners(encoder: &mut wgpu::CommandEncoder, corners: &CornerTargets) {
    copy(encoder, &corners.samples.colour, &corners.readback, 0);
}

fn copy(encoder: &mut wgpu::CommandEncoder, texture: &wgpu::Texture, buffer: &wgpu::Buffer, offset: u64) {
    let bytes_per_row = Some(stride_bytes(texture.width()));
    let layout = wgpu::TexelCopyBufferLayout { offset, bytes_per_row, rows_per_image: None };
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer, layout },
        texture.size(),
    );
}

/// Waits for what was submitted last and reads a buffer.
fn read<T>(gpu: &Gpu, buffer: &wgpu::Buffer, tick: Tick, take: impl FnOnce(&[u8]) -> T) -> Result<T, RenderError> {
    let failed = |reason: String| RenderError::Readback { tick, reason };
    buffer.map_async(wgpu::MapMode::Read, .., |_| ());
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| failed(e.to_string()))?;
    if let Some(reason) = gpu.failure() {
        return Err(failed(reason));
    }
    let bytes = buffer.get_mapped_range(..).map_err(|e| failed(e.to_string()))?;
    let taken = take(&bytes);
    drop(bytes);
    buffer.unmap();
    Ok(taken)
}

impl Targets {
    /// Waits for the planes that were submitted last and reads them, with or without colours.
    pub(crate) fn read(&self, gpu: &Gpu, tick: Tick, colours: bool) -> Result<Frame, RenderError> {
        read(gpu, &self.readback, tick, |bytes| self.frame(tick, bytes, colours))
    }

    /// The same, and says what is known of the corners: what is drawn there has a depth above this, row by row. The colours are the
    /// middles', of four bytes.
    pub(crate) fn read_middles(&self, gpu: &Gpu, tick: Tick) -> Result<(Frame, Middles), RenderError> {
        read(gpu, &self.readback, tick, |bytes| {
            let corners = ((self.width + 1) * (self.height + 1)) as usize;
            let colours = Vec::with_capacity(4 * (self.width * self.height) as usize);
            let mut middles = Middles { known: Vec::with_capacity(corners), colours };
            let row = |y: usize| {
                let [colours, ids, depths] = [0, 1, 2].map(|plane| self.row(bytes, plane, y));
                Row { colours, ids, depths }
            };
            let (last, mut corners) = (self.height as usize - 1, Corners::default());
            for y in 0..=last + 1 {
                corners.row(row(y.saturating_sub(1)), row(y.min(last)), &mut middles.known);
            }
            self.rows(bytes, 0).for_each(|row| middles.colours.extend_from_slice(row));
            (self.frame(tick, bytes, false), middles)
        })
    }

    /// Waits for the corners' colours and mixes them with the middles'.
    pub(crate) fn read_corners(&self, gpu: &Gpu, tick: Tick, middles: &Middles) -> Result<Vec<u8>, RenderError> {
        let Some(corners) = &self.corners else { return Ok(Vec::new()) };
        read(gpu, &corners.readback, tick, |bytes| {
            let mut rgb = vec![0; 3 * (self.width * self.height) as usize];
            let (width, mut quincunx) = (self.width as usize, Quincunx::default());
            let pixels: Vec<&[u8]> = middles.colours.chunks_exact(4 * width).collect();
            let mut drawn =
                bytes.chunks_exact(stride_bytes(self.width + 1) as usize).map(|row| &row[..4 * (width + 1)]);
            drawn.next().into_iter().for_each(|row| quincunx.corners([pixels[0]; 2], row));
            for (y, (row, drawn)) in rgb.chunks_exact_mut(3 * width).zip(drawn).enumerate() {
                quincunx.corners([pixels[y], pixels[(y + 1).min(pixels.len() - 1)]], drawn);
                fill(row, quincunx.row(pixels[y]));
            }
            rgb
        })
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
        let rows = self.rows(bytes, 0).zip(rgb.chunks_exact_mut(3 * self.width as usize));
        rows.for_each(|(pixels, row)| fill(row, pixels));
        rgb
    }

    fn rows<'a>(&self, bytes: &'a [u8], plane: usize) -> impl Iterator<Item = &'a [u8]> {
        (0..self.height as usize).map(move |y| self.row(bytes, plane, y))
    }

    fn row<'a>(&self, bytes: &'a [u8], plane: usize, y: usize) -> &'a [u8] {
        let start = plane * self.plane_bytes() as usize + y * stride_bytes(self.width) as usize;
        &bytes[start..][..4 * self.width as usize]
    }
}

/// Makes three bytes a pixel of four.
fn fill(row: &mut [u8], pixels: &[u8]) {
    let pixels = row.as_chunks_mut::<3>().0.iter_mut().zip(pixels.as_chunks::<4>().0);
    pixels.for_each(|(to, &[r, g, b, _])| *to = [r, g, b]);
}

/// CARLA's tag for each fine tag.
fn coarse_table() -> [u8; 256] {
    let mut table = [0; 256];
    for &tag in SemanticTag::ALL {
        table[tag as usize] = tag.coarse() as u8;
    }
    table
}
