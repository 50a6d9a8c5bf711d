//! Trees; trunks count as vegetation, as in CARLA.

use core::f32::consts::TAU;

use glam::{Vec2, Vec3};
use kernel::ops;

use super::hedge::LEAVES;
use crate::SemanticTag;
use crate::mesh::foliage::Leaf;
use crate::mesh::model::Detail;
use crate::mesh::shape::Lump;
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

const NEEDLES: [[u8; 3]; 2] = [[52, 84, 56], [60, 90, 50]];
const BARKS: [[u8; 3]; 3] = [[92, 76, 60], [110, 98, 84], [78, 66, 54]];
const BIRCH_LEAVES: [[u8; 3]; 2] = [[124, 142, 66], [112, 134, 62]];
const BIRCH_BARK: [u8; 3] = [206, 204, 194];
const POPLAR_LEAVES: [[u8; 3]; 2] = [[88, 116, 56], [98, 124, 62]];

/// Broad trees that are no higher have been planted lately, metres.
const YOUNG_M: f32 = 6.0;

const TAG: SemanticTag = SemanticTag::Vegetation;

/// How a tree has grown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Species {
    /// A wide crown of many lumps, as of oaks and limes.
    Broad,
    /// The same on a thin trunk between stakes.
    Young,
    /// Slender and loose, on a white trunk.
    Birch,
    /// A column from near the ground.
    Poplar,
    /// A stack of cones.
    Spruce,
}

impl Species {
    fn of(variety: &mut Variety, height_m: f32) -> Self {
        use Species as S;
        match variety.weighted(&[(S::Broad, 11), (S::Birch, 3), (S::Poplar, 2), (S::Spruce, 4)]) {
            S::Broad | S::Poplar if height_m < YOUNG_M => S::Young,
            species => species,
        }
    }
}

/// A tree `height_m` high with a crown `crown_m` wide.
pub fn tree(variant: u32, crown_m: f32, height_m: f32, detail: Detail) -> Mesh {
    let mut variety = Variety::of(variant);
    let species = Species::of(&mut variety, height_m);
    let plant = Plant { variant, crown_m, height_m, detail };
    let mut mesh = match species {
        Species::Spruce => plant.spruce(&mut variety),
        Species::Birch => plant.leafy(&mut variety, species, &BIRCH_LEAVES, Leaf::Small),
        Species::Poplar => plant.leafy(&mut variety, species, &POPLAR_LEAVES, Leaf::Small),
        Species::Broad | Species::Young => plant.leafy(&mut variety, species, &LEAVES, Leaf::Broad),
    };
    sway(&mut mesh, height_m);
    mesh
}

/// Lets wind move a tree `height_m` high.
pub(crate) fn sway(mesh: &mut Mesh, height_m: f32) {
    mesh.sway_between(0.25 * height_m, height_m);
}

/// What all species are made from.
struct Plant {
    variant: u32,
    crown_m: f32,
    height_m: f32,
    detail: Detail,
}

impl Plant {
    fn is_fine(&self) -> bool {
        self.detail == Detail::Fine
    }

    /// A trunk with branches under a crown of lumps, which near ones have leaves around.
    fn leafy(&self, variety: &mut Variety, species: Species, colours: &[[u8; 3]], leaf: Leaf) -> Mesh {
        let leaves = Paint::plain(TAG, variety.colour(colours)).grainy(220);
        let bark = self.bark(variety, species);
        let crown = match species {
            Species::Poplar => self.column(variety),
            Species::Birch => self.loose(variety),
            _ => self.round(variety),
        };
        let mut mesh = Mesh::default();
        let thin = if species == Species::Young { 0.6 } else { 1.0 };
        self.trunk(&mut mesh, bark, thin * (0.05 + 0.022 * self.height_m), &crown);
        if species == Species::Young && self.detail != Detail::Rough {
            stakes(&mut mesh, 0.32 * self.height_m);
        }
        let lumps: Vec<Lump> = crown.iter().map(|(lump, _)| *lump).collect();
        let side_m = (0.3 * self.crown_m).clamp(0.75, 1.3);
        for (i, &(lump, light)) in crown.iter().enumerate() {
            // Dents have choices of their own, so that lumps lie alike at every level of detail.
            let mut dents = Variety::of(self.variant ^ (i as u32 + 1) << 24);
            if !self.is_fine() {
                mesh.lump(leaves.shaded(light), &lump, &mut dents);
                continue;
            }
            let (share, dark) = if species == Species::Birch { (0.55, 0.8) } else { (0.74, 0.72) };
            let within = Lump { radii: share * lump.radii, rough: 0.1, ..lump };
            mesh.lump(leaves.shaded(dark * light), &within, &mut dents);
            let others = [&lumps[..i], &lumps[i + 1..]].concat();
            mesh.leafy_lump(leaf.paint(leaves.shaded(0.94 * light), 200), &lump, &others, side_m, &mut dents);
        }
        mesh
    }

