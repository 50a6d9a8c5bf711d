//! Heads, hair and what is worn on them.

use glam::Vec3;

use super::figure::{Look, Station};
use super::outfit::{Hair, Headgear};
use crate::mesh::Mesh;
use crate::mesh::model::Detail::{Coarse, Fine, Rough};
use crate::mesh::rings::Ring;

/// Where the neck begins, above the hips' middle, metres; heads are larger or smaller from here on.
const NECK_M: f32 = 0.59;

impl Look {
    /// Rings of a head of this size on this back.
    fn head_rings(&self, stations: &[Station]) -> Vec<Ring> {
        let (size, spine_m) = (self.outfit.build.head, self.spine_m(0.65));
        let mut rings = self.rings(stations);
        for ring in &mut rings {
            ring.radii *= size;
            let Vec3 { x, z, .. } = ring.centre;
            ring.centre = Vec3::new(spine_m + x * size, 0.0, NECK_M + (z - NECK_M) * size);
        }
        rings
    }

    fn shell(&self, mesh: &mut Mesh, colour: [u8; 3], stations: &[Station]) {
        mesh.loft(self.paint(colour), &self.head_rings(stations), self.by_detail([10, 6, 4]));
    }

    /// Neck, head and what covers it.
    pub(super) fn head(&self, mesh: &mut Mesh, helmet: Option<[u8; 3]>) {
        let outfit = &self.outfit;
        if self.detail == Rough {
            return self.rough_head(mesh, helmet);
        }
        let neck = [(0.53, -0.01, [0.05, 0.052], Coarse), (0.64, 0.002, [0.05, 0.05], Coarse)];
        mesh.loft(self.paint(outfit.skin).shaded(0.92), &self.head_rings(&neck), self.by_detail([8, 5, 3]));
        let skull = [
            (0.602, 0.022, [0.0; 2], Coarse),
            (0.606, 0.036, [0.045, 0.034], Fine),
            (0.638, 0.022, [0.076, 0.058], Coarse),
            (0.69, 0.012, [0.092, 0.072], Fine),
            (0.745, 0.004, [0.097, 0.077], Coarse),
            (0.792, -0.002, [0.084, 0.067], Fine),
            (0.82, -0.004, [0.052, 0.042], Fine),
            (0.832, -0.004, [0.0; 2], Coarse),
        ];
        self.shell(mesh, outfit.skin, &skull);
        if self.detail == Fine {
            self.face(mesh);
        }
        if outfit.beard {
            let beard = [
                (0.594, 0.03, [0.0; 2], Coarse),
                (0.602, 0.042, [0.05, 0.04], Fine),
                (0.636, 0.026, [0.08, 0.064], Coarse),
                (0.664, 0.01, [0.079, 0.069], Fine),
            ];
            self.shell(mesh, outfit.hair_colour, &beard);
        }
        if let Some(colour) = helmet {
            let shell = [
                (0.715, -0.02, [0.122, 0.104], Coarse),
                (0.775, -0.01, [0.128, 0.106], Coarse),
                (0.83, -0.01, [0.1, 0.082], Fine),
                (0.866, -0.014, [0.0; 2], Coarse),
            ];
            let rings = self.head_rings(&shell);
            return mesh.loft(self.paint(colour).glossy(120), &rings, self.by_detail([10, 6, 4]));
        }
        if outfit.headgear != Headgear::Scarf {
            self.hair(mesh);
        }
        self.headgear(mesh);
    }

    fn rough_head(&self, mesh: &mut Mesh, helmet: Option<[u8; 3]>) {
        let outfit = &self.outfit;
        let cover = match (helmet, outfit.headgear, outfit.hair) {
            (Some(colour), ..) => colour,
            (_, Headgear::None, Hair::Bald) => outfit.skin,
            (_, Headgear::None, _) => outfit.hair_colour,
            _ => outfit.headgear_colour,
        };
        // From afar, half of a head is skin.
        let colour = std::array::from_fn(|i| u8::midpoint(cover[i], outfit.skin[i]));
        let (wide, top_m) = if helmet.is_some() { (0.11, 0.86) } else { (0.095, 0.84) };
        let head = [
            (0.56, 0.01, [0.0; 2], Rough),
            (0.66, 0.01, [0.088, 0.075], Rough),
            (0.77, 0.0, [wide, 0.9 * wide], Rough),
            (top_m, 0.0, [0.0; 2], Rough),
        ];
        self.shell(mesh, colour, &head);
    }

