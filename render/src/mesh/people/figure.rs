//! Bodies and clothes of people as meshes, at a height of 1.75 m; [`super::person`] hangs them on joints.

use glam::{Vec2, Vec3};
use kernel::ops;

use super::outfit::{Bottom, Carried, Outfit, Top};
use crate::SemanticTag;
use crate::mesh::model::Detail;
use crate::mesh::rings::Ring;
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

/// A ring of a profile: height, place forward, half axes, and the roughest level that has it.
pub(in crate::mesh) type Station = (f32, f32, [f32; 2], Detail);

/// Height of the shoulders above the hips' middle, metres.
pub(in crate::mesh) const SHOULDER_M: f32 = 0.455;
/// From hip to knee, metres.
pub(in crate::mesh) const THIGH_M: f32 = 0.44;
/// From knee to ankle, metres.
pub(in crate::mesh) const SHIN_M: f32 = 0.385;
/// From shoulder to elbow, metres.
pub(in crate::mesh) const UPPER_ARM_M: f32 = 0.27;
/// From the elbow to the middle of the hand, metres.
pub(in crate::mesh) const HAND_M: f32 = 0.3;

const TIGHTS: [u8; 3] = [38, 34, 38];
const BAND: [u8; 3] = [214, 218, 220];

/// Somebody at a level of detail.
pub(in crate::mesh) struct Look {
    pub(in crate::mesh) tag: SemanticTag,
    pub(super) outfit: Outfit,
    pub(in crate::mesh) detail: Detail,
}

use Detail::{Coarse, Fine, Rough};

impl Look {
    /// Somebody grown up.
    pub(in crate::mesh) fn of(variety: &mut Variety, tag: SemanticTag, detail: Detail) -> Self {
        Self { tag, outfit: Outfit::of(variety, false), detail }
    }

    /// A child on foot.
    pub(in crate::mesh) fn child(variety: &mut Variety, detail: Detail) -> Self {
        Self { tag: SemanticTag::Pedestrian, outfit: Outfit::of(variety, true), detail }
    }

    /// Dressed for a saddle.
    pub(in crate::mesh) fn riding(self) -> Self {
        Self { outfit: self.outfit.riding(), ..self }
    }

    /// Dressed for a chair with a back.
    pub(in crate::mesh) fn sitting(self) -> Self {
        Self { outfit: self.outfit.riding().handed(), ..self }
    }

    pub(in crate::mesh) fn paint(&self, colour: [u8; 3]) -> Paint {
        Paint::plain(self.tag, colour)
    }

    /// One of three numbers by level of detail.
    pub(in crate::mesh) fn by_detail(&self, [fine, coarse, rough]: [u32; 3]) -> u32 {
        match self.detail {
            Fine => fine,
            Coarse => coarse,
            Rough => rough,
        }
    }

    /// The rings of a profile that this level of detail has.
    pub(in crate::mesh) fn rings(&self, stations: &[Station]) -> Vec<Ring> {
        let kept = stations.iter().filter(|station| station.3 >= self.detail);
        kept.map(|&(z, x, radii, _)| Ring::new(z, x, radii)).collect()
    }

    /// How far the back has bent forward at a height above the hips, metres.
    pub(in crate::mesh) fn spine_m(&self, z: f32) -> f32 {
        0.8 * self.outfit.build.stoop_rad * z.max(0.0) * z.max(0.0)
    }

    /// By how much cloth stands off the trunk, metres.
    fn loose_m(&self) -> f32 {
        let under = match self.outfit.top {
            Top::TShirt => 0.0,
            Top::Shirt => 0.004,
            Top::Suit => 0.01,
            Top::Hoodie => 0.014,
            Top::Jacket | Top::Coat => 0.019,
        };
        if self.outfit.vest.is_some() { under + 0.006 } else { under }
    }

