//! Bilinear upsampling and argmax, fused: logits of low resolution to a class for every pixel.
//!
//! The scores of a pixel are a convex combination of those at the four source pixels around it.
//! So where one class has the highest score at all four, it has the highest at every pixel
//! between them, and such cells (most of a street) are filled without interpolation.

use std::ops::Range;

use crate::metadata::ScoreKind;
use crate::onnx::Output;
use crate::simd::vectorised;
use crate::taps::{Enlarge, Taps};

/// Pixels that are interpolated at a time: neighbours in a cell, or one in each of neighbouring cells.
const LANES: usize = 8;
/// Pixels of each cell that are interpolated at a time where neighbouring cells are.
const BESIDE: usize = 2;

/// How sure a network is of every pixel, row by row from the top.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Certainty {
    /// Probability of the class with the highest one: 1 over the number of classes where all are alike, 1 where one
    /// stands alone.
    pub confidence: Vec<f32>,
    /// Entropy of the probabilities as a share of the greatest: 1 where all are alike, 0 where one stands alone.
    pub entropy: Vec<f32>,
}

/// How the scores lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Grid {
    pub channels: usize,
    pub width: usize,
    pub height: usize,
    /// Channels of a pixel beside each other (NHWC) instead of planes (NCHW).
    pub interleaved: bool,
}

impl Grid {
    fn channel_stride(&self) -> usize {
        if self.interleaved { 1 } else { self.width * self.height }
    }

    /// One no finer than a picture.
    pub fn within(self, width: usize, height: usize) -> Self {
        Self { width: self.width.min(width), height: self.height.min(height), ..self }
    }

    fn pixel_stride(&self) -> usize {
        if self.interleaved { self.channels } else { 1 }
    }
}

/// Turns scores on a grid into class indices on a picture of another size.
#[derive(Clone)]
pub(crate) struct Decoder {
    grid: Grid,
    width: usize,
    height: usize,
    columns: Vec<Span>,
    rows: Vec<Span>,
    /// All columns; none where scores of neighbours do not lie beside each other.
    blocks: Vec<Block>,
}

/// Neighbouring spans along an axis, a lane each. The last block overlaps the one before.
#[derive(Clone)]
struct Block {
    /// The first of its spans.
    first: usize,
    /// Weights of the right source pixel, for each pixel of the longest of its spans, padded to whole steps.
    weights: Vec<[[f32; LANES]; BESIDE]>,
}

impl Block {
    fn all(spans: &[Span]) -> Vec<Self> {
        let is_row =
            spans.iter().enumerate().all(|(i, span)| span.left == spans[0].left + i && span.right == span.left + 1);
        if spans.len() < LANES || !is_row {
            return Vec::new();
        }
        let firsts = (0..spans.len()).step_by(LANES).map(|first| first.min(spans.len() - LANES));
        firsts.map(|first| Self::of(first, &spans[first..][..LANES])).collect()
    }

    fn of(first: usize, spans: &[Span]) -> Self {
        let longest = spans.iter().map(|span| span.pixels.len()).fold(0, usize::max);
        let weight = |lane: usize, pixel: usize| spans[lane].weights.get(pixel).copied().unwrap_or(0.0);
        let step = |from: usize| std::array::from_fn(|i| std::array::from_fn(|lane| weight(lane, from + i)));
        Self { first, weights: (0..longest).step_by(BESIDE).map(step).collect() }
    }
}

/// The output pixels between two neighbouring source pixels along one axis.
#[derive(Clone)]
struct Span {
    left: usize,
    right: usize,
    pixels: Range<usize>,
    /// Weight of the right source pixel for each output pixel, padded to whole lanes.
    weights: Vec<f32>,
}

impl Span {
    fn nearest(&self) -> impl Iterator<Item = usize> + '_ {
        let side = |weight: &f32| if *weight < 0.5 { self.left } else { self.right };
        self.weights[..self.pixels.len()].iter().map(side)
    }
}

