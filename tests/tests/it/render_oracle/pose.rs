//! From a snapshot to triangles in the world: only the meshes are the renderer's, every transform is
//! computed here from their documentation.

use glam::{DAffine3, DQuat, DVec2, DVec3, Vec3};
use kernel::map::{Prop, PropKind, RoadNetwork};
use kernel::scene::{SceneSnapshot, Weather};
use render::mesh::actor::{ego_model, has_umbrella_up, sheltered_model};
use render::mesh::gait::{Cycle, Gait, RUNS_MPS};
use render::mesh::model::{Detail, Joint, Model};
use render::mesh::motion::Motion;
use render::mesh::prop;
use render::mesh::street::{signal, surface};
use render::mesh::{Finish, Mesh};
use render::{Camera, EGO_INSTANCE, instance_of_actor, instance_of_parked};

use super::bvh::{Label, Triangle};

fn wide(v: Vec3) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

fn turn(q: glam::Quat) -> DQuat {
    DQuat::from_xyzw(f64::from(q.x), f64::from(q.y), f64::from(q.z), f64::from(q.w)).normalize()
}

fn upright(position: Vec3, heading_rad: f32) -> DAffine3 {
    DAffine3::from_rotation_translation(DQuat::from_rotation_z(f64::from(heading_rad)), wide(position))
}

/// The class a mesh's tag has in CARLA 0.9.10: riders are pedestrians, all that is driven a vehicle.
fn class_of(tag: u8) -> u8 {
    match tag {
        0..=22 => tag,
        64 => 4,
        65..=68 => 10,
        _ => panic!("{tag} is no tag"),
    }
}

/// Collects triangles under the wind of one moment.
struct Collector {
    triangles: Vec<Triangle>,
    wind: f64,
    gust_rad: f64,
}

impl Collector {
    fn new(weather: &Weather, tick: u64) -> Self {
        let gust_rad = f64::from(render::wind::SWING_RADPS) * tick as f64 / 60.0;
        Self { triangles: Vec::new(), wind: f64::from(weather.wind_pct) / 100.0, gust_rad }
    }

    fn sway(&self, at: DVec3, weight: i8) -> DVec3 {
        use render::wind::{BEND, DIRECTION, REACH_M, WAVE};
        let phase = self.gust_rad + f64::from(WAVE.x) * at.x + f64::from(WAVE.y) * at.y;
        let share = f64::from(BEND.x) + f64::from(BEND.y) * phase.sin();
        let reach = f64::from(REACH_M) * self.wind * share * f64::from(weight) / 127.0;
        DVec3::new(f64::from(DIRECTION.x), f64::from(DIRECTION.y), 0.0) * reach
    }

    fn add(&mut self, mesh: &Mesh, instance: u16, to_world: DAffine3) {
        let corner = |i: u32| {
            let v = &mesh.vertices[i as usize];
            let at = to_world.transform_point3(wide(Vec3::from_array(v.position)));
            at + self.sway(at, v.sway)
        };
        let label = |i: u32| Label { class: class_of(mesh.vertices[i as usize].tag), instance };
        let leaf = |finish: usize, t: &[u32; 3]| {
            let v = t.map(|i| mesh.vertices[i as usize]);
            let uv = v.map(|v| DVec2::new(f64::from(v.uv[0]), f64::from(v.uv[1])));
            (finish == Finish::Leafy as usize).then_some((v[0].code, uv))
        };
        let all = mesh.triangles.iter().enumerate().flat_map(|(finish, list)| list.iter().map(move |t| (finish, t)));
        let triangles: Vec<Triangle> = all
            .map(|(finish, t)| Triangle { corners: t.map(corner), label: label(t[0]), leaf: leaf(finish, t) })
            .collect();
        self.triangles.extend(triangles);
    }

    fn add_model(&mut self, model: &Model, instance: u16, to_world: DAffine3, motion: &Motion) {
        let mut frames: Vec<DAffine3> = Vec::new();
        let speed_mps = motion.speed_mps.abs();
        for part in &model.parts {
            let (axis, angle) = part.joint.map_or((DVec3::X, 0.0), |joint| turned(&joint, motion));
            let rise_m = match &part.joint {
                Some(Joint::Bob(gait)) => value(gait, motion),
                _ => 0.0,
            };
            let parent = part.parent.map_or(to_world, |i| frames[i]);
            let joint = DAffine3::from_rotation_translation(
                DQuat::from_axis_angle(axis, angle),
                wide(part.pivot) + DVec3::Z * rise_m,
            );
            let frame = parent * joint;
            frames.push(frame);
            if part.shown_mps.is_none_or(|[from, to]| from <= speed_mps && speed_mps < to) {
                self.add(&part.mesh, instance, frame);
            }
        }
    }
}

