//! One grid of samples of a picture, and how near what is known to cover each of them is: what lies behind that shows nothing.

use core::ops::Range;

use glam::{Vec2, Vec3};

/// A vertex in the picture: samples to the right and downwards, and how near it is, 1 over metres ahead of the eye. That is
/// linear in the picture.
pub(super) type Place = Vec3;

/// A triangle with a corner nearer than this is kept, 1 over metres: it may cross the near plane.
pub(super) const NEAREST: f32 = 5.0;
/// A place in the picture is known so well, samples: the renderer rounds to 1/256. Far outside of it, as a share of the
/// distance.
const KNOWN_PX: f32 = 0.02;
const KNOWN_SHARE: f32 = 1e-5;
/// Nearness is known so well, as a share of that of a triangle's nearest corner.
const KNOWN_NEARNESS: f32 = 1e-5;
/// And its slope so well, as a share of its spread where a triangle is as high as wide.
const KNOWN_SPREAD: f32 = 5e-7;

/// Samples in rows and columns.
#[derive(Debug, Default)]
pub(super) struct Grid {
    /// By how much places in the picture are moved to be places of it, samples: its corners lie where the samples would of a
    /// picture that is larger by half a pixel on each side.
    shift: f32,
    size: Vec2,
    /// The least of what covers each sample, row by row; 0 where nothing is known to.
    nearness: Vec<f32>,
}

/// What can be told of a triangle before samples are looked at.
pub(super) enum Look {
    /// None shows it.
    Unseen,
    /// It crosses the near plane.
    Crossing,
    /// It is before the eye and turned to it.
    Facing(Outline),
}

/// Around a triangle.
pub(super) struct Outline {
    corners: [Place; 3],
    low: Vec2,
    high: Vec2,
    /// How well places are known, samples.
    known_px: f32,
    /// Twice its area, negative from behind.
    area: f32,
    nearest: f32,
}

/// Columns and rows.
pub(super) type Samples = [Range<usize>; 2];

/// What samples show of a triangle.
pub(super) struct Surface {
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
    /// How well its inside is known, samples times length.
    known: f32,
}

impl Look {
    #[inline]
    pub(super) fn at(corners: [Place; 3]) -> Self {
        let [na, nb, nc] = corners.map(|p| p.z);
        let (nearest, farthest) = (largest(largest(na, nb), nc), smallest(smallest(na, nb), nc));
        if farthest <= 0.0 || nearest > NEAREST {
            return if nearest > 0.0 { Self::Crossing } else { Self::Unseen };
        }
        let [a, b, c] = corners.map(|p| p.truncate());
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let (known_px, reach) = (known_px(low, high), high - low);
        let area = (c - a).perp_dot(b - a);
        if area < -2.0 * known_px * (reach.x + reach.y) {
            return Self::Unseen;
        }
        Self::Facing(Outline { corners, low, high, known_px, area, nearest })
    }
}

impl Surface {
    #[inline]
    pub(super) fn of(outline: &Outline) -> Self {
        let &Outline { corners, low, high, known_px, area, nearest } = outline;
        let [a, b, c] = corners.map(|p| p.truncate());
        let [na, nb, nc] = corners.map(|p| p.z);
        let slope = ((b - a).perp() * (nc - na) - (c - a).perp() * (nb - na)) / -area;
        // Of slivers little is known: what rounds in a long side times a difference of nearness stays, and the area is small.
        let (reach, spread) = (high - low, (nb - na).abs() + (nc - na).abs());
        let rounded = KNOWN_SPREAD * reach.length_squared() / area.abs() * spread;
        Self {
            edges: [(a, b), (b, c), (c, a)].map(|(p, q)| Edge::new(p, q, known_px)),
            corner: a,
            nearness: na,
            slope,
            known: known_px * (slope.x.abs() + slope.y.abs()) + KNOWN_NEARNESS * nearest + rounded,
        }
    }

    fn nearness_at(&self, at: Vec2) -> f32 {
        self.nearness + self.slope.dot(at - self.corner)
    }

    /// Columns of a row that it may cover, and those that it does.
    #[inline]
    fn spans(&self, columns: &Range<usize>, row: usize, shift: f32) -> [Range<usize>; 2] {
        let y = row as f32 + (0.5 - shift);
        let (start, end) = (columns.start as f32 - shift, columns.end as f32 - shift);
        let (mut may, mut does) = ([start, end], [start, end]);
        for edge in &self.edges {
            let at = edge.from.x + edge.slope * (y - edge.from.y);
            if edge.along.y > 0.0 {
                may[0] = largest(at - edge.known_columns, may[0]);
                does[0] = largest(at + edge.known_columns, does[0]);
            } else if edge.along.y < 0.0 {
                may[1] = smallest(at + edge.known_columns, may[1]);
                does[1] = smallest(at - edge.known_columns, does[1]);
            } else {
                let outside = edge.along.x * (y - edge.from.y);
                may[1] = if outside > edge.known { start } else { may[1] };
                does[1] = if outside > -edge.known { start } else { does[1] };
            }
        }
        let count = columns.end as f32;
        [may, does].map(|[low, high]| samples(low + shift, largest(high, low) + shift, count))
    }
}

