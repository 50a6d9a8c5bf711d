//! Which corners of pixels need not be drawn: those whose four pixels agree on one surface of one colour, which is theirs then. What
//! is nearer than that surface is drawn nevertheless, as something thin that no pixel's middle sees.

/// Colours agree whose bytes differ by so much at most.
const ALIKE: u8 = 12;
/// Depths are those of one plane up to this share.
const PLANE: f32 = 2e-4;
/// Depth of the farthest sky; nothing that is drawn has less.
const SKY_DEPTH: f32 = 1e-9;

/// A row of pixels: colours of four bytes, classes and instances, and depth as it is drawn, the greater the nearer.
#[derive(Clone, Copy)]
pub(crate) struct Row<'a> {
    pub(crate) colours: &'a [u8],
    pub(crate) ids: &'a [u8],
    pub(crate) depths: &'a [u8],
}

/// What is known of rows of corners. Loops run over slices of one length each, so that the compiler makes vectors of them.
#[derive(Default)]
pub(crate) struct Corners {
    ids: [Vec<u32>; 2],
    depths: [Vec<f32>; 2],
    /// Of each column of two pixels: bits in which ids differ, sum and difference of depths, lowest and highest colours.
    differ: Vec<u32>,
    sums: Vec<f32>,
    steps: Vec<f32>,
    low: Vec<u8>,
    high: Vec<u8>,
    /// By how much colours of the four pixels around a corner differ too much.
    excess: Vec<u8>,
}

impl Corners {
    /// For the corners between two rows of pixels, one more than a row has: what is drawn there has a depth above this, which is 0
    /// where pixels do not agree. Beyond the edges pixels are as at them.
    pub(crate) fn row(&mut self, above: Row<'_>, below: Row<'_>, known: &mut Vec<f32>) {
        for (list, row) in self.ids.iter_mut().zip([above, below]) {
            list.clear();
            list.extend(row.ids.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)));
        }
        for (list, row) in self.depths.iter_mut().zip([above, below]) {
            list.clear();
            list.extend(row.depths.as_chunks::<4>().0.iter().map(|depth| f32::from_le_bytes(*depth)));
        }
        let columns =
            |of: fn(f32, f32) -> f32| self.depths[0].iter().zip(&self.depths[1]).map(move |(a, b)| of(*a, *b));
        self.sums.clear();
        self.sums.extend(columns(|a, b| a + b));
        self.steps.clear();
        self.steps.extend(columns(|a, b| a - b));
        self.differ.clear();
        self.differ.extend(self.ids[0].iter().zip(&self.ids[1]).map(|(a, b)| a ^ b));
        self.spread(above, below);
        let last = self.differ.len() - 1;
        known.push(self.between(0, 0, 0));
        let start = known.len();
        known.resize(start + last, 0.0);
        self.inner(&mut known[start..]);
        known.push(self.between(last, last, last + 1));
    }

    /// The corners between two columns each.
    fn inner(&self, known: &mut [f32]) {
        let n = known.len();
        let pair = |from: usize| (&self.differ[from..][..n], &self.sums[from..][..n], &self.steps[from..][..n]);
        let ((da, sa, ta), (db, sb, tb)) = (pair(0), pair(1));
        let (ia, ib, excess) = (&self.ids[0][..n], &self.ids[0][1..][..n], &self.excess.as_chunks::<4>().0[1..][..n]);
        for i in 0..n {
            let differ = da[i] | db[i] | (ia[i] ^ ib[i]) | u32::from_le_bytes(excess[i]);
            known[i] = depth(differ, sa[i] + sb[i], ta[i] - tb[i]);
        }
    }

    fn between(&self, left: usize, right: usize, corner: usize) -> f32 {
        let differ =
            self.differ[left] | self.differ[right] | u32::from_le_bytes(self.excess.as_chunks::<4>().0[corner]);
        depth(differ, self.sums[left] + self.sums[right], self.steps[left] - self.steps[right])
    }

    fn spread(&mut self, above: Row<'_>, below: Row<'_>) {
        let pairs = || above.colours.iter().zip(below.colours);
        self.low.clear();
        self.low.extend(pairs().map(|(a, b)| (*a).min(*b)));
        self.high.clear();
        self.high.extend(pairs().map(|(a, b)| (*a).max(*b)));
        let too_much = |low: u8, high: u8| high.saturating_sub(low).saturating_sub(ALIKE);
        let n = self.low.len() - 4;
        self.excess.clear();
        self.excess.extend(self.low[..4].iter().zip(&self.high[..4]).map(|(low, high)| too_much(*low, *high)));
        self.excess.resize(4 + n, 0);
        let (la, lb, ha, hb) = (&self.low[..n], &self.low[4..][..n], &self.high[..n], &self.high[4..][..n]);
        let four = la.iter().zip(lb).zip(ha.iter().zip(hb));
        for (excess, ((la, lb), (ha, hb))) in self.excess[4..].iter_mut().zip(four) {
            *excess = too_much(*la.min(lb), *ha.max(hb));
        }
        self.excess.extend(self.low[n..].iter().zip(&self.high[n..]).map(|(low, high)| too_much(*low, *high)));
    }
}

