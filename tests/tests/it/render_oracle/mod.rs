//! Label images agree with an independent ray-caster on the processor, which shares the renderer's
//! meshes and nothing else.

mod air;
mod bvh;
mod pose;
mod small;
mod tally;

use kernel::map::bundled;
use kernel::{RoadNetwork, SceneSnapshot};
use render::{AdapterChoice, Camera, Frame, Renderer, SemanticTag};
use tests::{scenes, street};

use bvh::{Bvh, Label};
use pose::Rays;
use tally::{Count, Failures, Tally, Truth, name};

const WIDTH: u32 = 256;
const HEIGHT: u32 = 128;

/// Share of pixels away from borders that must have the same class.
const OVERALL: f64 = 0.995;
/// The same within each class that covers [`COVERS`] of these pixels.
const PER_CLASS: f64 = 0.98;
const COVERS: f64 = 0.005;
/// Share of agreeing pixels whose depth must agree too; where things of a class hide one another it may
/// not.
const DEPTHS: f64 = 0.98;
/// Share of agreeing pixels that must be of the same instance.
const INSTANCES: f64 = 0.998;

/// What rays find in a picture.
fn trace(bvh: &Bvh, rays: &Rays, width: u32) -> Truth {
    let sky = (Label { class: SemanticTag::Sky as u8, instance: 0 }, f64::INFINITY);
    let pixel = |&d| bvh.first_hit(rays.eye, d).map_or(sky, |(t, label)| (label, t));
    Truth { width: width as usize, pixels: rays.directions.iter().map(pixel).collect() }
}

/// What is below its bar in a driver's pictures.
fn failures(tally: &Tally) -> Failures {
    let mut failures = Failures::default();
    let (all, same) = (tally.sum(|c| c.all), tally.sum(|c| c.same));
    failures.expect("classes", Count::share(same, all), OVERALL);
    failures.expect("depths", Count::share(tally.sum(|c| c.close), same), DEPTHS);
    failures.expect("instances", Count::share(tally.sum(|c| c.who), same), INSTANCES);
    for (class, count) in tally.classes.iter().enumerate() {
        if f64::from(count.all) >= COVERS * f64::from(all) {
            failures.expect(name(class), Count::share(count.same, count.all), PER_CLASS);
        }
    }
    failures
}

/// Draws moments of a map and compares them all, as the driver sees them and through a long lens.
/// So many small classes at least must be near.
fn agree(network: &RoadNetwork, scenes: impl Iterator<Item = SceneSnapshot>, small_classes: usize) {
    let mut renderer = Renderer::new(network, &AdapterChoice::default()).unwrap();
    let (mut driver, mut lens) = (Tally::default(), Tally::default());
    for scene in scenes {
        let bvh = Bvh::new(pose::triangles(network, &scene));
        let frame = renderer.draw(&scene, &Camera::driver(WIDTH, HEIGHT)).unwrap();
        driver.add(&frame, &trace(&bvh, &Rays::of_driver(&scene, WIDTH, HEIGHT), WIDTH));
        small::look(network, &scene, &bvh, &mut renderer, &mut lens);
    }
    let mut failures = failures(&driver);
    small::failures(&lens, small_classes, &mut failures);
    assert_eq!(failures.0, Vec::<String>::new());
}

/// Moments of drives through a bundled map, each of another seed, 2 to 20 s after the start.
fn agree_on_drives(map: &str, moments: u64, small_classes: usize) {
    let moment = |seed: u64| {
        let ticks = 120 + seed * 7919 % 1080;
        scenes::scene(&format!("map = \"{map}\"\nseed = {seed}\n")).world_after(ticks).scene()
    };
    agree(&bundled(map).unwrap(), (1..=moments).map(moment), small_classes);
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn labels_agree_with_rays_cast_through_the_street() {
    agree(&street::network(), (0..10).map(street::scene), 4);
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn labels_agree_with_rays_cast_through_the_city() {
    agree_on_drives("city", 10, 3);
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn labels_agree_with_rays_cast_through_the_country() {
    agree_on_drives("rural", 10, 1);
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn labels_agree_with_rays_cast_through_the_other_maps() {
    ["old_town", "suburb", "ring", "lakeside", "motorway"].iter().for_each(|map| agree_on_drives(map, 3, 1));
}

#[test]
fn the_comparison_finds_a_shifted_picture() {
    let label = |i: u32| {
        let stripe = (i % WIDTH / 16) as u16;
        Label { class: if stripe.is_multiple_of(2) { 7 } else { 10 }, instance: stripe + 1 }
    };
    let truth = Truth { width: WIDTH as usize, pixels: (0..WIDTH * HEIGHT).map(|i| (label(i), 5.0)).collect() };
    let draw = |shift: u32, others: u16| {
        let shown = |i: u32| truth.pixels[((i + shift) % (WIDTH * HEIGHT)) as usize].0;
        Frame {
            class_ids: (0..WIDTH * HEIGHT).map(|i| shown(i).class).collect(),
            instance_ids: (0..WIDTH * HEIGHT).map(|i| shown(i).instance + others).collect(),
            depth_m: vec![5.0; truth.pixels.len()],
            ..Default::default()
        }
    };
    let found = |frame: Frame| {
        let mut tally = Tally::default();
        tally.add(&frame, &truth);
        failures(&tally).0
    };
    assert_eq!(found(draw(0, 0)), Vec::<String>::new());
    assert_eq!(found(draw(3, 0)).len(), 3, "overall and both classes");
    assert_eq!(found(draw(0, 1)), ["instances: 0.00000 is below 0.998"]);
}
