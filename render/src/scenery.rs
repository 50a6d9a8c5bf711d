//! The static world: one buffer of vertices and a list of pieces to choose from in each frame.

use std::ops::Range;

use glam::{Vec2, Vec3};
use kernel::SceneSnapshot;
use kernel::map::{Prop, PropKind, RoadNetwork};
use kernel::scene::ActorKind;

use crate::castings::Region;
use crate::horizon::{Horizon, Occluder};
use crate::instance_ids::{instance_of_parked, parked_number};
use crate::mesh::look::look;
use crate::mesh::model::Detail;
use crate::mesh::rows::Rise;
use crate::mesh::street::surface;
use crate::mesh::{FINISHES, Mesh, Vertex, prop, simplify, skirt};
use crate::models::Models;
use crate::shadow_box::ShadowGrid;
use crate::sieve::Sieve;
use crate::view::View;
use crate::wind;

/// Pieces smaller than this many pixels are left out.
const SMALLEST_PX: f32 = 2.0;

/// Houses up to this distance hide what is behind them, metres.
const HOUSES_M: f32 = 160.0;

/// Surfaces are simplified by as much as nobody sees, metres.
const FLAT_M: f32 = 0.003;

/// Skirts are so many times as deep as surfaces are displaced: both sides of a gap are. Deeper ones are drawn over ground that
/// is drawn over them.
const SKIRT: f32 = 2.5;

/// A piece of the static world at one level of detail.
#[derive(Clone, Debug, Default)]
struct Level {
    /// Its vertices in [`Scenery::vertices`].
    vertices: Range<u32>,
    /// Ranges in [`Scenery::indices`], one for each finish.
    ranges: [Range<u32>; FINISHES],
}

#[derive(Clone, Debug)]
struct Piece {
    centre: Vec3,
    radius_m: f32,
    /// Corners of the box around all of its levels.
    extent: [Vec3; 2],
    /// Of a parked car its number.
    parked: Option<usize>,
    /// Whether it may keep the sun from something: what lies flat on the ground does not, nor does the plain below all.
    casts: bool,
    /// In the order of [`Detail::ALL`].
    levels: [Level; Detail::ALL.len()],
}

impl Piece {
    /// Whether it is not one of the parked cars that are gone.
    fn stands(&self, gone: &[usize]) -> bool {
        gone.is_empty() || self.parked.is_none_or(|number| !gone.contains(&number))
    }
}

/// The static world of a map.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scenery {
    pub(crate) vertices: Vec<Vertex>,
    indices: Vec<u32>,
    /// The last one is the plain, which all others hide.
    pieces: Vec<Piece>,
    houses: Vec<Occluder>,
    /// What stands on the ground, which models may replace.
    objects: Vec<Prop>,
    plain: Mesh,
    /// Pieces, vertices and indices of the ground.
    ground: [usize; 3],
}

impl Scenery {
    pub(crate) fn new(network: &RoadNetwork) -> Self {
        let houses = network.props.iter().filter_map(Occluder::of).collect();
        let (objects, plain) = (network.props.clone(), surface::plain(network));
        let mut scenery = Self { houses, objects, plain, ..Default::default() };
        for surface::Cell { mut mesh, is_thin } in surface::cells(network) {
            // Below paint is what it lies on.
            let skirt = if is_thin { 0.0 } else { SKIRT };
            let levels = Detail::ALL.map(|detail| {
                mesh = simplify::simplified(&mesh, detail.error_m().max(FLAT_M));
                skirt::with_skirt(&mesh, skirt * detail.error_m())
            });
            scenery.add(levels, None, !is_thin);
        }
        scenery.ground = [scenery.pieces.len(), scenery.vertices.len(), scenery.indices.len()];
        scenery.dress(None);
        scenery
    }

    /// All that stands on the ground.
    pub(crate) fn objects(&self) -> &[Prop] {
        &self.objects
    }

    /// Puts all objects on the ground, with models of a user's own or without.
    pub(crate) fn dress(&mut self, models: Option<&Models>) {
        let [pieces, vertices, indices] = self.ground;
        self.pieces.truncate(pieces);
        self.vertices.truncate(vertices);
        self.indices.truncate(indices);
        let objects = core::mem::take(&mut self.objects);
        for ((object, parked), rise) in numbered(&objects).zip(Rise::of_all(&objects)) {
            self.add(Detail::ALL.map(|detail| placed(object, rise, parked, (models, detail))), parked, true);
        }
        self.objects = objects;
        let plain = self.plain.clone();
        self.add(Detail::ALL.map(|_| plain.clone()), None, false);
    }

