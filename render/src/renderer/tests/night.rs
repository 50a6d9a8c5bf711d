//! Pictures at dusk and at night.

use kernel::map::{Prop, PropKind};

use super::*;

fn at_altitude(scene: &SceneSnapshot, sun_altitude_deg: f32) -> SceneSnapshot {
    SceneSnapshot { weather: Weather { sun_altitude_deg, ..scene.weather }, ..scene.clone() }
}

fn with_headlights(scene: &SceneSnapshot) -> SceneSnapshot {
    SceneSnapshot { ego: EgoScene { lamps: lamps::HEADLIGHTS, ..scene.ego }, ..scene.clone() }
}

fn brightness(frame: &Frame, pixel: usize) -> f32 {
    frame.rgb[3 * pixel..3 * pixel + 3].iter().map(|c| f32::from(*c)).sum::<f32>() / 3.0
}

/// Mean brightness of some pixels.
fn mean(frame: &Frame, of: impl Fn(usize) -> bool) -> f32 {
    let pixels: Vec<usize> = (0..frame.class_ids.len()).filter(|i| of(*i)).collect();
    assert!(!pixels.is_empty(), "there are such pixels");
    pixels.iter().map(|i| brightness(frame, *i)).sum::<f32>() / pixels.len() as f32
}

/// The roads of a map with these objects alone, and a place there.
fn with_props(props: impl Fn(&SceneSnapshot) -> Vec<Prop>) -> (Renderer, SceneSnapshot) {
    let network = network("rural");
    let scene = places("rural", &network, 4).remove(1);
    let roads = MapData { props: props(&scene), ..MapData::clone(&network) };
    (renderer(&roads.into()), SceneSnapshot { actors: Vec::new(), ..scene })
}

/// An object so far ahead of the ego car and to its left that looks along its heading.
fn prop_at(scene: &SceneSnapshot, kind: PropKind, size: Vec3, [ahead_m, left_m]: [f32; 2]) -> Prop {
    let ahead = scene.ego.rotation * Vec3::X;
    let position = scene.ego.position + scene.ego.rotation * Vec3::new(ahead_m, left_m, 0.0);
    Prop { kind, position, heading_rad: ahead.y.atan2(ahead.x), size, variant: 0 }
}

#[test]
fn a_street_gets_darker_and_stays_readable() {
    let network = network("city");
    let mut renderer = renderer(&network);
    for scene in places("city", &network, 4) {
        let frames = [20.0, 4.0, -2.0, -6.0, -30.0].map(|deg| {
            let scene = with_headlights(&at_altitude(&scene, deg));
            renderer.draw(&scene, &Camera::driver(192, 96)).expect("drawn")
        });
        let is_sky = |i: usize| frames[0].class_ids[i] == SemanticTag::Sky as u8;
        let skies = frames.each_ref().map(|frame| mean(frame, is_sky));
        assert!(skies.is_sorted_by(|a, b| a > b), "{skies:?}");
        let [day, .., night] = frames.each_ref().map(|frame| mean(frame, |_| true));
        assert!((25.0..90.0).contains(&night) && night < 0.8 * day, "{night} {day}");
        let is_road = |i: usize| frames[0].class_ids[i] == SemanticTag::Road as u8;
        assert!(mean(&frames[4], is_road) > 40.0, "{}", mean(&frames[4], is_road));
    }
}

/// The face of a sign does, its grey back does not.
#[test]
fn signs_send_headlights_back_at_night() {
    let size = Vec3::new(0.08, 0.7, 2.6);
    for (turn_rad, [least, most]) in [(core::f32::consts::PI, [4.0, 99.0]), (0.0, [0.5, 3.0])] {
        let (mut renderer, scene) = with_props(|scene| {
            let sign = prop_at(scene, PropKind::Sign, size, [14.0, 0.5]);
            vec![Prop { heading_rad: sign.heading_rad + turn_rad, ..sign }]
        });
        let mut sign = |scene: &SceneSnapshot| {
            let frame = renderer.draw(scene, &Camera::driver(256, 128)).expect("drawn");
            mean(&frame, |i| frame.class_ids[i] == SemanticTag::TrafficSign as u8)
        };
        let night = at_altitude(&scene, -30.0);
        let share = sign(&with_headlights(&night)) / sign(&night);
        assert!((least..most).contains(&share), "{share} times as bright, turned by {turn_rad}");
    }
}

#[test]
fn night_changes_colours_alone() {
    let network = network("city");
    let mut renderer = renderer(&network);
    for (scene, quality) in places("city", &network, 3).iter().zip(Quality::ALL) {
        let car = ActorScene { lamps: lamps::HEADLIGHTS, ..car_at(scene, 12.0, 1.0) };
        let scene = SceneSnapshot { actors: vec![car], ..with_headlights(scene) };
        let camera = Camera::driver(128, 64).at(quality);
        let mut truth = |deg: f32| {
            let frame = renderer.draw(&at_altitude(&scene, deg), &camera).expect("drawn");
            Frame { rgb: Vec::new(), ..frame }
        };
        let day = truth(40.0);
        assert!(truth(-3.0) == day && truth(-30.0) == day, "{quality:?}");
    }
}

