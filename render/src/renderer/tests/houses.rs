//! Pictures of houses from near and far.

use kernel::map::{Prop, PropKind};

use super::*;

/// The roads of a map with one house alone, and a camera that stands so far from its front and to its side and looks along a
/// heading against the front, degrees.
fn house(size: Vec3, variant: u32, [out_m, aside_m]: [f32; 2], turn_deg: f32) -> (Renderer, SceneSnapshot, Camera) {
    let network = network("rural");
    let scene = places("rural", &network, 4).remove(1);
    // Off the road, high above the ground, where nothing hides it.
    let position = scene.ego.position + Vec3::Z * 100.0;
    let prop = Prop { kind: PropKind::Building, position, heading_rad: 0.0, size, variant };
    let roads = MapData { props: vec![prop], ..MapData::clone(&network) };
    let eye = position + Vec3::new(0.5 * size.x + out_m, aside_m, 0.5 * size.z);
    let rotation = Quat::from_rotation_z(core::f32::consts::PI + turn_deg.to_radians());
    let camera = Camera { mount: crate::Mount::World, position: eye, rotation, ..Camera::driver(256, 128) };
    (renderer(&roads.into()), SceneSnapshot { actors: Vec::new(), ..scene }, camera)
}

/// Share of the house's pixels that are lit windows.
fn lit_share(camera: [f32; 2], turn_deg: f32) -> f32 {
    let (mut renderer, scene, camera) = house(Vec3::new(10.0, 40.0, 12.0), 3, camera, turn_deg);
    let weather = Weather { sun_altitude_deg: -12.0, ..scene.weather };
    let frame = renderer.draw(&SceneSnapshot { weather, ..scene }, &camera).expect("drawn");
    let is_house = |i: &usize| frame.class_ids[*i] == SemanticTag::Building as u8;
    let pixels: Vec<usize> = (0..frame.class_ids.len()).filter(is_house).collect();
    let lit = pixels.iter().filter(|i| frame.rgb[3 * **i] > 120).count();
    lit as f32 / pixels.len() as f32
}

/// Seen from the side, reveals hide much of them.
#[test]
fn panes_lie_inside_the_wall() {
    let (ahead, along) = (lit_share([14.0, 0.0], 0.0), lit_share([1.2, 18.0], 80.0));
    assert!(ahead > 0.04 && along < 0.6 * ahead, "{ahead} {along}");
}

/// What is finer than a pixel does not come and go as the eye moves by less than one.
#[test]
fn fine_detail_does_not_flicker_from_afar() {
    let of_house = |variant: u32| {
        let frame = |aside_m: f32| {
            let (mut renderer, scene, camera) = house(Vec3::new(10.0, 40.0, 10.2), variant, [40.0, aside_m], 0.0);
            renderer.draw(&scene, &camera).expect("drawn")
        };
        let (one, other) = (frame(0.0), frame(0.06));
        let both = |i: &usize| [&one, &other].iter().all(|f| f.class_ids[*i] == SemanticTag::Building as u8);
        let pixels: Vec<usize> = (0..one.class_ids.len()).filter(both).collect();
        let off: u32 = pixels.iter().map(|i| u32::from(one.rgb[3 * i].abs_diff(other.rgb[3 * i]))).sum();
        off as f32 / pixels.len() as f32
    };
    let all: Vec<f32> = (0..12).map(of_house).collect();
    assert!(all.iter().sum::<f32>() < 12.0 * 2.6, "{all:?}");
}