fn spans(from: usize, to: usize, how: Enlarge) -> Vec<Span> {
    let taps = Taps::enlarging(from, to, how);
    let mut spans: Vec<Span> = Vec::new();
    for (i, &left) in taps.left.iter().enumerate() {
        match spans.last_mut().filter(|span| span.left == left) {
            Some(span) => span.pixels.end = i + 1,
            None => spans.push(Span { left, right: taps.right(i, from), pixels: i..i + 1, weights: vec![] }),
        }
    }
    for span in &mut spans {
        span.weights = taps.weight[span.pixels.clone()].to_vec();
        span.weights.resize(span.pixels.len().next_multiple_of(LANES), 0.0);
    }
    spans
}

impl Decoder {
    /// For scores on `grid` and a picture of `width` x `height` pixels.
    pub fn new(grid: Grid, width: usize, height: usize, how: Enlarge) -> Self {
        let columns = spans(grid.width, width, how);
        let rows = spans(grid.height, height, how);
        let blocks = if grid.interleaved { Vec::new() } else { Block::all(&columns) };
        Self { grid, width, height, columns, rows, blocks }
    }

    /// An output whose scores lie as this one's in planes, the order in which devices are compared.
    pub fn in_planes(&self, output: Output) -> Output {
        match output {
            Output::Scores(scores) if self.grid.interleaved => {
                let plane = |channel| scores.iter().skip(channel).step_by(self.grid.channels).copied();
                Output::Scores((0..self.grid.channels).flat_map(plane).collect())
            }
            other => other,
        }
    }

    /// The index of the highest score at every pixel; the lowest index where several are equal.
    pub fn classes(&self, scores: &[f32]) -> Vec<u8> {
        vectorised(
            #[inline(always)]
            || self.chosen(scores),
        )
    }

    #[inline(always)]
    fn chosen(&self, scores: &[f32]) -> Vec<u8> {
        let coarse = argmax(&self.grid, scores);
        if (self.grid.width, self.grid.height) == (self.width, self.height) {
            return coarse;
        }
        let mut out = vec![0; self.width * self.height];
        for row in &self.rows {
            for block in &self.blocks {
                self.fill_block(scores, &coarse, (row, block), &mut out);
            }
            for column in if self.blocks.is_empty() { &self.columns[..] } else { &[] } {
                match self.class_of_all(&coarse, row, column) {
                    Some(class) => self.fill(class, row, column, &mut out),
                    None => self.interpolate(scores, self.corners(row, column), row, column, &mut out),
                }
            }
        }
        out
    }

    /// The class of all four source pixels around a cell, if it is one.
    #[inline(always)]
    fn class_of_all(&self, coarse: &[u8], row: &Span, column: &Span) -> Option<u8> {
        let [first, others @ ..] = self.corners(row, column).map(|corner| coarse[corner]);
        others.iter().all(|class| *class == first).then_some(first)
    }

    #[inline(always)]
    fn fill(&self, class: u8, row: &Span, column: &Span, out: &mut [u8]) {
        for y in row.pixels.clone() {
            out[y * self.width..][column.pixels.clone()].fill(class);
        }
    }

    /// Fills the cells of a block: where one class has it all, with that, and the others together.
    #[inline(always)]
    fn fill_block(&self, scores: &[f32], coarse: &[u8], (row, block): (&Span, &Block), out: &mut [u8]) {
        let columns = &self.columns[block.first..][..LANES];
        let classes: [Option<u8>; LANES] = std::array::from_fn(|lane| self.class_of_all(coarse, row, &columns[lane]));
        for (column, class) in columns.iter().zip(classes) {
            if let Some(class) = class {
                self.fill(class, row, column, out);
            }
        }
        if classes.iter().any(Option::is_none) {
            self.interpolate_block(scores, &classes, (row, block), out);
        }
    }

