//! One grid of samples of a picture, and how near what is known to cover each of them is: what lies behind that shows nothing.

use core::ops::Range;

use glam::{Vec2, Vec3};

/// A vertex in the picture: samples to the right and downwards, metres ahead.
pub(super) type Place = Vec3;

/// A triangle with a corner nearer than this is kept, metres ahead of the eye: it may cross the near plane.
pub(super) const NEAR_M: f32 = 0.2;
/// A place in the picture is known so well, samples: the renderer rounds to 1/256. Far outside of it, as a share of the
/// distance.
const KNOWN_PX: f32 = 0.02;
const KNOWN_SHARE: f32 = 1e-5;
/// Nearness is known so well, as a share of that of a triangle's nearest corner.
const KNOWN_NEARNESS: f32 = 1e-5;

/// Samples in rows and columns. Nearness is 1 over metres ahead, which is linear in the picture.
#[derive(Debug, Default)]
pub(super) struct Grid {
    /// By how much places in the picture are moved to be places of it, samples: its corners lie where the samples would of a
    /// picture that is larger by half a pixel on each side.
    shift: f32,
    size: Vec2,
    /// The least of what covers each sample, row by row; 0 where nothing is known to.
    nearness: Vec<f32>,
}

/// What a grid can tell of a triangle before it looks at samples.
enum Look {
    /// None shows it.
    Unseen,
    /// It crosses the near plane.
    Crossing,
    Facing(Facing),
}

/// A triangle before the eye that is turned to it, with samples in the box around it.
struct Facing {
    columns: Range<usize>,
    rows: Range<usize>,
    edges: [Edge; 3],
    corner: Vec2,
    /// At the corner, and its change from column to column and from row to row.
    nearness: f32,
    slope: Vec2,
    /// How well it is known.
    known: f32,
}

/// An edge. Right of it is inside where it goes down the picture, left of it where it goes up.
#[derive(Clone, Copy)]
struct Edge {
    from: Vec2,
    along: Vec2,
    /// Columns a row, and how well its columns are known; of a level edge nothing.
    slope: f32,
    known_columns: f32,
    /// The same of its inside, samples times length.
    known: f32,
}

impl Grid {
    /// Forgets what it knew.
    pub(super) fn begin(&mut self, [columns, rows]: [u32; 2], shift: f32) {
        self.shift = shift;
        self.size = Vec2::new(columns as f32, rows as f32);
        self.nearness.clear();
        self.nearness.resize(columns as usize * rows as usize, 0.0);
    }

    /// Whether any sample may show something of what lies between two places and is nowhere nearer than this.
    pub(super) fn may_show_between(&self, low: Vec2, high: Vec2, nearness: f32) -> bool {
        let [columns, mut rows] = samples_between(low + self.shift, high + self.shift, self.size);
        let nearness = nearness * (1.0 + KNOWN_NEARNESS);
        !columns.is_empty() && rows.any(|row| self.samples(row, &columns).iter().any(|known| *known <= nearness))
    }

    /// Whether any sample may show a triangle.
    pub(super) fn may_show(&self, triangle: [Place; 3]) -> bool {
        match self.look(triangle) {
            Look::Unseen => false,
            Look::Crossing => true,
            Look::Facing(facing) => facing.rows.clone().any(|row| {
                let [may, _] = facing.spans(row);
                facing.is_nearest(row, may.start, self.samples(row, &may))
            }),
        }
    }

    /// The same, and from now on it hides what lies behind it.
    pub(super) fn cover(&mut self, triangle: [Place; 3]) -> bool {
        let facing = match self.look(triangle) {
            Look::Unseen => return false,
            Look::Crossing => return true,
            Look::Facing(facing) => facing,
        };
        let mut shows = false;
        for row in facing.rows.clone() {
            let [may, does] = facing.spans(row);
            shows = shows || facing.is_nearest(row, may.start, self.samples(row, &may));
            if !does.is_empty() {
                let first = facing.nearness_at(row, does.start) - facing.known;
                let start = row * self.size.x as usize;
                for (i, known) in (0u16..).zip(&mut self.nearness[start + does.start..start + does.end]) {
                    let nearness = first + f32::from(i) * facing.slope.x;
                    *known = if nearness > *known { nearness } else { *known };
                }
            }
        }
        shows
    }

