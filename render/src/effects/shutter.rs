//! Motion blur: what moves in the picture while the shutter is open, by the ego car's motion and that of other road users.
//!
//! A snapshot holds no yaw rates. The ego car's is that of its speed and its wheels (the rear axle goes where it points);
//! others go straight on. What limbs and wheels do beside that is not blurred.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};
use kernel::ego::WHEELBASE_M;
use kernel::{SceneSnapshot, ops};

use super::tone::Light;
use crate::{Camera, EGO_INSTANCE, Frame, Mount, instance_of_actor};

/// The longest streak, as a share of the picture's width.
const LONGEST: f32 = 0.125;
/// Nothing is blurred over less than this, pixels.
const LEAST_PX: f32 = 0.5;
/// Moments of an exposure that are looked at, at most; a streak has two a pixel.
const MOST_MOMENTS: usize = 65;

/// The light of a picture of a camera whose shutter is open so long, seconds.
pub(super) fn blurred(light: Light, seen: &Frame, scene: &SceneSnapshot, (camera, shutter_s): (&Camera, f32)) -> Light {
    let Some(streaks) = Streaks::new(seen, &Motion::new(scene, camera), (camera, shutter_s)) else { return light };
    let pixels = 0..light.0.len();
    Light(pixels.map(|at| streaks.light(&light, &seen.depth_m, at)).collect())
}

/// How the camera and all others move, in the camera's axes.
struct Motion {
    camera_mps: Vec3,
    turn_radps: Vec3,
    /// By instance.
    others_mps: BTreeMap<u16, Vec3>,
    /// Whether the ego car stands still in the picture.
    ego_is_still: bool,
}

impl Motion {
    fn new(scene: &SceneSnapshot, camera: &Camera) -> Self {
        let ego = &scene.ego;
        let (eye, rotation) = camera.pose(ego);
        let into_camera = |world: Vec3| rotation.inverse() * world;
        let ego_mps = ego.rotation * Vec3::X * ego.speed_mps;
        let yaw_radps = -ego.speed_mps * ops::tan(ego.wheel_angle_rad) / WHEELBASE_M;
        let turn = ego.rotation * Vec3::Z * yaw_radps;
        let (camera_mps, turn_radps) = match camera.mount {
            Mount::Ego => (ego_mps + turn.cross(eye - ego.position), turn),
            Mount::EgoPlace => (ego_mps, Vec3::ZERO),
            Mount::World => (Vec3::ZERO, Vec3::ZERO),
        };
        let moving = scene.actors.iter().filter(|actor| actor.speed_mps != 0.0);
        let mut others_mps: BTreeMap<u16, Vec3> = moving
            .map(|actor| (instance_of_actor(actor.id), into_camera(actor.rotation * Vec3::X * actor.speed_mps)))
            .collect();
        others_mps.insert(EGO_INSTANCE, into_camera(ego_mps));
        Self {
            camera_mps: into_camera(camera_mps),
            turn_radps: into_camera(turn_radps),
            others_mps,
            ego_is_still: camera.mount == Mount::Ego,
        }
    }

    fn is_still(&self) -> bool {
        let others = self.others_mps.values().all(|mps| *mps == Vec3::ZERO);
        self.camera_mps == Vec3::ZERO && self.turn_radps == Vec3::ZERO && others
    }

    /// How fast a pixel's place moves in the picture, to the right and down, focal lengths a second. `ray` leads to it,
    /// one metre ahead.
    fn of(&self, ray: Vec3, depth_m: f32, instance: u16) -> Vec2 {
        if instance == EGO_INSTANCE && self.ego_is_still {
            return Vec2::ZERO;
        }
        let body = if instance == 0 { None } else { self.others_mps.get(&instance) };
        let past = body.copied().unwrap_or_default() - self.camera_mps;
        // Depth is infinite in the sky.
        let moved = past / depth_m - self.turn_radps.cross(ray);
        Vec2::new(ray.y * moved.x - moved.y, ray.z * moved.x - moved.z)
    }
}