    fn bark(&self, variety: &mut Variety, species: Species) -> Paint {
        let bark = Paint::plain(TAG, variety.colour(&BARKS));
        let bark = if species == Species::Birch { bark.colour(BIRCH_BARK) } else { bark };
        if self.is_fine() { bark.grainy(200) } else { bark }
    }

    /// A trunk up into the crown, near ones with a foot that spreads and a branch into each of the outer lumps.
    fn trunk(&self, mesh: &mut Mesh, bark: Paint, radius: f32, crown: &[(Lump, f32)]) {
        let sides = if self.is_fine() { 8 } else { 4 };
        let top = 0.65 * self.height_m;
        if !self.is_fine() {
            mesh.tube(bark, Vec3::ZERO, Vec3::Z * top, radius, 0.5 * radius, sides);
            return;
        }
        mesh.tube(bark, Vec3::ZERO, Vec3::Z * 0.35, 1.45 * radius, radius, sides);
        mesh.tube(bark, Vec3::Z * 0.35, Vec3::Z * top, radius, 0.5 * radius, sides);
        for (lump, _) in crown.iter().filter(|(lump, _)| lump.centre.truncate() != Vec2::ZERO) {
            let fork = (lump.centre.z - 0.9 * lump.centre.truncate().length() - 0.3).clamp(0.22 * self.height_m, top);
            mesh.tube(bark, Vec3::Z * fork, lump.centre, 0.42 * radius, 0.16 * radius, 4);
        }
    }

    fn lump(&self, centre: Vec3, radii: Vec3, is_core: bool) -> Lump {
        let [rings, sides] = match (self.detail, is_core) {
            (Detail::Fine, _) => [4, 6],
            (Detail::Coarse, true) => [5, 7],
            (Detail::Coarse, false) | (Detail::Rough, true) => [4, 6],
            (Detail::Rough, false) => [3, 5],
        };
        Lump { centre, radii, rings, sides, rough: if is_core { 0.14 } else { 0.18 } }
    }

    /// One large and five smaller lumps of leaves, each with its brightness.
    fn round(&self, variety: &mut Variety) -> Vec<(Lump, f32)> {
        let (radius, foot) = (0.5 * self.crown_m, 0.3 * self.height_m);
        let middle = Vec3::new(0.0, 0.0, 0.5 * (foot + self.height_m));
        let core = Vec3::new(0.78 * radius, 0.78 * radius, 0.46 * (self.height_m - foot));
        let mut lumps = vec![(self.lump(middle + Vec3::Z * 0.08 * core.z, core, true), 1.0)];
        let turn = variety.between(0.0, TAU);
        for i in 0..5 {
            let angle = turn + TAU * i as f32 / 5.0;
            let rise = variety.between(-0.55, 0.35) * core.z;
            let reach = variety.between(0.5, 0.6) * radius;
            let centre = middle + Vec3::new(reach * ops::cos(angle), reach * ops::sin(angle), rise);
            let size = variety.between(0.38, 0.48) * radius;
            let lump = self.lump(centre, Vec3::new(size, size, size * 0.9), false);
            lumps.push((lump, variety.between(0.86, 1.08)));
        }
        lumps
    }