    fn samples(&self, row: usize, columns: &Range<usize>) -> &[f32] {
        let start = row * self.size.x as usize;
        &self.nearness[start + columns.start..start + columns.end]
    }

    fn look(&self, corners: [Place; 3]) -> Look {
        let [za, zb, zc] = corners.map(|p| p.z);
        if za.min(zb).min(zc) < NEAR_M {
            return if za.max(zb).max(zc) > 0.0 { Look::Crossing } else { Look::Unseen };
        }
        let [a, b, c] = corners.map(|p| p.truncate() + self.shift);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let known = known_px(low, high);
        let [columns, rows] = samples_between(low, high, self.size);
        if columns.is_empty() || rows.is_empty() {
            return Look::Unseen;
        }
        // Twice its area, negative from behind.
        let area = (c - a).perp_dot(b - a);
        let reach = high - low;
        if area < -2.0 * known * (reach.x + reach.y) {
            return Look::Unseen;
        }
        let nearest = 1.0 / za.min(zb).min(zc) * (1.0 + 2.0 * KNOWN_NEARNESS);
        if columns.len() * rows.len() <= 4
            && rows.clone().all(|row| self.samples(row, &columns).iter().all(|known| *known > nearest))
        {
            return Look::Unseen;
        }
        let [na, nb, nc] = [za, zb, zc].map(|z| 1.0 / z);
        let slope = ((b - a).perp() * (nc - na) - (c - a).perp() * (nb - na)) / -area;
        Look::Facing(Facing {
            columns,
            rows,
            edges: [(a, b), (b, c), (c, a)].map(|(p, q)| Edge::new(p, q, known)),
            corner: a,
            nearness: na,
            slope,
            // Of slivers nothing is known, as slopes are steep.
            known: known * (slope.x.abs() + slope.y.abs()) + KNOWN_NEARNESS * nearest,
        })
    }
}

impl Facing {
    fn nearness_at(&self, row: usize, column: usize) -> f32 {
        let sample = Vec2::new(column as f32, row as f32) + 0.5;
        self.nearness + self.slope.dot(sample - self.corner)
    }

    /// Whether it may be nearer than what is known of samples of a row, from a column on.
    fn is_nearest(&self, row: usize, first: usize, samples: &[f32]) -> bool {
        let nearness = self.nearness_at(row, first) + self.known;
        // Not a number where nothing is known.
        (0u16..).zip(samples).fold(false, |is, (i, known)| is | !(*known > nearness + f32::from(i) * self.slope.x))
    }

    /// Columns of a row that it may cover, and those that it does.
    fn spans(&self, row: usize) -> [Range<usize>; 2] {
        let y = row as f32 + 0.5;
        let (start, end) = (self.columns.start as f32, self.columns.end as f32);
        let [mut may, mut does] = [[start, end]; 2];
        for edge in &self.edges {
            let at = edge.from.x + edge.slope * (y - edge.from.y);
            if edge.along.y > 0.0 {
                may[0] = may[0].max(at - edge.known_columns);
                does[0] = does[0].max(at + edge.known_columns);
            } else if edge.along.y < 0.0 {
                may[1] = may[1].min(at + edge.known_columns);
                does[1] = does[1].min(at - edge.known_columns);
            } else {
                let outside = edge.along.x * (y - edge.from.y);
                may[1] = if outside > edge.known { start } else { may[1] };
                does[1] = if outside > -edge.known { start } else { does[1] };
            }
        }
        [may, does].map(|[low, high]| samples(low, high.max(low), self.columns.end as f32))
    }
}

impl Edge {
    fn new(from: Vec2, to: Vec2, known_px: f32) -> Self {
        let along = to - from;
        let known = known_px * (along.x.abs() + along.y.abs());
        Self { from, along, slope: along.x / along.y, known_columns: known / along.y.abs(), known }
    }
}

/// How well places between two are known, samples.
fn known_px(low: Vec2, high: Vec2) -> f32 {
    KNOWN_PX + KNOWN_SHARE * low.abs().max(high.abs()).max_element()
}

/// Columns and rows whose samples may lie between two places.
fn samples_between(low: Vec2, high: Vec2, size: Vec2) -> [Range<usize>; 2] {
    let known = known_px(low, high);
    [samples(low.x - known, high.x + known, size.x), samples(low.y - known, high.y + known, size.y)]
}

