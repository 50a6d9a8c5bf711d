//! What part of the world a shadow map shows, and how it is made of tiles that stay where they are.

use glam::{IVec2, Mat4, Vec2, Vec3, Vec4};
use kernel::ops;

use crate::view::View;

/// Tiles along each side of a shadow map.
pub(crate) const TILES: i32 = 8;

/// What casts shadows is so far at least before or behind what they fall on, metres along the sun's light.
const DEPTH_M: f32 = 1600.0;
/// A layer of tiles serves for so many metres along the light, so that few drives leave theirs.
const LAYER_M: f32 = 2000.0;

/// A shadow map shows what is so far above or below its centre at least, as a share of its reach: walls and slopes.
const HIGH: f32 = 0.5;

/// Shadows of what moves are not looked for any farther from it, metres.
const LONGEST_SHADOW_M: f32 = 60.0;

/// How tiles of shadow maps lie in the world: what a tile shows follows from this, its number and the map alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShadowGrid {
    sun: Vec3,
    /// Of half a shadow map, level.
    reach_m: f32,
    layer: i32,
}

impl ShadowGrid {
    /// Axes to the right and up as the sun sees it; to the right is level, so that shadows of what is upright lie along columns of
    /// texels.
    fn axes(&self) -> [Vec3; 2] {
        let side = if self.sun.z.abs() > 0.95 { Vec3::X } else { Vec3::Z };
        let right = side.cross(self.sun).normalize();
        [right, self.sun.cross(right)]
    }

    /// How far a map reaches up and down as the sun sees it, metres. A low sun sees the ground foreshortened: the less of the
    /// map it takes, the finer are the texels, whose traces on the ground it stretches.
    fn rise_m(&self) -> f32 {
        let sine = self.sun.z.clamp(0.0, 1.0);
        let cosine = ops::sqrt(1.0 - sine * sine);
        (self.reach_m * (sine + HIGH * cosine)).min(self.reach_m)
    }

    /// From the world to tiles to the right and downwards, and to depth from 0, nearest to the sun, to 1.
    fn rows(&self) -> [Vec4; 3] {
        let [right, up] = self.axes();
        let per_m = 0.5 * TILES as f32;
        let level = self.layer as f32 * LAYER_M;
        [
            (right * (per_m / self.reach_m)).extend(0.0),
            (up * (-per_m / self.rise_m())).extend(0.0),
            (self.sun * (-0.5 / DEPTH_M)).extend(0.5 + level * (0.5 / DEPTH_M)),
        ]
    }

    /// The first and the last tile on which something in a box, given by two corners, may cast a shadow.
    pub(crate) fn span(&self, [low, high]: [Vec3; 2]) -> [IVec2; 2] {
        let [right, down, _] = self.rows().map(Vec4::truncate);
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let at = Vec2::new(middle.dot(right), middle.dot(down));
        let reach = Vec2::new(half.dot(right.abs()), half.dot(down.abs())) + 0.01;
        [at - reach, at + reach].map(|at| at.floor().as_ivec2())
    }

    /// From the world to the clip space of a map that shows a block of tiles, as [`block`] numbers them.
    pub(crate) fn clip(&self, block: IVec2) -> Mat4 {
        let [x, y, z] = self.rows();
        let (corner, share) = ((block * TILES).as_vec2(), 2.0 / TILES as f32);
        let x = (x - Vec4::W * corner.x) * share - Vec4::W;
        let y = Vec4::W - (y - Vec4::W * corner.y) * share;
        Mat4::from_cols(x, y, z, Vec4::W).transpose()
    }
}

/// The square of the world that a shadow map covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShadowBox {
    pub(crate) grid: ShadowGrid,
    /// The tile in its upper left corner.
    first: IVec2,
}

impl ShadowBox {
    /// A box on the ground ahead of a camera. The ego car stands on the ground, and cameras are mostly near it.
    pub(crate) fn ahead_of(eye: Vec3, ahead: Vec3, ego: Vec3, sun: Vec3, reach_m: f32) -> Self {
        let is_near = eye.truncate().distance(ego.truncate()) < reach_m;
        let eye = eye.truncate().extend(if is_near { ego.z } else { eye.z });
        let level = View::level_ahead(ahead).extend(0.0);
        Self::around(eye + level * (0.7 * reach_m), sun, reach_m)
    }