impl Edge {
    #[inline]
    fn new(from: Vec2, to: Vec2, known_px: f32) -> Self {
        let along = to - from;
        let known = known_px * (along.x.abs() + along.y.abs());
        let per_row = 1.0 / along.y;
        Self { from, along, slope: along.x * per_row, known_columns: known * per_row.abs(), known }
    }
}

impl Grid {
    /// Forgets what it knew.
    pub(super) fn begin(&mut self, [columns, rows]: [u32; 2], shift: f32) {
        self.shift = shift;
        self.size = Vec2::new(columns as f32, rows as f32);
        self.nearness.clear();
        self.nearness.resize(columns as usize * rows as usize, 0.0);
    }

    /// Places are known to cover the samples, row by row.
    pub(super) fn raise(&mut self, known: impl Iterator<Item = f32>) {
        self.nearness.iter_mut().zip(known).for_each(|(nearness, known)| *nearness = largest(known, *nearness));
    }

    /// Whether any sample may show something of what lies between two places and is nowhere nearer than this.
    pub(super) fn may_show_between(&self, low: Vec2, high: Vec2, nearness: f32) -> bool {
        let [columns, mut rows] = samples_between(low + self.shift, high + self.shift, self.size, known_px(low, high));
        let nearness = nearness * (1.0 + KNOWN_NEARNESS);
        !columns.is_empty() && rows.any(|row| self.row(row, &columns).iter().any(|known| *known <= nearness))
    }

    /// Samples in the box around a triangle, unless none of them shows it.
    #[inline]
    pub(super) fn around(&self, outline: &Outline) -> Option<Samples> {
        let Outline { low, high, known_px, nearest, .. } = *outline;
        let [columns, rows] = samples_between(low + self.shift, high + self.shift, self.size, known_px);
        if columns.is_empty() || rows.is_empty() {
            return None;
        }
        let nearest = nearest * (1.0 + 2.0 * KNOWN_NEARNESS);
        let few = columns.len() * rows.len() <= 8;
        let is_hidden = few && rows.clone().all(|row| self.row(row, &columns).iter().all(|known| *known > nearest));
        (!is_hidden).then_some([columns, rows])
    }

    /// Whether any of some samples may show a surface.
    pub(super) fn may_show(&self, surface: &Surface, [columns, rows]: &Samples) -> bool {
        rows.clone().any(|row| self.row_may_show(surface, row, &surface.spans(columns, row, self.shift)[0]))
    }

    /// The same, and from now on the surface hides what lies behind it.
    pub(super) fn cover(&mut self, surface: &Surface, [columns, rows]: &Samples) -> bool {
        let mut shows = false;
        for row in rows.clone() {
            let [may, does] = surface.spans(columns, row, self.shift);
            shows = shows || self.row_may_show(surface, row, &may);
            if !does.is_empty() {
                let first = surface.nearness_at(self.sample(row, does.start)) - surface.known;
                let start = row * self.size.x as usize;
                for (i, known) in (0u16..).zip(&mut self.nearness[start + does.start..start + does.end]) {
                    *known = largest(first + f32::from(i) * surface.slope.x, *known);
                }
            }
        }
        shows
    }

    #[inline]
    fn row_may_show(&self, surface: &Surface, row: usize, columns: &Range<usize>) -> bool {
        if columns.is_empty() {
            return false;
        }
        let nearness = surface.nearness_at(self.sample(row, columns.start)) + surface.known;
        // Not a number where nothing is known.
        let hides = |known: f32, i: u16| known > nearness + f32::from(i) * surface.slope.x;
        (0u16..).zip(self.row(row, columns)).fold(false, |shows, (i, known)| shows | !hides(*known, i))
    }

    /// Where a sample lies in the picture.
    #[inline]
    fn sample(&self, row: usize, column: usize) -> Vec2 {
        Vec2::new(column as f32, row as f32) + (0.5 - self.shift)
    }

    #[inline]
    fn row(&self, row: usize, columns: &Range<usize>) -> &[f32] {
        let start = row * self.size.x as usize;
        &self.nearness[start + columns.start..start + columns.end]
    }
}

