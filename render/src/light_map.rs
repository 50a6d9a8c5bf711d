//! The light of lamps on a square of ground around the eye, as a texture.

use glam::{Quat, Vec2, Vec3};
use kernel::scene::{ActorKind, ActorScene, EgoScene, SceneSnapshot, lamps};

use crate::camera::EGO_MIDDLE_M;
use crate::light::Lamps;
use crate::street_lamps::StreetLamp;
use crate::view::View;

/// Texels along each side, and their size.
pub(crate) const SIDE: usize = 160;
const TEXEL_M: f32 = 1.0;

/// Half of the square's side.
const HALF_M: f32 = 0.5 * SIDE as f32 * TEXEL_M;

/// Most light of street lamps and of headlights that a texel tells, in that of one street lamp right below it.
const MOST: [f32; 2] = [2.0, 4.0];
/// Heights are told from so far below the ego car's to so far above, as `scene.wgsl` has it.
pub(crate) const HALF_RISE_M: f32 = 64.0;

/// A street lamp lights the ground up to this distance from the point below it, and half as much as there at the other.
const STREET_REACH_M: f32 = 24.0;
const STREET_HALF_M: f32 = 11.0;

/// How far low beams light the road, metres: those of the ego car, and of others, which are seen from the side.
const EGO_BEAM_M: f32 = 70.0;
const BEAM_M: f32 = 40.0;
/// Light of two headlights close before them.
const BEAM: f32 = 1.8;
/// A beam shows little aside of this tangent, and no more obstacles than so many, the nearest, keep it from the road.
const WIDEST: f32 = 1.5;
const MOST_HIDDEN: usize = 12;
/// What a car in a beam leaves of it on the road beyond.
const BEHIND_A_CAR: f32 = 0.25;

/// What lies on one square metre.
#[derive(Clone, Copy, Default)]
struct Lit {
    street: f32,
    head: f32,
    /// Sum of the heights of the lamps' feet by their light.
    height: f32,
}

/// The light map of a picture.
pub(crate) struct LightMap {
    /// Light of street lamps, of headlights (roots of shares of [`MOST`]), height of what they stand on.
    pub(crate) texels: Vec<[u8; 4]>,
    /// South-western corner.
    pub(crate) corner: Vec2,
    /// Height that texels' are above or below of.
    base_m: f32,
    lit: Vec<Lit>,
}

impl Default for LightMap {
    fn default() -> Self {
        let (texels, lit) = (vec![[0; 4]; SIDE * SIDE], vec![Lit::default(); SIDE * SIDE]);
        Self { texels, corner: Vec2::ZERO, base_m: 0.0, lit }
    }
}

/// The middle of the square for a view: it sees more of what lies ahead.
fn middle_of(view: &View) -> Vec2 {
    view.eye.truncate() + View::level_ahead(view.ahead) * (0.75 * HALF_M)
}

/// Two headlights.
struct Beam {
    from: Vec3,
    ahead: Vec2,
    reach_m: f32,
    strength: f32,
    /// What stands in the way: how far ahead, and tangents of the angles between which it hides what lies beyond.
    hidden: Vec<(f32, [f32; 2])>,
}

impl LightMap {
    /// Share of its side that is a metre.
    pub(crate) const PER_M: f32 = 1.0 / (SIDE as f32 * TEXEL_M);

    /// Light of street lamps and of headlights where texels tell the most of it.
    pub(crate) fn lights(&self, lamps: &Lamps) -> [Vec3; 2] {
        [lamps.street * MOST[0], lamps.head * MOST[1]]
    }

    /// Lowest height that it tells.
    pub(crate) fn lowest_m(&self) -> f32 {
        self.base_m - HALF_RISE_M
    }

