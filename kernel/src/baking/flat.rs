//! Objects that lie on the ground: water, squares, islands of traffic, rails.

use glam::{Vec2, Vec3};

use super::mesh::{Meshes, PAINT_M};
use super::rounding::snap3;
use super::shapes::point;
use super::source::Source;
use crate::map_data::SurfaceKind;

/// Corners of an outline; what has more is passed over.
const CORNERS: usize = 256;
/// Corners of all water that land is lowered for.
const SHORES: usize = 20_000;
/// What is higher is a rail to hold on to, metres.
const RAIL_M: f32 = 0.25;
/// Land lies so far below the water in it, metres.
const DEPTH_M: f32 = 0.5;

/// Water in the land.
pub(super) struct Pool {
    outline: Vec<Vec2>,
    level_m: f32,
}

impl Pool {
    /// The height that land has at most at a place, if the pool is there.
    pub fn bed_m(&self, place: Vec2) -> Option<f32> {
        holds(&self.outline, place).then_some(self.level_m - DEPTH_M)
    }
}

/// What an object that lies on the ground is made of; `None` for all others.
pub(super) fn kind(object: &xodr::Object) -> Option<SurfaceKind> {
    use xodr::ObjectType as T;
    let is_named = matches!(object.kind, T::None | T::Unknown);
    let name = object.name.to_ascii_lowercase();
    let has = |words: &[&str]| is_named && words.iter().any(|word| name.contains(word));
    match &object.shape {
        xodr::Shape::Outline { corners, closed: true, .. } if corners.len() <= CORNERS => match object.kind {
            T::TrafficIsland => Some(SurfaceKind::Ground),
            _ if has(&["water", "lake", "pond", "river", "canal"]) => Some(SurfaceKind::Water),
            _ if has(&["plaza", "square", "yard"]) => Some(SurfaceKind::Ground),
            _ => None,
        },
        xodr::Shape::Sweep { sections, .. } if has(&["rail", "track"]) => {
            let is_low = sections.iter().all(|s| s.left.top.z - s.left.base.z < RAIL_M);
            is_low.then_some(SurfaceKind::Rail)
        }
        _ => None,
    }
}

/// Adds all objects that lie on the ground to the surfaces.
pub(super) fn lay(source: &Source, meshes: &mut Meshes) {
    for object in source.net.objects() {
        let Some(kind) = kind(object) else { continue };
        match &object.shape {
            xodr::Shape::Outline { corners, .. } if kind == SurfaceKind::Water => {
                let level_m = level_m(corners);
                let outline: Vec<Vec3> = base(corners).iter().map(|p| p.truncate().extend(level_m)).collect();
                triangles(&outline).for_each(|corners| meshes.of(kind).fan(&corners));
            }
            xodr::Shape::Outline { corners, .. } => {
                let top: Vec<Vec3> = corners.iter().map(|c| snap3(point(c.top) + Vec3::Z * PAINT_M)).collect();
                triangles(&top).for_each(|corners| meshes.of(kind).fan(&corners));
                skirt(&top, &base(corners)).for_each(|face| meshes.of(kind).fan(&face));
            }
            xodr::Shape::Sweep { sections, .. } => {
                let up = Vec3::Z * PAINT_M;
                let rib = |s: &xodr::Section| [s.left, s.right].map(|c| snap3(point(c.base) + up));
                meshes.of(kind).strip(&sections.iter().map(rib).collect::<Vec<_>>());
            }
            _ => {}
        }
    }
}

/// All water of a file.
pub(super) fn pools(source: &Source) -> Vec<Pool> {
    let water = source.net.objects().iter().filter(|object| kind(object) == Some(SurfaceKind::Water));
    let pool = |object: &xodr::Object| match &object.shape {
        xodr::Shape::Outline { corners, .. } => {
            let outline = base(corners).iter().map(|p| p.truncate()).collect();
            Some(Pool { outline, level_m: level_m(corners) })
        }
        _ => None,
    };
    let mut corners = 0;
    let few = |pool: &Pool| {
        corners += pool.outline.len();
        corners <= SHORES
    };
    water.filter_map(pool).take_while(few).collect()
}

fn base(corners: &[xodr::Corner]) -> Vec<Vec3> {
    corners.iter().map(|c| point(c.base)).collect()
}