#[test]
fn by_day_street_lamps_give_no_light() {
    let network = network("city");
    let [mut usual, mut dark] = [(); 2].map(|()| renderer(&network));
    dark.street_lamps.clear();
    let scene = places("city", &network, 3).remove(1);
    let mut same = |deg: f32| {
        let [a, b] = [&mut usual, &mut dark]
            .map(|it| it.draw(&at_altitude(&scene, deg), &Camera::driver(128, 64)).expect("drawn"));
        a == b
    };
    assert!(same(5.0) && same(60.0) && !same(-10.0));
}

#[test]
fn a_street_lamp_lights_the_ground_below_it() {
    let lamp = |scene: &SceneSnapshot| vec![prop_at(scene, PropKind::Lamp, Vec3::new(0.2, 0.2, 7.0), [4.0, 6.0])];
    let (mut lit, scene) = with_props(lamp);
    let (mut unlit, _) = with_props(|_| Vec::new());
    let scene = at_altitude(&scene, -30.0);
    let camera = Camera::top(96, 96, 96.0);
    let [lit, unlit] = [&mut lit, &mut unlit].map(|it| it.draw(&scene, &camera).expect("drawn"));
    let foot = scene.ego.rotation * Vec3::new(4.0, 6.0, 0.0);
    let share = |near_m: f32, far_m: f32| {
        let around = |i: usize| {
            let at = Vec3::new((i % 96) as f32 - 47.5, 47.5 - (i / 96) as f32, 0.0);
            (near_m..far_m).contains(&at.distance(foot)) && unlit.instance_ids[i] == 0
        };
        mean(&lit, around) / mean(&unlit, around)
    };
    let (below, aside, far) = (share(3.0, 5.0), share(14.0, 16.0), share(35.0, 40.0));
    assert!(below > 2.5 && below > 1.4 * aside && far == 1.0, "{below} {aside} {far}");
}

#[test]
fn headlights_light_the_road_ahead() {
    let (mut renderer, scene) = bare();
    let scene = at_altitude(&scene, -30.0);
    let mut draw = |scene: &SceneSnapshot| renderer.draw(scene, &Camera::driver(128, 64)).expect("drawn");
    let (with, without) = (draw(&with_headlights(&scene)), draw(&scene));
    let ahead = |i: usize| (40..60).contains(&(i / 128)) && (48..80).contains(&(i % 128));
    assert!(mean(&with, ahead) > 2.5 * mean(&without, ahead), "{} {}", mean(&with, ahead), mean(&without, ahead));
    // So is a car ahead.
    let behind = with_headlights(&SceneSnapshot { actors: vec![car_at(&scene, 14.0, 0.0)], ..scene.clone() });
    let blocked = draw(&behind);
    let car = |i: usize| blocked.instance_ids[i] == instance_of_actor(1);
    let unlit = draw(&SceneSnapshot { ego: scene.ego, ..behind });
    assert!(mean(&blocked, car) > 1.3 * mean(&unlit, car));
}

#[test]
fn windows_shine_at_night_and_not_by_day() {
    let house =
        |scene: &SceneSnapshot| vec![prop_at(scene, PropKind::Building, Vec3::new(30.0, 12.0, 14.0), [30.0, 0.0])];
    let (mut renderer, scene) = with_props(house);
    let mut draw = |deg: f32| renderer.draw(&at_altitude(&scene, deg), &Camera::driver(256, 128)).expect("drawn");
    let (day, night) = (draw(40.0), draw(-12.0));
    let is_house = |i: usize| day.class_ids[i] == SemanticTag::Building as u8;
    let shines = |i: usize| is_house(i) && brightness(&night, i) > 100.0;
    let count = (0..day.class_ids.len()).filter(|i| shines(*i)).count();
    assert!(count > 30, "{count} pixels");
    let walls = |i: usize| is_house(i) && !shines(i);
    assert!(mean(&night, shines) > 3.0 * mean(&night, walls));
    assert!(mean(&day, shines) < mean(&day, walls), "by day they are dark");
}

#[test]
fn wet_roads_mirror_lamps_and_dry_ones_do_not() {
    let (mut renderer, scene) = bare();
    let camera = Camera::driver(256, 128);
    let mut draw = |wetness_pct: f32, lamps: u8| {
        let weather = Weather { sun_altitude_deg: -20.0, wetness_pct, ..scene.weather };
        let actors = vec![ActorScene { lamps, ..car_at(&scene, 16.0, 0.0) }];
        renderer.draw(&SceneSnapshot { weather, actors, ..scene.clone() }, &camera).expect("drawn")
    };
    let mut gain = |wetness_pct: f32, tag: SemanticTag| {
        let [without, with] = [0, lamps::BRAKE].map(|lamps| draw(wetness_pct, lamps));
        assert!(Frame { rgb: Vec::new(), ..with.clone() } == Frame { rgb: Vec::new(), ..without.clone() });
        let red = |frame: &Frame, i: usize| i32::from(frame.rgb[3 * i]) - i32::from(frame.rgb[3 * i + 2]);
        let ground = (64 * 256..128 * 256).filter(|i| with.class_ids[*i] == tag as u8);
        ground.map(|i| red(&with, i) - red(&without, i)).filter(|more| *more > 12).count()
    };
    // Glows reach over the ground around them.
    let [road, grass] = [SemanticTag::Road, SemanticTag::Terrain].map(|tag| [100.0, 0.0].map(|wet| gain(wet, tag)));
    assert!(road[0] > 3 * road[1] && road[0] > 60, "{road:?}");
    assert!(grass[0] <= grass[1], "{grass:?}");
}
