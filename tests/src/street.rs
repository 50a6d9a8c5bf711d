//! A straight street of 240 m made by hand, with one of everything that can be seen.

use glam::{Quat, Vec2, Vec3};
use kernel::map::{
    FurnitureKind, Junction, LightGroup, LightHead, MapData, Prop, PropKind, RoadNetwork, SIGN_LIMIT, SIGN_STOP,
    SIGN_YIELD, Surface, SurfaceKind,
};
use kernel::scene::{ActorKind, ActorScene, EgoScene, SceneSnapshot, Weather, lamps, quantise};
use kernel::signals::LightPhase;

/// Half of the street's length, metres.
const HALF_M: f32 = 120.0;
/// Half of the asphalt's width, metres.
const KERB_M: f32 = 4.0;

/// The street along the x axis: two lanes, sidewalks, houses, trees, signals and a crossing.
pub fn network() -> RoadNetwork {
    let map = MapData {
        name: "street".into(),
        digest: 1,
        junctions: vec![Junction { light_groups: vec![0], cycle_ticks: 900, ..Default::default() }],
        light_groups: vec![LightGroup { junction: 0, green_from_ticks: 0, green_ticks: 600, yellow_ticks: 180 }],
        light_heads: vec![head(Vec3::new(22.0, -4.6, 0.125)), head(Vec3::new(22.0, 4.6, 0.125))],
        surfaces: surfaces(),
        props: props(),
        bounds: [Vec3::new(-HALF_M, -60.0, 0.0), Vec3::new(HALF_M, 60.0, 12.0)],
        ..Default::default()
    };
    map.into()
}

fn head(position: Vec3) -> LightHead {
    LightHead { group: 0, position, facing_rad: core::f32::consts::PI, height_m: 3.0 }
}

