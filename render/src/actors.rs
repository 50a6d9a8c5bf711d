//! The moving world: actors, the ego car and signal heads, posed and merged for one frame.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use glam::{Affine3A, Mat3A, Vec3, Vec3A};
use kernel::map::LightHead;
use kernel::scene::{ActorKind, ActorScene, EgoScene, SceneSnapshot, Weather, lamps};
use kernel::signals::LightPhase;
use kernel::time::{TICK_HZ, Tick};

use crate::camera::EGO_MIDDLE_M;
use crate::glows::{self, Glow};
use crate::horizon::Horizon;
use crate::instance_ids::{EGO_INSTANCE, instance_of_actor, parked_number};
use crate::mesh::actor::{EGO_VARIANT, ego_model, has_umbrella_up, parked_model, sheltered_model};
use crate::mesh::model::{Detail, Model};
use crate::mesh::motion::Motion;
use crate::mesh::street::signal;
use crate::mesh::{CODE_BRAKE, CODE_CENTRE_BRAKE, CODE_HEAD, CODE_LEFT, CODE_LIT, CODE_RIGHT, Finish, Mesh, Vertex};
use crate::models::Models;
use crate::shadow_box::ShadowBox;
use crate::view::View;

/// Actors smaller than this many pixels are left out.
const SMALLEST_PX: f32 = 1.2;

/// Who comes this close to the eye is not drawn, metres: it would fill the picture.
const EYE_ROOM_M: f32 = 0.5;

/// Indicators flash 1.5 times a second (UN regulation 48: 60 to 120 times a minute).
const FLASH_TICKS: Tick = TICK_HZ as Tick * 2 / 3;
const AMBER: [u8; 3] = [255, 158, 32];

/// Beside the bits of [`lamps`]: tail lamps, which are the brake lamps and burn with the headlights where it is dark.
const TAIL: u8 = 0x80;
const TAIL_RED: [u8; 3] = [128, 18, 15];

/// Whoever is smaller than this many pixels casts no shadow.
const SMALLEST_CASTER_PX: f32 = 4.0;

/// All that moves, as one mesh.
#[derive(Clone, Debug, Default)]
pub(crate) struct Moving {
    pub(crate) vertices: Vec<Vertex>,
    /// Triangles that are seen.
    pub(crate) indices: Vec<u32>,
    /// What casts shadows into the picture, seen or not.
    pub(crate) casters: Vec<Caster>,
    /// How much lamps glow: not at all by day, 1 at night.
    pub(crate) shine: f32,
    /// Glows of lamps that are seen.
    pub(crate) glows: Vec<Glow>,
    eye: Vec3,
}

/// A mesh that casts a shadow: its vertices and its triangles.
#[derive(Clone, Debug)]
pub(crate) struct Caster {
    pub(crate) vertices: Range<u32>,
    pub(crate) indices: Vec<u32>,
}

/// What something that moves is in a picture.
#[derive(Clone, Copy)]
struct Role {
    is_seen: bool,
    casts: bool,
}

/// Models that are kept at most: people have tens of thousands of looks.
const MOST_MODELS: usize = 2000;

/// Vertices of a user's models that are kept at most: each colour has its own, 32 bytes each.
const MOST_OWN_VERTICES: usize = 4_000_000;

/// The models that have been needed so far.
#[derive(Default)]
pub(crate) struct Cast {
    /// The looks of parked cars by number, which they keep when they are pushed.
    parked_looks: Vec<u32>,
    /// By kind, variant, level of detail, and whether it is under an umbrella.
    models: BTreeMap<(ActorKind, u32, Detail, bool), Model>,
    /// Those without anybody in them.
    parked_models: BTreeMap<(ActorKind, u32, Detail), Model>,
    heads: BTreeMap<(LightPhase, Detail), Mesh>,
    /// The ego car, where it is not the renderer's own.
    ego: Option<Model>,
    /// A user's own.
    own: Option<Arc<Models>>,
}