    /// Eyes, nose and mouth.
    fn face(&self, mesh: &mut Mesh) {
        let (size, spine_m) = (self.outfit.build.head, self.spine_m(0.65));
        let at = |x: f32, y: f32, z: f32| Vec3::new(spine_m + x * size, y * size, NECK_M + (z - NECK_M) * size);
        let mut patch = |colour: [u8; 3], [x, y, z]: [f32; 3], [wide, high]: [f32; 2]| {
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            // The sides of a face recede.
            let corners = corners.map(|(u, v)| at(x - 0.45 * u * wide * y.signum(), y + u * wide, z + v * high));
            mesh.polygon(self.paint(colour), &corners);
        };
        for y in [-0.031, 0.031] {
            patch([52, 40, 36], [0.097, y, 0.722], [0.013, 0.0055]);
            patch(self.outfit.hair_colour, [0.097, y, 0.743], [0.018, 0.003]);
        }
        let skin = self.paint(self.outfit.skin);
        let tip = at(0.13, 0.0, 0.694);
        let (bridge, left, right) = (at(0.1, 0.0, 0.73), at(0.098, 0.018, 0.688), at(0.098, -0.018, 0.688));
        for [a, b, c] in [[bridge, tip, left], [bridge, right, tip], [left, tip, right]] {
            mesh.polygon(skin, &[a, b, c]);
        }
        let lips = self.outfit.skin.map(|c| (f32::from(c) * 0.72) as u8);
        for side in [-1.0, 1.0f32] {
            let corners = [(0.1025, 0.0, 0.652), (0.092, 0.026, 0.656), (0.1035, 0.0, 0.662)];
            let [a, b, c] = corners.map(|(x, y, z)| at(x, side * y, z));
            let corners = if side > 0.0 { [a, b, c] } else { [a, c, b] };
            mesh.polygon(self.paint([lips[0].saturating_add(14), lips[1], lips[2]]), &corners);
        }
    }

    fn hair(&self, mesh: &mut Mesh) {
        let outfit = &self.outfit;
        let mut stations = vec![
            (0.668, -0.034, [0.068, 0.07], Coarse),
            (0.72, -0.028, [0.084, 0.083], Fine),
            (0.775, -0.013, [0.096, 0.086], Coarse),
            (0.817, -0.006, [0.074, 0.066], Fine),
            (0.844, -0.006, [0.0; 2], Coarse),
        ];
        match outfit.hair {
            Hair::Bald => return,
            Hair::Short => {}
            Hair::Long => {
                let back = [(0.47, -0.07, [0.034, 0.09], Coarse), (0.56, -0.062, [0.05, 0.094], Coarse)];
                stations.splice(0..0, back);
            }
            Hair::Tied => {
                let bun = [
                    (0.69, -0.118, [0.0; 2], Coarse),
                    (0.735, -0.125, [0.042, 0.04], Coarse),
                    (0.775, -0.115, [0.0; 2], Coarse),
                ];
                self.shell(mesh, outfit.hair_colour, &bun);
            }
        }
        self.shell(mesh, outfit.hair_colour, &stations);
    }

    fn headgear(&self, mesh: &mut Mesh) {
        let colour = self.outfit.headgear_colour;
        let dome = |low_m: f32, top_m: f32| {
            [
                (low_m, -0.004, [0.105, 0.089], Coarse),
                (top_m - 0.035, -0.008, [0.092, 0.078], Coarse),
                (top_m - 0.01, -0.01, [0.06, 0.05], Fine),
                (top_m, -0.01, [0.0; 2], Coarse),
            ]
        };
        match self.outfit.headgear {
            Headgear::None => {}
            Headgear::Beanie => self.shell(mesh, colour, &dome(0.748, 0.868)),
            Headgear::Cap => {
                self.shell(mesh, colour, &dome(0.77, 0.858));
                let visor = [(0.764, 0.07, [0.098, 0.072], Coarse), (0.776, 0.04, [0.06, 0.06], Coarse)];
                self.shell(mesh, colour, &visor);
                let under = [visor[1], visor[0]];
                self.shell(mesh, colour.map(|c| c / 2), &under);
            }
            Headgear::Hat => {
                self.shell(mesh, colour, &dome(0.765, 0.882));
                let brim = [(0.764, -0.004, [0.168, 0.152], Coarse), (0.774, -0.004, [0.1, 0.084], Coarse)];
                self.shell(mesh, colour, &brim);
                self.shell(mesh, colour.map(|c| c / 2), &[brim[1], brim[0]]);
            }
            Headgear::Scarf => {
                let wrap = [
                    (0.49, -0.012, [0.088, 0.12], Coarse),
                    (0.55, -0.01, [0.074, 0.086], Fine),
                    (0.62, -0.012, [0.084, 0.08], Coarse),
                    (0.7, -0.016, [0.096, 0.086], Fine),
                    (0.775, -0.006, [0.1, 0.088], Coarse),
                    (0.825, -0.006, [0.068, 0.058], Fine),
                    (0.85, -0.006, [0.0; 2], Coarse),
                ];
                self.shell(mesh, colour, &wrap);
            }
        }
    }
}