/// How far each pixel's place moves while the shutter is open.
struct Streaks {
    width: usize,
    height: usize,
    /// Pixels, right and down.
    moved_px: Vec<Vec2>,
    /// The longest one in and around each tile of the picture.
    longest_px: Vec<Vec2>,
    /// Of a tile, pixels.
    tile: usize,
    tiles_x: usize,
}

impl Streaks {
    /// Those of a picture; none if nothing moves far enough to be seen.
    fn new(seen: &Frame, motion: &Motion, (camera, shutter_s): (&Camera, f32)) -> Option<Self> {
        if motion.is_still() {
            return None;
        }
        let (width, height) = (seen.width as usize, seen.height as usize);
        let pitch = 2.0 * ops::tan(0.5 * camera.fov_x_rad) / seen.width as f32;
        let (scale, limit) = (shutter_s / pitch, LONGEST * seen.width as f32);
        let aside = |at: usize, side: usize| (0.5 * side as f32 - 0.5 - at as f32) * pitch;
        let pixel = |at: usize| {
            let ray = Vec3::new(1.0, aside(at % width, width), aside(at / width, height));
            let moved = motion.of(ray, seen.depth_m[at], seen.instance_ids[at]) * scale;
            let length2 = moved.length_squared();
            if length2 > limit * limit { moved * (limit / ops::sqrt(length2)) } else { moved }
        };
        let moved_px: Vec<Vec2> = (0..width * height).map(pixel).collect();
        let longest2 = moved_px.iter().map(|moved| moved.length_squared()).fold(0.0, f32::max);
        if longest2 < LEAST_PX * LEAST_PX {
            return None;
        }
        // What moves through a pixel is not farther than half a streak.
        let tile = (0.5 * ops::sqrt(longest2)) as usize + 2;
        let tiles_x = width.div_ceil(tile);
        let mut streaks = Self { width, height, moved_px, longest_px: Vec::new(), tile, tiles_x };
        streaks.longest_px = streaks.longest();
        Some(streaks)
    }

    fn longest(&self) -> Vec<Vec2> {
        let tiles_y = self.height.div_ceil(self.tile);
        let mut own = vec![Vec2::ZERO; self.tiles_x * tiles_y];
        for (at, moved) in self.moved_px.iter().enumerate() {
            let longest = &mut own[self.tile_of(at)];
            *longest = longer(*longest, *moved);
        }
        let around = |at: usize| {
            let (x, y) = (at % self.tiles_x, at / self.tiles_x);
            let rows = y.saturating_sub(1)..(y + 2).min(tiles_y);
            let cells = rows.flat_map(|y| (x.saturating_sub(1)..(x + 2).min(self.tiles_x)).map(move |x| (x, y)));
            cells.map(|(x, y)| own[y * self.tiles_x + x]).fold(Vec2::ZERO, longer)
        };
        (0..own.len()).map(around).collect()
    }

    fn tile_of(&self, at: usize) -> usize {
        at / self.width / self.tile * self.tiles_x + at % self.width / self.tile
    }

    /// What falls on a pixel: what moves along with its place, and what is nearer and comes by with the longest streak.
    fn light(&self, light: &Light, depth_m: &[f32], at: usize) -> [f32; 3] {
        let (own, longest) = (self.moved_px[at], self.longest_px[self.tile_of(at)]);
        let comes_by = !alike(own, longest);
        let most = if comes_by { longest } else { own };
        let length = ops::sqrt(most.length_squared());
        if length < LEAST_PX {
            return light.0[at];
        }
        let moments = (2 * length as usize + 3).min(MOST_MOMENTS) as f32;
        let (mut behind, mut before, mut n_behind, mut n_before) = (Vec3::ZERO, Vec3::ZERO, 0.0, 0.0);
        for moment in 0..moments as usize {
            let time = (moment as f32 + 0.5) / moments - 0.5;
            let there = self.pixel(at, own * -time);
            let hides = depth_m[there] < depth_m[at] && !alike(self.moved_px[there], own);
            if !hides {
                behind += Vec3::from(light.0[there]);
                n_behind += 1.0;
            }
            if comes_by {
                let there = self.pixel(at, longest * -time);
                let moved = self.moved_px[there];
                if depth_m[there] < depth_m[at] && !alike(moved, own) {
                    let stays = stays(moved, longest, time);
                    before += stays * Vec3::from(light.0[there]);
                    n_before += stays;
                }
            }
        }
        let behind = if n_behind > 0.0 { behind / n_behind } else { Vec3::from(light.0[at]) };
        let moments = moments.max(n_before);
        ((behind * (moments - n_before) + before) / moments).to_array()
    }