/// The second one where the first is not a number; `f32::max` takes several instructions for more than that.
#[inline]
fn largest(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline]
fn smallest(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// How well places between two are known, samples.
#[inline]
fn known_px(low: Vec2, high: Vec2) -> f32 {
    KNOWN_PX + KNOWN_SHARE * low.abs().max(high.abs()).max_element()
}

/// Columns and rows whose samples may lie between two places that are known so well.
#[inline]
pub(super) fn samples_between(low: Vec2, high: Vec2, size: Vec2, known: f32) -> Samples {
    [samples(low.x - known, high.x + known, size.x), samples(low.y - known, high.y + known, size.y)]
}

/// The samples between two places of an axis that has so many; samples lie half a step inside.
#[inline]
fn samples(low: f32, high: f32, count: f32) -> Range<usize> {
    // Truncation of what is not negative: rounding functions are calls here.
    let whole = |at: f32| smallest(largest(at + 0.5, 0.0), count) as i32 as usize;
    whole(low)..whole(high)
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
        corners.map(|(x, y)| Vec3::new(x, y, 1.0 / ahead_m))
    }

    /// Tries a triangle with or without covering what it does.
    fn shows(grid: &mut Grid, triangle: [Place; 3], covers: bool) -> bool {
        match Look::at(triangle) {
            Look::Unseen => false,
            Look::Crossing => true,
            Look::Facing(outline) => grid.around(&outline).is_some_and(|samples| {
                let surface = Surface::of(&outline);
                if covers { grid.cover(&surface, &samples) } else { grid.may_show(&surface, &samples) }
            }),
        }
    }

    fn seen(corners: [(f32, f32); 3]) -> bool {
        let is_seen = shows(&mut grid(), at(corners, 10.0), false);
        assert_eq!(shows(&mut grid(), at(corners, 10.0), true), is_seen);
        is_seen
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
        let place = |x: f32, z: f32| Vec3::new(x, 10.0, 1.0 / z);
        assert!(shows(&mut grid(), [place(-900.0, -3.0), place(900.0, 4.0), place(10.0, 5.0)], false));
        assert!(!shows(&mut grid(), [place(10.0, -3.0), place(20.0, -4.0), place(10.0, -5.0)], false));
    }

    #[test]
    fn what_lies_behind_something_is_left_out_and_what_is_beside_or_level_with_it_is_not() {
        let mut grid = grid();
        assert!(shows(&mut grid, at(corner(10.0, 10.0, 40.0), 20.0), true));
        let [inside, across, beside] = [corner(15.0, 35.0, 6.0), corner(15.0, 5.0, 40.0), corner(60.0, 20.0, 20.0)];
        assert!(
            !shows(&mut grid, at(inside, 21.0), false)
                && shows(&mut grid, at(inside, 19.0), false)
                && shows(&mut grid, at(inside, 20.0), false)
        );
        assert!(shows(&mut grid, at(across, 30.0), false) && shows(&mut grid, at(beside, 30.0), false));
        let [low, high] = [Vec2::new(15.0, 35.0), Vec2::new(20.0, 40.0)];
        assert!(!grid.may_show_between(low, high, 1.0 / 21.0) && grid.may_show_between(low, high, 1.0 / 19.0));
        assert!(grid.may_show_between(low, high + 20.0, 1.0 / 21.0));
    }

    /// Long triangles, as rails and edges of kerbs are.
    #[test]
    fn slivers_are_not_known_to_be_nearer_than_they_are() {
        let mut number = 1u32;
        let mut drawn = |low: f32, high: f32| {
            number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            low + (high - low) * (number >> 8) as f32 / 16_777_216.0
        };
        let mut covered = 0;
        for _ in 0..300_000 {
            let a = Vec3::new(drawn(-300.0, 256.0), drawn(0.0, 128.0), 1.0 / drawn(5.0, 60.0));
            let b = a.truncate() + Vec2::new(drawn(50.0, 900.0), drawn(-300.0, 300.0));
            let c = b + Vec2::new(drawn(-2.0, 2.0), drawn(-4.0, 4.0));
            // Nearness changes along it and not across, as that of the ground beside the eye.
            let far = 1.0 / drawn(5.0, 60.0);
            let (along, slope) = (b - a.truncate(), far - a.z);
            let share = (c - a.truncate()).dot(along) / along.length_squared();
            let corners = [a, b.extend(far), c.extend(a.z + slope * share)];
            let Look::Facing(outline) = Look::at(corners) else { continue };
            let mut grid = grid();
            let Some(samples) = grid.around(&outline) else { continue };
            grid.cover(&Surface::of(&outline), &samples);
            let [p, q, r] = corners.map(|corner| corner.as_dvec3());
            let normal = (q - p).cross(r - p);
            for (at, known) in grid.nearness.iter().enumerate().filter(|(_, known)| **known > 0.0) {
                let sample = grid.sample(at / 256, at % 256).as_dvec2();
                let there = p.z - normal.truncate().dot(sample - p.truncate()) / normal.z;
                assert!(f64::from(*known) <= there * (1.0 + 1e-7), "{corners:?} at {sample}: {known} of {there}");
                covered += 1;
            }
        }
        assert!(covered > 50_000, "{covered}");
    }

    /// A floor that rises to the horizon hides what is below and nothing of what stands on it.
    #[test]
    fn nearness_is_that_of_each_sample() {
        let mut grid = grid();
        let floor = [Vec3::new(0.0, 127.0, 0.5), Vec3::new(250.0, 127.0, 0.5), Vec3::new(125.0, 65.0, 0.01)];
        assert!(shows(&mut grid, floor, true));
        let post = |ahead_m: f32| at([(124.0, 100.0), (127.0, 100.0), (125.0, 96.0)], ahead_m);
        let there_m = 1.0 / (1.0 / 100.0 + (1.0 / 2.0 - 1.0 / 100.0) * (97.5 - 65.0) / 62.0);
        assert!(shows(&mut grid, post(there_m * 0.99), false) && !shows(&mut grid, post(there_m * 1.2), false));
    }
}
