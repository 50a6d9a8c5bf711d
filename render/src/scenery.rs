//! The static world: one buffer of vertices and a list of pieces to choose from in each frame.

use std::ops::Range;

use glam::Vec3;
use kernel::map::{PropKind, RoadNetwork};

use crate::mesh::model::Detail;
use crate::mesh::{FINISHES, Mesh, Vertex, prop, surface};
use crate::view::View;

/// Instances of parked cars count from here.
pub const FIRST_PARKED_INSTANCE: u16 = 32768;

/// Pieces smaller than this many pixels are left out.
const SMALLEST_PX: f32 = 0.7;

/// A coarse mesh serves when it differs by less than this many pixels.
const COARSE_ERROR_PX: f32 = 0.4;

/// A piece of the static world at one level of detail.
#[derive(Clone, Debug, Default)]
struct Level {
    /// Ranges in [`Scenery::indices`], one for each finish.
    ranges: [Range<u32>; FINISHES],
}

#[derive(Clone, Debug)]
struct Piece {
    centre: Vec3,
    radius_m: f32,
    fine: Level,
    coarse: Level,
}

/// The static world of a map.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scenery {
    pub(crate) vertices: Vec<Vertex>,
    indices: Vec<u32>,
    pieces: Vec<Piece>,
}

impl Scenery {
    pub(crate) fn new(network: &RoadNetwork) -> Self {
        let mut scenery = Self::default();
        for mesh in static_meshes(network, Detail::Fine).into_iter().zip(static_meshes(network, Detail::Coarse)) {
            scenery.add(mesh);
        }
        scenery
    }

    fn add(&mut self, (fine, coarse): (Mesh, Mesh)) {
        let (centre, radius_m) = bounding_sphere(&fine);
        let same = fine == coarse;
        let fine = self.store(&fine);
        let coarse = if same { fine.clone() } else { self.store(&coarse) };
        self.pieces.push(Piece { centre, radius_m, fine, coarse });
    }

    fn store(&mut self, mesh: &Mesh) -> Level {
        let first = self.vertices.len() as u32;
        self.vertices.extend_from_slice(&mesh.vertices);
        let ranges = core::array::from_fn(|finish| {
            let start = self.indices.len() as u32;
            self.indices.extend(mesh.triangles[finish].iter().flatten().map(|i| i + first));
            start..self.indices.len() as u32
        });
        Level { ranges }
    }

    /// Indices of what a view sees for each finish, front to back.
    pub(crate) fn visible(&self, view: &View) -> [Vec<u32>; FINISHES] {
        let mut seen: Vec<(f32, &Level)> = Vec::new();
        for piece in &self.pieces {
            let Piece { centre, radius_m, .. } = *piece;
            if view.sees(centre, radius_m) && view.pixels(2.0 * radius_m, centre, radius_m) > SMALLEST_PX {
                let error_px = view.pixels(Detail::Coarse.error_m(), centre, radius_m);
                let level = if error_px < COARSE_ERROR_PX { &piece.coarse } else { &piece.fine };
                seen.push((centre.distance(view.eye) - radius_m, level));
            }
        }
        seen.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.gather(seen.into_iter().map(|(_, level)| level))
    }

    /// Indices of all coarse pieces that come closer than `reach_m` to the line through `centre`
    /// along `direction`, all finishes together.
    pub(crate) fn near_line(&self, centre: Vec3, direction: Vec3, reach_m: f32) -> Vec<u32> {
        let near =
            self.pieces.iter().filter(|p| (p.centre - centre).reject_from(direction).length() < reach_m + p.radius_m);
        self.gather(near.map(|p| &p.coarse)).concat()
    }

    fn gather<'a>(&self, levels: impl Iterator<Item = &'a Level>) -> [Vec<u32>; FINISHES] {
        let mut lists: [Vec<u32>; FINISHES] = Default::default();
        for level in levels {
            for (list, range) in lists.iter_mut().zip(&level.ranges) {
                list.extend_from_slice(&self.indices[range.start as usize..range.end as usize]);
            }
        }
        lists
    }
}

/// The meshes of the static world in the world's frame: surfaces, props, and the plain around.
pub fn static_meshes(network: &RoadNetwork, detail: Detail) -> Vec<Mesh> {
    let mut meshes = surface::cells(network);
    meshes.push(surface::plain(network));
    let mut parked = FIRST_PARKED_INSTANCE;
    for object in &network.props {
        let mut mesh = prop::mesh(object, detail);
        prop::place(&mut mesh, object.position, object.heading_rad);
        if object.kind == PropKind::ParkedCar {
            mesh.vertices.iter_mut().for_each(|v| v.instance = parked);
            parked = parked.saturating_add(1).min(crate::actors::EGO_INSTANCE - 1);
        }
        meshes.push(mesh);
    }
    meshes.retain(|mesh| !mesh.is_empty());
    meshes
}

/// A sphere around a mesh's bounding box.
fn bounding_sphere(mesh: &Mesh) -> (Vec3, f32) {
    let start = (Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY));
    let (low, high) = mesh.vertices.iter().fold(start, |(low, high), v| {
        let p = Vec3::from_array(v.position);
        (low.min(p), high.max(p))
    });
    (0.5 * (low + high), 0.5 * (high - low).length())
}
