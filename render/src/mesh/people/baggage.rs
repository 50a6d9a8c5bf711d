//! What people carry. It is of their class and instance, as in Cityscapes.

use glam::Vec3;

use super::figure::{HAND_M, Look};
use super::outfit::Carried;
use crate::mesh::Mesh;
use crate::mesh::model::Detail::{Coarse, Fine, Rough};
use crate::mesh::rings::Ring;

const STEEL: [u8; 3] = [120, 122, 126];

impl Look {
    /// The hand that holds something: 1 is left.
    pub(super) fn hand(&self) -> f32 {
        -self.outfit.bears
    }

    /// What hangs on the trunk.
    pub(super) fn worn(&self, mesh: &mut Mesh) {
        let (outfit, spine_m) = (&self.outfit, self.spine_m(0.3));
        let bag = self.paint(outfit.carried_colour);
        match outfit.carried {
            Carried::Backpack if self.detail == Fine => {
                let pack = [
                    Ring::new(0.06, -0.18, [0.0; 2]),
                    Ring::new(0.07, -0.185, [0.065, 0.12]),
                    Ring::new(0.16, -0.195, [0.09, 0.145]),
                    Ring::new(0.36, -0.19, [0.085, 0.14]),
                    Ring::new(0.46, -0.175, [0.06, 0.115]),
                    Ring::new(0.5, -0.16, [0.0; 2]),
                ];
                mesh.loft(bag, &pack.map(|r| Ring { centre: r.centre + Vec3::X * spine_m, ..r }), 8);
            }
            Carried::Backpack => {
                let (low, high) = (Vec3::new(-0.27, -0.13, 0.08), Vec3::new(-0.1, 0.13, 0.48));
                mesh.cuboid(bag, low + Vec3::X * spine_m, high + Vec3::X * spine_m);
            }
            Carried::Handbag => {
                let y = self.hand() * (outfit.build.hips_m + 0.065);
                let low = Vec3::new(-0.14, y - 0.04, -0.16);
                mesh.cuboid(bag, low, low + Vec3::new(0.28, 0.08, 0.2));
                if self.detail < Rough {
                    let shoulder = Vec3::new(0.0, self.hand() * 0.75 * outfit.build.shoulders_m, 0.5);
                    mesh.tube(bag, Vec3::new(0.1, y, 0.04), shoulder + Vec3::X * 0.07, 0.012, 0.012, 3);
                    mesh.tube(bag, Vec3::new(-0.1, y, 0.04), shoulder - Vec3::X * 0.07, 0.012, 0.012, 3);
                }
            }
            _ => {}
        }
    }

    /// What is held in a hanging hand.
    pub(super) fn held(&self, mesh: &mut Mesh, side: f32) {
        if side != self.hand() {
            return;
        }
        let bag = self.paint(self.outfit.carried_colour);
        let hand = Vec3::new(0.0, side * 0.035, -HAND_M);
        match self.outfit.carried {
            Carried::ShoppingBag => {
                let low = hand + Vec3::new(-0.15, -0.055, -0.46);
                mesh.cuboid(bag, low, low + Vec3::new(0.3, 0.11, 0.3));
                if self.detail < Rough {
                    for x in [-0.1, 0.1] {
                        mesh.tube(bag, hand + Vec3::new(x, 0.0, -0.17), hand - Vec3::Z * 0.03, 0.008, 0.008, 3);
                    }
                }
            }
            Carried::Briefcase => {
                let low = hand + Vec3::new(-0.2, -0.045, -0.36);
                mesh.cuboid(bag, low, low + Vec3::new(0.4, 0.09, 0.29));
            }
            Carried::RolledUmbrella => {
                let sides = self.by_detail([6, 4, 3]);
                mesh.tube(bag, hand - Vec3::Z * 0.64, hand - Vec3::Z * 0.1, 0.01, 0.03, sides);
                if self.detail < Rough {
                    mesh.tube(bag, hand - Vec3::Z * 0.1, hand + Vec3::Z * 0.05, 0.012, 0.012, 3);
                }
            }
            _ => {}
        }
    }

    /// A walking stick of a length under its handle.
    pub(super) fn stick(&self, length_m: f32) -> Mesh {
        let mut mesh = Mesh::default();
        let wood = self.paint([74, 52, 36]);
        let sides = self.by_detail([6, 4, 3]);
        mesh.tube(wood, Vec3::Z * -length_m, Vec3::Z * 0.01, 0.011, 0.013, sides);
        if self.detail == Fine {
            mesh.rod(wood, Vec3::new(-0.05, 0.0, 0.015), Vec3::new(0.07, 0.0, 0.015), 0.015, 5);
        }
        mesh
    }

    /// A telephone in a hand that is held up.
    pub(super) fn phone(&self) -> Mesh {
        let mut mesh = Mesh::default();
        let middle = Vec3::new(0.035, 0.0, -HAND_M - 0.02);
        let half = Vec3::new(0.006, 0.036, 0.075);
        mesh.cuboid(self.paint([24, 24, 28]).glossy(120), middle - half, middle + half);
        mesh
    }

    /// An open umbrella over somebody who holds it on the side 1 (left) or -1, around the hand.
    pub(super) fn umbrella(&self, side: f32) -> Mesh {
        let mut mesh = Mesh::default();
        let cloth = self.paint(self.outfit.umbrella_colour);
        // Who stoops has it farther back.
        let top = Vec3::new(-0.24 - 0.2 * self.outfit.build.stoop_rad, -side * 0.13, 0.72);
        mesh.tube(self.paint(STEEL), Vec3::Z * -0.06, top, 0.009, 0.009, self.by_detail([5, 3, 3]));
        let canopy = [
            (0.0, 0.0, [0.42; 2], Rough),
            (0.09, 0.0, [0.31; 2], Coarse),
            (0.14, 0.0, [0.16; 2], Fine),
            (0.16, 0.0, [0.0; 2], Rough),
        ];
        let mut rings = self.rings(&canopy);
        for ring in &mut rings {
            ring.centre += top - Vec3::Z * 0.12;
        }
        let sides = self.by_detail([10, 8, 6]);
        mesh.loft(cloth, &rings, sides);
        rings.reverse();
        mesh.loft(cloth.shaded(0.6), &rings, sides);
        mesh
    }
}