impl Cast {
    /// With the looks of the map's parked cars.
    pub(crate) fn new(parked_looks: Vec<u32>) -> Self {
        Self { parked_looks, ..Self::default() }
    }

    /// Takes models of a user's own, or none.
    pub(crate) fn dress(&mut self, own: Option<Arc<Models>>) {
        let ego = own.as_ref().and_then(|models| models.ego(EGO_VARIANT));
        *self = Self { own, ego, ..Self::new(core::mem::take(&mut self.parked_looks)) };
    }

    /// Poses what a view sees, nearest first, and what casts a shadow into it, if one may be cast.
    pub(crate) fn pose(
        &mut self,
        scene: &SceneSnapshot,
        heads: &[LightHead],
        (view, mut horizon): (&View, Horizon),
        shadow: Option<&ShadowBox>,
        moving: &mut Moving,
    ) {
        moving.vertices.clear();
        moving.indices.clear();
        moving.casters.clear();
        moving.glows.clear();
        moving.eye = view.eye;
        if self.models.len() > MOST_MODELS || self.own_vertices() > MOST_OWN_VERTICES {
            self.models.clear();
            self.parked_models.clear();
        }
        self.pose_ego(&scene.ego, scene.tick, (view, shadow), moving);
        let around = |actor: &ActorScene| {
            let (centre, radius) = sphere(actor);
            shadow.map_or((centre, radius), |shadow| shadow.around_shadow(centre, radius))
        };
        let near = |actor: &ActorScene| {
            let (centre, radius) = around(actor);
            centre.truncate().distance(view.eye.truncate()) - radius
        };
        let mut all: Vec<(f32, &ActorScene)> = scene.actors.iter().map(|a| (near(a), a)).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, actor) in all {
            let (centre, radius) = around(actor);
            if view.sees(centre, radius) && !horizon.hides(centre, radius) {
                self.pose_actor(actor, (scene.tick, &scene.weather), (view, shadow), moving);
            }
        }
        for head in heads {
            self.pose_head(head, scene.lights[head.group as usize], (view, shadow), moving);
        }
    }

    /// Vertices that are kept of a user's models.
    fn own_vertices(&self) -> usize {
        if self.own.is_none() {
            return 0;
        }
        self.models.values().chain(self.parked_models.values()).map(Model::vertices).sum()
    }

    fn pose_ego(
        &mut self,
        ego: &EgoScene,
        tick: Tick,
        (view, shadow): (&View, Option<&ShadowBox>),
        moving: &mut Moving,
    ) {
        let frame =
            Affine3A::from_rotation_translation(ego.rotation, ego.position + ego.rotation * Vec3::X * EGO_MIDDLE_M);
        let size = ActorKind::Car.size_m();
        let role = Role { is_seen: view.sees(frame.translation.into(), size.length()), casts: shadow.is_some() };
        let model = self.ego.as_ref().unwrap_or_else(|| ego_model());
        moving.append(model, frame, &Motion::of_ego(ego), (EGO_INSTANCE, flashing(ego.lamps, tick)), role);
    }

    fn pose_actor(
        &mut self,
        actor: &ActorScene,
        (tick, weather): (Tick, &Weather),
        (view, shadow): (&View, Option<&ShadowBox>),
        moving: &mut Moving,
    ) {
        let (centre, radius) = sphere(actor);
        let pixels = view.pixels(2.0 * radius, centre, radius);
        let role = Role {
            is_seen: pixels >= SMALLEST_PX && view.sees(centre, radius) && !is_around(actor, view.eye),
            casts: pixels >= SMALLEST_CASTER_PX && shadow.is_some_and(|shadow| shadow.reaches(centre, radius)),
        };
        if !(role.is_seen || role.casts) {
            return;
        }
        let detail = view.detail(centre, radius);
        let detail = if role.is_seen { detail } else { detail.max(Detail::Coarse) };
        let parked = parked_number(actor.id).and_then(|number| self.parked_looks.get(number));
        let variant = parked.copied().unwrap_or(actor.variant);
        let sheltered = has_umbrella_up(actor.kind, variant, weather.precipitation_pct);
        let model = if parked.is_some() {
            let make = || made(self.own.as_deref(), (actor.kind, variant, detail), parked_model);
            self.parked_models.entry((actor.kind, variant, detail)).or_insert_with(make)
        } else {
            let sheltered_model = |kind, variant, detail| sheltered_model(kind, variant, detail, sheltered);
            let make = || made(self.own.as_deref(), (actor.kind, variant, detail), sheltered_model);
            self.models.entry((actor.kind, variant, detail, sheltered)).or_insert_with(make)
        };
        let frame = Affine3A::from_rotation_translation(actor.rotation, actor.position);
        let painted = (instance_of_actor(actor.id), flashing(actor.lamps, tick));
        moving.append(model, frame, &Motion::of_actor(actor), painted, role);
    }

    fn pose_head(
        &mut self,
        head: &LightHead,
        phase: LightPhase,
        (view, shadow): (&View, Option<&ShadowBox>),
        moving: &mut Moving,
    ) {
        let centre = head.position + Vec3::Z * head.height_m;
        if view.pixels(1.0, centre, 0.0) < SMALLEST_PX {
            return;
        }
        let role =
            Role { is_seen: view.sees(centre, 1.0), casts: shadow.is_some_and(|shadow| casts(head, view, shadow)) };
        if !(role.is_seen || role.casts) {
            return;
        }
        let detail = view.detail(centre, 1.0);
        let detail = if role.is_seen { detail } else { detail.max(Detail::Coarse) };
        let mesh = self.heads.entry((phase, detail)).or_insert_with(|| signal::head(phase, detail));
        let frame = Affine3A::from_rotation_translation(glam::Quat::from_rotation_z(head.facing_rad), centre);
        moving.append_mesh(mesh, frame, (0, 0), role);
    }
}

