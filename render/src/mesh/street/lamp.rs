//! Street lamps.

use glam::{Quat, Vec3};

use crate::SemanticTag;
use crate::mesh::model::Detail;
use crate::mesh::{CODE_STREET, Mesh, Paint};

const STEEL: Paint = Paint::plain(SemanticTag::Pole, [132, 136, 138]).glossy(30);
const IRON: Paint = Paint::plain(SemanticTag::Pole, [40, 56, 52]).glossy(40);

/// Lamps that are no higher stand in old streets, metres.
const OLD_M: f32 = 5.5;
/// Lamps that are no higher have straight arms, metres.
const SLANTED_M: f32 = 6.5;

/// End of the arm of a street lamp, and the box that hangs on it.
fn lamp_box(height_m: f32) -> [Vec3; 3] {
    let tip = Vec3::new(1.5, 0.0, height_m - 0.05);
    [tip, tip - Vec3::new(0.2, 0.15, 0.07), tip + Vec3::new(0.55, 0.15, 0.07)]
}

/// Middle of the glass of a street lamp.
pub(crate) fn lamp_glass(height_m: f32) -> Vec3 {
    let [_, low, high] = lamp_box(height_m);
    Vec3::new(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), low.z - 0.03)
}

/// A street lamp `height_m` high whose arm reaches along its x axis. Its height tells which streets it is made for.
pub fn lamp(height_m: f32, detail: Detail) -> Mesh {
    let mut mesh = Mesh::default();
    let sides = if detail == Detail::Fine { 10 } else { 4 };
    let glass = Paint::plain(SemanticTag::Pole, [226, 224, 206]).glossy(120).coded(CODE_STREET);
    if height_m < OLD_M {
        old(&mut mesh, height_m, glass, sides);
        return mesh;
    }
    let [tip, low, high] = lamp_box(height_m);
    mesh.tube(STEEL.shaded(0.85), Vec3::ZERO, Vec3::Z * 0.9, 0.13, 0.12, sides);
    mesh.tube(STEEL.shaded(0.85), Vec3::Z * 0.9, Vec3::Z * 0.98, 0.12, 0.085, sides);
    if detail == Detail::Fine {
        // The door to its fuses.
        mesh.cuboid(STEEL.shaded(0.6), Vec3::new(-0.05, 0.118, 0.35), Vec3::new(0.05, 0.128, 0.7));
    }
    let arm: &[Vec3] = if height_m < SLANTED_M {
        &[Vec3::Z * (height_m - 0.2), tip]
    } else {
        // It bends out of the pole.
        let at = |x: f32, down: f32| Vec3::new(x, 0.0, height_m - down);
        if detail == Detail::Rough { &[at(0.0, 0.9), tip] } else { &[at(0.0, 0.9), at(0.12, 0.45), at(0.5, 0.16), tip] }
    };
    mesh.tube(STEEL, Vec3::Z * 0.9, arm[0], 0.085, 0.055, sides);
    for pair in arm.windows(2) {
        mesh.tube(STEEL, pair[0], pair[1], 0.05, 0.045, sides.min(6));
    }
    if height_m < SLANTED_M {
        mesh.disc(STEEL, arm[0], Vec3::Z, 0.055, sides);
    }
    head(&mut mesh, [low, high], glass, detail);
    mesh
}

/// A flat housing that gets slimmer towards the arm, with its glass below.
fn head(mesh: &mut Mesh, [low, high]: [Vec3; 2], glass: Paint, detail: Detail) {
    let shell = STEEL.shaded(0.8);
    if detail == Detail::Rough {
        mesh.cuboid(shell, low, high);
    } else {
        let ring = |z: f32, inner: f32, front: f32| {
            let (x0, x1, y0, y1) = (low.x, high.x - front, 0.45 * low.y + inner, low.y + inner);
            [Vec3::new(x0, y0, z), Vec3::new(x1, y1, z), Vec3::new(x1, -y1, z), Vec3::new(x0, -y0, z)]
        };
        let [floor, middle, roof] = [ring(low.z, 0.0, 0.0), ring(low.z + 0.07, 0.0, 0.0), ring(high.z, 0.05, 0.07)];
        mesh.walls(shell, &floor, &middle);
        mesh.frustum(shell.shaded(1.1), &middle, &roof);
        let [a, b, c, d] = floor;
        mesh.polygon(shell, &[d, c, b, a]);
    }
    mesh.cuboid(glass, low + Vec3::new(0.1, 0.03, -0.03), Vec3::new(high.x - 0.1, high.y - 0.03, low.z));
}

/// A pole of cast iron with a swan's neck, from which a bell hangs.
fn old(mesh: &mut Mesh, height_m: f32, glass: Paint, sides: u32) {
    let at = lamp_glass(height_m);
    for (from, to, thick, slim) in [
        (0.0, 0.25, 0.15, 0.13),
        (0.25, 0.95, 0.1, 0.09),
        (0.95, 1.05, 0.115, 0.1),
        (1.05, height_m - 0.75, 0.06, 0.05),
    ] {
        mesh.tube(IRON, Vec3::Z * from, Vec3::Z * to, thick, slim, sides);
    }
    let (start, top) = (height_m - 0.75, height_m + 0.35);
    let neck = [
        Vec3::Z * start,
        Vec3::new(0.08, 0.0, start + 0.55),
        Vec3::new(0.45, 0.0, top - 0.1),
        Vec3::new(0.95, 0.0, top),
        Vec3::new(at.x - 0.2, 0.0, top - 0.08),
        Vec3::new(at.x, 0.0, at.z + 0.32),
    ];
    let links = if sides > 4 { &neck[..] } else { &[neck[0], neck[2], neck[5]] };
    for pair in links.windows(2) {
        mesh.tube(IRON, pair[0], pair[1], 0.04, 0.035, sides.min(6));
    }
    let bell = |from: f32, to: f32, thick: f32, slim: f32, mesh: &mut Mesh| {
        mesh.tube(IRON, at + Vec3::Z * from, at + Vec3::Z * to, thick, slim, sides);
    };
    bell(0.03, 0.12, 0.3, 0.24, mesh);
    bell(0.12, 0.3, 0.24, 0.06, mesh);
    // Seen from below: the glass in its rim.
    let down = Quat::from_rotation_x(core::f32::consts::PI) * Vec3::Z;
    mesh.disc(IRON, at + Vec3::Z * 0.03, down, 0.3, sides);
    mesh.tube(glass, at - Vec3::Z * 0.05, at + Vec3::Z * 0.03, 0.12, 0.24, sides);
    mesh.disc(glass, at - Vec3::Z * 0.05, down, 0.12, sides);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What shines is where the light is said to come from, and each height has arms of its own.
    #[test]
    fn the_glass_is_around_the_place_of_the_light() {
        for height_m in [5.0, 6.0, 7.0] {
            for detail in Detail::ALL {
                let mesh = lamp(height_m, detail);
                let glass: Vec<Vec3> =
                    mesh.vertices.iter().filter(|v| v.code == CODE_STREET).map(|v| Vec3::from(v.position)).collect();
                let middle = glass.iter().sum::<Vec3>() / glass.len() as f32;
                assert!(middle.distance(lamp_glass(height_m)) < 0.06, "{height_m}: {middle}");
            }
        }
    }
}
