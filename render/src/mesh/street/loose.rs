//! Things that somebody may take away, and those that have no class of their own.

use glam::Vec3;

use crate::SemanticTag;
use crate::mesh::model::Detail;
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

/// What is as slim and higher is a bin, metres.
const HIGHEST_CONE_M: f32 = 0.95;
const WHITE: [u8; 3] = [232, 230, 224];
const ORANGE: [u8; 3] = [226, 92, 30];

/// A cone, beacon, barricade or bin of class Dynamic, whichever fits a box of `size` metres.
pub fn movable(variant: u32, size: Vec3, detail: Detail) -> Mesh {
    let (tag, wide) = (SemanticTag::Dynamic, size.x.max(size.y));
    if wide > 1.5 * size.z {
        barricade(tag, size)
    } else if wide < 0.6 * size.z && size.z < HIGHEST_CONE_M && size.x.min(size.y) > 0.6 * wide {
        cone(tag, size, detail)
    } else if size.x.min(size.y) < 0.6 * wide {
        beacon(tag, size)
    } else {
        bin(tag, variant, size)
    }
}

/// Rubber with white rings on a square foot.
pub fn cone(tag: SemanticTag, size: Vec3, detail: Detail) -> Mesh {
    let sides = if detail == Detail::Fine { 12 } else { 6 };
    let (foot, radius) = (0.5 * size.x.min(size.y), 0.4 * size.x.min(size.y));
    let mut mesh = Mesh::default();
    mesh.cuboid(Paint::plain(tag, [40, 40, 42]), Vec3::new(-foot, -foot, 0.0), Vec3::new(foot, foot, 0.05));
    let ring = |share: f32| (Vec3::Z * (0.05 + share * (size.z - 0.05)), radius * (1.0 - 0.8 * share));
    for (k, colour) in [ORANGE, WHITE, ORANGE, WHITE, ORANGE].into_iter().enumerate() {
        let ((a, wide), (b, narrow)) = (ring(0.2 * k as f32), ring(0.2 * (k + 1) as f32));
        mesh.tube(Paint::plain(tag, colour), a, b, wide, narrow, sides);
    }
    mesh
}

/// A striped board on a foot, whose face looks along its x axis.
pub fn beacon(tag: SemanticTag, size: Vec3) -> Mesh {
    let half = 0.5 * size;
    let mut mesh = Mesh::default();
    mesh.cuboid(Paint::plain(tag, [40, 40, 42]), Vec3::new(-half.x, -half.y, 0.0), Vec3::new(half.x, half.y, 0.12));
    let count = (size.z / 0.2).round().clamp(2.0, 12.0) as u32;
    let height = (size.z - 0.12) / count as f32;
    let thick = half.min(Vec3::splat(0.04)).x;
    let (x, y) = if size.x < size.y { (thick, half.y) } else { (half.x, thick) };
    for k in 0..count {
        let low = 0.12 + height * k as f32;
        let colour = if k % 2 == 0 { WHITE } else { [200, 30, 34] };
        mesh.cuboid(Paint::plain(tag, colour), Vec3::new(-x, -y, low), Vec3::new(x, y, low + height));
    }
    mesh
}

/// Red and white boards on two feet.
pub fn barricade(tag: SemanticTag, size: Vec3) -> Mesh {
    let half = 0.5 * size;
    let mut mesh = Mesh::default();
    for x in [-0.8 * half.x, 0.8 * half.x] {
        mesh.cuboid(
            Paint::plain(tag, [90, 92, 94]),
            Vec3::new(x - 0.05, -half.y, 0.0),
            Vec3::new(x + 0.05, half.y, 0.9 * size.z),
        );
    }
    let count = (size.x / 0.4).round().clamp(2.0, 24.0) as u32;
    let length = size.x / count as f32;
    for k in 0..count {
        let x = -half.x + length * k as f32;
        let colour = if k % 2 == 0 { WHITE } else { [200, 30, 34] };
        mesh.cuboid(Paint::plain(tag, colour), Vec3::new(x, -0.03, 0.6 * size.z), Vec3::new(x + length, 0.03, size.z));
    }
    mesh
}