    /// The pixel that is so far from another, within the picture.
    fn pixel(&self, at: usize, aside_px: Vec2) -> usize {
        let on = |at: usize, aside: f32, side: usize| (at as f32 + 0.5 + aside).clamp(0.0, side as f32 - 0.5) as usize;
        on(at / self.width, aside_px.y, self.height) * self.width + on(at % self.width, aside_px.x, self.width)
    }
}

/// How many moments what moves so stays at a place that the longest streak leads to from it in this time, a share of the
/// exposure: none if it goes elsewhere or does not come so far, and more than one if it is slower.
fn stays(moved: Vec2, longest: Vec2, time: f32) -> f32 {
    let (moved2, longest2, along) = (moved.length_squared(), longest.length_squared(), moved.dot(longest));
    let comes = along > 0.0 && along * along > 0.9 * moved2 * longest2 && moved2 >= 4.0 * time * time * longest2;
    if comes { ops::sqrt(longest2 / moved2) } else { 0.0 }
}

fn longer(one: Vec2, other: Vec2) -> Vec2 {
    if other.length_squared() > one.length_squared() { other } else { one }
}

/// Whether two places of a picture move as if they were of one thing.
fn alike(one: Vec2, other: Vec2) -> bool {
    let most = 0.25 * one.length_squared().max(other.length_squared());
    one.distance_squared(other) <= most + 0.25
}

#[cfg(test)]
mod tests {
    use glam::Quat;
    use kernel::Scenario;
    use kernel::scene::EgoScene;

    use super::*;

    fn scene(speed_mps: f32, wheel_angle_rad: f32) -> SceneSnapshot {
        let network = kernel::map::bundled("ring").expect("it is bundled");
        let scene = kernel::World::new(&Scenario::default_for("ring", 7), &network).expect("it fits").scene();
        let ego = EgoScene { position: Vec3::ZERO, rotation: Quat::IDENTITY, speed_mps, wheel_angle_rad, lamps: 0 };
        SceneSnapshot { ego, actors: Vec::new(), ..scene }
    }

    /// Where a point that stands still is seen after a time, focal lengths to the right and down.
    fn seen_after(scene: &SceneSnapshot, camera: &Camera, point: Vec3, time_s: f32) -> Vec2 {
        let EgoScene { speed_mps, wheel_angle_rad, .. } = scene.ego;
        let yaw_radps = -speed_mps * ops::tan(wheel_angle_rad) / WHEELBASE_M;
        let (turned, moved) = (Quat::from_rotation_z(yaw_radps * time_s), Vec3::X * speed_mps * time_s);
        let ego = EgoScene { position: moved, rotation: turned, ..scene.ego };
        let (eye, rotation) = camera.pose(&ego);
        let at = rotation.inverse() * (point - eye);
        Vec2::new(-at.y / at.x, -at.z / at.x)
    }

    #[test]
    fn pixels_move_as_the_camera_sees_what_stands_still() {
        for (speed, wheel) in [(20.0, 0.0), (8.0, 0.3), (-3.0, -0.2)] {
            let scene = scene(speed, wheel);
            for camera in [Camera::driver(64, 32), Camera::chase(64, 32), Camera::driver_row(64, 32)[0]] {
                let (eye, rotation) = camera.pose(&scene.ego);
                for ray in [Vec3::new(1.0, 0.3, -0.2), Vec3::new(1.0, -0.8, 0.4)] {
                    let (point, depth_m) = (eye + rotation * ray * 12.0, 12.0);
                    let [before, after] = [-1e-2, 1e-2].map(|time| seen_after(&scene, &camera, point, time));
                    let expected = (after - before) / 2e-2;
                    let moved = Motion::new(&scene, &camera).of(ray, depth_m, 0);
                    assert!(moved.distance(expected) < 0.02 * expected.length() + 1e-3, "{moved} {expected}");
                }
            }
        }
    }

