//! Rain, fog and water change colours, and nothing that counts as truth.

use kernel::SceneSnapshot;
use kernel::scene::Weather;
use kernel::weather::WeatherPreset;
use render::mesh::actor::has_umbrella_up;
use render::{AdapterChoice, Camera, Frame, Renderer, SemanticTag, instance_of_actor};
use tests::street;

fn renderer() -> Renderer {
    Renderer::new(&street::network(), &AdapterChoice::default()).expect("an adapter")
}

/// The street in a weather with the sun where it was.
fn street_in(weather: Weather) -> SceneSnapshot {
    SceneSnapshot { weather, ..street::scene(4) }
}

fn preset(name: &str) -> Weather {
    WeatherPreset::find(name).expect(name).weather(200.0)
}

/// Mean brightness of the pixels that a predicate picks, of 255.
fn brightness(frame: &Frame, picks: impl Fn(usize) -> bool) -> f64 {
    let picked: Vec<usize> = (0..frame.class_ids.len()).filter(|at| picks(*at)).collect();
    assert!(picked.len() > 100, "{} pixels", picked.len());
    let sum: u32 = picked.iter().flat_map(|at| &frame.rgb[3 * at..3 * at + 3]).map(|v| u32::from(*v)).sum();
    f64::from(sum) / (3.0 * picked.len() as f64)
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn weather_changes_colours_and_no_class_instance_or_depth() {
    let (mut renderer, camera) = (renderer(), Camera::driver(256, 128));
    // Branches move with the wind, and umbrellas are up in rain.
    let calm = |weather: Weather| {
        let mut scene = street_in(Weather { wind_pct: 0.0, ..weather });
        scene.actors.retain(|actor| !has_umbrella_up(actor.kind, actor.variant, 100.0));
        scene
    };
    let dry = renderer.draw(&calm(Weather::dry(5.0, 0.0, 45.0, 200.0)), &camera).expect("a frame");
    for name in WeatherPreset::names() {
        let frame = renderer.draw(&calm(preset(name)), &camera).expect("a frame");
        let truth = |frame: &Frame| {
            let depths: Vec<u32> = frame.depth_m.iter().map(|m| m.to_bits()).collect();
            (frame.class_ids.clone(), frame.fine_ids.clone(), frame.instance_ids.clone(), depths)
        };
        assert!(truth(&frame) == truth(&dry), "{name} changes the truth");
        assert_ne!(frame.rgb, dry.rgb, "{name}");
    }
    let again = renderer.draw(&calm(Weather::dry(5.0, 0.0, 45.0, 200.0)), &camera).expect("a frame");
    assert!(again == dry, "what was drawn before stays in the picture");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn rain_changes_who_puts_up_an_umbrella_and_nobody_else() {
    let (mut renderer, camera) = (renderer(), Camera::driver(256, 128));
    let mut changed = 0;
    for moment in 0..20 {
        let mut scene = street::scene(moment);
        // So that enough of them are near, and some have one.
        scene.actors.iter_mut().for_each(|actor| actor.variant += 31 * moment);
        let carriers: Vec<u16> = scene
            .actors
            .iter()
            .filter(|a| has_umbrella_up(a.kind, a.variant, 100.0))
            .map(|a| instance_of_actor(a.id))
            .collect();
        let [dry, wet] = [0.0, 100.0].map(|rain_pct| {
            let weather = Weather { precipitation_pct: rain_pct, ..scene.weather };
            renderer.draw_classes(&SceneSnapshot { weather, ..scene.clone() }, &camera).expect("a frame")
        });
        for at in (0..dry.class_ids.len()).filter(|at| dry.depth_m[*at].to_bits() != wet.depth_m[*at].to_bits()) {
            let whose = [dry.instance_ids[at], wet.instance_ids[at]];
            assert!(whose.iter().any(|instance| carriers.contains(instance)), "moment {moment}: {whose:?}");
            changed += 1;
        }
    }
    assert!(changed > 0, "somebody has one");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn fog_hides_what_is_far_and_begins_where_it_shall() {
    let (mut renderer, camera) = (renderer(), Camera::driver(256, 128));
    let clear = Weather::dry(0.0, 0.0, 45.0, 200.0);
    let mut draw = |density, from_m| {
        let fog = Weather { fog_density_pct: density, fog_distance_m: from_m, ..clear };
        renderer.draw(&street_in(fog), &camera).expect("a frame")
    };
    let (none, dense, later) = (draw(0.0, 0.0), draw(100.0, 0.0), draw(100.0, 30.0));
    // Contrast to the fog's own colour falls by Koschmieder's law: beyond the 50 m that one sees 2 % are left.
    let spread = |frame: &Frame, near_m: f32, far_m: f32| {
        let at =
            |at: usize| frame.class_ids[at] != SemanticTag::Sky as u8 && (near_m..far_m).contains(&frame.depth_m[at]);
        let values: Vec<f64> =
            (0..frame.depth_m.len()).filter(|i| at(*i)).map(|i| f64::from(frame.rgb[3 * i + 1])).collect();
        assert!(values.len() > 50, "{} pixels", values.len());
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / values.len() as f64).sqrt()
    };
    assert!(spread(&dense, 60.0, 200.0) < 0.1 * spread(&none, 60.0, 200.0));
    assert!(spread(&later, 10.0, 20.0) > 1.1 * spread(&dense, 10.0, 20.0));
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn wet_roads_are_darker_and_puddles_mirror_the_sky() {
    let (mut renderer, camera) = (renderer(), Camera::driver(512, 256));
    let clear = Weather::dry(60.0, 0.0, 45.0, 200.0);
    let mut draw = |weather| renderer.draw(&street_in(weather), &camera).expect("a frame");
    let (dry, wet, flooded) =
        (draw(clear), draw(Weather { wetness_pct: 100.0, ..clear }), draw(Weather { puddles_pct: 100.0, ..clear }));
    let near = |at: usize| dry.class_ids[at] == SemanticTag::Road as u8 && dry.depth_m[at] < 6.0;
    let far = |at: usize| dry.class_ids[at] == SemanticTag::Road as u8 && dry.depth_m[at] > 20.0;
    let [before, after] = [&dry, &wet].map(|frame| brightness(frame, near));
    assert!(after < 0.9 * before, "{before} {after}");
    let [before, after] = [&wet, &flooded].map(|frame| brightness(frame, far));
    assert!(after > 1.2 * before, "{before} {after}");
    let house = |at: usize| dry.class_ids[at] == SemanticTag::Building as u8;
    assert!((brightness(&dry, house) - brightness(&wet, house)).abs() < 0.5);
}
