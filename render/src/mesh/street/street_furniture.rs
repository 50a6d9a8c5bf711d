//! Street furniture, each piece as what it is.

use glam::Vec3;
use kernel::map::FurnitureKind;

use super::loose;
use crate::SemanticTag;
use crate::mesh::model::Detail;
use crate::mesh::shape::Lump;
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

const IRON: [u8; 3] = [52, 54, 58];
const STEEL: [u8; 3] = [132, 136, 138];
const WOOD: [u8; 3] = [140, 100, 64];
const WHITE: [u8; 3] = [226, 226, 220];

/// What is higher is a pole, and no bollard, metres.
const BOLLARD_M: f32 = 1.6;
/// A bench this long has room for a bin beside it, metres.
const BIN_BESIDE_M: f32 = 1.5;
/// From one hoop of a bicycle stand to the next, metres.
const HOOP_PITCH_M: f32 = 0.8;

/// A piece of street furniture of a class in a box of `size` metres.
pub fn mesh(what: FurnitureKind, tag: SemanticTag, variant: u32, size: Vec3, detail: Detail) -> Mesh {
    use FurnitureKind as F;
    let piece = Piece { tag, size, detail };
    match what {
        F::Bench => lengthwise(&piece, |piece| bench(piece, variant)),
        F::Shelter => lengthwise(&piece, shelter),
        F::BicycleStand => lengthwise(&piece, bicycle_stand),
        F::Planter => lengthwise(&piece, |piece| planter(piece, variant)),
        F::Cabinet => lengthwise(&piece, |piece| cabinet(piece, variant)),
        F::Post => post(&piece),
        F::Hydrant => hydrant(&piece),
        F::Mailbox => mailbox(&piece),
        F::Dumpster => dumpster(&piece, variant),
        F::Bin => loose::bin(tag, variant, size),
        F::Cone => loose::cone(tag, size, detail),
        F::Beacon => loose::beacon(tag, size),
        F::Barricade => loose::barricade(tag, size),
        F::Stall => loose::stall(tag, variant, size),
        F::Other => match tag {
            SemanticTag::Dynamic => loose::movable(variant, size, detail),
            SemanticTag::Other => loose::sundry(variant, size),
            _ => block(&piece),
        },
    }
}

/// What a piece is made in: its class, its box and how finely.
#[derive(Clone, Copy)]
struct Piece {
    tag: SemanticTag,
    size: Vec3,
    detail: Detail,
}

impl Piece {
    fn paint(&self, colour: [u8; 3]) -> Paint {
        Paint::plain(self.tag, colour)
    }

    /// Half its extent on the ground.
    fn half(&self) -> Vec3 {
        Vec3::new(0.5 * self.size.x, 0.5 * self.size.y, 0.0)
    }

    fn is_fine(&self) -> bool {
        self.detail == Detail::Fine
    }

    fn sides(&self) -> u32 {
        if self.is_fine() { 8 } else { 5 }
    }

    /// A point in its box by shares: of half its length and width from the middle, of its height from the ground.
    fn at(&self, x: f32, y: f32, z: f32) -> Vec3 {
        Vec3::new(x, y, z) * Vec3::new(0.5 * self.size.x, 0.5 * self.size.y, self.size.z)
    }
}

/// Makes what is longer than wide, turned where its box is not.
fn lengthwise(piece: &Piece, make: impl Fn(&Piece) -> Mesh) -> Mesh {
    if piece.size.x >= piece.size.y {
        return make(piece);
    }
    let mut mesh = make(&Piece { size: Vec3::new(piece.size.y, piece.size.x, piece.size.z), ..*piece });
    for vertex in &mut mesh.vertices {
        let ([x, y, z], [nx, ny, nz]) = (vertex.position, vertex.normal);
        (vertex.position, vertex.normal) = ([-y, x, z], [-ny, nx, nz]);
    }
    mesh
}

/// Concrete without any shape.
fn block(piece: &Piece) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.cuboid(piece.paint([152, 150, 144]).grainy(40), piece.at(-1.0, -1.0, 0.0), piece.at(1.0, 1.0, 1.0));
    mesh
}