    #[test]
    fn the_sky_turns_and_does_not_come_nearer() {
        let camera = Camera::driver(64, 32);
        let of = |wheel: f32| Motion::new(&scene(20.0, wheel), &camera).of(Vec3::X, f32::INFINITY, 0);
        assert_eq!(of(0.0), Vec2::ZERO);
        assert!(of(0.1).x < -0.5, "the car turns right, what is ahead goes left: {}", of(0.1));
    }

    #[test]
    fn the_ego_car_stands_still_in_pictures_of_its_own_cameras() {
        let (ray, scene) = (Vec3::new(1.0, 0.0, -0.5), scene(20.0, 0.1));
        assert_eq!(Motion::new(&scene, &Camera::chase(64, 32)).of(ray, 5.0, EGO_INSTANCE), Vec2::ZERO);
        let top = Motion::new(&scene, &Camera::top(64, 64, 50.0));
        assert!(top.of(ray, 5.0, EGO_INSTANCE).length() < 1e-4 && top.of(ray, 5.0, 0).length() > 1.0);
    }

    /// A car that comes to a speed and is steered to one side from there on: in each tick its yaw rate by the shutter, and by how
    /// far the kernel turned it around that tick, rad/s.
    fn yaws_radps(speed_mps: f32, steer: f32) -> Vec<(f32, f32)> {
        let network = kernel::map::bundled("motorway").expect("it is bundled");
        let mut world = kernel::World::new(&Scenario::default_for("motorway", 7), &network).expect("it fits");
        let mut scenes = Vec::new();
        for tick in 0..900 {
            let ego = world.scene().ego;
            let steer = if scenes.is_empty() && ego.speed_mps < speed_mps - 0.5 { 0.0 } else { steer };
            let throttle = (0.3 * (speed_mps - ego.speed_mps)).clamp(0.0, 1.0);
            let semantic = kernel::Controls::from_fractions(steer, throttle, 0.0);
            world.step(&kernel::TickInput { semantic, ..Default::default() });
            if steer != 0.0 && tick > 0 {
                scenes.push(world.scene());
            }
        }
        // Rotations of snapshots are on a grid of 2^-14: over a fifth of a second that is less than a thousandth of a radian.
        let yaw_radps = |scenes: &[SceneSnapshot]| {
            let turned = scenes[0].ego.rotation.inverse() * scenes[12].ego.rotation;
            2.0 * turned.z * turned.w.signum() * kernel::time::TICK_HZ as f32 / 12.0
        };
        let turn = |scene: &SceneSnapshot| Motion::new(scene, &Camera::driver(64, 32)).turn_radps.z;
        // The middle of an exposure is the tick's.
        let around = scenes.windows(13).map(|scenes| (turn(&scenes[6]), yaw_radps(scenes)));
        around.take(60).collect()
    }

    #[test]
    fn the_ego_car_turns_as_the_kernel_turns_it() {
        for (speed_mps, steer) in [(4.0, 0.3), (8.0, -0.1), (12.0, 0.05), (12.0, -0.05)] {
            let yaws = yaws_radps(speed_mps, steer);
            assert_eq!(yaws.len(), 60);
            // Tyres take a moment to turn the car; after a second it may meet the guard rail.
            for (tick, (shutter, kernel)) in yaws.into_iter().enumerate().skip(30) {
                let words = format!("{speed_mps} m/s, steered by {steer}, tick {tick}: {shutter} and {kernel}");
                assert!(kernel.abs() > 0.02 && kernel * steer < 0.0, "{words}");
                assert!((shutter - kernel).abs() < 0.15 * kernel.abs() + 0.002, "{words}");
            }
        }
    }
}
