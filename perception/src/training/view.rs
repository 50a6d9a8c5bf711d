//! Which part of a frame a picture shows, and where each of its pixels comes from.

use super::random::Random;

/// Where a line of a picture comes from.
#[derive(Clone, Debug)]
enum Source {
    /// A line, the next one's share, and the next one: where the frame has no more lines than the picture.
    Between { low: usize, high: usize, share: f32 },
    /// The mean over lines from `first` on, with the middle one: where the frame has more. Nothing thin is skipped.
    Mean { first: usize, weights: Vec<f32>, middle: usize },
}

impl Source {
    fn nearest(&self) -> usize {
        match *self {
            Self::Between { low, high, share } => {
                if share < 0.5 {
                    low
                } else {
                    high
                }
            }
            Self::Mean { middle, .. } => middle,
        }
    }

    /// The lines that it is made of.
    fn lines(&self) -> std::ops::Range<usize> {
        match self {
            Self::Between { low, high, .. } => *low..high + 1,
            Self::Mean { first, weights, .. } => *first..first + weights.len(),
        }
    }

    fn mix(&self, value: impl Fn(usize) -> f32) -> f32 {
        match self {
            Self::Between { low, high, share } => {
                let low = value(*low);
                if *share == 0.0 { low } else { low + share * (value(*high) - low) }
            }
            Self::Mean { first, weights, .. } => {
                weights.iter().enumerate().fold(0.0, |sum, (i, weight)| sum + weight * value(first + i))
            }
        }
    }
}

/// Where a window lies along an axis.
#[derive(Clone, Copy, Debug)]
pub(super) enum Place {
    /// Anywhere.
    Random,
    /// So that this pixel of the frame is in it, with as much as there is of a fifth of the window on either side.
    Round(u32),
}

/// An axis of a picture: a source for each of its lines.
#[derive(Clone, Debug)]
pub(super) struct Axis(Vec<Source>);

/// A random window of a `zoom`th of an axis of `from` pixels, stretched or shrunk to `to` pixels.
pub(super) fn window((from, to): (usize, usize), zoom: f32, place: Place, random: &mut Random) -> Axis {
    let chance = random.unit();
    let start = match place {
        Place::Random => chance * from as f32 * (1.0 - 1.0 / zoom),
        Place::Round(pixel) => {
            let length = from as f32 / zoom;
            (pixel as f32 + 0.5 - (0.2 + 0.6 * chance) * length).clamp(0.0, from as f32 - length)
        }
    };
    // Pixels of the picture over those of the frame.
    let density = zoom * (to as f32 / from as f32);
    let source =
        |i: usize| if density < 1.0 { mean(start, i, density, from) } else { between(start, i, density, from) };
    Axis((0..to).map(source).collect())
}

fn between(start: f32, i: usize, density: f32, from: usize) -> Source {
    let place = (start + (i as f32 + 0.5) / density - 0.5).clamp(0.0, (from - 1) as f32);
    let low = place as usize;
    Source::Between { low, high: (low + 1).min(from - 1), share: place - low as f32 }
}

fn mean(start: f32, i: usize, density: f32, from: usize) -> Source {
    let edge = |i: usize| (start + i as f32 / density).min(from as f32);
    let (low, high) = (edge(i), edge(i + 1));
    let first = (low as usize).min(from - 1);
    let end = (high.ceil() as usize).clamp(first + 1, from);
    let covered = |k: usize| (high.min((k + 1) as f32) - low.max(k as f32)).max(0.0);
    let mut weights: Vec<f32> = (first..end).map(covered).collect();
    let sum: f32 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= sum);
    Source::Mean { first, weights, middle: (low.midpoint(high) as usize).min(from - 1) }
}

impl Axis {
    pub(super) fn reverse(&mut self) {
        self.0.reverse();
    }
}

/// A part of a frame whose rows are `width` pixels.
pub(super) struct View<'a> {
    pub(super) rows: &'a Axis,
    pub(super) columns: &'a Axis,
    pub(super) width: usize,
}

