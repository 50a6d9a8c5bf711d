//! The same picture through Vulkan and through OpenGL: what a network sees does not depend on the API.

use kernel::SceneSnapshot;
use kernel::weather::WeatherPreset;
use render::{AdapterChoice, Camera, Frame, Quality, Renderer, adapters};
use tests::street;

/// Moments of the street, and their weather where it is not the dry one that they have.
const SCENES: [(u32, Option<&str>); 8] = [
    (0, None),
    (4, None),
    (9, None),
    (3, Some("HardRainNoon")),
    (5, Some("FoggyNoon")),
    (7, Some("ClearDusk")),
    (8, Some("DryNight")),
    (2, Some("CloudyNoon")),
];
/// How far colours may be apart in the mean of a picture, of 255.
const COLOURS: f64 = 1.0;
/// Share of the labels (class and instance) that may differ.
const LABELS: f64 = 0.001;

fn scenes() -> Vec<SceneSnapshot> {
    let scene = |(moment, weather): &(u32, Option<&str>)| {
        let scene = street::scene(*moment);
        let azimuth_deg = scene.weather.sun_azimuth_deg;
        let weather = weather.map(|name| WeatherPreset::find(name).expect(name).weather(azimuth_deg));
        SceneSnapshot { weather: weather.unwrap_or(scene.weather), ..scene }
    };
    SCENES.iter().map(scene).collect()
}

/// Pictures of all scenes in all of the qualities by the adapter of an API.
fn drawn_by(choice: &AdapterChoice, qualities: &[Quality]) -> Vec<Frame> {
    let mut renderer = Renderer::new(&street::network(), choice).expect("an adapter");
    let mut pictures = Vec::new();
    for quality in qualities {
        let camera = Camera::driver(256, 128).at(*quality);
        pictures.extend(scenes().iter().map(|scene| renderer.draw(scene, &camera).expect("a picture")));
    }
    pictures
}

/// Mean difference of two pictures' colours, of 255, and the share of their labels that differ.
fn difference(a: &Frame, b: &Frame) -> (f64, f64) {
    let sum: u64 = a.rgb.iter().zip(&b.rgb).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    let labels = |frame: &Frame, at: usize| (frame.fine_ids[at], frame.instance_ids[at]);
    let others = (0..a.fine_ids.len()).filter(|at| labels(a, *at) != labels(b, *at)).count();
    (sum as f64 / a.rgb.len() as f64, others as f64 / a.fine_ids.len() as f64)
}

/// What is wrong with the second pictures, one by one.
fn complaints(first: &[Frame], second: &[Frame]) -> Vec<String> {
    let wrong = |(number, (a, b)): (usize, (&Frame, &Frame))| {
        let (colours, labels) = difference(a, b);
        let said = || format!("picture {number}: colours {colours:.3} apart, {:.3} % of labels differ", 100.0 * labels);
        (colours > COLOURS || labels > LABELS).then(said)
    };
    assert_eq!(first.len(), second.len());
    first.iter().zip(second).enumerate().filter_map(wrong).collect()
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
#[cfg_attr(no_opengl, ignore = "no driver of OpenGL for EGL is installed; AEYE_GPU=require makes this an error")]
fn vulkan_and_opengl_draw_the_same() {
    let qualities = [Quality::Plain, Quality::Standard];
    let [vulkan, opengl] = ["vulkan", "gl"].map(|api| {
        let choice = AdapterChoice::Named(api.into());
        assert_eq!(choice.find().expect("an adapter").backend, api);
        drawn_by(&choice, &qualities)
    });
    let found = complaints(&vulkan, &opengl);
    assert!(found.is_empty(), "{:?} of {:#?}", found, adapters());
    // A picture of another moment is another one: so this would be seen.
    let moved: Vec<Frame> = [&opengl[1..], &opengl[..1]].concat();
    assert_eq!(complaints(&vulkan, &moved).len(), vulkan.len());
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn opengl_draws_only_where_it_is_asked_for() {
    let asked = std::env::var("AEYE_GPU").is_ok_and(|name| name == "gl");
    assert_eq!(AdapterChoice::Auto.find().expect("an adapter").backend == "gl", asked);
    let apis: Vec<bool> = adapters().iter().map(|adapter| adapter.backend == "gl").collect();
    assert!(apis.is_sorted(), "those of OpenGL come last: {:?}", adapters());
}
