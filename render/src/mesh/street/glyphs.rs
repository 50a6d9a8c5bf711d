//! Letters and digits of signs, as strokes (after DIN 1451, the type of German road signs).

use core::f32::consts::TAU;

use glam::{Vec2, Vec3};
use kernel::ops;

use crate::mesh::model::Detail;
use crate::mesh::{Mesh, Paint};

/// Width of a stroke as a share of a glyph's height.
const STROKE: f32 = 0.145;

/// Part of a glyph in its box, from (0, 0) below to (1, 1) above, in the reader's directions.
#[derive(Clone, Copy, Debug)]
enum Stroke {
    /// From point to point.
    Line(&'static [[f32; 2]]),
    /// Of an ellipse with a centre and half axes, from one angle anticlockwise to another, degrees from the right.
    Arc([f32; 2], [f32; 2], [f32; 2]),
}

use Stroke::{Arc, Line};

const ZERO: &[Stroke] = &[
    Arc([0.5, 0.72], [0.5, 0.28], [0.0, 180.0]),
    Line(&[[0.0, 0.72], [0.0, 0.28]]),
    Arc([0.5, 0.28], [0.5, 0.28], [180.0, 360.0]),
    Line(&[[1.0, 0.28], [1.0, 0.72]]),
];
const FOOT: &[[f32; 2]] = &[[1.0, 0.0], [0.0, 0.0]];

/// The strokes of a character; none where there is no such glyph.
fn strokes(character: char) -> &'static [Stroke] {
    match character {
        '0' | 'O' => ZERO,
        '1' => &[Line(&[[0.15, 0.72], [0.62, 1.0], [0.62, 0.0]])],
        '2' => &[Arc([0.5, 0.72], [0.48, 0.28], [-32.0, 172.0]), Line(&[[0.91, 0.57], [0.0, 0.0]]), Line(FOOT)],
        '3' => &[Arc([0.48, 0.76], [0.44, 0.24], [-90.0, 160.0]), Arc([0.48, 0.26], [0.5, 0.26], [-160.0, 90.0])],
        '4' => &[Line(&[[0.62, 1.0], [0.0, 0.26], [1.0, 0.26]]), Line(&[[0.74, 0.5], [0.74, 0.0]])],
        '5' => &[Line(&[[0.92, 1.0], [0.12, 1.0], [0.06, 0.54]]), Arc([0.46, 0.32], [0.52, 0.31], [-150.0, 140.0])],
        '6' => &[Arc([0.5, 0.3], [0.5, 0.3], [0.0, 360.0]), Arc([0.96, 0.3], [0.96, 0.72], [112.0, 180.0])],
        '7' => &[Line(&[[0.0, 1.0], [1.0, 1.0], [0.36, 0.0]])],
        '8' => &[Arc([0.5, 0.76], [0.43, 0.24], [0.0, 360.0]), Arc([0.5, 0.26], [0.5, 0.26], [0.0, 360.0])],
        '9' => &[Arc([0.5, 0.7], [0.5, 0.3], [0.0, 360.0]), Arc([0.04, 0.7], [0.96, 0.72], [-68.0, 0.0])],
        'H' => &[Line(&[[0.0, 0.0], [0.0, 1.0]]), Line(&[[1.0, 0.0], [1.0, 1.0]]), Line(&[[0.0, 0.5], [1.0, 0.5]])],
        'P' => &[
            Line(&[[0.0, 0.0], [0.0, 1.0], [0.5, 1.0]]),
            Arc([0.5, 0.74], [0.5, 0.26], [-90.0, 90.0]),
            Line(&[[0.5, 0.48], [0.0, 0.48]]),
        ],
        'S' => &[Arc([0.5, 0.75], [0.48, 0.25], [25.0, 270.0]), Arc([0.5, 0.25], [0.5, 0.25], [-155.0, 90.0])],
        'T' => &[Line(&[[0.0, 1.0], [1.0, 1.0]]), Line(&[[0.5, 1.0], [0.5, 0.0]])],
        _ => &[],
    }
}

impl Stroke {
    fn points(self, detail: Detail) -> Vec<Vec2> {
        match self {
            Line(points) => points.iter().map(|p| Vec2::from_array(*p)).collect(),
            Arc(centre, radii, [from, to]) => {
                let step_deg = if detail == Detail::Fine { 24.0 } else { 60.0 };
                let count = ((to - from) / step_deg).round().max(1.0) as u32;
                let at = |i: u32| (from + (to - from) * i as f32 / count as f32) / 360.0 * TAU;
                let point = |a: f32| Vec2::from(centre) + Vec2::from(radii) * Vec2::new(ops::cos(a), ops::sin(a));
                (0..=count).map(|i| point(at(i))).collect()
            }
        }
    }
}

/// Writes a word on a board whose face looks along x, around `centre`, with glyphs of a width and height, metres, so far from
/// one another. The reader's right is positive y.
pub(super) fn write(mesh: &mut Mesh, paint: Paint, word: &str, centre: Vec3, size: Vec2, gap_m: f32, detail: Detail) {
    let pitch = size.x + gap_m;
    let first = -0.5 * pitch * (word.chars().count() as f32 - 1.0);
    for (i, character) in word.chars().enumerate() {
        let middle = centre + Vec3::Y * (first + pitch * i as f32);
        glyph(mesh, paint, character, middle, size, detail);
    }
}

fn glyph(mesh: &mut Mesh, paint: Paint, character: char, centre: Vec3, size: Vec2, detail: Detail) {
    let half = 0.5 * STROKE * size.y;
    // Strokes keep within the box.
    let room = size - 2.0 * half;
    let place = |p: Vec2| (p - 0.5) * room;
    let on_face = |p: Vec2| centre + Vec3::new(0.0, p.x, p.y);
    for stroke in strokes(character) {
        for pair in stroke.points(detail).windows(2) {
            let (from, to) = (place(pair[0]), place(pair[1]));
            let along = (to - from).normalize_or_zero() * half;
            let aside = along.perp();
            // A little longer than from point to point, so that bends are closed; ends of lines are square.
            let reach = if matches!(stroke, Line(_)) { along } else { 0.3 * along };
            let (from, to) = (from - reach, to + reach);
            mesh.polygon(paint, &[from - aside, to - aside, to + aside, from + aside].map(on_face));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SemanticTag;

    #[test]
    fn glyphs_face_the_reader_and_keep_within_their_box() {
        let paint = Paint::plain(SemanticTag::TrafficSign, [20; 3]);
        let size = Vec2::new(0.16, 0.3);
        for (character, detail) in "0123456789STOPH".chars().flat_map(|c| Detail::ALL.map(|detail| (c, detail))) {
            let mut mesh = Mesh::default();
            write(&mut mesh, paint, &character.to_string(), Vec3::ZERO, size, 0.0, detail);
            assert!(!mesh.is_empty(), "{character}");
            assert!(mesh.vertices.iter().all(|v| v.normal[0] == 127), "{character}");
            let bounds = 0.5 * size + 0.012;
            assert!(
                mesh.vertices.iter().all(|v| v.position[1].abs() < bounds.x && v.position[2].abs() < bounds.y),
                "{character}"
            );
        }
    }
}
