//! Lines and areas as SVG paths, thinned out and in few bytes.

use std::fmt::Write;

use glam::Vec2;

use super::sheet::Sheet;

/// Points that stray less than this from a line are left out, metres.
const STRAY_M: f32 = 0.06;

/// The `d` of a path, in whole centimetres, from point to point relative.
#[derive(Default)]
pub struct Path(String);

impl Path {
    /// Adds an area.
    pub fn area(&mut self, sheet: &Sheet, corners: &[Vec2]) {
        if corners.len() > 2 {
            self.line(sheet, corners);
            self.0.push('z');
        }
    }

    /// Adds a line.
    pub fn line(&mut self, sheet: &Sheet, points: &[Vec2]) {
        let mut before: Option<[i64; 2]> = None;
        let points = if points.len() > 1 { points } else { &[] };
        for place in points.iter().map(|point| sheet.cm(*point)) {
            // Writing to a string cannot fail.
            let _ = match before {
                None => write!(self.0, "M{} {}l", place[0], place[1]),
                Some(before) => write!(self.0, "{}{}", number(place[0] - before[0]), number(place[1] - before[1])),
            };
            before = Some(place);
        }
    }

    /// Adds a point, which a round cap makes a disc.
    pub fn dot(&mut self, sheet: &Sheet, place: Vec2) {
        let [x, y] = sheet.cm(place);
        let _ = write!(self.0, "M{x} {y}h0");
    }

    /// Whether nothing was added.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The element, with a class that names it and further attributes.
    pub fn put(&self, out: &mut String, class: &str, attributes: &str) {
        if !self.is_empty() {
            let _ = writeln!(out, "<path class=\"{class}\" {attributes} d=\"{}\"/>", self.0);
        }
    }
}

/// A number after another: a sign tells where it begins.
fn number(cm: i64) -> String {
    if cm < 0 { cm.to_string() } else { format!(" {cm}") }
}

/// A line without the points that hardly bend it (Douglas and Peucker).
pub fn thinned(points: &[Vec2]) -> Vec<Vec2> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut kept = vec![false; points.len()];
    let mut open = vec![(0, points.len() - 1)];
    (kept[0], kept[points.len() - 1]) = (true, true);
    while let Some((from, to)) = open.pop() {
        let away = |k: usize| distance(points[k], points[from], points[to]);
        let farthest = (from + 1..to).max_by(|a, b| away(*a).total_cmp(&away(*b)));
        if let Some(k) = farthest.filter(|k| away(*k) > STRAY_M) {
            kept[k] = true;
            open.extend([(from, k), (k, to)]);
        }
    }
    points.iter().zip(kept).filter(|(_, kept)| *kept).map(|(point, _)| *point).collect()
}

/// How far a place is from the straight between two others.
fn distance(place: Vec2, from: Vec2, to: Vec2) -> f32 {
    let along = to - from;
    let share = ((place - from).dot(along) / along.length_squared().max(1e-9)).clamp(0.0, 1.0);
    place.distance(from + along * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_on_a_straight_are_left_out_and_bends_stay() {
        let straight: Vec<Vec2> = (0..50).map(|k| Vec2::new(k as f32, 0.02 * (k % 2) as f32)).collect();
        assert_eq!(thinned(&straight).len(), 2);
        let bend = [Vec2::ZERO, Vec2::new(5.0, 0.0), Vec2::new(5.0, 5.0), Vec2::new(2.0, 5.0)];
        assert_eq!(thinned(&bend), bend);
        let there_and_back = [Vec2::ZERO, Vec2::X, Vec2::ZERO];
        assert_eq!(thinned(&there_and_back), there_and_back);
    }
}