/// The model of a road user: a user's own, or else what is made in code.
fn made(
    own: Option<&Models>,
    (kind, variant, detail): (ActorKind, u32, Detail),
    make: impl Fn(ActorKind, u32, Detail) -> Model,
) -> Model {
    let make = || make(kind, variant, detail);
    own.and_then(|models| models.actor(kind, variant, detail, make)).unwrap_or_else(make)
}

/// A sphere around an actor; limbs and handlebars may reach beyond its box.
fn sphere(actor: &ActorScene) -> (Vec3, f32) {
    let size = actor.kind.size_m();
    (actor.position + Vec3::Z * 0.5 * size.z, 0.5 * size.length() + 0.4)
}

/// Whether a signal head casts a shadow that a view may see.
fn casts(head: &LightHead, view: &View, shadow: &ShadowBox) -> bool {
    // What stands on the ground is as high as a sphere around it.
    let half = 0.5 * head.height_m;
    let (centre, radius) = shadow.around_shadow(head.position + Vec3::Z * half, half + 1.0);
    view.sees(centre, radius) && shadow.reaches(head.position + Vec3::Z * head.height_m, 1.0)
}

/// Whether an eye looks out of an actor, or from right above its roof: a chase camera does, when somebody follows closely.
fn is_around(actor: &ActorScene, eye: Vec3) -> bool {
    let half = 0.5 * actor.kind.size_m();
    let local = actor.rotation.inverse() * (eye - actor.position) - Vec3::Z * half.z;
    (local.abs() - half).max_element() < EYE_ROOM_M
}

impl Moving {
    /// Appends a model; `painted` are its instance and the lamps that shine.
    fn append(&mut self, model: &Model, frame: Affine3A, motion: &Motion, painted: (u16, u8), role: Role) {
        for (mesh, pose) in model.posed(motion) {
            self.append_mesh(mesh, frame * pose, painted, role);
        }
    }