/// Water is as high as the lowest place on its shore.
fn level_m(corners: &[xodr::Corner]) -> f32 {
    base(corners).iter().map(|p| p.z).fold(f32::MAX, f32::min)
}

/// Faces down from the edges of an area.
fn skirt<'a>(top: &'a [Vec3], base: &'a [Vec3]) -> impl Iterator<Item = [Vec3; 4]> + 'a {
    let outwards = area(top) > 0.0;
    (0..top.len()).map(move |k| {
        let next = (k + 1) % top.len();
        let (a, b) = if outwards { (k, next) } else { (next, k) };
        [top[b], top[a], base[a], base[b]]
    })
}

/// Twice the area of an outline, positive where it runs counter-clockwise.
fn area(outline: &[Vec3]) -> f32 {
    let next = |k: usize| outline[(k + 1) % outline.len()];
    outline.iter().enumerate().map(|(k, p)| p.truncate().perp_dot(next(k).truncate())).sum()
}

/// Whether an outline is around a place (a ray to the east crosses it an odd number of times).
fn holds(outline: &[Vec2], place: Vec2) -> bool {
    let crosses = |(k, a): (usize, &Vec2)| {
        let b = outline[(k + 1) % outline.len()];
        (a.y > place.y) != (b.y > place.y) && place.x < a.x + (place.y - a.y) / (b.y - a.y) * (b.x - a.x)
    };
    outline.iter().enumerate().filter(|edge| crosses(*edge)).count() % 2 == 1
}

/// Cuts an outline into triangles that face up, ear by ear; where it crosses itself, a part of it.
fn triangles(outline: &[Vec3]) -> impl Iterator<Item = [Vec3; 3]> {
    let mut left = outline.to_vec();
    if area(&left) < 0.0 {
        left.reverse();
    }
    std::iter::from_fn(move || {
        let n = left.len();
        let corner = |k: usize| [left[(k + n - 1) % n], left[k], left[(k + 1) % n]];
        let ear = (0..n).filter(|_| n >= 3).find(|&k| {
            let [a, b, c] = corner(k);
            let inside = |p: &&Vec3| **p != a && **p != b && **p != c && is_in([a, b, c], **p);
            turn(a, b, c) >= 0.0 && !left.iter().any(|p| inside(&p))
        })?;
        let found = corner(ear);
        left.remove(ear);
        Some(found)
    })
}

fn turn(a: Vec3, b: Vec3, c: Vec3) -> f32 {
    (b - a).truncate().perp_dot((c - b).truncate())
}

fn is_in([a, b, c]: [Vec3; 3], p: Vec3) -> bool {
    [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| turn(from, to, p) >= 0.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Of a star, however its rays are long, triangles cover the whole area, and hold what it holds.
        #[test]
        fn triangles_fill_an_outline(radii in prop::collection::vec(1f32..50.0, 3..40), turned in any::<bool>(),
                                     (x, y) in (-50f32..50.0, -50f32..50.0)) {
            let at = |(k, radius): (usize, &f32)| {
                let angle = std::f32::consts::TAU * k as f32 / radii.len() as f32;
                Vec3::new(radius * crate::ops::cos(angle), radius * crate::ops::sin(angle), 2.0)
            };
            let mut outline: Vec<Vec3> = radii.iter().enumerate().map(at).collect();
            if turned {
                outline.reverse();
            }
            let cut: Vec<_> = triangles(&outline).collect();
            prop_assert_eq!(cut.len(), outline.len() - 2);
            let covered: f32 = cut.iter().map(|t| area(t)).sum();
            prop_assert!((covered - area(&outline).abs()).abs() < 1e-3 * covered + 0.1);
            let place = Vec3::new(x, y, 2.0);
            let near_edge = |t: &[Vec3; 3]| [(0, 1), (1, 2), (2, 0)].iter().any(|&(a, b)| turn(t[a], t[b], place).abs() < 0.05);
            prop_assume!(!cut.iter().any(near_edge));
            let flat: Vec<Vec2> = outline.iter().map(|p| p.truncate()).collect();
            prop_assert_eq!(cut.iter().any(|t| is_in(*t, place)), holds(&flat, place.truncate()));
        }
    }
}
