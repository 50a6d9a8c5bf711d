//! People behind the windows of vehicles: silhouettes on the glass, as much as its reflections let anyone see.

use glam::Vec3;

use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

const SKINS: [[u8; 3]; 4] = [[236, 196, 168], [214, 166, 132], [166, 118, 88], [104, 70, 50]];
const HAIRS: [[u8; 3]; 4] = [[36, 28, 24], [82, 58, 38], [142, 104, 62], [150, 148, 144]];
const TOPS: [[u8; 3]; 6] = [[188, 42, 44], [62, 98, 162], [228, 224, 214], [84, 86, 92], [74, 126, 88], [196, 110, 60]];

/// How much of people's colours shows through glass.
const SEEN_SHARE: f32 = 0.36;

/// Silhouettes lie so far before the glass, metres: less than anything that is mounted on it.
const BEFORE_GLASS_M: f32 = 0.006;

/// Half the width of a head and of a trunk, seen from the front and from the side, metres.
const HEAD_M: [f32; 2] = [0.085, 0.1];
const TRUNK_M: [f32; 2] = [0.22, 0.14];

/// From which side a window shows who sits behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum From {
    Ahead,
    Behind,
    Aside,
}

/// Somebody who sits in a vehicle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Occupant {
    /// Middle of the head.
    head: Vec3,
    skin: [u8; 3],
    hair: [u8; 3],
    top: [u8; 3],
}

impl Occupant {
    pub(super) fn of(variety: &mut Variety, head: Vec3) -> Self {
        Self { head, skin: variety.pick(&SKINS), hair: variety.pick(&HAIRS), top: variety.pick(&TOPS) }
    }

    /// Paints head and trunk on a window whose corners begin with its lower edge, as seen from one side.
    pub(super) fn show(&self, mesh: &mut Mesh, glass: Paint, window: &[Vec3; 4], from: From) {
        let normal = (window[1] - window[0]).cross(window[2] - window[0]).normalize_or_zero();
        let (across, depth) = if from == From::Aside { (Vec3::X, Vec3::Y) } else { (Vec3::Y, Vec3::X) };
        let bottom = window[0].z.max(window[1].z) + 0.005;
        let [trunk, head] = [TRUNK_M, HEAD_M].map(|widths| widths[usize::from(from == From::Aside)]);
        let through = |colour: [u8; 3]| {
            let seen = |i: usize| {
                f32::from(glass.colour[i]) + SEEN_SHARE * (f32::from(colour[i]) - f32::from(glass.colour[i]))
            };
            glass.colour(core::array::from_fn(|i| seen(i) as u8))
        };
        let mut paint_on = |colour: [u8; 3], outline: &[(f32, f32)]| {
            let onto = |&(aside, up): &(f32, f32)| {
                let p = self.head + across * aside + Vec3::Z * up;
                let p = p.with_z(p.z.max(bottom));
                p + depth * ((window[0] - p).dot(normal) / depth.dot(normal)) + normal * BEFORE_GLASS_M
            };
            let mut ring: Vec<Vec3> = outline.iter().map(onto).collect();
            if (ring[1] - ring[0]).cross(ring[2] - ring[0]).dot(normal) < 0.0 {
                ring.reverse();
            }
            mesh.polygon(through(colour), &ring);
        };
        // From behind, seats hide all but heads.
        if from != From::Behind {
            paint_on(self.top, &[(-trunk, -0.45), (trunk, -0.45), (0.8 * trunk, -0.15), (-0.8 * trunk, -0.15)]);
        }
        let face = if from == From::Behind { self.hair } else { self.skin };
        let (half, low, high) = (0.6 * head, -0.13, 0.12);
        paint_on(face, &[(-half, low), (half, low), (head, 0.0), (half, high), (-half, high), (-head, 0.0)]);
    }
}
