//! What is drawn to a shadow map for a picture: what stands still, where the map does not show it yet, and what moves.

use std::ops::Range;

use glam::{IVec2, Mat4, Vec2, Vec3};

use crate::actors::Moving;
use crate::shadow_box::{ShadowBox, TILES, block, slot};

/// A rectangle of texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Area {
    /// Its upper left corner.
    pub(crate) at: [u32; 2],
    pub(crate) size: [u32; 2],
}

/// What casts shadows on a part of a map.
pub(crate) struct Casting {
    /// From the world to the clip space of the map.
    pub(crate) clip: Mat4,
    /// Nothing is drawn outside of it.
    pub(crate) within: Area,
    /// Indices of triangles.
    pub(crate) casters: Vec<u32>,
}

/// The first and the last tile of a rectangle that lies in one map.
pub(crate) type Region = [IVec2; 2];

/// As few rectangles as is easily found, of tiles that are sorted by rows.
pub(crate) fn regions(tiles: &[IVec2]) -> Vec<Region> {
    let same_map = |a: IVec2, b: IVec2| block(a) == block(b);
    let mut runs: Vec<Region> = Vec::new();
    for &tile in tiles {
        match runs.last_mut() {
            Some([_, last]) if *last + IVec2::X == tile && same_map(*last, tile) => *last = tile,
            _ => runs.push([tile; 2]),
        }
    }
    let mut regions: Vec<Region> = Vec::new();
    for run in runs {
        let above = |[first, last]: &&mut Region| {
            (first.x, last.x, last.y + 1) == (run[0].x, run[1].x, run[0].y) && same_map(*first, run[0])
        };
        match regions.iter_mut().find(above) {
            Some([_, last]) => *last = run[1],
            None => regions.push(run),
        }
    }
    regions
}

/// Casters on regions of a map with so many texels a side.
pub(crate) fn of_still(shadow: &ShadowBox, regions: &[Region], casters: Vec<Vec<u32>>, side: u32) -> Vec<Casting> {
    let texels = side / TILES as u32;
    let casting = |(&[first, last], casters): (&Region, Vec<u32>)| {
        let [at, size] = [slot(first), last - first + 1].map(|tiles| (tiles.as_uvec2() * texels).to_array());
        Casting { clip: shadow.grid.clip(block(first)), within: Area { at, size }, casters }
    };
    regions.iter().zip(casters).map(casting).collect()
}

/// What moves and casts a shadow on a box, map by map as that crosses the edges of its own, and what it may cover there.
pub(crate) fn of_moving(moving: &Moving, shadow: &ShadowBox, side: u32) -> (Vec<Casting>, Vec<Area>) {
    let matrix = shadow.matrix();
    let bounds: Vec<[Vec2; 2]> =
        moving.casters.iter().map(|it| bounds_of(moving, it.vertices.clone(), matrix)).collect();
    let mut covered = Vec::new();
    let mut on = |maps: IVec2| {
        // The part of the box, in its own uv, and from there to the map's.
        let to_map = shadow.corner() - maps.as_vec2();
        let (start, end) = ((-to_map).max(Vec2::ZERO), (1.0 - to_map).min(Vec2::ONE));
        let within = area(start + to_map, end + to_map, side, 0.0)?;
        let mut casters = Vec::new();
        for (caster, [low, high]) in moving.casters.iter().zip(&bounds) {
            let (low, high) = (low.max(start), high.min(end));
            if low.cmple(high).all() {
                casters.extend_from_slice(&caster.indices);
                covered.extend(area(low + to_map, high + to_map, side, 2.0));
            }
        }
        let clip = shadow.grid.clip(shadow.first_block() + maps);
        (!casters.is_empty()).then_some(Casting { clip, within, casters })
    };
    let castings = (0..4).filter_map(|i| on(IVec2::new(i & 1, i >> 1))).collect();
    (castings, covered)
}

/// The rectangle around some vertices.
fn bounds_of(moving: &Moving, vertices: Range<u32>, matrix: Mat4) -> [Vec2; 2] {
    let vertices = &moving.vertices[vertices.start as usize..vertices.end as usize];
    let start = [Vec2::INFINITY, Vec2::NEG_INFINITY];
    vertices.iter().fold(start, |[low, high], vertex| {
        let at = matrix.transform_point3(Vec3::from_array(vertex.position)).truncate();
        [low.min(at), high.max(at)]
    })
}

/// Texels between two places of a map and so many around them, if there are any.
fn area(low: Vec2, high: Vec2, side: u32, around: f32) -> Option<Area> {
    let texels = |at: Vec2| (at * side as f32 + 0.5).clamp(Vec2::ZERO, Vec2::splat(side as f32)).as_uvec2();
    let around = around / side as f32;
    let (low, high) = (texels(low - around), texels(high + around));
    let size = high - low;
    (size.x > 0 && size.y > 0).then_some(Area { at: low.to_array(), size: size.to_array() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actors::Caster;
    use crate::mesh::Vertex;
    use bytemuck::Zeroable;

    #[test]
    fn tiles_are_drawn_as_few_rectangles_each_in_one_map() {
        let tiles = |x: Range<i32>, y: Range<i32>| y.flat_map(move |y| x.clone().map(move |x| IVec2::new(x, y)));
        let all: Vec<IVec2> = tiles(4..12, 5..13).collect();
        let count = |regions: Vec<Region>| regions.iter().map(|[a, b]| (*b - *a + 1).element_product()).sum::<i32>();
        assert_eq!((regions(&all).len(), count(regions(&all))), (4, 64));
        let column: Vec<IVec2> = tiles(11..12, 5..13).collect();
        assert_eq!(regions(&column), [[IVec2::new(11, 5), IVec2::new(11, 7)], [IVec2::new(11, 8), IVec2::new(11, 12)]]);
        let step: Vec<IVec2> = all.into_iter().filter(|tile| tile.x == 11 || tile.y == 12).collect();
        assert_eq!(count(regions(&step)), 15);
        assert!(regions(&[]).is_empty());
    }

    /// Two triangles: one where a box goes on over the edge of its map, and one outside of it.
    #[test]
    fn what_moves_is_drawn_to_the_maps_on_which_its_box_lies() {
        let shadow = ShadowBox::around(Vec3::new(30.0, 17.0, 0.0), Vec3::Z, 64.0);
        let mut moving = Moving::default();
        for at in [Vec3::new(0.2, 0.3, 0.0), Vec3::new(-90.0, 0.0, 0.0)] {
            let first = moving.vertices.len() as u32;
            for corner in [Vec3::ZERO, Vec3::new(2.0, 0.0, 1.0), Vec3::new(0.0, -2.0, 1.0)] {
                moving
                    .vertices
                    .push(Vertex { position: (at - Vec3::X + Vec3::Y + corner).to_array(), ..Vertex::zeroed() });
            }
            moving.casters.push(Caster { vertices: first..first + 3, indices: (first..first + 3).collect() });
        }
        let (castings, covered) = of_moving(&moving, &shadow, 1024);
        assert_eq!((castings.len(), covered.len()), (4, 4), "the origin is a corner of four tiles and of four maps");
        assert!(castings.iter().all(|casting| casting.casters == [0, 1, 2]));
        let texels = |areas: &mut dyn Iterator<Item = Area>| areas.map(|area| area.size[0] * area.size[1]).sum::<u32>();
        assert_eq!(texels(&mut castings.iter().map(|casting| casting.within)), 1024 * 1024);
        assert!((16 * 16..24 * 24).contains(&texels(&mut covered.iter().copied())), "{covered:?}");
    }
}