    /// Fills those cells of a block that have no class yet.
    #[inline(always)]
    fn interpolate_block(
        &self,
        scores: &[f32],
        classes: &[Option<u8>; LANES],
        (row, block): (&Span, &Block),
        out: &mut [u8],
    ) {
        let columns = &self.columns[block.first..][..LANES];
        let plane = self.grid.width * self.grid.height;
        let [above, below] = [row.left, row.right].map(|y| &scores[y * self.grid.width + columns[0].left..]);
        for (y, &down) in row.pixels.clone().zip(&row.weights) {
            for (step, weights) in block.weights.iter().enumerate() {
                let mut best = [[f32::NEG_INFINITY; LANES]; BESIDE];
                let mut class = [[0u32; LANES]; BESIDE];
                for channel in 0..self.grid.channels {
                    let [above, below] = [above, below].map(|scores| &scores[channel * plane..][..LANES + 1]);
                    let mixed = |side: usize| -> [f32; LANES] {
                        let (above, below) = (&above[side..][..LANES], &below[side..][..LANES]);
                        std::array::from_fn(|lane| above[lane] + (below[lane] - above[lane]) * down)
                    };
                    let (left, right) = (mixed(0), mixed(1));
                    for pixel in 0..BESIDE {
                        for lane in 0..LANES {
                            let score = left[lane] + (right[lane] - left[lane]) * weights[pixel][lane];
                            let better = score > best[pixel][lane];
                            best[pixel][lane] = if better { score } else { best[pixel][lane] };
                            class[pixel][lane] = if better { channel as u32 } else { class[pixel][lane] };
                        }
                    }
                }
                let line = &mut out[y * self.width..][..self.width];
                for (lane, column) in columns.iter().enumerate().filter(|(lane, _)| classes[*lane].is_none()) {
                    let pixels = column.pixels.clone().skip(step * BESIDE);
                    pixels.zip(&class).for_each(|(x, class)| line[x] = class[lane] as u8);
                }
            }
        }
    }

    /// How sure the scores are at every pixel.
    pub fn certainty(&self, scores: &[f32], kind: ScoreKind) -> Certainty {
        let (step, stride) = (self.grid.pixel_stride(), self.grid.channel_stride());
        let pixels = self.width * self.height;
        let mut certainty = Certainty { confidence: vec![0.0; pixels], entropy: vec![0.0; pixels] };
        let mut mixed = vec![0.0; self.grid.channels];
        for row in &self.rows {
            for column in &self.columns {
                let corners = self.corners(row, column).map(|corner| &scores[corner * step..]);
                for (y, &down) in row.pixels.clone().zip(&row.weights) {
                    for (x, &along) in column.pixels.clone().zip(&column.weights) {
                        for (channel, mixed) in mixed.iter_mut().enumerate() {
                            let [a, b, c, d] = corners.map(|scores| scores[channel * stride]);
                            let (left, right) = (a + (c - a) * down, b + (d - b) * down);
                            *mixed = left + (right - left) * along;
                        }
                        let pixel = y * self.width + x;
                        kind.distribute(&mut mixed);
                        certainty.confidence[pixel] = mixed.iter().copied().fold(0.0, f32::max);
                        certainty.entropy[pixel] = entropy(&mixed);
                    }
                }
            }
        }
        certainty
    }

    /// The four source pixels around a cell: upper left and right, lower left and right.
    fn corners(&self, row: &Span, column: &Span) -> [usize; 4] {
        let at = |x: usize, y: usize| y * self.grid.width + x;
        [at(column.left, row.left), at(column.right, row.left), at(column.left, row.right), at(column.right, row.right)]
    }

    /// A class map as it is, resized to the picture: every pixel takes the nearest source pixel.
    pub fn nearest(&self, ids: &[i64]) -> Vec<i64> {
        let mut out = Vec::with_capacity(self.width * self.height);
        for y in self.rows.iter().flat_map(Span::nearest) {
            let line = &ids[y * self.grid.width..];
            out.extend(self.columns.iter().flat_map(Span::nearest).map(|x| line[x]));
        }
        out
    }

