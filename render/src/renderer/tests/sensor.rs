//! Pictures of cameras with a sensor.

use super::*;
use crate::Sensor;

fn with(sensor: &str) -> Camera {
    let sensor: Sensor = sensor.parse().expect("a sensor");
    Camera::driver(192, 96).at(Imaging { quality: Quality::Plain, sensor, models: None })
}

/// A place of a map at which the ego car and others move, or nobody does.
fn scene(network: &Arc<RoadNetwork>, speed_mps: f32) -> SceneSnapshot {
    let scene = places("suburb", network, 5).remove(2);
    let car = ActorScene { speed_mps: 2.0 * speed_mps, ..car_at(&scene, 14.0, 3.0) };
    SceneSnapshot { ego: EgoScene { speed_mps, ..scene.ego }, actors: vec![car], ..scene }
}

fn labels(frame: &Frame) -> Frame {
    Frame { rgb: Vec::new(), ..frame.clone() }
}

#[test]
fn labels_are_the_same_whatever_changes_colours_alone() {
    let network = network("suburb");
    let (mut renderer, scene) = (renderer(&network), scene(&network, 15.0));
    let ideal = renderer.draw(&scene, &Camera::driver(192, 96).at(Quality::Plain)).expect("drawn");
    for sensor in
        ["exposure_ev=-2", "noise=4", "motion_blur_s=0.03", "vignetting=0.5", "exposure_ev=1,noise=9,motion_blur_s=0.1"]
    {
        let frame = renderer.draw(&scene, &with(sensor)).expect("drawn");
        assert!(labels(&frame) == labels(&ideal), "{sensor}");
        assert!(frame.rgb != ideal.rgb, "{sensor}");
    }
    let nothing = with("exposure_ev=0,noise=0,k1=0,k2=0,motion_blur_s=0,vignetting=0");
    assert!(renderer.draw(&scene, &nothing).expect("drawn") == ideal);
}

#[test]
fn nothing_is_blurred_where_nothing_moves() {
    let network = network("suburb");
    let (mut renderer, scene) = (renderer(&network), scene(&network, 0.0));
    let [sharp, open] =
        ["noise=0", "motion_blur_s=0.1"].map(|sensor| renderer.draw(&scene, &with(sensor)).expect("drawn"));
    assert!(sharp == open);
}

#[test]
fn who_drives_past_a_standing_car_is_blurred_alone() {
    let network = network("suburb");
    let (mut renderer, mut scene) = (renderer(&network), scene(&network, 0.0));
    scene.actors[0].speed_mps = 20.0;
    scene.actors[0].rotation *= Quat::from_rotation_z(1.6);
    let [sharp, open] =
        ["noise=0", "motion_blur_s=0.1"].map(|sensor| renderer.draw(&scene, &with(sensor)).expect("drawn"));
    let columns = |frame: &Frame| -> Vec<usize> {
        let car = (0..192 * 96).filter(|i| frame.instance_ids[*i] == instance_of_actor(1));
        car.map(|i| i % 192).collect()
    };
    let car = columns(&sharp);
    let (first, last) = (car.iter().min().expect("it is seen"), car.iter().max().expect("it is seen"));
    let changed: Vec<usize> =
        (0..192 * 96).filter(|i| sharp.rgb[3 * i..3 * i + 3] != open.rgb[3 * i..3 * i + 3]).collect();
    assert!(changed.len() > car.len() / 4, "{} of {}", changed.len(), car.len());
    // 2 m at 12 m and more are 16 pixels at most, half of them on each side.
    let outside = changed.iter().filter(|i| !(first.saturating_sub(9)..=last + 9).contains(&(*i % 192)));
    assert_eq!(outside.map(|i| (i % 192, i / 192)).collect::<Vec<_>>(), [], "{first} to {last}");
    let before = changed.iter().filter(|i| sharp.instance_ids[**i] != instance_of_actor(1));
    assert!(before.count() > 20, "it comes by what stands behind it");
}

/// As OpenCV has it, found by halving.
fn undistorted(seen: f64, [k1, k2]: [f64; 2]) -> f64 {
    let (mut low, mut high) = (0.0, 2.0);
    for _ in 0..60 {
        let r: f64 = 0.5 * (low + high);
        let at = r * (1.0 + k1 * r * r + k2 * r.powi(4));
        *(if at < seen { &mut low } else { &mut high }) = r;
    }
    0.5 * (low + high)
}