    /// Makes it for what a view sees of a scene.
    pub(crate) fn light(&mut self, view: &View, scene: &SceneSnapshot, street: &[StreetLamp]) {
        let (half, middle) = (HALF_M, middle_of(view));
        self.corner = (middle / TEXEL_M).floor() * TEXEL_M - half;
        self.base_m = scene.ego.position.z;
        self.lit.fill(Lit::default());
        for lamp in street {
            self.add_street_lamp(lamp);
        }
        let reach_m = 1.5 * half + BEAM_M;
        let is_near = |actor: &&ActorScene| actor.position.truncate().distance(middle) < reach_m;
        let near: Vec<&ActorScene> = scene.actors.iter().filter(is_near).collect();
        let mut obstacles = vec![Obstacle::of_ego(&scene.ego)];
        obstacles.extend(near.iter().filter_map(|actor| Obstacle::of(actor)));
        let is_lit = |lamps: u8| lamps & lamps::HEADLIGHTS != 0;
        let of_others = near.iter().filter(|actor| is_lit(actor.lamps)).filter_map(|actor| Beam::of(actor));
        let own = is_lit(scene.ego.lamps).then(|| Beam::of_ego(&scene.ego));
        let square = [self.corner, self.corner + 2.0 * half];
        let reaches = |beam: &Beam| {
            let middle = beam.from.truncate() + beam.ahead * (0.5 * beam.reach_m);
            middle.clamp(square[0], square[1]).distance(middle) < beam.reach_m
        };
        for beam in own.into_iter().chain(of_others).filter(reaches) {
            self.add_beam(&beam.behind(&obstacles));
        }
        self.encode();
    }

    /// Adds light to the texels in a square; `light` says how much by where they are from its middle.
    fn add(&mut self, middle: Vec2, reach_m: f32, foot_m: f32, is_street: bool, light: impl Fn(Vec2) -> f32) {
        let foot_m = foot_m - self.base_m;
        let rel = (middle - self.corner) / TEXEL_M;
        // The border stays dark, so that what lies beyond is dark too.
        let range = |at: f32| {
            let limit = |edge: f32| edge.clamp(1.0, SIDE as f32 - 1.0) as usize;
            limit((at - reach_m / TEXEL_M).floor())..limit((at + reach_m / TEXEL_M).ceil())
        };
        for y in range(rel.y) {
            for x in range(rel.x) {
                let at = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                let brightness = light((at - rel) * TEXEL_M);
                let lit = &mut self.lit[y * SIDE + x];
                let sum = if is_street { &mut lit.street } else { &mut lit.head };
                *sum += brightness;
                lit.height += brightness * foot_m;
            }
        }
    }

    fn add_street_lamp(&mut self, lamp: &StreetLamp) {
        self.add(lamp.position.truncate(), STREET_REACH_M, lamp.foot_m, true, |rel| {
            let square = rel.length_squared();
            let fade = (1.0 - square / (STREET_REACH_M * STREET_REACH_M)).max(0.0);
            let near = 1.0 + square / (STREET_HALF_M * STREET_HALF_M);
            fade * fade / (near * near)
        });
    }

    fn add_beam(&mut self, beam: &Beam) {
        let half = 0.5 * beam.reach_m;
        let aside = beam.ahead.perp();
        self.add(beam.from.truncate() + beam.ahead * half, half, beam.from.z, false, |rel| {
            let (along, across) = (rel.dot(beam.ahead) + half, rel.dot(aside));
            beam.strength * beam.light(along, across)
        });
    }

    fn encode(&mut self) {
        let byte = |share: f32| (255.0 * share.clamp(0.0, 1.0) + 0.5) as u8;
        for (texel, lit) in self.texels.iter_mut().zip(&self.lit) {
            let sum = lit.street + lit.head;
            let height_m = if sum > 0.0 { lit.height / sum } else { 0.0 };
            let [street, head] = [lit.street / MOST[0], lit.head / MOST[1]].map(|share| byte(share.sqrt()));
            *texel = [street, head, byte(0.5 + 0.5 * height_m / HALF_RISE_M), 255];
        }
    }
}