/// Planks on two feet with its back at positive y, and beside some a bin for litter.
fn bench(piece: &Piece, variant: u32) -> Mesh {
    let (wood, iron) = (piece.paint(WOOD), piece.paint(IRON));
    let mut mesh = Mesh::default();
    let (half, height) = (piece.half(), piece.size.z);
    let has_bin = piece.size.x > BIN_BESIDE_M && Variety::of(variant).one_in(3);
    let end = half.x - if has_bin { 0.45 } else { 0.0 };
    let (seat, thick) = (0.5 * height, 0.06 * height);
    if piece.detail != Detail::Rough {
        for x in [-0.85 * half.x, end - 0.15 * half.x] {
            let (low, high) = (Vec3::new(x - 0.04, -0.8 * half.y, 0.0), Vec3::new(x + 0.04, 0.9 * half.y, seat));
            mesh.cuboid(iron, low, high);
        }
    }
    mesh.cuboid(wood, Vec3::new(-half.x, -half.y, seat), Vec3::new(end, 0.8 * half.y, seat + thick));
    // Two planks to lean on, one where that cannot be told.
    let planks: &[[f32; 2]] = if piece.is_fine() { &[[0.64, 0.79], [0.85, 1.0]] } else { &[[0.64, 1.0]] };
    for [low, high] in planks {
        mesh.cuboid(wood, Vec3::new(-half.x, 0.8 * half.y, low * height), Vec3::new(end, half.y, high * height));
    }
    if has_bin {
        let middle = Vec3::new(half.x - 0.17, 0.0, 0.0);
        let radius = 0.16f32.min(half.y);
        mesh.tube(iron, middle + Vec3::Z * 0.15, middle + Vec3::Z * 0.85 * height, radius, radius, piece.sides());
        mesh.disc(iron.shaded(0.5), middle + Vec3::Z * 0.85 * height, Vec3::Z, radius, piece.sides());
        if piece.detail != Detail::Rough {
            mesh.tube(iron, middle, middle + Vec3::Z * 0.15, 0.05, 0.05, 4);
        }
    }
    mesh
}

/// A shell on a plinth, with two doors under a lid.
fn cabinet(piece: &Piece, variant: u32) -> Mesh {
    let colour = Variety::of(variant).colour(&[[150, 152, 146], [122, 126, 120], [104, 116, 100]]);
    let shell = piece.paint(colour).glossy(30);
    let mut mesh = Mesh::default();
    mesh.cuboid(shell.shaded(0.55), piece.at(-0.92, -0.92, 0.0), piece.at(0.92, 0.92, 0.12));
    mesh.cuboid(shell, piece.at(-0.94, -0.94, 0.12), piece.at(0.94, 0.94, 0.94));
    mesh.cuboid(shell.shaded(0.8), piece.at(-1.0, -1.0, 0.94), piece.at(1.0, 1.0, 1.0));
    if piece.is_fine() {
        // The gap between the doors, on both of the long sides.
        for y in [-0.95, 0.95] {
            let gap = [(-0.02, 0.16), (0.02, 0.16), (0.02, 0.9), (-0.02, 0.9)];
            mesh.polygon(shell.shaded(0.4), &gap.map(|(x, z): (f32, f32)| piece.at(-x * f32::signum(y), y, z)));
        }
    }
    mesh
}

/// A bollard with a white band, or a pole of steel.
fn post(piece: &Piece) -> Mesh {
    let mut mesh = Mesh::default();
    let (sides, radius, top) = (piece.sides(), 0.5 * piece.size.x.min(piece.size.y), Vec3::Z * piece.size.z);
    if piece.size.z > BOLLARD_M {
        let steel = piece.paint(STEEL).glossy(30);
        mesh.tube(steel, Vec3::ZERO, top, radius, radius, sides);
        mesh.disc(steel, top, Vec3::Z, radius, sides);
        return mesh;
    }
    let (iron, white) = (piece.paint(IRON), piece.paint(WHITE));
    let (band, end) = (0.78 * top, 0.9 * top);
    mesh.tube(iron, Vec3::ZERO, band, radius, radius, sides);
    mesh.tube(white, band, end, radius, radius, sides);
    mesh.tube(iron, end, top, radius, 0.7 * radius, sides);
    mesh.disc(iron, top, Vec3::Z, 0.7 * radius, sides);
    mesh
}