/// What is drawn has a depth above this, from the sum of four depths and by how much they are bent.
fn depth(differ: u32, sum: f32, bend: f32) -> f32 {
    let mean = 0.25 * sum;
    let agrees = (differ == 0) & (bend.abs() <= PLANE * mean);
    if agrees { mean * (1.0 + 0.5 * PLANE) + SKY_DEPTH } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Pixels {
        colours: Vec<u8>,
        ids: Vec<u8>,
        depths: Vec<u8>,
    }

    impl Pixels {
        fn new(greys: [u8; 3], ids: [u32; 3], depths: [f32; 3]) -> Self {
            Self {
                colours: greys.into_iter().flat_map(|grey| [grey, grey, grey, 255]).collect(),
                ids: ids.into_iter().flat_map(u32::to_le_bytes).collect(),
                depths: depths.into_iter().flat_map(f32::to_le_bytes).collect(),
            }
        }

        fn row(&self) -> Row<'_> {
            Row { colours: &self.colours, ids: &self.ids, depths: &self.depths }
        }
    }

    fn known(above: &Pixels, below: &Pixels) -> Vec<bool> {
        let mut depths = Vec::new();
        Corners::default().row(above.row(), below.row(), &mut depths);
        depths.into_iter().map(|depth| depth > 0.0).collect()
    }

    #[test]
    fn corners_are_known_where_four_pixels_agree() {
        let pixels = |greys, ids, depths| Pixels::new(greys, ids, depths);
        let above = pixels([90, 95, 100], [7; 3], [0.01, 0.02, 0.03]);
        assert_eq!(known(&above, &pixels([91, 96, 100], [7; 3], [0.02, 0.03, 0.04])), [true; 4], "a plane");
        let others = pixels([91, 96, 100], [7, 7, 8], [0.02, 0.03, 0.04]);
        assert_eq!(known(&above, &others), [true, true, false, false], "another instance");
        let bright = pixels([103, 96, 100], [7; 3], [0.02, 0.03, 0.04]);
        assert_eq!(known(&above, &bright), [false, false, true, true], "another colour");
        let bent = pixels([91, 96, 100], [7; 3], [0.02, 0.03, 0.0402]);
        assert_eq!(known(&above, &bent), [true, true, false, true], "an edge between two planes");
    }

    #[test]
    fn what_agrees_is_not_drawn_again_and_what_is_before_it_is() {
        let row = Pixels::new([90; 3], [7; 3], [0.01; 3]);
        let mut depths = Vec::new();
        Corners::default().row(row.row(), row.row(), &mut depths);
        assert!(depths.iter().all(|depth| (0.01..0.010_01).contains(depth)));
        let sky = Pixels::new([90; 3], [11; 3], [0.0; 3]);
        depths.clear();
        Corners::default().row(sky.row(), sky.row(), &mut depths);
        assert_eq!(depths, [SKY_DEPTH; 4]);
    }
}
