//! A uniform grid over the plane, for questions about places.

use glam::Vec2;

use crate::ops;

/// Least and greatest corner of something seen from above.
pub(super) type Bounds = (Vec2, Vec2);

/// Items by the cells that their boxes touch.
#[derive(Clone, Debug, Default)]
pub(crate) struct Grid {
    origin: Vec2,
    cell_m: f32,
    columns: usize,
    rows: usize,
    /// `items[starts[c]..starts[c + 1]]` touch cell `c`.
    starts: Vec<u32>,
    items: Vec<u32>,
}

/// More cells than this are merged into larger ones.
const MAX_CELLS: f32 = 1e6;

impl Grid {
    /// Sorts boxes into cells of about `cell_m`.
    pub fn new(boxes: &[Bounds], cell_m: f32) -> Self {
        let low = boxes.iter().fold(Vec2::splat(f32::MAX), |m, b| m.min(b.0));
        let high = boxes.iter().fold(Vec2::splat(f32::MIN), |m, b| m.max(b.1));
        if boxes.is_empty() {
            return Self::default();
        }
        let extent = high - low;
        let cell_m = cell_m.max(ops::sqrt(extent.x * extent.y / MAX_CELLS)).max(extent.max_element() / MAX_CELLS);
        // An extent that is not finite is no count of cells.
        let count = |extent_m: f32| ((extent_m / cell_m) as usize).min(MAX_CELLS as usize) + 1;
        let (columns, rows) = (count(extent.x), count(extent.y));
        let mut grid = Self { origin: low, cell_m, columns, rows, starts: vec![0; columns * rows + 1], items: vec![] };
        grid.fill(boxes);
        grid
    }

    fn fill(&mut self, boxes: &[Bounds]) {
        for b in boxes {
            self.cells(b.0, b.1).for_each(|c| self.starts[c + 1] += 1);
        }
        for c in 1..self.starts.len() {
            self.starts[c] += self.starts[c - 1];
        }
        let mut next = self.starts.clone();
        self.items = vec![0; next[next.len() - 1] as usize];
        for (item, b) in boxes.iter().enumerate() {
            for c in self.cells(b.0, b.1) {
                self.items[next[c] as usize] = item as u32;
                next[c] += 1;
            }
        }
    }

    /// First and last column, and first and last row, of the cells that a box touches.
    fn span(&self, low: Vec2, high: Vec2) -> [(usize, usize); 2] {
        let at = |v: f32, n: usize| ((v / self.cell_m).max(0.0) as usize).min(n.saturating_sub(1));
        let (a, b) = (low - self.origin, high - self.origin);
        [(at(a.x, self.columns), at(b.x, self.columns)), (at(a.y, self.rows), at(b.y, self.rows))]
    }

    fn cells(&self, low: Vec2, high: Vec2) -> impl Iterator<Item = usize> + use<> {
        let [(x0, x1), (y0, y1)] = self.span(low, high);
        let columns = self.columns;
        (y0..=y1).flat_map(move |y| (x0..=x1).map(move |x| y * columns + x))
    }

    /// An item in the fullest cell, and how many that holds.
    pub fn most_crowded(&self) -> Option<(u32, usize)> {
        let cells = self.starts.windows(2).map(|c| &self.items[c[0] as usize..c[1] as usize]);
        cells.max_by_key(|items| items.len()).and_then(|items| Some((*items.first()?, items.len())))
    }

    /// Items whose boxes may touch the square of half side `radius_m` around `p`; some come twice.
    pub fn around(&self, p: Vec2, radius_m: f32) -> impl Iterator<Item = u32> + '_ {
        let [(x0, x1), (y0, y1)] = self.span(p - radius_m, p + radius_m);
        let rows = if self.starts.is_empty() { 0..0 } else { y0..y1 + 1 };
        // The cells of a row lie behind each other.
        let items = move |y: usize| {
            let row = &self.starts[y * self.columns..];
            &self.items[row[x0] as usize..row[x1 + 1] as usize]
        };
        rows.flat_map(items).copied()
    }
}
