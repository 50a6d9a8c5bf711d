//! A window that moves over a map: of a convolution or a pool.

use std::cell::Cell;
use std::ops::Range;

use tract_onnx::tract_core::ops::cnn::PoolSpec;

/// Floats of a band of the input that is worked on at once: a quarter of a usual second-level cache.
const BAND: usize = 1 << 16;

thread_local! {
    /// Where bands are padded: as large as the largest one was, with what was left there, all of which is written over.
    static SCRATCH: Cell<Vec<f32>> = const { Cell::new(Vec::new()) };
}

/// Sizes in pixels, rows before columns, of a window with its way over a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    pub input: [usize; 2],
    pub output: [usize; 2],
    pub kernel: [usize; 2],
    pub stride: [usize; 2],
    pub dilation: [usize; 2],
    /// Rows and columns of padding before the input.
    pub before: [usize; 2],
}

impl Window {
    /// The window of an operator of the engine's over maps of a size.
    pub fn new(spec: &PoolSpec, input: [usize; 2]) -> Option<Self> {
        let &[rows, cols] = spec.kernel_shape.as_slice() else { return None };
        let padding = spec.computed_padding(&input);
        let window = Self {
            input,
            output: [padding[0].convoluted, padding[1].convoluted],
            kernel: [rows, cols],
            stride: [spec.stride(0), spec.stride(1)],
            dilation: [spec.dilation(0), spec.dilation(1)],
            before: [padding[0].pad_before, padding[1].pad_before],
        };
        (window.input.iter().chain(&window.output).all(|n| *n > 0)).then_some(window)
    }

    /// Rows or columns that the window reads for so many outputs.
    fn reach(&self, axis: usize, outputs: usize) -> usize {
        (outputs - 1) * self.stride[axis] + (self.kernel[axis] - 1) * self.dilation[axis] + 1
    }

    /// Whether it reads beyond the input.
    pub fn is_padded(&self) -> bool {
        (0..2).any(|axis| self.before[axis] > 0 || self.reach(axis, self.output[axis]) > self.input[axis])
    }

    /// Pixels of the input with its padding.
    pub fn padded_area(&self) -> usize {
        self.reach(0, self.output[0]).saturating_mul(self.reach(1, self.output[1]))
    }

    /// Columns from one row to the next of what [`Self::bands`] gives.
    pub fn pitch(&self) -> usize {
        if self.is_padded() { self.reach(1, self.output[1]) } else { self.input[1] }
    }

    /// Where each tap lies from the first one, in floats of a map with so many channels.
    pub fn taps(&self, channels: usize) -> impl Iterator<Item = usize> {
        let (pitch, [row, col]) = (self.pitch(), self.dilation);
        let cols = self.kernel[1];
        (0..self.kernel[0] * cols).map(move |tap| (tap / cols * row * pitch + tap % cols * col) * channels)
    }

    /// Where the window of each output pixel of so many rows begins, in floats.
    pub fn starts(&self, rows: usize, channels: usize) -> Vec<usize> {
        let (pitch, [down, along]) = (self.pitch(), self.stride);
        let mut starts = Vec::with_capacity(rows * self.output[1]);
        for row in 0..rows {
            let first = row * down * pitch;
            starts.extend((0..self.output[1]).map(|col| (first + col * along) * channels));
        }
        starts
    }

    /// Visits a map band by band, from top to bottom: with the part of the input that a band of output rows reads, its
    /// padding filled in, and with those rows.
    pub fn bands(&self, x: &[f32], channels: usize, fill: f32, mut visit: impl FnMut(&[f32], Range<usize>)) {
        let (pitch, is_padded) = (self.pitch(), self.is_padded());
        let rows = (BAND / (pitch * channels)).saturating_sub(self.reach(0, 1)) / self.stride[0] + 1;
        let mut scratch = if is_padded { SCRATCH.take() } else { Vec::new() };
        for from in (0..self.output[0]).step_by(rows) {
            let band = from..(from + rows).min(self.output[0]);
            let top = from * self.stride[0];
            if is_padded {
                let length = self.reach(0, band.len()) * pitch * channels;
                scratch.resize(length.max(scratch.len()), fill);
                self.pad(x, channels, fill, top, &mut scratch[..length]);
                visit(&scratch[..length], band);
            } else {
                visit(&x[top * pitch * channels..], band);
            }
        }
        if is_padded {
            SCRATCH.set(scratch);
        }
    }

    /// Writes padded rows from a row on.
    fn pad(&self, x: &[f32], channels: usize, fill: f32, top: usize, padded: &mut [f32]) {
        let pitch = self.pitch();
        let left = self.before[1].min(pitch);
        let cols = self.input[1].min(pitch - left);
        for (row, padded) in padded.chunks_exact_mut(pitch * channels).enumerate() {
            let from = (top + row).checked_sub(self.before[0]).filter(|row| *row < self.input[0]);
            let Some(from) = from else {
                padded.fill(fill);
                continue;
            };
            let line = &x[from * self.input[1] * channels..][..cols * channels];
            padded[..left * channels].fill(fill);
            padded[left * channels..][..line.len()].copy_from_slice(line);
            padded[(left + cols) * channels..].fill(fill);
        }
    }
}