    fn trunk_rings(&self) -> Vec<Ring> {
        let (build, l) = (&self.outfit.build, self.loose_m());
        let (g, shoulders, hips) = (build.girth, build.shoulders_m, build.hips_m);
        let belly_m = 0.12 * (g - 1.02).max(0.0);
        let (waist, bust) = if build.waisted { (0.126, 0.016) } else { (0.14, 0.0) };
        let chest = 0.5 + 0.5 * g;
        let hem_m = match self.outfit.top {
            Top::TShirt | Top::Shirt => -0.06,
            Top::Coat => -0.04,
            _ => -0.1,
        };
        // Wide enough for legs that walk, but under the skirt of a coat.
        let hem = match self.outfit.top {
            Top::Coat => [0.112 * g + l, hips + l],
            _ => [0.128 * g + l, (hips + l + 0.012).max(0.18 + 0.5 * l)],
        };
        let stations = [
            (hem_m, 0.0, hem, Rough),
            (0.06, belly_m, [0.11 * g + l, 0.5 * (hips + waist * g) + l], Fine),
            (0.15, belly_m, [0.106 * g + l, waist * g + l], Coarse),
            (0.28, 0.4 * belly_m + 0.2 * bust, [0.11 * chest + l, 0.82 * shoulders * chest + l], Fine),
            (0.37, 0.8 * bust, [0.114 * chest + l + 0.5 * bust, 0.87 * shoulders * chest + l], Rough),
            (SHOULDER_M, 0.0, [0.094 + 0.6 * l, 0.96 * shoulders + 0.5 * l], Coarse),
            (0.502, -0.01, [0.07 + 0.4 * l, 0.7 * shoulders], Rough),
            (0.535, -0.004, [0.058, 0.072], Fine),
            (0.56, 0.002, [0.047, 0.05], Coarse),
            (0.56, 0.0, [0.0, 0.0], Rough),
        ];
        let mut rings = self.rings(&stations);
        if self.detail < Rough {
            rings.pop();
        }
        for ring in &mut rings {
            ring.centre.x += self.spine_m(ring.centre.z);
        }
        rings
    }

    /// A ring about the trunk at a height.
    fn girdle(rings: &[Ring], z: f32, out_m: f32) -> Ring {
        let pair = rings.windows(2).find(|pair| z < pair[1].centre.z).unwrap_or(&rings[rings.len() - 2..]);
        let share = ((z - pair[0].centre.z) / (pair[1].centre.z - pair[0].centre.z)).clamp(0.0, 1.0);
        let radii = pair[0].radii.lerp(pair[1].radii, share) + Vec2::splat(out_m);
        Ring { centre: pair[0].centre.lerp(pair[1].centre, share), radii }
    }

    /// A strip down the front of the trunk, so far off it: heights and its edges to the left and right.
    fn front_strip(&self, mesh: &mut Mesh, (rings, out_m): (&[Ring], f32), paint: Paint, strip: &[(f32, [f32; 2])]) {
        let at = |z: f32, y: f32| {
            let ring = Self::girdle(rings, z, out_m);
            let share = (y / ring.radii.y).clamp(-0.95, 0.95);
            ring.centre + Vec3::new(ring.radii.x * ops::sqrt(1.0 - share * share), y, 0.0)
        };
        for pair in strip.windows(2) {
            let [(top_m, [top_left, top_right]), (low_m, [low_left, low_right])] = [pair[0], pair[1]];
            let corners = [at(top_m, top_left), at(top_m, top_right), at(low_m, low_right), at(low_m, low_left)];
            mesh.polygon(paint, &corners);
        }
    }

    /// Trunk and head around the hips' middle, upright.
    pub(in crate::mesh) fn trunk(&self, helmet: Option<[u8; 3]>) -> Mesh {
        let (outfit, mut mesh) = (&self.outfit, Mesh::default());
        let (rings, sides) = (self.trunk_rings(), self.by_detail([10, 6, 5]));
        mesh.loft(self.paint(outfit.vest.unwrap_or(outfit.top_colour)), &rings, sides);
        if outfit.vest.is_some() {
            for z in &[0.27, 0.1][..self.by_detail([2, 2, 1]) as usize] {
                let band = [Self::girdle(&rings, *z, 0.006), Self::girdle(&rings, z + 0.055, 0.006)];
                mesh.loft(self.paint(BAND).glossy(140), &band, sides);
            }
        }
        if self.detail == Fine {
            self.fronts(&mut mesh, &rings);
        }
        self.head(&mut mesh, helmet);
        self.worn(&mut mesh);
        mesh
    }