/// A box under a lid.
pub fn bin(tag: SemanticTag, variant: u32, size: Vec3) -> Mesh {
    let body =
        Paint::plain(tag, Variety::of(variant).colour(&[[62, 66, 70], [50, 86, 60], [54, 74, 120], [196, 160, 46]]));
    let half = Vec3::new(0.5 * size.x, 0.5 * size.y, 0.0);
    let mut mesh = Mesh::default();
    mesh.cuboid(body, -half * 0.86, half * 0.86 + Vec3::Z * (0.88 * size.z));
    mesh.cuboid(body.shaded(0.8), -half + Vec3::Z * (0.88 * size.z), half + Vec3::Z * size.z);
    mesh
}

/// A stall, box or heap of class Other, whichever fits a box of `size` metres.
pub fn sundry(variant: u32, size: Vec3) -> Mesh {
    if size.z > 1.9 && size.x.min(size.y) > 0.8 {
        return stall(SemanticTag::Other, variant, size);
    }
    let mut mesh = Mesh::default();
    let half = Vec3::new(0.5 * size.x, 0.5 * size.y, 0.0);
    mesh.cuboid(cloth(SemanticTag::Other, &mut Variety::of(variant)), -half, half + Vec3::Z * size.z);
    mesh
}

fn cloth(tag: SemanticTag, variety: &mut Variety) -> Paint {
    Paint::plain(tag, variety.colour(&[[196, 168, 60], [150, 62, 54], [70, 96, 120], [176, 174, 166]]))
}

/// A roof on four posts, with a counter or a back wall.
pub fn stall(tag: SemanticTag, variant: u32, size: Vec3) -> Mesh {
    let mut variety = Variety::of(variant);
    let paint = cloth(tag, &mut variety);
    let half = Vec3::new(0.5 * size.x, 0.5 * size.y, 0.0);
    let mut mesh = Mesh::default();
    let post = paint.colour([96, 98, 100]);
    for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let at = Vec3::new(x * (half.x - 0.06), y * (half.y - 0.06), 0.0);
        mesh.cuboid(post, at - Vec3::new(0.05, 0.05, 0.0), at + Vec3::new(0.05, 0.05, size.z - 0.2));
    }
    let counter = 0.9f32.min(size.z - 0.2);
    let back = if variety.between(0.0, 1.0) < 0.5 { counter } else { size.z - 0.2 };
    mesh.cuboid(paint.shaded(0.75), Vec3::new(-half.x, half.y - 0.12, 0.0), Vec3::new(half.x, half.y - 0.06, back));
    mesh.cuboid(paint.shaded(0.85), Vec3::new(-half.x, -half.y + 0.1, 0.0), Vec3::new(half.x, 0.0, counter));
    mesh.cuboid(paint, -half + Vec3::Z * (size.z - 0.2), half + Vec3::Z * size.z);
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever a file says of its size, a thing is of its class and stays within its box.
    #[test]
    fn things_fill_their_box_and_no_more() {
        for size in
            [[0.4, 0.4, 0.75], [0.2, 0.4, 1.1], [2.4, 0.5, 1.0], [0.6, 0.6, 1.1], [3.2, 2.0, 2.3], [0.1, 9.0, 0.3]]
        {
            let size = Vec3::from_array(size);
            for variant in 0..8 {
                let meshes = [
                    (movable(variant, size, Detail::Fine), SemanticTag::Dynamic),
                    (sundry(variant, size), SemanticTag::Other),
                ];
                for (mesh, tag) in meshes {
                    assert!(mesh.vertices.iter().all(|v| v.tag == tag as u8));
                    let places = || mesh.vertices.iter().map(|v| Vec3::from_array(v.position));
                    assert!(places().all(|p| p.abs().cmple(size * Vec3::new(0.5, 0.5, 1.0) + 0.051).all()), "{size}");
                    assert!((places().map(|p| p.z).fold(0.0, f32::max) - size.z).abs() < 1e-3, "{size} {tag:?}");
                }
            }
        }
    }
}