/// A red pillar on a flange, with two outlets and a cap.
fn hydrant(piece: &Piece) -> Mesh {
    let red = piece.paint([178, 36, 30]).glossy(50);
    let mut mesh = Mesh::default();
    let (sides, radius, top) = (piece.sides(), 0.5 * piece.size.x.min(piece.size.y), Vec3::Z * piece.size.z);
    if piece.detail != Detail::Rough {
        mesh.tube(red.shaded(0.8), Vec3::ZERO, 0.06 * top, 0.95 * radius, 0.95 * radius, sides);
        mesh.disc(red.shaded(0.8), 0.06 * top, Vec3::Z, 0.95 * radius, sides);
        let outlet = piece.paint([188, 188, 182]);
        let (low, high) =
            (Vec3::new(-0.2 * radius, -radius, 0.6 * top.z), Vec3::new(0.2 * radius, radius, 0.7 * top.z));
        mesh.cuboid(outlet, low, high);
    }
    mesh.tube(red, Vec3::ZERO, 0.8 * top, 0.6 * radius, 0.6 * radius, sides);
    mesh.tube(red.shaded(0.9), 0.8 * top, top, 0.7 * radius, 0.25 * radius, sides);
    mesh.disc(red.shaded(0.9), top, Vec3::Z, 0.25 * radius, sides);
    mesh
}

/// A yellow box under a sloping roof on a foot, with a slot to both sides.
fn mailbox(piece: &Piece) -> Mesh {
    let yellow = piece.paint([228, 182, 34]).glossy(40);
    let mut mesh = Mesh::default();
    mesh.cuboid(piece.paint(IRON), piece.at(-0.35, -0.35, 0.0), piece.at(0.35, 0.35, 0.35));
    mesh.cuboid(yellow, piece.at(-0.95, -0.95, 0.35), piece.at(0.95, 0.95, 0.9));
    let ring = |share: f32, z: f32| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| piece.at(share * x, share * y, z))
    };
    mesh.frustum(yellow.shaded(0.9), &ring(1.0, 0.9), &ring(0.6, 1.0));
    if piece.is_fine() {
        for x in [-0.96, 0.96] {
            let slot = [(-0.6, 0.76), (0.6, 0.76), (0.6, 0.81), (-0.6, 0.81)];
            mesh.polygon(piece.paint([30, 30, 32]), &slot.map(|(y, z)| piece.at(x, x.signum() * y, z)));
        }
    }
    mesh
}

/// A roof on a back of glass at positive y, short sides, and a bench.
fn shelter(piece: &Piece) -> Mesh {
    let (steel, glass) = (piece.paint([92, 96, 100]).glossy(40), piece.paint([150, 172, 178]).glossy(200));
    let mut mesh = Mesh::default();
    let (half, height) = (piece.half(), piece.size.z);
    let roof = 0.94 * height;
    let sheet = 0.03f32.min(0.2 * half.y);
    mesh.cuboid(steel, Vec3::new(-half.x, -half.y, roof), Vec3::new(half.x, half.y, height));
    mesh.cuboid(glass, Vec3::new(-half.x, 0.92 * half.y - sheet, 0.08), Vec3::new(half.x, 0.92 * half.y, roof));
    for x in [-1.0, 1.0] {
        let (out, within) = (0.98 * x * half.x, 0.98 * x * half.x - x * sheet);
        let (low, high) = (out.min(within), out.max(within));
        mesh.cuboid(glass, Vec3::new(low, -0.2 * half.y, 0.08), Vec3::new(high, 0.9 * half.y, roof));
        if piece.detail != Detail::Rough {
            for y in [-0.25, 0.88] {
                let foot = Vec3::new(x * (half.x - 0.06), y * half.y, 0.0);
                mesh.cuboid(steel, foot - Vec3::new(0.04, 0.04, 0.0), foot + Vec3::new(0.04, 0.04, roof));
            }
        }
    }
    if piece.is_fine() {
        let (low, high) = (
            Vec3::new(-0.7 * half.x, 0.2 * half.y, 0.18 * height),
            Vec3::new(0.7 * half.x, 0.85 * half.y, 0.2 * height),
        );
        mesh.cuboid(piece.paint(WOOD), low, high);
    }
    mesh
}