impl View<'_> {
    /// Adds the picture of red, green and blue bytes, each through its table.
    pub(super) fn picture(&self, rgb: &[u8], table: &[[f32; 256]; 3], values: &mut Vec<f32>) {
        let mixed = |y: usize| -> Vec<f32> {
            let line = &rgb[y * self.width * 3..][..self.width * 3];
            let value = |c: usize, x: usize| table[c][usize::from(line[x * 3 + c])];
            self.columns.0.iter().flat_map(|column| [0, 1, 2].map(|c| column.mix(|x| value(c, x)))).collect()
        };
        // Lines that the last row was made of: the next one often needs some again.
        let mut lines: Vec<(usize, Vec<f32>)> = Vec::new();
        for row in &self.rows.0 {
            lines.retain(|(y, _)| row.lines().contains(y));
            for y in row.lines() {
                if lines.iter().all(|(known, _)| *known != y) {
                    lines.push((y, mixed(y)));
                }
            }
            lines.sort_unstable_by_key(|(y, _)| *y);
            let first = row.lines().start;
            values.extend((0..self.columns.0.len() * 3).map(|i| row.mix(|y| lines[y - first].1[i])));
        }
    }

    /// Adds the labels of the pixels in the middle of what is seen.
    pub(super) fn labels(&self, labels: &[u8], out: &mut Vec<u8>) {
        for row in &self.rows.0 {
            let line = &labels[row.nearest() * self.width..][..self.width];
            out.extend(self.columns.0.iter().map(|column| line[column.nearest()]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(source: &Source) -> f32 {
        source.mix(|y| y as f32)
    }

    #[test]
    fn a_window_covers_its_part_of_the_axis() {
        let mut random = Random::new(&[4]);
        let whole = window((8, 8), 1.0, Place::Random, &mut random);
        assert!(
            whole
                .0
                .iter()
                .enumerate()
                .all(|(i, s)| matches!(s, Source::Between { low, share, .. } if *low == i && *share == 0.0))
        );
        for _ in 0..50 {
            let half = window((8, 8), 2.0, Place::Random, &mut random).0;
            assert!(half.windows(2).all(|w| place(&w[1]) - place(&w[0]) <= 0.5 + 1e-5));
            assert!(place(&half[7]) - place(&half[0]) > 2.9);
        }
    }

    #[test]
    fn larger_frames_are_made_smaller_by_means_and_a_window_of_them_is_as_fine_as_they_are() {
        let mut random = Random::new(&[5]);
        let half = window((16, 8), 1.0, Place::Random, &mut random);
        for (i, source) in half.0.iter().enumerate() {
            assert_eq!((source.mix(|y| y as f32), source.lines()), (2.0 * i as f32 + 0.5, 2 * i..2 * i + 2));
        }
        let fine = window((16, 8), 2.0, Place::Random, &mut random).0;
        assert!(fine.windows(2).all(|w| (place(&w[1]) - place(&w[0]) - 1.0).abs() < 1e-5));
        for zoom in [1.1, 1.5, 1.9] {
            for source in window((64, 32), zoom, Place::Random, &mut random).0 {
                let Source::Mean { weights, middle, .. } = &source else { panic!("more lines than asked for") };
                assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5 && source.lines().end <= 64);
                assert!(source.lines().contains(middle));
            }
        }
    }

    #[test]
    fn what_a_window_is_laid_round_is_in_it() {
        let mut random = Random::new(&[6]);
        for (pixel, zoom) in [(0, 2.0), (63, 1.5), (31, 4.0), (40, 1.0)] {
            for _ in 0..50 {
                let axis = window((64, 64), zoom, Place::Round(pixel), &mut random).0;
                let (first, last) = (axis[0].nearest(), axis[63].nearest());
                assert!((first..=last).contains(&(pixel as usize)), "{pixel} in {first}..={last}");
            }
        }
    }

    #[test]
    fn a_row_is_made_of_the_lines_it_names() {
        // Frames twice as large whose red is the row and whose green is the column.
        let rgb: Vec<u8> = (0..8 * 16).flat_map(|i| [i / 16, i % 16, 0]).collect();
        let table = [std::array::from_fn(|byte| byte as f32); 3];
        let mut random = Random::new(&[7]);
        let (rows, mut columns) =
            (window((8, 4), 1.0, Place::Random, &mut random), window((16, 8), 1.0, Place::Random, &mut random));
        columns.reverse();
        let view = View { rows: &rows, columns: &columns, width: 16 };
        let (mut values, mut labels) = (Vec::new(), Vec::new());
        view.picture(&rgb, &table, &mut values);
        view.labels(&(0..8 * 16).collect::<Vec<u8>>(), &mut labels);
        assert_eq!(values[..6], [0.5, 14.5, 0.0, 0.5, 12.5, 0.0]);
        assert_eq!(values[8 * 3..][..3], [2.5, 14.5, 0.0]);
        assert_eq!(labels[..2], [16 + 15, 16 + 13]);
    }
}
