//! Roads, markings, sidewalks and grass from the map's surfaces.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};
use kernel::map::{Lane, RoadNetwork, Surface, SurfaceKind};

use super::along::{Pavement, Roads, Stretch, road_of};
use super::{drain, verge};
use crate::SemanticTag;
use crate::mesh::variety::Variety;
use crate::mesh::{
    CODE_COVERS, CODE_GRATING, CODE_KERB, CODE_KERBED, CODE_OLDEST, CODE_PAINT, CODE_SETTS, Finish, Mesh, Paint,
};

/// Side of the square cells that surfaces are cut into, metres.
const CELL_M: f32 = 24.0;

fn paint(kind: SurfaceKind) -> Paint {
    match kind {
        SurfaceKind::Road => asphalt(JUNCTION_AGE),
        SurfaceKind::RoadLine => laid(SemanticTag::RoadLine, [208, 208, 200], Finish::Asphalt, CODE_PAINT),
        SurfaceKind::Sidewalk => laid(SemanticTag::SideWalk, [150, 145, 138], Finish::Paving, FLAGS),
        SurfaceKind::Terrain => laid(SemanticTag::Terrain, [94, 100, 66], Finish::Grass, 0),
        SurfaceKind::Ground => laid(SemanticTag::Ground, [140, 134, 124], Finish::Paving, SMALL_STONES),
        SurfaceKind::Gravel => Paint::plain(SemanticTag::Road, [152, 142, 122]).grainy(220),
        SurfaceKind::Track => Paint::plain(SemanticTag::RailTrack, [112, 102, 92]).grainy(220),
        SurfaceKind::Rail => Paint::plain(SemanticTag::RailTrack, [150, 148, 146]).glossy(120),
        SurfaceKind::Water => Paint::plain(SemanticTag::Water, [66, 96, 112]).glossy(200),
        SurfaceKind::Setts => laid(SemanticTag::Road, [106, 101, 95], Finish::Paving, CODE_SETTS),
    }
}

const SMALL_STONES: u8 = CODE_SETTS + 1;
const FLAGS: u8 = CODE_SETTS + 2;
const SLABS: u8 = CODE_SETTS + 3;

/// Age of the asphalt of junctions: their lanes lie over each other, and are alike.
const JUNCTION_AGE: u8 = 3;

/// Roads of a higher limit are no streets, with no manholes and younger asphalt, m/s.
const STREET_MPS: f32 = 60.0 / 3.6;

const fn laid(tag: SemanticTag, colour: [u8; 3], finish: Finish, code: u8) -> Paint {
    Paint { tag, colour, finish, param: 0, code }
}

/// Bitumen fades.
fn asphalt(age: u8) -> Paint {
    let grey = 64 + 5 * age;
    laid(SemanticTag::Road, [grey, grey, grey + 2], Finish::Asphalt, age)
}

/// How something is laid in a road, by its name.
fn variety_of(road: &str) -> Variety {
    Variety::of(road.bytes().fold(17, |h: u32, byte| h.wrapping_mul(31) ^ u32::from(byte)))
}

/// How the surface of a place looks, and where places around are on it.
enum Lay<'a> {
    /// By the world's axes.
    Level(Paint),
    Road(Paint, Stretch<'a>),
    Pavement(Paint, Pavement<'a>),
}

impl<'a> Lay<'a> {
    fn new(kind: SurfaceKind, place: Vec3, roads: &Roads<'a>) -> Self {
        let paint = paint(kind);
        match kind {
            SurfaceKind::Road => roads.stretch(place).map(|on| Self::Road(asphalt_of(on.on.lane), on)),
            SurfaceKind::Setts => roads.stretch(place).map(|on| Self::Road(paint, on)),
            SurfaceKind::Sidewalk => roads.pavement(place).map(|on| Self::Pavement(pavement_of(&on), on)),
            _ => None,
        }
        .unwrap_or(Self::Level(paint))
    }

    /// Paint and place on the surface of one of its corners.
    fn at(&self, place: Vec3) -> (Paint, Vec2) {
        match self {
            Self::Level(paint) => (*paint, place.truncate()),
            Self::Road(paint, on) => (Paint { param: 255 * on.phase(place), ..*paint }, on.uv(place)),
            Self::Pavement(paint, on) => (*paint, on.uv(place)),
        }
    }
}

fn asphalt_of(lane: &Lane) -> Paint {
    let mut variety = variety_of(road_of(lane));
    if lane.speed_limit_mps > STREET_MPS {
        return asphalt(variety.pick(&[0, 1, 2, 3, 3]));
    }
    let paint = asphalt(variety.pick(&[1, 2, 3, 4, 5, 6, CODE_OLDEST]));
    paint.coded(paint.code | CODE_COVERS)
}

fn pavement_of(on: &Pavement) -> Paint {
    let bond = variety_of(road_of(on.on.lane)).pick(&[FLAGS, FLAGS, SLABS, SMALL_STONES]);
    let kerb = if on.road.is_some() { CODE_KERBED } else { 0 };
    paint(SurfaceKind::Sidewalk).coded(bond | kerb)
}

/// A piece of a surface.
pub struct Cell {
    /// In the world's frame.
    pub mesh: Mesh,
    /// Whether it lies on other ground, so thin that nothing shows below its edges.
    pub is_thin: bool,
}

/// The surfaces of a map, cut into cells.
pub fn cells(network: &RoadNetwork) -> impl Iterator<Item = Cell> + '_ {
    let roads = Roads::new(network);
    let of = move |surface: &'_ Surface| {
        let is_thin = surface.kind.lies_on_ground();
        cut(surface, &roads).into_iter().map(move |mesh| Cell { mesh, is_thin })
    };
    let laid_on = verges(network).into_iter().chain(drains(network)).map(|mesh| Cell { mesh, is_thin: true });
    network.surfaces.iter().flat_map(of).chain(laid_on)
}