    fn add(&mut self, meshes: [Mesh; Detail::ALL.len()], parked: Option<usize>, casts: bool) {
        if meshes[0].is_empty() {
            return;
        }
        let [low, high] = extent(&meshes[0], 0.0);
        let (centre, radius_m) = (0.5 * (low + high), 0.5 * (high - low).length());
        let windblown = meshes.iter().map(|mesh| extent(mesh, wind::REACH_M));
        let all = windblown.fold([low, high], |[low, high], [l, h]| [low.min(l), high.max(h)]);
        let mut levels: [Level; Detail::ALL.len()] = Default::default();
        for i in 0..meshes.len() {
            let same = i > 0 && meshes[i] == meshes[i - 1];
            levels[i] = if same { levels[i - 1].clone() } else { self.store(&meshes[i]) };
        }
        self.pieces.push(Piece { centre, radius_m, extent: all, parked, casts, levels });
    }

    fn store(&mut self, mesh: &Mesh) -> Level {
        let first = self.vertices.len() as u32;
        self.vertices.extend_from_slice(&mesh.vertices);
        let ranges = core::array::from_fn(|finish| {
            let start = self.indices.len() as u32;
            self.indices.extend(mesh.triangles[finish].iter().flatten().map(|i| i + first));
            start..self.indices.len() as u32
        });
        Level { vertices: first..self.vertices.len() as u32, ranges }
    }

    /// The skyline of the houses around an eye.
    pub(crate) fn horizon(&self, eye: Vec3) -> Horizon {
        Horizon::new(eye, &self.houses, HOUSES_M)
    }

    /// Sifts what a view sees before a skyline, front to back, without the parked cars that are gone.
    pub(crate) fn sift(&self, (view, mut horizon): (&View, Horizon), gone: &[usize], sieve: &mut Sieve) {
        let large = |p: &Piece| view.pixels(2.0 * p.radius_m, p.centre, p.radius_m) > SMALLEST_PX;
        let is_seen = |p: &&Piece| p.stands(gone) && view.sees(p.centre, p.radius_m) && large(p);
        let near_m = |p: &Piece| p.centre.truncate().distance(view.eye.truncate()) - p.radius_m;
        let (others, plain) = self.pieces.split_at(self.pieces.len() - 1);
        let mut seen: Vec<(f32, &Piece)> = others.iter().filter(is_seen).map(|p| (near_m(p), p)).collect();
        seen.sort_by(|a, b| a.0.total_cmp(&b.0));
        seen.retain(|(_, p)| !horizon.hides(p.centre, p.radius_m));
        for piece in seen.into_iter().map(|(_, piece)| piece).chain(plain) {
            if !sieve.may_show_of(piece.extent) {
                continue;
            }
            let level = &piece.levels[view.detail(piece.centre, piece.radius_m) as usize];
            let vertices = &self.vertices[level.vertices.start as usize..level.vertices.end as usize];
            let indices = level.ranges.iter().map(|range| self.indices_of(range));
            sieve.sift(vertices, level.vertices.start, indices.enumerate());
        }
    }

    /// For each of some regions of a shadow map the indices of all coarse pieces that may cast a shadow on it, all finishes
    /// together, without the parked cars that are gone.
    pub(crate) fn casters(&self, grid: &ShadowGrid, regions: &[Region], gone: &[usize]) -> Vec<Vec<u32>> {
        let mut casters = vec![Vec::new(); regions.len()];
        if regions.is_empty() {
            return casters;
        }
        for piece in self.pieces.iter().filter(|p| p.casts && p.stands(gone)) {
            let [low, high] = grid.span(piece.extent);
            let level = &piece.levels[Detail::Coarse as usize];
            let meets = |[first, last]: &Region| last.cmpge(low).all() && first.cmple(high).all();
            for (_, list) in regions.iter().zip(&mut casters).filter(|(region, _)| meets(region)) {
                list.extend(level.ranges.iter().flat_map(|range| self.indices_of(range)));
            }
        }
        casters
    }

    /// The box around a parked car where the map has it.
    pub(crate) fn parked_extent(&self, number: usize) -> Option<[Vec3; 2]> {
        self.pieces.iter().find(|piece| piece.parked == Some(number)).map(|piece| piece.extent)
    }