/// A body that widens upwards, under a lid that rises to its back.
fn dumpster(piece: &Piece, variant: u32) -> Mesh {
    let colour = Variety::of(variant).colour(&[[56, 86, 62], [62, 76, 104], [92, 94, 96]]);
    let steel = piece.paint(colour).glossy(30);
    let mut mesh = Mesh::default();
    let ring = |share: f32, front: f32, back: f32| {
        let corners = [(-1.0, -1.0, front), (1.0, -1.0, front), (1.0, 1.0, back), (-1.0, 1.0, back)];
        corners.map(|(x, y, z)| piece.at(share * x, share * y, z))
    };
    mesh.walls(steel, &ring(0.84, 0.1, 0.1), &ring(0.96, 0.78, 0.92));
    mesh.frustum(steel.shaded(0.45), &ring(1.0, 0.78, 0.92), &ring(1.0, 0.86, 1.0));
    if piece.detail != Detail::Rough {
        for (x, y) in [(-0.7, -0.7), (0.7, -0.7), (0.7, 0.7), (-0.7, 0.7)] {
            mesh.cuboid(piece.paint(IRON), piece.at(x - 0.06, y - 0.1, 0.0), piece.at(x + 0.06, y + 0.1, 0.12));
        }
    }
    mesh
}

/// A trough of concrete with plants in it.
fn planter(piece: &Piece, variant: u32) -> Mesh {
    let concrete = piece.paint([158, 154, 146]).grainy(40);
    let mut mesh = Mesh::default();
    let rim = if piece.is_fine() { 0.86 } else { 1.0 };
    let ring = |share: f32, z: f32| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| piece.at(share * x, share * y, z))
    };
    mesh.walls(concrete, &ring(0.92, 0.0), &ring(1.0, 0.55));
    for k in 0..4 {
        let (outer, inner, next) = (ring(1.0, 0.55), ring(rim, 0.55), (k + 1) % 4);
        if rim < 1.0 {
            mesh.polygon(concrete.shaded(1.08), &[outer[k], outer[next], inner[next], inner[k]]);
        }
    }
    mesh.polygon(piece.paint([70, 56, 44]), &ring(rim, 0.55));
    let mut variety = Variety::of(variant);
    let green = piece.paint(variety.colour(&[[74, 108, 54], [92, 122, 62], [112, 96, 74]])).grainy(120);
    let count = ((piece.size.x / piece.size.y).round() as u32).clamp(1, 4);
    let (rings, sides) = if piece.is_fine() { (4, 7) } else { (2, 5) };
    for k in 0..count {
        let x = (2.0 * k as f32 + 1.0) / count as f32 - 1.0;
        let radii = Vec3::new(0.46 * piece.size.x / count as f32, 0.43 * piece.size.y, 0.25 * piece.size.z);
        let centre = piece.at(x, 0.0, 0.75);
        mesh.lump(green, &Lump { centre, radii, rings, sides, rough: 0.0 }, &mut variety);
    }
    mesh
}