/// A rectangle at a height, cut along x into pieces of 4 m.
fn strip(surface: &mut Surface, x: [f32; 2], y: [f32; 2], z: [f32; 2]) {
    let pieces = ((x[1] - x[0]) / 4.0).ceil().max(1.0);
    let step = (x[1] - x[0]) / pieces;
    for i in 0..pieces as u32 {
        let (a, b) = (x[0] + step * i as f32, x[0] + step * (i + 1) as f32);
        let first = surface.positions.len() as u32;
        surface.positions.extend([
            Vec3::new(a, y[0], z[0]),
            Vec3::new(b, y[0], z[0]),
            Vec3::new(b, y[1], z[1]),
            Vec3::new(a, y[1], z[1]),
        ]);
        surface.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
}

fn surfaces() -> Vec<Surface> {
    let make = |kind| Surface { kind, positions: Vec::new(), triangles: Vec::new() };
    let mut road = make(SurfaceKind::Road);
    let mut lines = make(SurfaceKind::RoadLine);
    let mut walks = make(SurfaceKind::Sidewalk);
    let mut grass = make(SurfaceKind::Terrain);
    let long = [-HALF_M, HALF_M];
    strip(&mut road, long, [-KERB_M, KERB_M], [0.0, 0.0]);
    for i in 0..40 {
        let x = -HALF_M + 6.0 * i as f32;
        strip(&mut lines, [x, x + 3.0], [-0.07, 0.07], [0.016, 0.016]);
    }
    for i in 0..8 {
        let y = -3.6 + i as f32;
        strip(&mut lines, [15.0, 18.0], [y, y + 0.5], [0.016, 0.016]);
    }
    strip(&mut lines, [13.6, 14.0], [-3.8, -0.1], [0.016, 0.016]);
    for side in [-1.0f32, 1.0] {
        let (inner, outer) = (side * KERB_M, side * (KERB_M + 2.5));
        strip(&mut walks, long, [inner.min(outer), inner.max(outer)], [0.125, 0.125]);
        let (low, high) = if side > 0.0 { (-0.2, 0.125) } else { (0.125, -0.2) };
        strip(&mut walks, long, [inner, inner], [low, high]);
    }
    strip(&mut grass, long, [-60.0, 60.0], [-0.06, -0.06]);
    vec![road, lines, walks, grass]
}

fn props() -> Vec<Prop> {
    let mut props = Vec::new();
    let mut put = |kind, x: f32, y: f32, heading_rad: f32, size: [f32; 3], variant| {
        let position = Vec3::new(x, y, if y.abs() > KERB_M { 0.125 } else { 0.0 });
        props.push(Prop { kind, position, heading_rad, size: Vec3::from_array(size), variant });
    };
    for (i, side) in [-1.0f32, 1.0].into_iter().enumerate() {
        let inward = -side * core::f32::consts::FRAC_PI_2;
        for k in 0..14 {
            let (x, variant) = (-112.0 + 16.5 * k as f32, (100 * i + k) as u32);
            if k % 5 != 3 {
                let (width, height) = (11.0 + (k % 3) as f32 * 2.0, 6.5 + (k * 7 % 5) as f32 * 2.6);
                put(PropKind::Building, x, side * 14.5, inward, [11.0, width, height], variant);
            } else {
                put(PropKind::Hedge, x, side * 7.4, 0.0, [9.0, 0.9, 1.2], variant);
                put(PropKind::Tree, x + 2.0, side * 13.0, 0.0, [6.5, 6.5, 9.0], variant);
                put(PropKind::Tree, x - 4.0, side * 17.0, 0.0, [5.0, 5.0, 8.0], variant + 50);
            }
            put(PropKind::Tree, x + 8.0, side * 6.0, 0.0, [3.6, 3.6, 6.0], variant + 20);
            put(PropKind::Lamp, x + 3.0, side * 4.5, inward, [0.2, 0.2, 7.0], 0);
            if k % 2 == 0 {
                put(
                    PropKind::ParkedCar,
                    x + 2.0,
                    side * 3.1,
                    if side > 0.0 { core::f32::consts::PI } else { 0.0 },
                    [4.5, 1.8, 1.5],
                    variant,
                );
            }
        }
    }
    put(PropKind::SignalPole, 22.0, -4.6, 0.0, [0.15, 0.15, 3.5], 0);
    put(PropKind::SignalPole, 22.0, 4.6, 0.0, [0.15, 0.15, 3.5], 0);
    let back = core::f32::consts::PI;
    put(PropKind::Sign, 8.0, -4.6, back, [0.1, 0.7, 2.6], SIGN_LIMIT + 50);
    put(PropKind::Sign, 13.0, -4.6, back, [0.1, 0.7, 2.6], SIGN_STOP);
    put(PropKind::Sign, 13.0, 4.6, back, [0.1, 0.7, 2.6], SIGN_YIELD);
    put(PropKind::Fence, 30.0, -7.2, 0.0, [12.0, 0.1, 1.2], 3);
    put(PropKind::Wall, 44.0, -7.2, 0.0, [10.0, 0.25, 1.4], 2);
    put(PropKind::GuardRail, 40.0, 7.0, 0.0, [12.0, 0.25, 0.8], 0);
    put(PropKind::Furniture, 12.0, 6.0, 0.0, [0.6, 0.6, 1.1], FurnitureKind::Cabinet.variant());
    put(PropKind::Furniture, 18.0, 6.2, back, [1.8, 0.6, 0.85], FurnitureKind::Bench.variant());
    props
}

/// A moment in the street; `moment` moves everything along, 0 and up.
pub fn scene(moment: u32) -> SceneSnapshot {
    let t = moment as f32;
    let mut actors = Vec::new();
    let mut put = |kind, x: f32, y: f32, heading: f32, speed_mps: f32| {
        let id = actors.len() as u32 + 1;
        let along = Vec2::from_angle(heading) * (0.37 * t * speed_mps.min(3.0) % 40.0);
        actors.push(ActorScene {
            id,
            kind,
            variant: id * 7 + 1,
            position: Vec3::new(x + along.x, y + along.y, if y.abs() > KERB_M { 0.125 } else { 0.0 }),
            rotation: Quat::from_rotation_z(heading),
            speed_mps,
            phase_rad: (0.9 * t + id as f32) % core::f32::consts::TAU,
            lamps: [0, lamps::BRAKE, lamps::BRAKE | lamps::LEFT, lamps::RIGHT][id as usize % 4],
        });
    };
    let back = core::f32::consts::PI;
    put(ActorKind::Car, 12.0, -1.9, 0.0, 8.0);
    put(ActorKind::Car, 34.0, 1.9, back, 9.0);
    put(ActorKind::Car, 55.0, -1.9, 0.0, 8.0);
    put(ActorKind::Truck, 46.0, 1.9, back, 8.0);
    put(ActorKind::Bus, 70.0, 1.9, back, 8.0);
    put(ActorKind::Bicycle, 7.0, 1.3, back, 4.0);
    put(ActorKind::Motorcycle, 18.0, 1.5, back, 9.0);
    put(ActorKind::Bicycle, 26.0, -3.4, 0.0, 4.0);
    for i in 0..12 {
        let (x, side) = (5.0 + 3.1 * i as f32, if i % 2 == 0 { 1.0 } else { -1.0 });
        put(ActorKind::Pedestrian, x, side * (4.8 + 0.3 * (i % 4) as f32), if i % 3 == 0 { 0.0 } else { back }, 1.3);
    }
    put(ActorKind::Pedestrian, 16.5, -1.0, 1.57, 1.3);
    let mut scene = SceneSnapshot {
        tick: 60 * u64::from(moment),
        ego: EgoScene {
            position: Vec3::new(-3.0 + 0.8 * t % 20.0, -1.9, 0.0),
            rotation: Quat::from_rotation_z(0.04 * (t % 5.0) - 0.08),
            speed_mps: 8.0,
            wheel_angle_rad: 0.0,
            lamps: 0,
        },
        actors,
        lights: vec![LightPhase::ALL[moment as usize % 3]],
        weather: weather(moment),
    };
    quantise(&mut scene);
    scene
}

fn weather(moment: u32) -> Weather {
    let t = moment as f32;
    Weather::dry(25.0, 10.0 * (t % 6.0), 38.0 + 7.0 * (t % 7.0), (140.0 + 47.0 * t) % 360.0)
}