    /// Draws everything at its finest from now on.
    #[cfg(test)]
    pub(crate) fn keep_finest(&mut self) {
        self.pieces.iter_mut().for_each(|piece| piece.levels = Detail::ALL.map(|_| piece.levels[0].clone()));
    }

    fn indices_of(&self, range: &Range<u32>) -> &[u32] {
        &self.indices[range.start as usize..range.end as usize]
    }
}

/// The static objects, parked cars with their numbers.
fn numbered(objects: &[Prop]) -> impl Iterator<Item = (&Prop, Option<usize>)> {
    let mut numbers = 0..;
    objects.iter().map(move |object| (object, if is_parked(object) { numbers.next() } else { None }))
}

fn is_parked(object: &Prop) -> bool {
    object.kind == PropKind::ParkedCar
}

/// What selects the looks of each parked car.
pub(crate) fn parked_looks(network: &RoadNetwork) -> Vec<u32> {
    network.props.iter().filter(|object| is_parked(object)).map(look).collect()
}

/// The numbers of the parked cars that are somewhere else.
pub(crate) fn gone(scene: &SceneSnapshot) -> Vec<usize> {
    let cars = scene.actors.iter().filter(|actor| actor.kind != ActorKind::Door);
    cars.filter_map(|actor| parked_number(actor.id)).collect()
}

/// The mesh of an object in the world's frame.
fn placed(object: &Prop, rise: Rise, parked: Option<usize>, (models, detail): (Option<&Models>, Detail)) -> Mesh {
    let instance = parked.map_or(0, instance_of_parked);
    let model = models.and_then(|models| models.object(object, detail));
    let mut mesh = model.unwrap_or_else(|| prop::mesh(object, detail));
    rise.tilt(&mut mesh, object.size.x);
    prop::place(&mut mesh, object.position, object.heading_rad);
    mesh.vertices.iter_mut().for_each(|v| v.instance = instance);
    mesh
}

/// Corners of the box around a mesh that wind moves by up to so much.
fn extent(mesh: &Mesh, sway_m: f32) -> [Vec3; 2] {
    let start = [Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY)];
    mesh.vertices.iter().fold(start, |[low, high], v| {
        let sway = Vec2::splat(sway_m * f32::from(v.sway) / 127.0).extend(0.0);
        let at = Vec3::from_array(v.position);
        [low.min(at - sway), high.max(at + sway)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SemanticTag;
    use crate::castings::regions;
    use crate::shadow_box::ShadowBox;

    /// Indices of what casts shadows on a box.
    fn cast(scenery: &Scenery, shadow: &ShadowBox, gone: &[usize]) -> Vec<u32> {
        scenery.casters(&shadow.grid, &regions(&shadow.tiles().collect::<Vec<_>>()), gone).concat()
    }

    #[test]
    fn a_parked_car_that_is_gone_is_not_drawn() {
        let city = kernel::map::bundled("city").expect("a bundled map");
        let scenery = Scenery::new(&city);
        let (car, _) = numbered(&city.props).find(|(_, parked)| *parked == Some(5)).expect("the city has parked cars");
        let drawn = |gone: &[usize]| cast(&scenery, &ShadowBox::around(car.position, Vec3::Z, 0.5), gone).len();
        assert!(drawn(&[5]) < drawn(&[]));
        assert_eq!(drawn(&[900]), drawn(&[]));
    }

    #[test]
    fn neither_lines_on_the_road_nor_the_plain_cast_shadows() {
        let city = kernel::map::bundled("city").expect("a bundled map");
        let scenery = Scenery::new(&city);
        let middle = 0.5 * (city.bounds[0] + city.bounds[1]);
        let casters = cast(&scenery, &ShadowBox::around(middle, Vec3::Z, 1000.0), &[]);
        let plain = scenery.pieces.last().expect("a piece").levels[0].vertices.clone();
        let tags: Vec<u8> = casters.iter().map(|i| scenery.vertices[*i as usize].tag).collect();
        assert!(casters.iter().all(|i| !plain.contains(i)) && !tags.contains(&(SemanticTag::RoadLine as u8)));
        assert!([SemanticTag::Building, SemanticTag::SideWalk].iter().all(|tag| tags.contains(&(*tag as u8))));
    }
}