impl Beam {
    /// How much it lights what lies so far ahead and aside, metres: a wide low beam.
    fn light(&self, along: f32, across: f32) -> f32 {
        if along <= 0.5 {
            return 0.0;
        }
        let aside = across / (along + 2.0);
        let beam = 1.0 + aside * aside / (0.4 * 0.4);
        let (near, far) = (((along - 0.5) / 3.0).min(1.0), (2.0 * (1.0 - along / self.reach_m)).clamp(0.0, 1.0));
        let distance = 1.0 + along * along / (16.0 * 16.0);
        let is_hidden =
            |(from_m, [low, high]): &(f32, [f32; 2])| along > *from_m && (low * along..high * along).contains(&across);
        let left = if self.hidden.iter().any(is_hidden) { BEHIND_A_CAR } else { 1.0 };
        left * near * far / (distance * beam * beam)
    }
}

/// What keeps light from the road beyond it: a car or larger.
struct Obstacle {
    position: Vec2,
    /// Half of its length and width, along where it heads.
    half: Vec2,
    heading: Vec2,
}

impl Obstacle {
    fn of_ego(ego: &EgoScene) -> Self {
        let middle = ego.position + ego.rotation * Vec3::X * EGO_MIDDLE_M;
        Self::new(middle, ego.rotation, ActorKind::Car)
    }

    fn of(actor: &ActorScene) -> Option<Self> {
        actor.kind.is_car_or_heavier().then(|| Self::new(actor.position, actor.rotation, actor.kind))
    }

    fn new(position: Vec3, rotation: Quat, kind: ActorKind) -> Self {
        let heading = (rotation * Vec3::X).truncate().normalize_or_zero();
        Self { position: position.truncate(), half: 0.5 * kind.size_m().truncate(), heading }
    }

    /// Half of how far it reaches along a direction.
    fn half_along(&self, direction: Vec2) -> f32 {
        let shares = Vec2::new(self.heading.dot(direction), self.heading.perp().dot(direction)).abs();
        shares.dot(self.half)
    }
}

impl Beam {
    fn of_ego(ego: &EgoScene) -> Self {
        let length_m = ActorKind::Car.size_m().x;
        let ahead = ego.rotation * Vec3::X;
        let from = ego.position + ahead * (EGO_MIDDLE_M + 0.5 * length_m);
        Self::new(from, ahead, EGO_BEAM_M, BEAM)
    }

    fn of(actor: &ActorScene) -> Option<Self> {
        let strength = match actor.kind {
            kind if kind.is_car_or_heavier() => BEAM,
            kind if kind.is_motorcycle() => 0.6 * BEAM,
            _ => return None,
        };
        let ahead = actor.rotation * Vec3::X;
        let from = actor.position + ahead * (0.5 * actor.kind.size_m().x);
        Some(Self::new(from, ahead, BEAM_M, strength))
    }

    fn new(from: Vec3, ahead: Vec3, reach_m: f32, strength: f32) -> Self {
        Self { from, ahead: ahead.truncate().normalize_or_zero(), reach_m, strength, hidden: Vec::new() }
    }