    /// Fills the cell between four source pixels.
    #[inline(always)]
    fn interpolate(&self, scores: &[f32], corners: [usize; 4], row: &Span, column: &Span, out: &mut [u8]) {
        let (step, stride) = (self.grid.pixel_stride(), self.grid.channel_stride());
        let corners = corners.map(|corner| &scores[corner * step..]);
        for (y, &down) in row.pixels.clone().zip(&row.weights) {
            let line = &mut out[y * self.width..][column.pixels.clone()];
            for (line, weights) in line.chunks_mut(LANES).zip(column.weights.as_chunks::<LANES>().0) {
                let mut best = [f32::NEG_INFINITY; LANES];
                let mut class = [0u32; LANES];
                for channel in 0..self.grid.channels {
                    let [a, b, c, d] = corners.map(|scores| scores[channel * stride]);
                    let left = a + (c - a) * down;
                    let slope = b + (d - b) * down - left;
                    for lane in 0..LANES {
                        let score = left + slope * weights[lane];
                        let better = score > best[lane];
                        best[lane] = if better { score } else { best[lane] };
                        class[lane] = if better { channel as u32 } else { class[lane] };
                    }
                }
                for (pixel, class) in line.iter_mut().zip(class) {
                    *pixel = class as u8;
                }
            }
        }
    }
}

/// The index of the highest score of each source pixel.
#[inline(always)]
fn argmax(grid: &Grid, scores: &[f32]) -> Vec<u8> {
    let pixels = grid.width * grid.height;
    let mut class = vec![0u8; pixels];
    if grid.interleaved {
        for (class, scores) in class.iter_mut().zip(scores.chunks_exact(grid.channels)) {
            let first_highest = |best: usize, i: usize| if scores[i] > scores[best] { i } else { best };
            *class = (1..grid.channels).fold(0, first_highest) as u8;
        }
        return class;
    }
    let mut best = scores[..pixels].to_vec();
    for (channel, plane) in scores.chunks_exact(pixels).enumerate().skip(1) {
        for ((best, class), &score) in best.iter_mut().zip(&mut class).zip(plane) {
            let better = score > *best;
            *best = if better { score } else { *best };
            *class = if better { channel as u8 } else { *class };
        }
    }
    class
}

impl ScoreKind {
    /// Makes probabilities of the scores of a pixel, in place.
    fn distribute(self, scores: &mut [f32]) {
        match self {
            Self::Logits => {
                let highest = scores.iter().copied().fold(f32::NEG_INFINITY, f32::max);
                scores.iter_mut().for_each(|score| *score = (*score - highest).exp());
            }
            // What a network rounds below 0 is none.
            Self::Probabilities => scores.iter_mut().for_each(|score| *score = score.max(0.0)),
        }
        let sum: f32 = scores.iter().sum();
        // Where nothing has a score, all are alike.
        let alike = 1.0 / scores.len() as f32;
        scores.iter_mut().for_each(|score| *score = if sum > 0.0 { *score / sum } else { alike });
    }
}