/// A row of hoops across its length.
fn bicycle_stand(piece: &Piece) -> Mesh {
    let steel = piece.paint(STEEL).glossy(60);
    let mut mesh = Mesh::default();
    let (half, sides) = (piece.half(), if piece.is_fine() { 5 } else { 3 });
    let radius = 0.03f32.min(0.3 * half.y).min(half.x);
    let count = ((piece.size.x / HOOP_PITCH_M) as u32).clamp(1, 12);
    for k in 0..count {
        let x = ((2 * k + 1) as f32 / count as f32 - 1.0) * half.x;
        let y = half.y - radius;
        let (foot, top) = (|y: f32| Vec3::new(x, y, 0.0), |y: f32| Vec3::new(x, y, piece.size.z - radius));
        mesh.tube(steel, foot(-y), top(-y), radius, radius, sides);
        mesh.tube(steel, foot(y), top(y), radius, radius, sides);
        let bar = Vec3::new(radius, half.y, 2.0 * radius);
        let low = Vec3::new(x - radius, -half.y, piece.size.z - 2.0 * radius);
        mesh.cuboid(steel, low, low + Vec3::new(2.0 * bar.x, 2.0 * bar.y, bar.z));
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    const TAGS: [SemanticTag; 3] = [SemanticTag::Static, SemanticTag::Dynamic, SemanticTag::Other];

    fn places(mesh: &Mesh) -> impl Iterator<Item = Vec3> + '_ {
        mesh.vertices.iter().map(|v| Vec3::from_array(v.position))
    }

    fn count(mesh: &Mesh) -> usize {
        mesh.all_triangles().count()
    }

    /// Whatever a file says of its size, a piece is of its class, within its box, as high as that, and cheap.
    #[test]
    fn every_piece_fills_its_box_and_no_more() {
        let sizes =
            [[1.6, 0.6, 0.9], [0.6, 1.8, 0.85], [0.25, 0.25, 1.0], [0.3, 0.3, 6.0], [3.6, 1.4, 2.5], [1.2, 1.0, 1.3]];
        for (size, &what) in sizes.iter().flat_map(|size| FurnitureKind::ALL.iter().map(move |what| (size, what))) {
            let size = Vec3::from_array(*size);
            for (tag, detail) in TAGS.into_iter().flat_map(|tag| Detail::ALL.map(|detail| (tag, detail))) {
                for variant in 0..6 {
                    let mesh = mesh(what, tag, variant, size, detail);
                    let box_m = size * Vec3::new(0.5, 0.5, 1.0) + 0.051;
                    assert!(mesh.vertices.iter().all(|v| v.tag == tag as u8), "{what:?}");
                    assert!(places(&mesh).all(|p| p.abs().cmple(box_m).all()), "{what:?} {size}");
                    assert!((places(&mesh).map(|p| p.z).fold(0.0, f32::max) - size.z).abs() < 1e-3, "{what:?} {size}");
                    assert!(
                        count(&mesh) <= if detail == Detail::Fine { 320 } else { 200 },
                        "{what:?} {}",
                        count(&mesh)
                    );
                }
            }
        }
    }

    /// Pieces of one size look different, so it is not their size that tells them.
    #[test]
    fn kinds_of_one_size_look_different() {
        let size = Vec3::new(1.6, 0.6, 0.9);
        let meshes: Vec<Mesh> =
            FurnitureKind::ALL.iter().map(|&what| mesh(what, SemanticTag::Static, 1, size, Detail::Fine)).collect();
        for (k, one) in meshes.iter().enumerate() {
            assert!(meshes[..k].iter().all(|other| other != one), "{:?}", FurnitureKind::ALL[k]);
        }
    }

    /// A bench is open below its seat, and its back is at positive y.
    #[test]
    fn a_bench_has_a_seat_and_a_back() {
        let size = Vec3::new(1.6, 0.6, 0.9);
        for variant in 0..8 {
            let mesh = mesh(FurnitureKind::Bench, SemanticTag::Static, variant, size, Detail::Fine);
            assert!(places(&mesh).filter(|p| p.z > 0.86).all(|p| p.y > 0.2));
            let faces = mesh.all_triangles().map(|t| t.map(|i| places(&mesh).nth(i as usize).expect("a corner")));
            let wide = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a).x.abs() + (b - a).cross(c - a).y.abs() > 0.3;
            assert!(faces.filter(|t| t.iter().all(|p| p.z < 0.44)).all(|t| !wide(t)), "nothing but feet below");
        }
    }
}