    /// What is seen of the front of jackets, straps, and hoods.
    fn fronts(&self, mesh: &mut Mesh, rings: &[Ring]) {
        let outfit = &self.outfit;
        let even = |strip: &[(f32, f32)]| strip.iter().map(|&(z, half)| (z, [half, -half])).collect::<Vec<_>>();
        let opens_to_m = match outfit.top {
            _ if outfit.vest.is_some() => None,
            Top::Suit => Some(0.24),
            Top::Jacket | Top::Coat => Some(0.3),
            _ => None,
        };
        if let Some(low_m) = opens_to_m {
            let shirt = if outfit.top == Top::Suit { [220, 220, 216] } else { outfit.shirt_colour };
            let opening = even(&[(0.53, 0.036), (0.45, 0.031), (0.37, 0.019), (low_m, 0.002)]);
            self.front_strip(mesh, (rings, 0.004), self.paint(shirt), &opening);
            if outfit.top == Top::Suit && !outfit.build.waisted {
                let tie = even(&[(0.525, 0.01), (0.37, 0.014), (0.27, 0.005)]);
                self.front_strip(mesh, (rings, 0.008), self.paint([96, 26, 34]), &tie);
            }
        }
        if outfit.carried == Carried::Backpack {
            let strap = self.paint(outfit.carried_colour).shaded(0.85);
            for side in [-1.0, 1.0] {
                let y = side * 0.52 * outfit.build.shoulders_m;
                let edges = [y + 0.022, y - 0.022];
                self.front_strip(mesh, (rings, 0.01), strap, &[0.51, 0.45, 0.37, 0.2].map(|z| (z, edges)));
            }
        }
        if outfit.top == Top::Hoodie {
            let hood = [
                Ring::new(0.43, -0.085, [0.0; 2]),
                Ring::new(0.5, -0.08, [0.05, 0.095]),
                Ring::new(0.545, -0.068, [0.048, 0.085]),
                Ring::new(0.575, -0.055, [0.0; 2]),
            ];
            let hood = hood.map(|r| Ring { centre: r.centre + Vec3::X * self.spine_m(0.5), ..r });
            mesh.loft(self.paint(outfit.top_colour).shaded(0.9), &hood, 8);
        }
    }

    /// Pelvis and what hangs from the waist, around the hips' middle.
    pub(in crate::mesh) fn hips(&self) -> Mesh {
        let (outfit, mut mesh) = (&self.outfit, Mesh::default());
        let (g, hips) = (outfit.build.girth, outfit.build.hips_m);
        let sides = self.by_detail([10, 6, 5]);
        let is_coat = outfit.top == Top::Coat;
        let hanging = match outfit.bottom {
            _ if is_coat => Some((outfit.top_colour, -0.4, [0.18 + 0.02 * g, hips + 0.05])),
            Bottom::Skirt => Some((outfit.bottom_colour, -0.5, [0.225, 0.2])),
            Bottom::Dress => Some((outfit.top_colour, -0.44, [0.21, 0.2])),
            _ => None,
        };
        if self.detail < Rough {
            let pelvis = [
                (-0.15, 0.0, [0.0, 0.0], Coarse),
                (-0.11, 0.0, [0.085, 0.115], Fine),
                (-0.04, -0.006, [0.1 * g, 0.95 * hips], Coarse),
                (0.06, 0.0, [0.09 * g, 0.84 * hips], Coarse),
            ];
            mesh.loft(self.paint(outfit.bottom_colour), &self.rings(&pelvis), sides);
        }
        if let Some((colour, hem_m, radii)) = hanging {
            let cloth = [
                (hem_m, 0.0, radii, Rough),
                (-0.12, -0.005, [0.125 * g + 0.015, hips + 0.024], Fine),
                (0.07, 0.0, [0.112 * g + 0.012, hips + 0.008], Rough),
            ];
            mesh.loft(self.paint(colour), &self.rings(&cloth), sides);
        }
        mesh
    }

    /// A limb of round rings from bottom to top, which leans to the left by `out` of its length.
    fn limb(&self, mesh: &mut Mesh, colour: [u8; 3], stations: &[Station], out: f32) {
        let mut rings = self.rings(stations);
        for ring in &mut rings {
            ring.centre.y = -out * ring.centre.z;
        }
        mesh.loft(self.paint(colour), &rings, self.by_detail([7, 5, 3]));
    }

    /// Upper arm around the shoulder, hanging; side 1 is left.
    pub(in crate::mesh) fn upper_arm(&self, side: f32) -> Mesh {
        let mut mesh = Mesh::default();
        let (g, l, out) = (0.6 + 0.4 * self.outfit.build.girth, 0.6 * self.loose_m(), side * ARM_OUT);
        let sleeve = [
            (-0.28, 0.0, [0.04 * g + l; 2], Rough),
            (-0.12, 0.0, [0.049 * g + l; 2], Fine),
            (-0.01, 0.0, [0.055 * g + l; 2], Rough),
            (0.03, 0.0, [0.04 * g + l; 2], Fine),
            (0.052, 0.0, [0.0; 2], Coarse),
        ];
        let short = self.outfit.top == Top::TShirt;
        if short && self.detail == Fine {
            self.limb(&mut mesh, self.outfit.skin, &sleeve[..2], out);
            let cuff = (-0.15, 0.0, [0.055 * g; 2], Fine);
            self.limb(&mut mesh, self.outfit.top_colour, &[cuff, sleeve[2], sleeve[3], sleeve[4]], out);
        } else {
            self.limb(&mut mesh, self.outfit.top_colour, &sleeve, out);
        }
        mesh
    }

