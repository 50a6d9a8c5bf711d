//! Traffic lights.

use core::f32::consts::PI;

use glam::Vec3;
use kernel::ops;
use kernel::signals::LightPhase;

use crate::SemanticTag;
use crate::mesh::model::Detail;
use crate::mesh::{CODE_LIT, Mesh, Paint};

const STEEL: Paint = Paint::plain(SemanticTag::Pole, [92, 96, 98]).glossy(30);
const SHELL: Paint = Paint::plain(SemanticTag::TrafficLight, [34, 38, 36]);
const YELLOW: [u8; 3] = [222, 176, 34];

/// The pole reaches so far above the middle of the lamps, metres: brackets hold a head above and below.
const ABOVE_M: f32 = 0.62;
/// From the middle of a head to that of its upper and lower lamp, metres.
const PITCH_M: f32 = 0.32;
/// Height of the box with the button for who walks, metres.
const BUTTON_M: f32 = 1.05;

/// The pole of a signal head, whose lamps are `lamps_m` high.
pub fn pole(lamps_m: f32, detail: Detail) -> Mesh {
    let mut mesh = Mesh::default();
    let sides = if detail == Detail::Fine { 10 } else { 4 };
    let top = Vec3::Z * (lamps_m + ABOVE_M);
    mesh.tube(STEEL, Vec3::ZERO, top, 0.075, 0.06, sides);
    mesh.disc(STEEL, top, Vec3::Z, 0.06, sides);
    if detail != Detail::Rough {
        mesh.tube(STEEL.shaded(0.8), Vec3::ZERO, Vec3::Z * 0.5, 0.11, 0.1, sides);
        mesh.disc(STEEL.shaded(0.8), Vec3::Z * 0.5, Vec3::Z, 0.1, sides);
        let low = Vec3::new(-0.07, 0.06, BUTTON_M - 0.12);
        mesh.cuboid(STEEL.colour(YELLOW), low, low + Vec3::new(0.14, 0.1, 0.26));
    }
    if detail == Detail::Fine {
        for z in [lamps_m - ABOVE_M + 0.06, lamps_m + ABOVE_M - 0.1] {
            mesh.cuboid(STEEL.shaded(0.8), Vec3::new(-0.08, -0.08, z), Vec3::new(0.17, 0.08, z + 0.05));
        }
        mesh.disc(STEEL.colour([190, 30, 30]), Vec3::new(0.0, 0.165, BUTTON_M), Vec3::Y, 0.035, 8);
    }
    mesh
}

/// A signal head of class TrafficLight around the middle of its lamps, which shine along its x axis.
///
/// It hangs in front of the axis of its pole.
pub fn head(phase: LightPhase, detail: Detail) -> Mesh {
    let mut mesh = Mesh::default();
    housing(&mut mesh, detail);
    board(&mut mesh, detail);
    let sides = match detail {
        Detail::Fine => 16,
        Detail::Coarse => 6,
        Detail::Rough => 4,
    };
    for (own, z, lit, dark) in [
        (LightPhase::Red, PITCH_M, [255, 40, 30], [66, 14, 14]),
        (LightPhase::Yellow, 0.0, [255, 190, 20], [64, 50, 12]),
        (LightPhase::Green, -PITCH_M, [30, 240, 120], [12, 54, 34]),
    ] {
        let paint = if own == phase { SHELL.colour(lit).coded(CODE_LIT) } else { SHELL.colour(dark).glossy(90) };
        if detail == Detail::Fine {
            mesh.disc(SHELL.shaded(0.7), Vec3::new(0.303, 0.0, z), Vec3::X, 0.142, sides);
            visor(&mut mesh, z);
        }
        mesh.disc(paint, Vec3::new(0.306, 0.0, z), Vec3::X, 0.125, sides);
    }
    mesh
}

