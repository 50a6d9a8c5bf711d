//! Label images agree with an independent ray-caster on the processor, which shares the renderer's
//! meshes and nothing else.

mod air;
mod bvh;
mod pose;

use kernel::map::bundled;
use kernel::{RoadNetwork, SceneSnapshot};
use render::{AdapterChoice, Camera, Frame, Renderer, SemanticTag};
use tests::{scenes, street};

use bvh::Bvh;

const WIDTH: u32 = 256;
const HEIGHT: u32 = 128;

/// Share of pixels away from class borders that must agree.
const OVERALL: f64 = 0.995;
/// The same within each class that covers [`COVERS`] of these pixels.
const PER_CLASS: f64 = 0.98;
const COVERS: f64 = 0.005;
/// Share of agreeing pixels whose depth must agree too; where things of a class hide one another it may
/// not.
const DEPTHS: f64 = 0.98;
/// Depths agree when they differ by less than this share.
const DEPTH_SHARE: f64 = 0.01;
/// Or, of plants, than this, metres: which leaves cover a sample depends on how coarse their picture is.
const LEAVES_M: f64 = 1.2;

/// Class and distance of every pixel.
fn cast(network: &RoadNetwork, scene: &SceneSnapshot) -> Vec<(u8, f64)> {
    let bvh = Bvh::new(pose::triangles(network, scene));
    let (eye, directions) = pose::rays(scene, WIDTH, HEIGHT);
    let sky = (SemanticTag::Sky as u8, f64::INFINITY);
    directions.iter().map(|&d| bvh.first_hit(eye, d).map_or(sky, |(t, class)| (class, t))).collect()
}

/// Whether all eight neighbours have the class of a pixel.
fn is_inside(truth: &[(u8, f64)], at: usize) -> bool {
    let (x, y) = ((at % WIDTH as usize) as i64, (at / WIDTH as usize) as i64);
    let class = |x: i64, y: i64| truth[(y * i64::from(WIDTH) + x) as usize].0;
    let range = |v: i64, end: u32| (v - 1).max(0)..=(v + 1).min(i64::from(end) - 1);
    range(y, HEIGHT).all(|v| range(x, WIDTH).all(|u| class(u, v) == truth[at].0))
}

/// By how much depths may differ that agree, metres.
fn depth_room(class: u8, distance: f64) -> f64 {
    let leaves = if class == SemanticTag::Vegetation as u8 { LEAVES_M } else { 0.0 };
    leaves.max(DEPTH_SHARE * distance)
}

/// Pixels away from borders, by class of the ray-caster: (all, of the same class, of the same depth).
struct Tally {
    classes: [[u32; 3]; 23],
}

impl Tally {
    fn new() -> Self {
        Self { classes: [[0; 3]; 23] }
    }

    fn add(&mut self, frame: &Frame, truth: &[(u8, f64)]) {
        for at in (0..truth.len()).filter(|&at| is_inside(truth, at)) {
            let (class, distance) = truth[at];
            let same = frame.class_ids[at] == class;
            let depth = f64::from(frame.depth_m[at]);
            let close = depth == distance || (depth - distance).abs() < depth_room(class, distance);
            let counts = &mut self.classes[class as usize];
            counts[0] += 1;
            counts[1] += u32::from(same);
            counts[2] += u32::from(same && close);
        }
    }

    /// What is below its bar, as text.
    fn failures(&self) -> Vec<String> {
        let sum = |k: usize| f64::from(self.classes.iter().map(|c| c[k]).sum::<u32>());
        let mut failures = Vec::new();
        let mut expect = |what: String, share: f64, bar: f64| {
            println!("{what}: {share:.5}");
            if share < bar {
                failures.push(format!("{what}: {share:.5} is below {bar}"));
            }
        };
        expect("classes".into(), sum(1) / sum(0), OVERALL);
        expect("depths".into(), sum(2) / sum(1), DEPTHS);
        for (id, [all, same, _]) in self.classes.iter().enumerate() {
            if f64::from(*all) >= COVERS * sum(0) {
                let name = SemanticTag::from_id(id as u8).map_or("?", SemanticTag::name);
                expect(name.into(), f64::from(*same) / f64::from(*all), PER_CLASS);
            }
        }
        failures
    }
}

/// Draws moments of a map and compares them all.
fn agree(network: &RoadNetwork, scenes: impl Iterator<Item = SceneSnapshot>) {
    let mut renderer = Renderer::new(network, &AdapterChoice::default()).unwrap();
    let mut tally = Tally::new();
    for scene in scenes {
        let frame = renderer.draw(&scene, &Camera::driver(WIDTH, HEIGHT)).unwrap();
        tally.add(&frame, &cast(network, &scene));
    }
    assert_eq!(tally.failures(), Vec::<String>::new());
}

/// Ten moments of drives through a bundled map, each of another seed, 2 to 20 s after the start.
fn agree_on_drives(map: &str) {
    let moment = |seed: u64| {
        let ticks = 120 + seed * 7919 % 1080;
        scenes::scene(&format!("map = \"{map}\"\nseed = {seed}\n")).world_after(ticks).scene()
    };
    agree(&bundled(map).unwrap(), (1..=10).map(moment));
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn labels_agree_with_rays_cast_through_the_street() {
    agree(&street::network(), (0..10).map(street::scene));
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn labels_agree_with_rays_cast_through_the_city() {
    agree_on_drives("city");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn labels_agree_with_rays_cast_through_the_country() {
    agree_on_drives("rural");
}

#[test]
fn the_comparison_finds_a_shifted_picture() {
    let truth: Vec<(u8, f64)> =
        (0..WIDTH * HEIGHT).map(|i| (if (i % WIDTH / 16).is_multiple_of(2) { 7 } else { 10 }, 5.0)).collect();
    let draw = |shift: u32| Frame {
        class_ids: (0..WIDTH * HEIGHT).map(|i| truth[((i + shift) % (WIDTH * HEIGHT)) as usize].0).collect(),
        depth_m: vec![5.0; truth.len()],
        ..Default::default()
    };
    let failures = |frame: Frame| {
        let mut tally = Tally::new();
        tally.add(&frame, &truth);
        tally.failures()
    };
    assert_eq!(failures(draw(0)), Vec::<String>::new());
    assert_eq!(failures(draw(3)).len(), 3, "overall and both classes");
}
