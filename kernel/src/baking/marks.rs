//! Road marks as lines, for those who draw a map; the paint itself is in `paint`.

use glam::Vec3;

use super::notes::{Notes, Passed};
use super::shapes::point;
use super::source::Source;

/// A painted line.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Its middle, at least two points.
    pub points: Vec<Vec3>,
    /// How wide it is, metres.
    pub width_m: f32,
    /// Paint and gap of a broken line, metres.
    pub dash_m: Option<[f32; 2]>,
    /// The colour that the file names; empty or `standard` is white.
    pub colour: String,
}

/// The lines of a file that are painted.
pub(super) fn of(source: &Source) -> Vec<Mark> {
    let lines = source.net.road_marks().iter().flat_map(|mark| &mark.lines);
    let marks = lines.map(|line| Mark {
        points: middle(&line.pieces),
        width_m: line.width,
        dash_m: match line.pattern {
            xodr::LinePattern::Dashed { length, space } => Some([length, space]),
            xodr::LinePattern::Continuous | xodr::LinePattern::Single { .. } => None,
        },
        colour: line.color.clone(),
    });
    marks.filter(|mark| mark.points.len() > 1).collect()
}

/// The line through the middle of painted pieces, and of the gaps between them.
fn middle(pieces: &[[xodr::Point; 4]]) -> Vec<Vec3> {
    let mut points: Vec<Vec3> = Vec::with_capacity(pieces.len() + 1);
    for piece in pieces {
        let [right, end_right, end_left, left] = piece.map(point);
        points.extend([(right + left) / 2.0, (end_right + end_left) / 2.0]);
    }
    points.dedup();
    points
}

/// Notes the marks that the paint does not show as the file says.
pub(super) fn note(source: &Source, notes: &mut Notes) {
    use xodr::RoadMarkType as T;
    for (index, mark) in source.net.road_marks().iter().enumerate() {
        let is_bare = mark.lines.iter().all(|line| line.pieces.is_empty());
        let why = match mark.kind {
            // No paint, by the standard.
            T::None | T::Curb | T::Edge | T::Grass => continue,
            _ if is_bare => "is not painted",
            _ if !["standard", "white", ""].contains(&mark.color.as_str()) => "is painted white",
            _ => continue,
        };
        let what = || if is_bare { format!("type {}", mark.kind) } else { format!("colour {}", mark.color) };
        notes.pass(Passed::RoadMark, why, what, || source.place_of_mark(index));
    }
}