/// The samples between two places of an axis that has so many; samples lie half a step inside.
fn samples(low: f32, high: f32, count: f32) -> Range<usize> {
    // Truncation of what is not negative: rounding functions are calls here.
    let first = (low + 0.5).clamp(0.0, count) as usize;
    let end = (high + 0.5).clamp(0.0, count) as usize;
    first..end
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid {
        let mut grid = Grid::default();
        grid.begin([256, 128], 0.0);
        grid
    }

    fn at(corners: [(f32, f32); 3], ahead_m: f32) -> [Place; 3] {
        corners.map(|(x, y)| Vec3::new(x, y, ahead_m))
    }

    fn seen(corners: [(f32, f32); 3]) -> bool {
        let shows = grid().may_show(at(corners, 10.0));
        assert_eq!(grid().cover(at(corners, 10.0)), shows);
        shows
    }

    /// Anticlockwise as it is seen; downwards is positive.
    fn corner(x: f32, y: f32, side: f32) -> [(f32, f32); 3] {
        [(x, y + side), (x + side, y + side), (x, y)]
    }

    /// The other way round.
    fn behind([a, b, c]: [(f32, f32); 3]) -> [(f32, f32); 3] {
        [a, c, b]
    }

    #[test]
    fn triangles_that_show_a_sample_are_kept_and_others_are_not() {
        assert!(seen(corner(10.0, 10.0, 40.0)) && !seen(behind(corner(10.0, 10.0, 40.0))), "turned away");
        assert!(seen(corner(10.4, 10.3, 0.4)), "around the sample at 10.5");
        assert!(!seen(corner(10.6, 10.6, 0.8)), "between samples");
        assert!(!seen([(10.1, 10.9), (10.9, 11.3), (10.2, 10.6)]), "its box holds a sample, it does not");
        assert!(!seen(corner(-20.0, 10.0, 10.0)) && !seen(corner(10.0, 140.0, 10.0)), "beside the picture");
        assert!(seen(corner(-20.0, 10.0, 30.0)), "partly beside it");
    }

    #[test]
    fn what_crosses_the_near_plane_is_kept_and_what_is_behind_the_eye_is_not() {
        let place = |x: f32, z: f32| Vec3::new(x, 10.0, z);
        assert!(grid().may_show([place(-900.0, -3.0), place(900.0, 4.0), place(10.0, 5.0)]));
        assert!(!grid().may_show([place(10.0, -3.0), place(20.0, -4.0), place(10.0, -5.0)]));
    }

    #[test]
    fn what_lies_behind_something_is_left_out_and_what_is_beside_or_level_with_it_is_not() {
        let mut grid = grid();
        assert!(grid.cover(at(corner(10.0, 10.0, 40.0), 20.0)));
        let [inside, across, beside] = [corner(15.0, 35.0, 6.0), corner(15.0, 5.0, 40.0), corner(60.0, 20.0, 20.0)];
        assert!(!grid.may_show(at(inside, 21.0)) && grid.may_show(at(inside, 19.0)) && grid.may_show(at(inside, 20.0)));
        assert!(grid.may_show(at(across, 30.0)) && grid.may_show(at(beside, 30.0)));
        let [low, high] = [Vec2::new(15.0, 35.0), Vec2::new(20.0, 40.0)];
        assert!(!grid.may_show_between(low, high, 1.0 / 21.0) && grid.may_show_between(low, high, 1.0 / 19.0));
        assert!(grid.may_show_between(low, high + 20.0, 1.0 / 21.0));
    }

    /// A floor that rises to the horizon hides what is below and nothing of what stands on it.
    #[test]
    fn nearness_is_that_of_each_sample() {
        let mut grid = grid();
        let floor = [Vec3::new(0.0, 127.0, 2.0), Vec3::new(250.0, 127.0, 2.0), Vec3::new(125.0, 65.0, 100.0)];
        assert!(grid.cover(floor));
        let post = |ahead_m: f32| {
            [Vec3::new(124.0, 100.0, ahead_m), Vec3::new(127.0, 100.0, ahead_m), Vec3::new(125.0, 96.0, ahead_m)]
        };
        let there_m = 1.0 / (1.0 / 100.0 + (1.0 / 2.0 - 1.0 / 100.0) * (96.5 - 65.0) / 62.0);
        assert!(grid.may_show(post(there_m * 0.99)) && !grid.may_show(post(there_m * 1.2)));
    }
}