    /// Lower arm with its hand around the elbow, hanging; side 1 is left.
    pub(in crate::mesh) fn lower_arm(&self, side: f32) -> Mesh {
        let (outfit, mut mesh) = (&self.outfit, Mesh::default());
        let (g, l) = (0.6 + 0.4 * outfit.build.girth, 0.6 * self.loose_m());
        let colour = if outfit.top == Top::TShirt { outfit.skin } else { outfit.top_colour };
        let low_m = if self.detail == Rough { -0.33 } else { -0.24 };
        let sleeve = [
            (low_m, 0.0, [0.029 * g + l; 2], Rough),
            (-0.09, 0.0, [0.04 * g + l; 2], Fine),
            (0.02, 0.0, [0.04 * g + l; 2], Rough),
            (0.042, 0.0, [0.0; 2], Fine),
        ];
        self.limb(&mut mesh, colour, &sleeve, 0.0);
        if self.detail < Rough {
            let hand = [
                (-0.37, 0.012, [0.0; 2], Coarse),
                (-0.345, 0.012, [0.026, 0.012], Fine),
                (-0.29, 0.006, [0.04, 0.02], Coarse),
                (-0.22, 0.0, [0.025, 0.022], Coarse),
            ];
            self.limb(&mut mesh, outfit.skin, &hand, 0.0);
        }
        self.held(&mut mesh, side);
        mesh
    }

    fn leg_colour(&self, covered: bool) -> [u8; 3] {
        let outfit = &self.outfit;
        match outfit.bottom {
            Bottom::Trousers => outfit.bottom_colour,
            Bottom::Shorts if covered => outfit.bottom_colour,
            Bottom::Skirt | Bottom::Dress if !matches!(outfit.top, Top::TShirt | Top::Shirt) => TIGHTS,
            _ => outfit.skin,
        }
    }

    /// Upper leg around the hip, hanging.
    pub(in crate::mesh) fn thigh(&self) -> Mesh {
        let mut mesh = Mesh::default();
        let g = 0.5 + 0.5 * self.outfit.build.girth;
        let l = if matches!(self.outfit.bottom, Bottom::Trousers | Bottom::Shorts) { 0.01 } else { 0.0 };
        let colour = self.leg_colour(true);
        let leg = [
            (-0.45, 0.0, [0.053 * g + l; 2], Rough),
            (-0.24, 0.004, [0.07 * g + l; 2], Fine),
            (-0.07, 0.0, [0.084 * g + l, 0.074 * g + l], Coarse),
            (0.04, 0.0, [0.085 * g, 0.07 * g], Rough),
        ];
        self.limb(&mut mesh, colour, &leg, 0.0);
        mesh
    }

    /// Lower leg around the knee, hanging.
    pub(in crate::mesh) fn shin(&self) -> Mesh {
        let mut mesh = Mesh::default();
        let g = 0.5 + 0.5 * self.outfit.build.girth;
        let is_bare = self.outfit.bottom != Bottom::Trousers;
        let (calf, ankle) = if is_bare { (0.053 * g, 0.036) } else { (0.062 * g, 0.06) };
        let leg = [
            (-SHIN_M - 0.015, 0.0, [ankle; 2], Rough),
            (-0.15, -0.012, [calf; 2], Coarse),
            (0.0, 0.0, [if is_bare { 0.053 * g } else { 0.064 * g }; 2], Fine),
            (0.035, 0.0, [if is_bare { 0.046 * g } else { 0.056 * g }; 2], Rough),
            // A bent knee is closed.
            (0.062, 0.0, [0.0; 2], Coarse),
        ];
        self.limb(&mut mesh, self.leg_colour(false), &leg, 0.0);
        mesh
    }

    /// A shoe around the ankle.
    pub(in crate::mesh) fn foot(&self, side: f32) -> Mesh {
        let (mut mesh, y) = (Mesh::default(), side * 0.012);
        let shoe = self.paint(self.outfit.shoe_colour);
        let sides = self.by_detail([8, 5, 3]);
        let stations = [
            (-0.075, 0.042, [0.13, 0.045], Rough),
            (-0.045, 0.04, [0.13, 0.048], Fine),
            (-0.012, 0.004, [0.075, 0.043], Fine),
            (0.03, -0.008, [0.046, 0.042], Coarse),
        ];
        let mut rings = self.rings(&stations);
        if self.detail == Rough {
            rings.push(Ring::new(0.03, -0.008, [0.0; 2]));
        }
        for ring in &mut rings {
            ring.centre.y = y * (ring.centre.x / 0.042);
        }
        mesh.loft(shoe, &rings, sides);
        if self.detail < Rough {
            mesh.sole(shoe.shaded(0.7), &rings[0], sides);
        }
        mesh
    }
}

/// By how much of its length an arm stands off the trunk.
pub(in crate::mesh) const ARM_OUT: f32 = 0.13;