    fn append_mesh(&mut self, mesh: &Mesh, frame: Affine3A, (instance, lamps): (u16, u8), role: Role) {
        let first = self.vertices.len() as u32;
        let is_lit_behind = self.shine > 0.0 && lamps & lamps::HEADLIGHTS != 0;
        let lamps = if is_lit_behind { lamps | TAIL } else { lamps & !TAIL };
        self.vertices.extend(mesh.vertices.iter().map(|v| posed(v, &frame, instance, lamps)));
        if self.shine > 0.0 && role.is_seen {
            glows::of_lamps(&self.vertices[first as usize..], self.eye, self.shine, &mut self.glows);
        }
        let plain = || mesh.triangles[Finish::Plain as usize].iter().flatten().map(|i| i + first);
        if role.is_seen {
            self.indices.extend(plain());
        }
        if role.casts {
            self.casters.push(Caster { vertices: first..self.vertices.len() as u32, indices: plain().collect() });
        }
    }
}

/// The lamps that shine at a tick: indicators flash.
fn flashing(lamps: u8, tick: Tick) -> u8 {
    if tick % FLASH_TICKS < FLASH_TICKS / 2 { lamps } else { lamps & !(lamps::LEFT | lamps::RIGHT) }
}

fn posed(v: &Vertex, frame: &Affine3A, instance: u16, lamps: u8) -> Vertex {
    let position = frame.transform_point3a(Vec3A::from_array(v.position)).to_array();
    let turn: Mat3A = frame.matrix3;
    let n = (turn * Vec3A::from_array(v.normal.map(f32::from))).round();
    let (code, colour) = match v.code {
        CODE_HEAD if lamps & lamps::HEADLIGHTS != 0 => (CODE_LIT, [255, 250, 230]),
        CODE_BRAKE | CODE_CENTRE_BRAKE if lamps & lamps::BRAKE != 0 => (CODE_LIT, [255, 44, 36]),
        CODE_BRAKE if lamps & TAIL != 0 => (CODE_LIT, TAIL_RED),
        CODE_LEFT if lamps & lamps::LEFT != 0 => (CODE_LIT, AMBER),
        CODE_RIGHT if lamps & lamps::RIGHT != 0 => (CODE_LIT, AMBER),
        code => (code, v.colour),
    };
    Vertex { position, normal: [n.x as i8, n.y as i8, n.z as i8], instance, code, colour, ..*v }
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;
    use crate::light::Light;
    use crate::mesh::{CODE_HEAD, Paint};
    use crate::models::{Figure, Subject};
    use crate::{Camera, SemanticTag};

    /// What is drawn of the ego car and others, seen from behind and above.
    fn drawn(lamps: u8, tick: Tick, actors: Vec<ActorScene>) -> Vec<Vertex> {
        let ego =
            EgoScene { position: Vec3::ZERO, rotation: Quat::IDENTITY, speed_mps: 0.0, wheel_angle_rad: 0.0, lamps };
        let weather = Weather::dry(0.0, 0.0, 45.0, 0.0);
        let scene = SceneSnapshot { tick, ego, actors, lights: Vec::new(), weather };
        let view = View::new(&Camera::chase(320, 200), &scene.ego);
        let mut moving = Moving::default();
        Cast::default().pose(&scene, &[], (&view, Horizon::new(view.eye, &[], 100.0)), None, &mut moving);
        moving.vertices
    }

    /// Colours of lamps that shine.
    fn lit(vertices: &[Vertex]) -> Vec<[u8; 3]> {
        let mut lit: Vec<_> = vertices.iter().filter(|v| v.code == CODE_LIT).map(|v| v.colour).collect();
        lit.sort_unstable();
        lit.dedup();
        lit
    }

    fn actor(kind: ActorKind, x: f32, lamps: u8) -> ActorScene {
        let (position, rotation) = (Vec3::X * x, Quat::IDENTITY);
        ActorScene { id: 1, kind, variant: 4, position, rotation, speed_mps: 0.0, phase_rad: 0.0, lamps }
    }

    /// Colours of the lamps of the ego car that shine at a tick.
    fn shining(lamps: u8, tick: Tick) -> Vec<[u8; 3]> {
        let vertices = drawn(lamps, tick, Vec::new());
        assert!(vertices.iter().any(|v| v.code == CODE_HEAD || v.code == CODE_LIT), "the car is there");
        lit(&vertices)
    }

    #[test]
    fn all_lamps_of_every_motor_vehicle_shine() {
        let all = lamps::HEADLIGHTS | lamps::BRAKE | lamps::LEFT | lamps::RIGHT;
        for &kind in ActorKind::ALL {
            let lit = lit(&drawn(0, 0, vec![actor(kind, 20.0, all)]));
            let has_lamps = kind.is_car_or_heavier() || kind.is_motorcycle();
            assert_eq!(lit.len(), if has_lamps { 3 } else { 0 }, "{kind:?}: {lit:?}");
        }
    }

    #[test]
    fn who_stands_at_the_eye_is_not_drawn() {
        let is_drawn = |x: f32| drawn(0, 0, vec![actor(ActorKind::Truck, x, 0)]).iter().any(|v| v.instance == 1);
        assert!(!is_drawn(-6.0), "the eye is above its roof");
        assert!(is_drawn(20.0) && is_drawn(-1.0));
    }

    #[test]
    fn the_lamps_of_the_ego_car_shine_and_its_indicators_flash() {
        let (red, white) = ([255, 44, 36], [255, 250, 230]);
        let off = FLASH_TICKS / 2;
        assert_eq!(shining(0, 0), Vec::<[u8; 3]>::new());
        assert_eq!(shining(lamps::BRAKE, off), [red]);
        for side in [lamps::LEFT, lamps::RIGHT, lamps::LEFT | lamps::RIGHT] {
            assert_eq!((shining(side, 0), shining(side, off)), (vec![AMBER], Vec::new()));
        }
        assert_eq!(shining(lamps::HEADLIGHTS | lamps::LEFT, off), [white], "head lamps do not flash");
        assert_eq!(shining(lamps::HEADLIGHTS | lamps::BRAKE | lamps::LEFT, 0), [red, AMBER, white]);
    }

    #[test]
    fn tail_lamps_burn_in_the_dark_and_glow() {
        let ego = EgoScene {
            position: Vec3::ZERO,
            rotation: Quat::IDENTITY,
            speed_mps: 0.0,
            wheel_angle_rad: 0.0,
            lamps: lamps::HEADLIGHTS,
        };
        let weather = Weather::dry(0.0, 0.0, -20.0, 0.0);
        let scene = SceneSnapshot { tick: 0, ego, actors: Vec::new(), lights: Vec::new(), weather };
        let view = View::new(&Camera::chase(320, 200), &scene.ego);
        let mut moving = Moving { shine: 1.0, ..Default::default() };
        Cast::default().pose(&scene, &[], (&view, Horizon::new(view.eye, &[], 100.0)), None, &mut moving);
        assert_eq!(lit(&moving.vertices), [TAIL_RED, [255, 250, 230]]);
        let is_tail = |glow: &Glow| {
            let [x, y, _] = glow.position;
            glow.colour[0] > 5.0 * glow.colour[2] && x < 0.0 && y.abs() > 0.4
        };
        assert!(moving.glows.len() >= 2 && moving.glows.iter().all(is_tail), "{:?}", moving.glows);
    }

    /// A model of a box, with or without lamps of its own, under the renderer's rider.
    #[test]
    fn lamps_that_are_not_drawn_do_not_glow() {
        let ego =
            EgoScene { position: Vec3::ZERO, rotation: Quat::IDENTITY, speed_mps: 0.0, wheel_angle_rad: 0.0, lamps: 0 };
        let actors = vec![actor(ActorKind::Motorcycle, 14.0, lamps::HEADLIGHTS | lamps::BRAKE)];
        let weather = Weather::dry(0.0, 0.0, -20.0, 0.0);
        let scene = SceneSnapshot { tick: 0, ego, actors, lights: Vec::new(), weather };
        let view = View::new(&Camera::chase(320, 200), &scene.ego);
        let glows = |code: Option<u8>| {
            let own = code.map(|code| {
                let (subject, mut mesh) = (Subject::Actor(ActorKind::Motorcycle), Mesh::default());
                let paint = Paint::plain(subject.tag(), [90; 3]).coded(code);
                mesh.cuboid(paint, Vec3::ZERO, Vec3::new(2.2, 0.6, 1.1));
                let figure = Figure::new(subject, Model::rigid(mesh)).expect("it fits");
                Arc::new(Models::new([1; 16].into(), BTreeMap::from([(subject, vec![figure])])))
            });
            let (mut cast, mut moving) = (Cast::default(), Moving { shine: 1.0, ..Default::default() });
            cast.dress(own);
            cast.pose(&scene, &[], (&view, Horizon::new(view.eye, &[], 100.0)), None, &mut moving);
            assert!(moving.vertices.iter().any(|v| v.tag == SemanticTag::Rider as u8));
            moving.glows.len()
        };
        assert!(glows(None) > 0 && glows(Some(CODE_BRAKE)) > 0);
        assert_eq!(glows(Some(0)), 0);
    }

    /// A head beside and one before the camera, and what casts shadows of them.
    #[test]
    fn signals_cast_shadows_into_the_picture_from_beside_it() {
        let ego =
            EgoScene { position: Vec3::ZERO, rotation: Quat::IDENTITY, speed_mps: 0.0, wheel_angle_rad: 0.0, lamps: 0 };
        let weather = Weather::dry(0.0, 0.0, 25.0, 90.0);
        let lights = vec![LightPhase::Red];
        let scene = SceneSnapshot { tick: 0, ego, actors: Vec::new(), lights, weather };
        let view = View::new(&Camera::driver(256, 128), &scene.ego);
        let sun = Light::new(&scene.weather).sun;
        let shadow = ShadowBox::ahead_of(view.eye, view.ahead, Vec3::ZERO, sun, 64.0);
        // How many are drawn, and how many cast a shadow, but for the ego car.
        let counts = |x: f32, y: f32, shadow: Option<&ShadowBox>| {
            let head = LightHead { group: 0, position: Vec3::new(x, y, 0.0), facing_rad: 3.0, height_m: 4.0 };
            let mut moving = Moving::default();
            let horizon = Horizon::new(view.eye, &[], 100.0);
            Cast::default().pose(&scene, &[head], (&view, horizon), shadow, &mut moving);
            let casters =
                moving.casters.iter().filter(|it| moving.vertices[it.vertices.start as usize].instance != EGO_INSTANCE);
            let is_drawn = moving.indices.iter().any(|i| moving.vertices[*i as usize].instance != EGO_INSTANCE);
            (usize::from(is_drawn), casters.count())
        };
        // The sun stands on the left.
        assert_eq!(counts(12.0, 0.0, Some(&shadow)), (1, 1));
        assert_eq!(counts(8.0, 13.0, Some(&shadow)), (0, 1), "its shadow falls before the camera");
        assert_eq!(counts(8.0, -18.0, Some(&shadow)), (0, 0), "its shadow falls farther aside");
        assert_eq!((counts(12.0, 0.0, None), counts(8.0, 13.0, None)), ((1, 0), (0, 0)));
    }

    #[test]
    fn all_of_a_car_is_one_instance() {
        let vertices = drawn(0, 0, vec![actor(ActorKind::Car, 12.0, 0)]);
        let of = |instance: u16| vertices.iter().filter(|v| v.instance == instance).count();
        assert!(of(1) > 0 && of(EGO_INSTANCE) > 0 && of(1) + of(EGO_INSTANCE) == vertices.len());
    }
}