    /// A column from near the ground, with small lumps up and around it.
    fn column(&self, variety: &mut Variety) -> Vec<(Lump, f32)> {
        let (radius, foot) = (0.36 * self.crown_m, 0.12 * self.height_m);
        let high = self.height_m - foot;
        let core = Vec3::new(0.86 * radius, 0.86 * radius, 0.5 * high);
        let mut lumps = vec![(self.lump(Vec3::Z * (foot + 0.5 * high), core, true), 1.0)];
        let turn = variety.between(0.0, TAU);
        for (i, (up, taper)) in (0u8..).zip([(0.2, 0.8), (0.36, 0.95), (0.52, 0.9), (0.66, 0.75), (0.8, 0.5)]) {
            let angle = turn + 2.4 * f32::from(i);
            let (reach, size) = (0.5 * radius * taper, 0.62 * radius * taper);
            let centre = Vec3::new(reach * ops::cos(angle), reach * ops::sin(angle), foot + up * high);
            let lump = self.lump(centre, Vec3::new(size, size, 0.15 * high), false);
            lumps.push((lump, variety.between(0.92, 1.06)));
        }
        lumps
    }

    /// A slender lump with small ones up and around it.
    fn loose(&self, variety: &mut Variety) -> Vec<(Lump, f32)> {
        let (radius, foot) = (0.5 * self.crown_m, 0.26 * self.height_m);
        let step = (self.height_m - foot) / 6.0;
        let core = Vec3::new(0.56 * radius, 0.56 * radius, 0.5 * (self.height_m - foot));
        let mut lumps = vec![(self.lump(Vec3::Z * 0.5 * (foot + self.height_m), core, true), 1.0)];
        let turn = variety.between(0.0, TAU);
        for (i, taper) in (0u8..).zip([0.8, 1.0, 0.95, 0.8, 0.55]) {
            let angle = turn + 2.4 * f32::from(i);
            let (reach, size) = (0.5 * radius * taper, radius * taper * variety.between(0.4, 0.5));
            let height = foot + step * (f32::from(i) + 0.6);
            let centre = Vec3::new(reach * ops::cos(angle), reach * ops::sin(angle), height);
            let lump = self.lump(centre, Vec3::new(size, size, 0.85 * step), false);
            lumps.push((lump, variety.between(0.92, 1.1)));
        }
        lumps
    }

    /// A trunk under a stack of cones, which near ones have twigs around.
    fn spruce(&self, variety: &mut Variety) -> Mesh {
        let needles = Paint::plain(TAG, variety.colour(&NEEDLES)).grainy(200);
        let bark = Paint::plain(TAG, variety.colour(&BARKS));
        let mut mesh = Mesh::default();
        let sides = if self.is_fine() { 9 } else { 7 };
        mesh.tube(bark, Vec3::ZERO, Vec3::Z * 0.3 * self.height_m, 0.16, 0.12, 6);
        for i in 0..5 {
            let up = i as f32 / 5.0;
            let (z0, z1) = (self.height_m * (0.16 + 0.78 * up), self.height_m * (0.46 + 0.78 * up).min(1.0));
            let radius = 0.5 * self.crown_m * (1.0 - 0.86 * up);
            let paint = needles.shaded(0.86 + 0.06 * i as f32);
            let within = if self.is_fine() { 0.72 } else { 1.0 };
            mesh.tube(paint.shaded(within), Vec3::Z * z0, Vec3::Z * z1, within * radius, 0.02, sides);
            mesh.disc(paint.shaded(0.5), Vec3::Z * z0, Vec3::NEG_Z, within * radius, sides);
            if self.is_fine() {
                twigs(&mut mesh, paint, (z0, z1), radius, &mut Variety::of(self.variant ^ (i + 1) << 24));
            }
        }
        mesh
    }
}