/// That of probabilities, as a share of the greatest.
fn entropy(probabilities: &[f32]) -> f32 {
    let nats: f32 = probabilities.iter().filter(|p| **p > 0.0).map(|p| -p * p.ln()).sum();
    if probabilities.len() > 1 { (nats / (probabilities.len() as f32).ln()).clamp(0.0, 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Scores without any order, the same in both memory layouts.
    fn scores(grid: &Grid, seed: u32) -> Vec<f32> {
        let value = |c: usize, y: usize, x: usize| {
            let mixed = ((c * 64 + y) * 64 + x + 1).wrapping_mul(0x9e37_79b9) as u32 ^ seed.wrapping_mul(0x85eb_ca6b);
            (mixed.wrapping_mul(0xc2b2_ae35) >> 8) as f32 / (1 << 24) as f32
        };
        let mut out = vec![0.0; grid.channels * grid.width * grid.height];
        for y in 0..grid.height {
            for x in 0..grid.width {
                for c in 0..grid.channels {
                    let pixel = y * grid.width + x;
                    out[pixel * grid.pixel_stride() + c * grid.channel_stride()] = value(c, y, x);
                }
            }
        }
        out
    }

    fn how(align: bool) -> Enlarge {
        if align { Enlarge::AlignCorners } else { Enlarge::HalfPixel }
    }

    /// Scores of one output pixel by the textbook, in f64.
    fn upsampled(d: &Decoder, scores: &[f32], align: bool, x: usize, y: usize) -> Vec<f64> {
        let g = &d.grid;
        let place = |i: usize, from: usize, to: usize| match align {
            true => i as f64 * (from - 1) as f64 / (to - 1) as f64,
            false => ((i as f64 + 0.5) * from as f64 / to as f64 - 0.5).clamp(0.0, (from - 1) as f64),
        };
        let (sx, sy) = (place(x, g.width, d.width), place(y, g.height, d.height));
        let mut sums = vec![0.0; g.channels];
        for v in 0..g.height {
            for u in 0..g.width {
                let weight = (1.0 - (sx - u as f64).abs()).max(0.0) * (1.0 - (sy - v as f64).abs()).max(0.0);
                for (c, sum) in sums.iter_mut().enumerate() {
                    let at = (v * g.width + u) * g.pixel_stride() + c * g.channel_stride();
                    *sum += weight * f64::from(scores[at]);
                }
            }
        }
        sums
    }

    #[test]
    fn scores_are_compared_in_one_order() {
        let grid = |interleaved| Grid { channels: 3, width: 5, height: 2, interleaved };
        let ordered = |interleaved| {
            let grid = grid(interleaved);
            let decoder = Decoder::new(grid, 10, 4, Enlarge::HalfPixel);
            match decoder.in_planes(Output::Scores(scores(&grid, 7))) {
                Output::Scores(scores) => scores,
                Output::Ids(ids) => panic!("{ids:?} are no scores"),
            }
        };
        assert_eq!(ordered(true), ordered(false));
        assert_eq!(ordered(false), scores(&grid(false), 7));
    }

    #[test]
    fn agrees_with_the_textbook() {
        let sizes = [((8, 4), (64, 32)), ((5, 3), (17, 11)), ((16, 8), (16, 8)), ((9, 6), (7, 5)), ((2, 1), (30, 9))];
        let sizes = sizes.into_iter().chain([((20, 6), (50, 20)), ((16, 8), (32, 16)), ((9, 4), (81, 9))]);
        for (seed, ((w, h), (width, height))) in sizes.enumerate() {
            for (interleaved, align) in [(false, false), (true, false), (false, true), (true, true)] {
                let grid = Grid { channels: 16, width: w, height: h, interleaved };
                let decoder = Decoder::new(grid, width, height, how(align));
                let scores = scores(&grid, seed as u32);
                let classes = decoder.classes(&scores);
                for (i, &class) in classes.iter().enumerate() {
                    let sums = upsampled(&decoder, &scores, align, i % width, i / width);
                    let highest = sums.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                    let below = highest - sums[usize::from(class)];
                    assert!(below < 1e-4, "{w}x{h} to {width}x{height}: pixel {i} is {below} below the highest");
                }
                assert!(classes.iter().any(|c| *c != classes[0]), "the scores must form several areas");
            }
        }
    }

    #[test]
    fn certainty_agrees_with_the_textbook() {
        for (interleaved, align, (width, height)) in
            [(false, false, (17, 11)), (true, true, (17, 11)), (true, false, (5, 3))]
        {
            let grid = Grid { channels: 16, width: 5, height: 3, interleaved };
            let decoder = Decoder::new(grid, width, height, how(align));
            let scores: Vec<f32> = scores(&grid, 7).iter().map(|score| 9.0 * score).collect();
            for kind in [ScoreKind::Logits, ScoreKind::Probabilities] {
                let Certainty { confidence, entropy } = decoder.certainty(&scores, kind);
                for (i, (&sure, &doubt)) in confidence.iter().zip(&entropy).enumerate() {
                    let sums = upsampled(&decoder, &scores, align, i % width, i / width).into_iter();
                    let shares: Vec<f64> = sums.map(|s| if kind == ScoreKind::Logits { s.exp() } else { s }).collect();
                    let p = shares.iter().map(|share| share / shares.iter().sum::<f64>());
                    let highest = p.clone().fold(0.0, f64::max);
                    let nats = p.map(|p| -p * p.ln()).sum::<f64>() / 16f64.ln();
                    assert!((f64::from(sure) - highest).abs() < 1e-4, "pixel {i}: {sure}, expected {highest}");
                    assert!((f64::from(doubt) - nats).abs() < 1e-4, "pixel {i}: {doubt}, expected {nats}");
                }
            }
        }
    }

    #[test]
    fn equal_scores_are_the_least_confidence() {
        let grid = Grid { channels: 4, width: 2, height: 2, interleaved: false };
        for (kind, score) in
            [(ScoreKind::Logits, 800.0), (ScoreKind::Probabilities, 0.25), (ScoreKind::Probabilities, 0.0)]
        {
            let certainty = Decoder::new(grid, 3, 3, Enlarge::HalfPixel).certainty(&[score; 16], kind);
            assert_eq!(certainty, Certainty { confidence: vec![0.25; 9], entropy: vec![1.0; 9] });
        }
    }

    #[test]
    fn both_memory_layouts_give_the_same_classes() {
        for (width, height, size) in
            [(6, 4, (48, 32)), (21, 4, (42, 8)), (21, 4, (64, 9)), (9, 3, (81, 30)), (300, 2, (333, 4))]
        {
            for how in [Enlarge::HalfPixel, Enlarge::AlignCorners, Enlarge::Nearest] {
                let planes = Grid { channels: 5, width, height, interleaved: false };
                let pixels = Grid { interleaved: true, ..planes };
                let of = |grid: Grid| Decoder::new(grid, size.0, size.1, how).classes(&scores(&grid, 3));
                assert_eq!(of(planes), of(pixels), "{width}x{height} to {size:?}, {how:?}");
            }
        }
    }

    #[test]
    fn class_maps_are_resized_to_the_nearest() {
        let grid = Grid { channels: 1, width: 2, height: 2, interleaved: false };
        let ids = Decoder::new(grid, 4, 4, Enlarge::HalfPixel).nearest(&[1, 2, 3, 4]);
        assert_eq!(ids, [1, 1, 2, 2, 1, 1, 2, 2, 3, 3, 4, 4, 3, 3, 4, 4]);
    }

    #[test]
    fn nearest_neighbours_give_the_class_of_a_source_pixel() {
        let grid = Grid { channels: 5, width: 6, height: 4, interleaved: true };
        let scores = scores(&grid, 3);
        let coarse = argmax(&grid, &scores);
        let classes = Decoder::new(grid, 18, 10, Enlarge::Nearest).classes(&scores);
        let source = |i: usize| i / 18 * 4 / 10 * 6 + i % 18 * 6 / 18;
        assert!(classes.iter().enumerate().all(|(i, class)| *class == coarse[source(i)]));
    }

    #[test]
    fn the_first_of_equal_scores_wins() {
        let grid = Grid { channels: 3, width: 2, height: 2, interleaved: false };
        assert!(Decoder::new(grid, 8, 8, Enlarge::HalfPixel).classes(&[1.0; 12]).iter().all(|class| *class == 0));
    }
}
