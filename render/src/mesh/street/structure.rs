//! Bridges and tunnels, in pieces along their x axis.

use glam::Vec3;

use crate::SemanticTag;
use crate::mesh::{Mesh, Paint};

/// A piece of a bridge, of class Bridge: seen from below, too.
pub fn bridge(size: Vec3, rise_m: f32) -> Mesh {
    piece(Paint::plain(SemanticTag::Bridge, [150, 146, 138]).grainy(110), size, rise_m)
}

/// A piece of the wall or roof of a tunnel, of class Wall.
pub fn tunnel(size: Vec3, rise_m: f32) -> Mesh {
    piece(Paint::plain(SemanticTag::Wall, [142, 140, 136]).grainy(110), size, rise_m)
}

/// A box whose far end is so much higher than the near one.
fn piece(paint: Paint, size: Vec3, rise_m: f32) -> Mesh {
    let (x, y, rise) = (0.5 * size.x, 0.5 * size.y, 0.5 * rise_m);
    let ring = |z: f32| {
        [Vec3::new(-x, -y, z - rise), Vec3::new(x, -y, z + rise), Vec3::new(x, y, z + rise), Vec3::new(-x, y, z - rise)]
    };
    let mut mesh = Mesh::default();
    mesh.frustum(paint, &ring(0.0), &ring(size.z));
    let [a, b, c, d] = ring(0.0);
    mesh.polygon(paint.shaded(0.9), &[d, c, b, a]);
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_piece_is_closed_and_as_high_at_both_ends() {
        let mesh = bridge(Vec3::new(4.0, 2.0, 1.0), 0.6);
        let at = |i: u32| Vec3::from_array(mesh.vertices[i as usize].position);
        let volume: f32 = mesh.all_triangles().map(|[a, b, c]| at(a).dot(at(b).cross(at(c))) / 6.0).sum();
        assert!((volume - 8.0).abs() < 1e-4, "{volume}");
        let top =
            |x: f32| (0..mesh.vertices.len() as u32).map(at).filter(|p| p.x == x).map(|p| p.z).fold(-9.0, f32::max);
        assert!((top(2.0) - 1.3).abs() < 1e-5 && (top(-2.0) - 0.7).abs() < 1e-5);
    }
}