/// What a gait is at a moment.
fn value(gait: &Gait, motion: &Motion) -> f64 {
    let phase = f64::from(motion.phase_rad) * f64::from(gait.beats) + f64::from(gait.lead_rad);
    let at = |cycle: &Cycle| {
        let near = 0.5 + 0.5 * (phase - f64::from(cycle.lift_at_rad)).cos();
        f64::from(cycle.rest) + f64::from(cycle.swing) * phase.sin() + f64::from(cycle.lift) * near.powi(3)
    };
    let [from, to] = RUNS_MPS.map(f64::from);
    let speed = f64::from(motion.speed_mps).abs();
    let (walks, runs) = ((speed / f64::from(gait.walks_mps)).min(1.0), ((speed - from) / (to - from)).clamp(0.0, 1.0));
    let walking = f64::from(gait.stand) * (1.0 - walks) + at(&gait.walk) * walks;
    walking * (1.0 - runs) + at(&gait.run) * runs
}

/// Axis and angle of a joint at a moment.
fn turned(joint: &Joint, motion: &Motion) -> (DVec3, f64) {
    match joint {
        Joint::Swing(s) => {
            let full = f64::from(s.full_speed_mps);
            let share = if full > 0.0 { (f64::from(motion.speed_mps).abs() / full).min(1.0) } else { 1.0 };
            let phase = f64::from(motion.phase_rad) + f64::from(s.lead_rad);
            (wide(s.axis), f64::from(s.rest_rad) + f64::from(s.amplitude_rad) * phase.sin() * share)
        }
        Joint::Stride(gait) => (DVec3::Y, value(gait, motion)),
        Joint::Bob(_) => (DVec3::Y, 0.0),
        Joint::Steer => (DVec3::Z, f64::from(motion.steer_rad)),
        Joint::Roll { radius_m } => (DVec3::Y, f64::from(motion.rolled_m) / f64::from(*radius_m)),
    }
}

/// All triangles of a moment.
pub fn triangles(network: &RoadNetwork, scene: &SceneSnapshot) -> Vec<Triangle> {
    let mut all = Collector::new(&scene.weather, scene.tick);
    for cell in surface::cells(network).map(|cell| cell.mesh).chain([surface::plain(network)]) {
        all.add(&cell, 0, DAffine3::IDENTITY);
    }
    let mut parked = 0..;
    for object in &network.props {
        let Prop { position, heading_rad, kind, .. } = *object;
        let instance = if kind == PropKind::ParkedCar { parked.next().map_or(0, instance_of_parked) } else { 0 };
        all.add(&prop::mesh(object, Detail::Fine), instance, upright(position, heading_rad));
    }
    for head in &network.light_heads {
        let lamps = head.position + Vec3::Z * head.height_m;
        let phase = scene.lights[head.group as usize];
        all.add(&signal::head(phase, Detail::Fine), 0, upright(lamps, head.facing_rad));
    }
    for actor in &scene.actors {
        let sheltered = has_umbrella_up(actor.kind, actor.variant, scene.weather.precipitation_pct);
        let model = sheltered_model(actor.kind, actor.variant, Detail::Fine, sheltered);
        let frame = DAffine3::from_rotation_translation(turn(actor.rotation), wide(actor.position));
        all.add_model(&model, instance_of_actor(actor.id), frame, &Motion::of_actor(actor));
    }
    let ego = DAffine3::from_rotation_translation(turn(scene.ego.rotation), wide(scene.ego.position));
    let middle = DAffine3::from_translation(DVec3::X * f64::from(kernel::ego::CENTRE_M.x));
    all.add_model(ego_model(), EGO_INSTANCE, ego * middle, &Motion::of_ego(&scene.ego));
    all.triangles
}

/// Where rays start and where they go, one for each pixel, rows from above. Directions have length 1 along the view.
pub struct Rays {
    pub eye: DVec3,
    pub directions: Vec<DVec3>,
}

impl Rays {
    /// Those of the driver's camera: level, 1.2 m forward of the car's middle and 1.5 m high, 90 degrees from side to side.
    pub fn of_driver(scene: &SceneSnapshot, width: u32, height: u32) -> Self {
        let car = turn(scene.ego.rotation);
        let mount = DVec3::new(f64::from(kernel::ego::CENTRE_M.x) + 1.2, 0.0, 1.5);
        Self::new(wide(scene.ego.position) + car * mount, car, 1.0, [width, height])
    }

    /// Those of a camera that stands in the world.
    pub fn of_still(camera: &Camera) -> Self {
        let half = (0.5 * f64::from(camera.fov_x_rad)).tan();
        Self::new(wide(camera.position), turn(camera.rotation), half, [camera.width, camera.height])
    }

    /// `half` is the tangent of half the field of view from side to side.
    fn new(eye: DVec3, view: DQuat, half: f64, [width, height]: [u32; 2]) -> Self {
        let pixel = 2.0 * half / f64::from(width);
        let directions = (0..height).flat_map(|row| {
            (0..width).map(move |column| {
                let left = (0.5 * f64::from(width) - f64::from(column) - 0.5) * pixel;
                let up = (0.5 * f64::from(height) - f64::from(row) - 0.5) * pixel;
                view * DVec3::new(1.0, left, up)
            })
        });
        Self { eye, directions: directions.collect() }
    }
}
