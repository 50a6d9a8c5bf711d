//! Traffic lights.

use glam::Vec3;
use kernel::signals::LightPhase;

use crate::SemanticTag;
use crate::mesh::model::Detail;
use crate::mesh::{CODE_LIT, Mesh, Paint};

/// The pole of a signal head.
pub fn pole(height_m: f32, detail: Detail) -> Mesh {
    let steel = Paint::plain(SemanticTag::Pole, [92, 96, 98]).glossy(30);
    let mut mesh = Mesh::default();
    let sides = if detail == Detail::Fine { 8 } else { 4 };
    mesh.tube(steel, Vec3::ZERO, Vec3::Z * height_m, 0.075, 0.06, sides);
    mesh.disc(steel, Vec3::Z * height_m, Vec3::Z, 0.06, sides);
    mesh
}

/// A signal head of class TrafficLight around the middle of its lamps, which shine along its x axis.
///
/// It hangs in front of the axis of its pole.
pub fn head(phase: LightPhase, detail: Detail) -> Mesh {
    let shell = Paint::plain(SemanticTag::TrafficLight, [34, 38, 36]);
    let mut mesh = Mesh::default();
    mesh.cuboid(shell, Vec3::new(0.08, -0.17, -0.5), Vec3::new(0.3, 0.17, 0.5));
    // A back board in white and dark makes it stand out, as in many countries.
    let board =
        |x: f32, y: f32, z: f32| [Vec3::new(x, -y, -z), Vec3::new(x, y, -z), Vec3::new(x, y, z), Vec3::new(x, -y, z)];
    let mut back = board(0.075, 0.27, 0.62);
    mesh.polygon(shell.colour([214, 214, 208]), &board(0.08, 0.27, 0.62));
    mesh.polygon(shell.colour([28, 30, 30]), &board(0.084, 0.24, 0.59));
    back.reverse();
    mesh.polygon(shell, &back);
    let sides = match detail {
        Detail::Fine => 12,
        Detail::Coarse => 6,
        Detail::Rough => 4,
    };
    for (own, z, lit, dark) in [
        (LightPhase::Red, 0.32, [255, 40, 30], [66, 14, 14]),
        (LightPhase::Yellow, 0.0, [255, 190, 20], [64, 50, 12]),
        (LightPhase::Green, -0.32, [30, 240, 120], [12, 54, 34]),
    ] {
        let paint = if own == phase { shell.colour(lit).coded(CODE_LIT) } else { shell.colour(dark) };
        mesh.disc(paint, Vec3::new(0.306, 0.0, z), Vec3::X, 0.125, sides);
        if detail == Detail::Fine {
            visor(&mut mesh, shell, z);
        }
    }
    mesh
}

/// A small roof over a lamp.
fn visor(mesh: &mut Mesh, shell: Paint, z: f32) {
    let at = |x: f32, y: f32, up: f32| Vec3::new(x, y, z + up);
    let (root, tip) = (0.3, 0.46);
    let arc = [(-0.14, 0.02), (-0.1, 0.11), (0.1, 0.11), (0.14, 0.02)];
    for pair in arc.windows(2) {
        let ((y0, z0), (y1, z1)) = (pair[0], pair[1]);
        let strip = [at(root, y0, z0), at(tip, y0, z0), at(tip, y1, z1), at(root, y1, z1)];
        mesh.polygon(shell, &strip);
        mesh.polygon(shell.shaded(0.6), &[strip[3], strip[2], strip[1], strip[0]]);
    }
}