/// One chamber for each lamp, or all in one from afar.
fn housing(mesh: &mut Mesh, detail: Detail) {
    if detail != Detail::Fine {
        mesh.cuboid(SHELL, Vec3::new(0.08, -0.17, -0.5), Vec3::new(0.3, 0.17, 0.5));
        return;
    }
    for z in [-PITCH_M, 0.0, PITCH_M] {
        let ring = |x: f32, half_y: f32, half_z: f32| {
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            corners.map(|(y, up): (f32, f32)| Vec3::new(x, y * half_y, z + up * half_z))
        };
        // Flat in front, with rounded shoulders behind.
        let [back, middle, front] = [ring(0.1, 0.11, 0.11), ring(0.18, 0.17, 0.158), ring(0.3, 0.17, 0.158)];
        mesh.walls(SHELL.shaded(1.15), &back, &middle);
        mesh.frustum(SHELL, &middle, &front);
        let [a, b, c, d] = back;
        mesh.polygon(SHELL, &[d, c, b, a]);
    }
}

/// A back board in white and dark makes it stand out, as in many countries.
fn board(mesh: &mut Mesh, detail: Detail) {
    // Corners are cut where that can be seen.
    let cut = if detail == Detail::Fine { 0.08 } else { 0.0 };
    let outline = |x: f32, y: f32, z: f32| -> Vec<Vec3> {
        if cut == 0.0 {
            return [(-y, -z), (y, -z), (y, z), (-y, z)].map(|(y, z)| Vec3::new(x, y, z)).to_vec();
        }
        let (y1, z1) = (y - cut, z - cut);
        [(-y1, -z), (y1, -z), (y, -z1), (y, z1), (y1, z), (-y1, z), (-y, z1), (-y, -z1)]
            .map(|(y, z)| Vec3::new(x, y, z))
            .to_vec()
    };
    mesh.polygon(SHELL.colour([214, 214, 208]), &outline(0.08, 0.27, 0.62));
    mesh.polygon(SHELL.colour([28, 30, 30]), &outline(0.084, 0.24, 0.59));
    let mut back = outline(0.075, 0.27, 0.62);
    back.reverse();
    mesh.polygon(SHELL.colour([70, 74, 74]), &back);
}

/// A tunnel over a lamp, open below.
fn visor(mesh: &mut Mesh, z: f32) {
    let (root, tip) = (0.3, 0.48);
    let at = |x: f32, i: u32| {
        // From a little below the middle on one side over the top to the other.
        let angle = PI * (-0.12 + 1.24 * i as f32 / 8.0);
        let slope = if x > root { 0.96 } else { 1.0 };
        Vec3::new(x, 0.148 * ops::cos(angle), z + 0.148 * slope * ops::sin(angle))
    };
    for i in 0..8 {
        let strip = [at(root, i), at(tip, i), at(tip, i + 1), at(root, i + 1)];
        mesh.polygon(SHELL, &strip);
        mesh.polygon(SHELL.shaded(0.6), &[strip[3], strip[2], strip[1], strip[0]]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lit(phase: LightPhase, detail: Detail) -> Vec<Vec3> {
        let mesh = head(phase, detail);
        mesh.vertices.iter().filter(|v| v.code == CODE_LIT).map(|v| Vec3::from(v.position)).collect()
    }

    #[test]
    fn one_lamp_shines_in_front_of_all_else_where_a_driver_looks() {
        for (phase, z) in [(LightPhase::Red, PITCH_M), (LightPhase::Yellow, 0.0), (LightPhase::Green, -PITCH_M)] {
            for detail in Detail::ALL {
                let middle = lit(phase, detail).iter().sum::<Vec3>() / lit(phase, detail).len() as f32;
                assert!(middle.distance(Vec3::new(0.306, 0.0, z)) < 0.01, "{phase:?} {detail:?}: {middle}");
            }
        }
    }

    /// A visor keeps within the width of its chamber and leaves its lamp open below.
    #[test]
    fn visors_are_open_below() {
        let mesh = head(LightPhase::Red, Detail::Fine);
        let out: Vec<Vec3> = mesh.vertices.iter().map(|v| Vec3::from(v.position)).filter(|p| p.x > 0.4).collect();
        assert!(!out.is_empty());
        for z in [-PITCH_M, 0.0, PITCH_M] {
            assert!(out.iter().filter(|p| (p.z - z).abs() < 0.15).all(|p| p.z > z - 0.07 && p.y.abs() < 0.15));
        }
    }
}