    /// The one whose middle is within half a tile of a place.
    pub(crate) fn around(centre: Vec3, sun: Vec3, reach_m: f32) -> Self {
        let layer = ops::round(centre.dot(sun) / LAYER_M) as i32;
        let grid = ShadowGrid { sun, reach_m, layer };
        let [right, down, _] = grid.rows().map(Vec4::truncate);
        let middle = Vec2::new(ops::round(centre.dot(right)), ops::round(centre.dot(down)));
        Self { grid, first: middle.as_ivec2() - TILES / 2 }
    }

    /// Its tiles.
    pub(crate) fn tiles(&self) -> impl Iterator<Item = IVec2> {
        let first = self.first;
        (0..TILES * TILES).map(move |i| first + IVec2::new(i % TILES, i / TILES))
    }

    /// Whether anything in a sphere may cast a shadow on the map.
    pub(crate) fn reaches(&self, centre: Vec3, radius_m: f32) -> bool {
        let [right, down, _] = self.grid.rows().map(Vec4::truncate);
        let middle = (self.first + TILES / 2).as_vec2();
        let off = |axis: Vec3, middle: f32| (centre.dot(axis) - middle).abs() - radius_m * axis.length();
        let half = 0.5 * TILES as f32;
        off(right, middle.x) < half && off(down, middle.y) < half
    }

    /// A sphere around what stands on the ground in another one, and its shadow.
    pub(crate) fn around_shadow(&self, centre: Vec3, radius_m: f32) -> (Vec3, f32) {
        let sun = self.grid.sun;
        let length_m = if sun.z > 0.0 { (2.0 * radius_m / sun.z).min(LONGEST_SHADOW_M) } else { 0.0 };
        (centre - sun * (0.5 * length_m), radius_m + 0.5 * length_m)
    }

    /// From the world to uv (v down) in the box, from 0 to 1, and depth.
    pub(crate) fn matrix(&self) -> Mat4 {
        let [x, y, z] = self.grid.rows();
        let (share, first) = (1.0 / TILES as f32, self.first.as_vec2());
        let [x, y] = [x - Vec4::W * first.x, y - Vec4::W * first.y].map(|row| row * share);
        Mat4::from_cols(x, y, z, Vec4::W).transpose()
    }

    /// Where its upper left corner lies in the map, on which tiles stay where they are: from there it goes on over the edges.
    pub(crate) fn corner(&self) -> Vec2 {
        slot(self.first).as_vec2() / TILES as f32
    }

    /// The block of tiles that its upper left corner lies in; it reaches into the next ones.
    pub(crate) fn first_block(&self) -> IVec2 {
        block(self.first)
    }
}

/// Where a tile lies in a map.
pub(crate) fn slot(tile: IVec2) -> IVec2 {
    tile.rem_euclid(IVec2::splat(TILES))
}

/// The number of the block of tiles, as many as a map has, in which each of them has a place of its own.
pub(crate) fn block(tile: IVec2) -> IVec2 {
    tile.div_euclid(IVec2::splat(TILES))
}

#[cfg(test)]
mod tests {
    use kernel::scene::Weather;

    use super::*;
    use crate::light::Light;

    fn sun(altitude_deg: f32) -> Vec3 {
        Light::new(&Weather::dry(0.0, 0.0, altitude_deg, 40.0)).sun
    }

    #[test]
    fn a_shadow_lies_in_the_sphere_around_it() {
        for altitude_deg in [10.0, 30.0, 75.0] {
            let sun = sun(altitude_deg);
            let shadow = ShadowBox::around(Vec3::ZERO, sun, 64.0);
            let top = Vec3::new(5.0, 2.0, 1.8);
            let (centre, radius_m) = shadow.around_shadow(top * Vec3::new(1.0, 1.0, 0.5), 1.0);
            let tip = top - sun * (top.z / sun.z);
            assert!(centre.distance(tip) < radius_m && centre.distance(top) < radius_m, "{altitude_deg}");
        }
    }

    #[test]
    fn the_ground_below_a_high_camera_has_shadows_too() {
        let ego = Vec3::new(300.0, 40.0, 12.0);
        for eye_m in [1.5, 20.0, 50.0, 300.0] {
            let shadow = ShadowBox::ahead_of(ego + Vec3::Z * eye_m, Vec3::X, ego, sun(10.0), 64.0);
            assert!(shadow.reaches(ego + Vec3::X * 40.0, 0.0) && shadow.reaches(ego, 0.0), "{eye_m} m");
        }
    }