fn verges(network: &RoadNetwork) -> Vec<Mesh> {
    let mut cells: BTreeMap<[i32; 2], Mesh> = BTreeMap::new();
    for surface in &network.surfaces {
        for piece in verge::pieces(network, surface, paint(SurfaceKind::Terrain)) {
            verge::mesh(&piece, cells.entry(cell_of(piece[0].0)).or_default());
        }
    }
    cells.into_values().collect()
}

fn drains(network: &RoadNetwork) -> Vec<Mesh> {
    let iron = laid(SemanticTag::Road, [66, 66, 68], Finish::Asphalt, CODE_GRATING);
    let mut cells: BTreeMap<[i32; 2], Mesh> = BTreeMap::new();
    for (middle, mesh) in drain::gratings(network, iron) {
        cells.entry(cell_of(middle)).or_default().append(&mesh, Vec3::ZERO);
    }
    cells.into_values().collect()
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

fn cut(surface: &Surface, roads: &Roads) -> Vec<Mesh> {
    let mut cells: BTreeMap<[i32; 2], Vec<[u32; 3]>> = BTreeMap::new();
    for &triangle in &surface.triangles {
        cells.entry(cell_of(centre(surface, triangle))).or_default().push(triangle);
    }
    cells.values().map(|triangles| cell(surface, triangles, roads)).collect()
}

fn cell_of(place: Vec3) -> [i32; 2] {
    [(place.x / CELL_M).floor() as i32, (place.y / CELL_M).floor() as i32]
}

fn centre(surface: &Surface, triangle: [u32; 3]) -> Vec3 {
    triangle.iter().map(|&i| surface.positions[i as usize]).sum::<Vec3>() / 3.0
}

/// Vertices are shared between triangles that are alike steep, so that kerbs keep their edge.
fn cell(surface: &Surface, triangles: &[[u32; 3]], roads: &Roads) -> Mesh {
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
    let mut mesh = Mesh::default();
    for &triangle in triangles {
        let is_steep = steep(face(triangle));
        let lay = Lay::new(surface.kind, centre(surface, triangle), roads);
        let corners = triangle.map(|i| {
            let (paint, uv) = lay.at(at(i));
            let is_kerb = is_steep && surface.kind == SurfaceKind::Sidewalk;
            let paint = if is_kerb { paint.coded(CODE_KERB) } else { paint };
            mesh.vertex(paint, at(i), normals[&(i, is_steep)].normalize_or(Vec3::Z), uv)
        });
        mesh.triangle(paint(surface.kind).finish, corners);
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streets_differ_in_age_and_their_pavements_have_kerbs() {
        let network = kernel::map::bundled("city").expect("a bundled map");
        let mut codes: BTreeMap<u8, usize> = BTreeMap::new();
        for Cell { mesh, .. } in cells(&network) {
            for (finish, bits) in [(Finish::Asphalt, 0x80), (Finish::Paving, 0)] {
                for v in mesh.triangles[finish as usize].iter().map(|t| mesh.vertices[t[0] as usize]) {
                    *codes.entry(v.code | bits).or_default() += 1;
                }
            }
        }
        let ages = codes.keys().filter(|code| **code & (0x80 | CODE_COVERS) == 0x80 | CODE_COVERS).count();
        let bonds = codes.keys().filter(|code| **code & !3 == CODE_KERBED).count();
        assert!(ages >= 3 && bonds >= 2 && codes.contains_key(&CODE_KERB), "{codes:?}");
    }

    #[test]
    fn worn_ground_is_bare_at_the_edge_of_what_is_paved_alone() {
        let network = kernel::map::bundled("rural").expect("a bundled map");
        let grass = cells(&network).flat_map(|cell| cell.mesh.vertices).filter(|v| v.tag == SemanticTag::Terrain as u8);
        let (bare, green): (Vec<_>, Vec<_>) = grass.partition(|v| v.param > 0);
        assert!(bare.len() > 1000 && green.len() > bare.len());
    }
}