    /// The same behind what stands in its way.
    fn behind(mut self, obstacles: &[Obstacle]) -> Self {
        let hides = |obstacle: &Obstacle| {
            let rel = obstacle.position - self.from.truncate();
            let aside = self.ahead.perp();
            let (along, across) = (rel.dot(self.ahead), rel.dot(aside));
            let half = obstacle.half_along(aside);
            let edges = [across - half, across + half].map(|edge| edge / along);
            let is_ahead = along > obstacle.half_along(self.ahead) && along < self.reach_m;
            (is_ahead && edges[0] < WIDEST && edges[1] > -WIDEST).then_some((along, edges))
        };
        self.hidden = obstacles.iter().filter_map(hides).collect();
        self.hidden.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.hidden.truncate(MOST_HIDDEN);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Camera;

    fn beam(hidden: Vec<(f32, [f32; 2])>) -> Beam {
        Beam { from: Vec3::ZERO, ahead: Vec2::X, reach_m: 60.0, strength: 1.0, hidden }
    }

    #[test]
    fn the_map_lies_ahead_and_below_who_looks_straight_down() {
        let ego =
            EgoScene { position: Vec3::ZERO, rotation: Quat::IDENTITY, speed_mps: 0.0, wheel_angle_rad: 0.0, lamps: 0 };
        let middle = |pitch_rad: f32| {
            let rotation = Quat::from_rotation_y(pitch_rad);
            middle_of(&View::new(&Camera { position: Vec3::ZERO, rotation, ..Camera::chase(64, 64) }, &ego))
        };
        for off_rad in [-0.01, -1e-6, 0.0, 1e-6, 0.01] {
            let at = middle(core::f32::consts::FRAC_PI_2 + off_rad);
            assert!(at.length() < 2.0, "{off_rad}: {at}");
        }
        assert!(middle(0.16).distance(Vec2::X * 60.0) < 1e-3 && middle(-1.0).distance(Vec2::X * 60.0) < 1e-3);
    }

    #[test]
    fn a_beam_lights_what_is_ahead_and_fades() {
        let free = beam(Vec::new());
        assert_eq!(free.light(-1.0, 0.0), 0.0);
        let along: Vec<f32> = [5.0, 10.0, 25.0, 50.0, 60.0].map(|m| free.light(m, 0.0)).to_vec();
        assert!(along.is_sorted_by(|a, b| a > b) && along[4] == 0.0, "{along:?}");
        assert!(free.light(10.0, 8.0) < 0.3 * free.light(10.0, 0.0));
        let behind = beam(vec![(12.0, [-0.1, 0.1])]);
        assert_eq!(behind.light(10.0, 0.0), free.light(10.0, 0.0));
        assert_eq!(behind.light(20.0, 0.5), BEHIND_A_CAR * free.light(20.0, 0.5));
        assert_eq!(behind.light(20.0, 3.0), free.light(20.0, 3.0));
    }

    #[test]
    fn a_bus_across_the_road_shades_all_of_it_and_one_beside_none() {
        let bus = |at: Vec2, turn_rad: f32| {
            let rotation = Quat::from_rotation_z(turn_rad);
            beam(Vec::new()).behind(&[Obstacle::new(at.extend(0.0), rotation, ActorKind::Bus)])
        };
        let ahead = Vec2::new(15.0, 0.0);
        let free = beam(Vec::new()).light(30.0, 7.0);
        assert_eq!(bus(ahead, 0.0).light(30.0, 7.0), free);
        assert_eq!(bus(ahead, core::f32::consts::FRAC_PI_2).light(30.0, 7.0), BEHIND_A_CAR * free);
        assert!(bus(Vec2::new(10.0, 40.0), 0.0).hidden.is_empty());
    }

    #[test]
    fn the_map_tells_light_and_height_and_ends_in_the_dark() {
        let mut map = LightMap::default();
        for x in [0.0, 80.5] {
            map.add_street_lamp(&StreetLamp { position: Vec3::new(x, 80.5, 12.0), foot_m: 5.0 });
        }
        map.encode();
        let texel = |x: usize, y: usize| map.texels[y * SIDE + x];
        let below = texel(80, 80);
        assert_eq!(below[0], (255.0 * (1.0 / MOST[0]).sqrt() + 0.5) as u8);
        assert!((f32::from(below[2]) / 255.0 - (0.5 + 2.5 / HALF_RISE_M)).abs() < 0.003);
        assert!(texel(95, 80)[0] < below[0] / 2 && below[1] == 0);
        assert!(texel(1, 80)[0] > 150 && texel(0, 80)[0] == 0, "the border is dark");
    }
}