    /// The place of the middle against the eye, level.
    fn off(ahead: Vec3) -> Vec2 {
        let sun = Vec3::Z;
        let shadow = ShadowBox::ahead_of(Vec3::ZERO, ahead, Vec3::ZERO, sun, 64.0);
        let [right, down, _] = shadow.grid.rows().map(Vec4::truncate);
        let tiles = (shadow.first + TILES / 2).as_vec2();
        (right * (tiles.x / right.length_squared()) + down * (tiles.y / down.length_squared())).truncate()
    }

    #[test]
    fn who_looks_straight_down_has_shadows_around_the_place_below() {
        let tile_m = 2.0 * 64.0 / TILES as f32;
        let lean = |rad: f32| Vec3::new(ops::sin(rad), 0.0, -ops::cos(rad));
        for rad in [-0.02, -1e-6, 0.0, 1e-6, 0.02] {
            assert!(off(lean(rad)).length() <= tile_m, "{rad}: {}", off(lean(rad)));
        }
        for rad in [-1.4f32, -0.7, 0.7, 1.4] {
            let ahead = Vec2::new(rad.signum() * 0.7 * 64.0, 0.0);
            assert!(off(lean(rad)).distance(ahead) <= tile_m, "{rad}: {}", off(lean(rad)));
        }
    }

    #[test]
    fn a_low_sun_has_finer_texels_and_loses_neither_ground_nor_walls() {
        let centre = Vec3::new(7.0, -3.0, 2.0);
        let shadow = |altitude_deg: f32| ShadowBox::around(centre, sun(altitude_deg), 64.0);
        for altitude_deg in [6.0, 15.0, 30.0, 60.0, 85.0] {
            let shadow = shadow(altitude_deg);
            for aside in [Vec3::new(0.766, 0.643, 0.0), Vec3::new(0.643, -0.766, 0.0)] {
                for (along_m, high_m) in [(-54.0, 0.0), (54.0, 0.0), (20.0, 24.0), (20.0, -14.0)] {
                    let at = centre + aside * along_m + Vec3::Z * high_m;
                    let place = shadow.matrix().project_point3(at) - 0.5;
                    assert!(place.truncate().abs().max_element() < 0.495, "{altitude_deg}, {at}: {place}");
                    assert!(shadow.reaches(at + shadow.grid.sun * 100.0, 0.0));
                }
            }
        }
        let per_m = |shadow: ShadowBox| shadow.matrix().transform_vector3(Vec3::Z).y.abs();
        assert!(per_m(shadow(8.0)) > 1.5 / 128.0, "of height");
    }

    #[test]
    fn a_map_has_its_centre_in_the_middle_and_the_sun_side_first() {
        for sun in [Vec3::new(0.0, 0.6, 0.8), Vec3::Z] {
            let centre = Vec3::new(10.0, 20.0, 0.0);
            let shadow = ShadowBox::around(centre, sun, 50.0);
            let at = |p: Vec3| shadow.matrix().project_point3(p);
            assert!((at(centre) - 0.5).truncate().abs().max_element() < 0.51 / TILES as f32);
            assert!(at(centre + sun * 10.0).z < at(centre).z && (0.1..0.9).contains(&at(centre).z));
            assert!((at(centre + sun * 10.0) - at(centre)).truncate().length() < 1e-5);
        }
    }

    #[test]
    fn a_tile_is_drawn_where_it_is_looked_up() {
        for centre in [Vec3::new(10.0, 20.0, 0.0), Vec3::new(-700.0, 333.0, 40.0)] {
            let shadow = ShadowBox::around(centre, sun(35.0), 64.0);
            for tile in shadow.tiles() {
                let there = Vec2::new(0.3, -0.2) / TILES as f32;
                let clip = shadow.grid.clip(block(tile));
                let wanted = (slot(tile).as_vec2() + 0.5) / TILES as f32 + 0.5 * there;
                let clip_place = (wanted - 0.5) * Vec2::new(2.0, -2.0);
                let world = clip.inverse().project_point3(clip_place.extend(0.5));
                let found = shadow.matrix().project_point3(world).truncate() + shadow.corner();
                assert!((found - found.floor()).distance(wanted) < 1e-3, "{tile}: {found}, {wanted}");
                assert_eq!(shadow.grid.span([world; 2])[0].clamp(tile - 1, tile), shadow.grid.span([world; 2])[0]);
            }
            let reach = shadow.first_block() + 1 - block(shadow.tiles().last().expect("64"));
            assert!(reach.cmpge(IVec2::ZERO).all());
        }
    }
}
