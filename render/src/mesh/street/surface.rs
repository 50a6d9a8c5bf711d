//! Roads, markings, sidewalks and grass from the map's surfaces.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};
use kernel::map::{RoadNetwork, Surface, SurfaceKind};

use crate::SemanticTag;
use crate::mesh::{CODE_GRASS, CODE_SLABS, Mesh, Paint};

/// Side of the square cells that surfaces are cut into, metres.
const CELL_M: f32 = 24.0;

fn paint(kind: SurfaceKind) -> Paint {
    match kind {
        SurfaceKind::Road => Paint::plain(SemanticTag::Road, [98, 98, 100]).grainy(90),
        SurfaceKind::RoadLine => Paint::plain(SemanticTag::RoadLine, [224, 224, 216]).grainy(60),
        SurfaceKind::Sidewalk => Paint::plain(SemanticTag::SideWalk, [164, 158, 150]).grainy(60).coded(CODE_SLABS),
        SurfaceKind::Terrain => Paint::plain(SemanticTag::Terrain, [98, 110, 68]).grainy(200).coded(CODE_GRASS),
        SurfaceKind::Ground => Paint::plain(SemanticTag::Ground, [140, 134, 124]).grainy(120),
        SurfaceKind::Gravel => Paint::plain(SemanticTag::Road, [152, 142, 122]).grainy(220),
        SurfaceKind::Track => Paint::plain(SemanticTag::RailTrack, [112, 102, 92]).grainy(220),
        SurfaceKind::Rail => Paint::plain(SemanticTag::RailTrack, [150, 148, 146]).glossy(120),
        SurfaceKind::Water => Paint::plain(SemanticTag::Water, [66, 96, 112]).glossy(200),
        SurfaceKind::Setts => Paint::plain(SemanticTag::Road, [118, 112, 106]).grainy(160),
    }
}

/// A piece of a surface.
pub struct Cell {
    /// In the world's frame.
    pub mesh: Mesh,
    /// What it is of.
    pub kind: SurfaceKind,
}

/// The surfaces of a map, cut into cells.
pub fn cells(network: &RoadNetwork) -> impl Iterator<Item = Cell> + '_ {
    let of = |surface: &'_ Surface| {
        let kind = surface.kind;
        cut(surface).into_iter().map(move |mesh| Cell { mesh, kind })
    };
    network.surfaces.iter().flat_map(of)
}

/// Reach of the plain beyond the map, metres.
const PLAIN_M: f32 = 3000.0;

/// Grass to the horizon, half a metre below the lowest point of the map.
pub fn plain(network: &RoadNetwork) -> Mesh {
    let [low, high] = network.bounds;
    let (middle, z) = (0.5 * (low + high), low.z - 0.5);
    let corner = |x: f32, y: f32| Vec3::new(middle.x + x * PLAIN_M, middle.y + y * PLAIN_M, z);
    let mut mesh = Mesh::default();
    mesh.polygon(
        paint(SurfaceKind::Terrain),
        &[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
    );
    mesh
}

fn cut(surface: &Surface) -> Vec<Mesh> {
    let mut cells: BTreeMap<[i32; 2], Vec<[u32; 3]>> = BTreeMap::new();
    for &triangle in &surface.triangles {
        let centre: Vec3 = triangle.iter().map(|&i| surface.positions[i as usize]).sum::<Vec3>() / 3.0;
        let cell = [(centre.x / CELL_M).floor() as i32, (centre.y / CELL_M).floor() as i32];
        cells.entry(cell).or_default().push(triangle);
    }
    cells.values().map(|triangles| cell(surface, triangles)).collect()
}

/// Vertices are shared between triangles that are alike steep, so that kerbs keep their edge.
fn cell(surface: &Surface, triangles: &[[u32; 3]]) -> Mesh {
    let at = |i: u32| surface.positions[i as usize];
    let face = |[a, b, c]: [u32; 3]| (at(b) - at(a)).cross(at(c) - at(a));
    let steep = |normal: Vec3| normal.z.abs() < 0.7 * normal.length();
    let mut normals: BTreeMap<(u32, bool), Vec3> = BTreeMap::new();
    for &triangle in triangles {
        let normal = face(triangle);
        for i in triangle {
            *normals.entry((i, steep(normal))).or_default() += normal;
        }
    }
    let paint = paint(surface.kind);
    let mut mesh = Mesh::default();
    let index: BTreeMap<(u32, bool), u32> = normals
        .iter()
        .map(|(&key, normal)| {
            let p = at(key.0);
            // Kerb stones are lighter than slabs and have no joints.
            let paint =
                if key.1 && surface.kind == SurfaceKind::Sidewalk { paint.shaded(1.08).coded(0) } else { paint };
            (key, mesh.vertex(paint, p, normal.normalize_or(Vec3::Z), Vec2::new(p.x, p.y)))
        })
        .collect();
    for &triangle in triangles {
        let kind = steep(face(triangle));
        mesh.triangle(paint.finish, triangle.map(|i| index[&(i, kind)]));
    }
    mesh
}