#[test]
fn labels_under_a_lens_are_those_of_the_places_that_it_shows() {
    let network = network("suburb");
    let (mut renderer, scene) = (renderer(&network), scene(&network, 15.0));
    for (text, k) in [("k1=-0.1", [-0.1, 0.0]), ("k1=-0.3,k2=0.1", [-0.3, 0.1]), ("k1=0.3,noise=4", [0.3, 0.0])] {
        let camera = with(text);
        let lens = Lenses::default().of(&camera).expect("it does not fold");
        let [source, bent] = [lens.pinhole(), &camera].map(|camera| renderer.draw(&scene, camera).expect("drawn"));
        assert!(labels(&renderer.draw_classes(&scene, &camera).expect("drawn")) == labels(&bent), "{text}");
        let mut compared = 0;
        for (x, y) in (0..96).flat_map(|y| (0..192).map(move |x| (x, y))) {
            let aside = [(x as f64 + 0.5 - 96.0) / 96.0, (y as f64 + 0.5 - 48.0) / 96.0];
            let seen = aside[0].hypot(aside[1]);
            let place = aside.map(|aside| 96.0 * aside * undistorted(seen, k) / seen);
            let place = [place[0] + 0.5 * f64::from(source.width), place[1] + 0.5 * f64::from(source.height)];
            // Roundings may decide between two pixels.
            if place.iter().any(|at| (at - at.round()).abs() < 1e-3) {
                continue;
            }
            let (from, to) = (place[1] as usize * source.width as usize + place[0] as usize, y * 192 + x);
            let of = |frame: &Frame, i: usize| {
                (frame.fine_ids[i], frame.class_ids[i], frame.instance_ids[i], frame.depth_m[i])
            };
            assert_eq!(of(&source, from), of(&bent, to), "{text}: {x} {y}");
            compared += 1;
        }
        assert!(compared > 18_000, "{compared}");
    }
}

#[test]
fn a_lens_that_hardly_bends_shows_hardly_another_picture() {
    let network = network("suburb");
    let (mut renderer, scene) = (renderer(&network), scene(&network, 15.0));
    let [ideal, bent] = ["noise=0", "k1=-0.00001"].map(|sensor| renderer.draw(&scene, &with(sensor)).expect("drawn"));
    let differing = ideal.class_ids.iter().zip(&bent.class_ids).filter(|(a, b)| a != b).count();
    assert!(differing < 20, "{differing}");
    let apart: u64 = ideal.rgb.iter().zip(&bent.rgb).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    assert!((apart as f64 / ideal.rgb.len() as f64) < 0.5, "{apart}");
}

#[test]
fn a_lens_that_folds_the_picture_is_refused() {
    let network = network("suburb");
    let (mut renderer, scene) = (renderer(&network), scene(&network, 0.0));
    let refused = renderer.draw(&scene, &with("k1=-0.5")).expect_err("it folds").to_string();
    assert!(refused.starts_with("a lens of k1=-0.5 folds the picture"), "{refused}");
    assert!(renderer.draw_classes(&scene, &with("k1=-0.5")).is_err());
}

#[test]
fn a_size_that_is_too_large_for_the_lens_alone_is_blamed_on_both() {
    let network = network("suburb");
    let (mut renderer, scene) = (renderer(&network), scene(&network, 0.0));
    let limit = renderer.gpu.longest_side();
    let mut said = |width: u32, sensor: &str| {
        let camera = Camera { width, height: 1, ..with(sensor) };
        renderer.draw(&scene, &camera).expect_err("too large").to_string()
    };
    let own = format!("camera asks for an image of {}x1 pixels, expected 1x1 to {limit}x{limit}", limit + 1);
    assert_eq!([said(limit + 1, "noise=1"), said(limit + 1, "k1=-0.1")], [own.clone(), own]);
    let lens = said(limit, "k1=-0.1");
    let words = format!("camera asks for an image of {limit}x1 pixels through a lens of k1=-0.1, for which ");
    assert!(lens.starts_with(&words) && lens.contains(&format!("expected 1x1 to {limit}x{limit} of these")), "{lens}");
    assert!(said(0, "k1=-0.1").starts_with("camera asks for an image of 0x1 pixels, expected"));
}

#[test]
fn cameras_that_take_turns_have_the_pictures_of_their_own_lenses() {
    let network = network("suburb");
    let (mut used, scene) = (renderer(&network), scene(&network, 15.0));
    let cameras = ["k1=-0.1", "k1=0.2", "k1=-0.1,noise=4"]
        .map(with)
        .into_iter()
        .chain([Camera::driver(64, 64).at(with("k1=-0.1").imaging())]);
    for camera in cameras.clone().chain(cameras) {
        let fresh = Renderer::new(&network, &AdapterChoice::default()).expect("an adapter").draw(&scene, &camera);
        assert!(used.draw(&scene, &camera) == fresh, "{camera:?}");
    }
}

#[test]
fn exposure_and_vignetting_change_the_light_that_falls_in() {
    let network = network("suburb");
    let (mut renderer, scene) = (renderer(&network), scene(&network, 0.0));
    let mut of = |sensor: &str| renderer.draw(&scene, &with(sensor)).expect("drawn").rgb;
    let sum = |rgb: &[u8]| rgb.iter().map(|byte| u64::from(*byte)).sum::<u64>();
    let exposures = ["exposure_ev=-4", "exposure_ev=-1", "noise=0", "exposure_ev=1", "exposure_ev=4"].map(&mut of);
    assert!(exposures.iter().map(|rgb| sum(rgb)).is_sorted_by(|a, b| a < b));
    let (ideal, shaded) = (of("noise=0"), of("vignetting=1"));
    let at = |rgb: &[u8], x: usize, y: usize| sum(&rgb[3 * (192 * y + x)..][..3]);
    assert!(ideal.iter().zip(&shaded).all(|(ideal, shaded)| shaded <= ideal));
    assert!(at(&ideal, 96, 48).abs_diff(at(&shaded, 96, 48)) <= 3);
    // At the left edge the angle is 45 degrees: a quarter of the light.
    assert!((at(&shaded, 0, 48) as f64) < 0.75 * at(&ideal, 0, 48) as f64);
}
