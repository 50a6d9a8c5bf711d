//! Spray that vehicles throw up behind them in rain, as soft discs that face the eye. They cover colours and write neither
//! class nor depth.

use bytemuck::{Pod, Zeroable};
use glam::{Quat, Vec3};
use kernel::SceneSnapshot;
use kernel::scene::ActorKind;
use kernel::weather::Water;

use crate::camera::EGO_MIDDLE_M;
use crate::light::smooth;
use crate::view::View;

/// One disc of spray, as `spray.wgsl` reads it.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Puff {
    pub(crate) position: [f32; 3],
    pub(crate) radius_m: f32,
    /// How much of what is behind it it covers in its middle, 0 to 1.
    pub(crate) cover: f32,
}

/// Tyres throw up no spray below a film of so much water, mm, and all that they do from the other on; the same of speeds, m/s.
const FILM_MM: [f32; 2] = [0.45, 0.85];
const SPEED_MPS: [f32; 2] = [9.0, 27.0];
/// Cover of the densest puff behind a car, and behind what is heavier.
const COVER: f32 = 0.34;
const HEAVY_COVER: f32 = 0.5;
/// Behind the rear bumper, as shares of how far the cloud reaches, with shares of the cover.
const PUFFS: [(f32, f32); 4] = [(0.02, 1.0), (0.2, 0.85), (0.5, 0.6), (0.95, 0.35)];
/// How far a cloud reaches in a second's way of its vehicle.
const REACH_S: f32 = 0.42;
/// Discs are so much wider than high, as in `spray.wgsl`.
pub(crate) const WIDE: f32 = 1.3;
/// Spray farther away is not drawn, metres.
const FAR_M: f32 = 140.0;

/// The spray that a view sees, the farthest first.
pub(crate) fn of(scene: &SceneSnapshot, view: &View, puffs: &mut Vec<Puff>) {
    puffs.clear();
    let water = Water::of(&scene.weather);
    let wet = smooth(FILM_MM[0], FILM_MM[1], water.film_mm);
    if wet == 0.0 || scene.weather.precipitation_pct == 0.0 {
        return;
    }
    let ego = &scene.ego;
    let middle = ego.position + ego.rotation * Vec3::X * EGO_MIDDLE_M;
    let vehicles = scene.actors.iter().filter(|actor| actor.kind.is_car_or_heavier());
    let vehicles = vehicles.map(|actor| (actor.position, actor.rotation, actor.kind, actor.speed_mps));
    for (position, rotation, kind, speed_mps) in vehicles.chain([(middle, ego.rotation, ActorKind::Car, ego.speed_mps)])
    {
        let share = wet * smooth(SPEED_MPS[0], SPEED_MPS[1], speed_mps);
        if share > 0.0 && position.distance(view.eye) < FAR_M {
            puffs.extend(
                behind(position, rotation, kind, speed_mps).map(|puff| Puff { cover: share * puff.cover, ..puff }),
            );
        }
    }
    puffs.retain(|puff| view.sees(puff.position.into(), WIDE * puff.radius_m));
    let far_m = |puff: &Puff| Vec3::from(puff.position).distance(view.eye);
    puffs.sort_by(|a, b| far_m(b).total_cmp(&far_m(a)));
}

/// The cloud behind a vehicle as dense as it gets.
fn behind(position: Vec3, rotation: Quat, kind: ActorKind, speed_mps: f32) -> impl Iterator<Item = Puff> {
    let size = kind.size_m();
    let cover = if kind == ActorKind::Car { COVER } else { HEAVY_COVER };
    let start_m = 0.5 * size.x;
    PUFFS.into_iter().map(move |(along, share)| {
        let radius_m = 0.42 * size.y * (1.0 + 0.8 * along);
        let back = rotation * Vec3::new(-start_m - along * REACH_S * speed_mps, 0.0, 0.0);
        let position = (position + back + Vec3::Z * (0.75 * radius_m)).to_array();
        Puff { position, radius_m, cover: cover * share }
    })
}

#[cfg(test)]
mod tests {
    use kernel::scene::{ActorScene, EgoScene, Weather};

    use super::*;
    use crate::Camera;

    fn puffs(precipitation_pct: f32, speed_mps: f32) -> Vec<Puff> {
        let ego =
            EgoScene { position: Vec3::ZERO, rotation: Quat::IDENTITY, speed_mps, wheel_angle_rad: 0.0, lamps: 0 };
        let (kind, position, rotation) = (ActorKind::Car, Vec3::X * 30.0, Quat::IDENTITY);
        let car = ActorScene { id: 1, kind, variant: 4, position, rotation, speed_mps, phase_rad: 0.0, lamps: 0 };
        let weather = Weather { precipitation_pct, ..Weather::dry(90.0, 0.0, 40.0, 0.0) };
        let scene = SceneSnapshot { tick: 0, ego, actors: vec![car], lights: Vec::new(), weather };
        let mut puffs = Vec::new();
        of(&scene, &View::new(&Camera::driver(256, 128), &scene.ego), &mut puffs);
        puffs
    }

    #[test]
    fn who_is_fast_in_rain_throws_up_spray_behind() {
        assert!(puffs(0.0, 30.0).is_empty() && puffs(80.0, 6.0).is_empty());
        let [fast, slow] = [30.0, 15.0].map(|mps| puffs(80.0, mps));
        assert!(fast.len() > 2 && fast.iter().all(|puff| puff.position[0] < 30.0 - 0.4 * ActorKind::Car.size_m().x));
        assert!(fast.is_sorted_by(|a, b| a.position[0] >= b.position[0]), "the farthest first");
        let most = |puffs: &[Puff]| puffs.iter().map(|puff| puff.cover).fold(0.0, f32::max);
        assert!(most(&slow) > 0.0 && most(&slow) < most(&fast) && most(&fast) < 0.5);
    }
}