/// Twigs that hang from a cone between two heights: two rows, the lower ones longer.
fn twigs(mesh: &mut Mesh, paint: Paint, (z0, z1): (f32, f32), radius: f32, variety: &mut Variety) {
    let needles = Leaf::Needle.paint(paint.shaded(1.12), 90);
    for (row, share) in [(0, 0.02), (1, 0.4)] {
        let (z, reach) = (z0 + share * (z1 - z0), radius * (1.0 - share));
        let count = ((TAU * reach / 0.42) as u32).clamp(5, 16);
        let turn = variety.between(0.0, TAU);
        for k in 0..count {
            let angle = turn + TAU * k as f32 / count as f32 + variety.between(-0.15, 0.15);
            let out = Vec3::new(ops::cos(angle), ops::sin(angle), 0.0);
            let along = (out - Vec3::Z * variety.between(0.3, 0.7)).normalize_or(Vec3::X);
            let across = (Vec3::Z.cross(out) + Vec3::Z * variety.between(-0.6, 0.6)).normalize_or(Vec3::Y);
            let length = (0.75 * reach + 0.25).min(1.5);
            let tip = Vec3::Z * (z + 0.18) + out * (reach + 0.05);
            let light = variety.between(0.85, 1.12) * if row == 0 { 0.92 } else { 1.0 };
            let heart = Vec3::Z * (z - 0.4 * radius);
            mesh.leaf_card(needles.shaded(light), tip - 0.5 * length * along, [along, across], length, heart);
        }
    }
}

/// Two stakes beside a trunk with a band between them.
fn stakes(mesh: &mut Mesh, height_m: f32) {
    let wood = Paint::plain(TAG, [146, 116, 80]);
    for side in [-1.0, 1.0] {
        let foot = Vec3::new(0.0, 0.3 * side, 0.0);
        mesh.tube(wood, foot, foot + Vec3::Z * height_m, 0.035, 0.035, 5);
        mesh.disc(wood, foot + Vec3::Z * height_m, Vec3::Z, 0.035, 5);
    }
    let at = Vec3::new(0.02, 0.3, height_m - 0.22);
    mesh.cuboid(wood.shaded(0.8), Vec3::new(-at.x, -at.y, at.z), Vec3::new(at.x, at.y, at.z + 0.07));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Finish;

    fn leafy(mesh: &Mesh) -> usize {
        mesh.triangles[Finish::Leafy as usize].len()
    }

    /// Shadow maps are drawn from coarse trees, by a pass that knows no air between leaves.
    #[test]
    fn only_near_trees_have_single_leaves() {
        for variant in 0..60 {
            let [fine, coarse, rough] = Detail::ALL.map(|detail| tree(variant, 4.6, 9.5, detail));
            assert!((60..1200).contains(&leafy(&fine)), "{variant}: {}", leafy(&fine));
            assert_eq!([&coarse, &rough].map(leafy), [0, 0]);
        }
    }

    /// From near and far a crown has about the same outline.
    #[test]
    fn a_crown_is_as_wide_and_high_at_every_level() {
        for variant in 0..60 {
            let [fine, coarse, rough] = Detail::ALL.map(|detail| {
                let mesh = tree(variant, 4.6, 9.5, detail);
                let places = || mesh.vertices.iter().map(|v| Vec3::from_array(v.position));
                [places().map(|p| p.truncate().length()).fold(0.0, f32::max), places().map(|p| p.z).fold(0.0, f32::max)]
            });
            assert!(coarse[0] < 2.9 && coarse[1] < 10.2, "{variant}: {coarse:?}");
            for (near, far) in [(fine, coarse), (coarse, rough)] {
                assert!(
                    (near[0] - far[0]).abs() < 1.0 && (near[1] - far[1]).abs() < 0.9,
                    "{variant}: {near:?}, {far:?}"
                );
            }
        }
    }

    #[test]
    fn trees_are_of_many_species() {
        let mut seen: Vec<Species> = Vec::new();
        for variant in 0..60 {
            for height_m in [5.0, 9.0] {
                let species = Species::of(&mut Variety::of(variant), height_m);
                if !seen.contains(&species) {
                    seen.push(species);
                }
            }
        }
        assert_eq!(seen.len(), 5, "{seen:?}");
    }
}
