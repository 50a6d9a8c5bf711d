//! What `aeye eval` says of distances is near what the renderer measured.

use std::collections::BTreeMap;

use lab::eval::road_users;
use perception::classes::PEDESTRIAN_TAG;
use render::{AdapterChoice, Camera, Frame, Renderer};
use tests::scenes::{busy_city, busy_hamlet};

/// The pedestrians of a frame, by number in the order of their ids: the instances as a dataset has them,
/// and the depths of their pixels in metres, sorted.
fn instances(frame: &Frame) -> (Vec<u16>, Vec<Vec<f32>>) {
    let mut depths: BTreeMap<u16, Vec<f32>> = BTreeMap::new();
    let pixels = || frame.instance_ids.iter().zip(&frame.class_ids);
    for ((id, tag), depth_m) in pixels().zip(&frame.depth_m) {
        if *id != 0 && *tag == PEDESTRIAN_TAG {
            depths.entry(*id).or_default().push(*depth_m);
        }
    }
    let number = |id: &u16| depths.keys().position(|known| known == id).map_or(0, |n| 4000 + n as u16);
    let plane = pixels().map(|(id, tag)| if *tag == PEDESTRIAN_TAG { number(id) } else { 0 }).collect();
    depths.values_mut().for_each(|depths| depths.sort_by(f32::total_cmp));
    (plane, depths.into_values().collect())
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn people_are_about_as_far_away_as_the_renderer_measured() {
    let camera = Camera::driver(256, 128);
    let (mut near, mut errors) = (0, Vec::new());
    for scene in [busy_city(), busy_hamlet()] {
        let mut renderer = Renderer::new(&scene.network, &AdapterChoice::default()).unwrap();
        let mut world = scene.world();
        let mut level_ticks = 0;
        while world.tick() < 1800 {
            let before_mps = world.hud().speed_mps;
            world.step(&tests::scenes::follow_route(&world));
            // Distances are told of a level camera; a car that brakes or pulls away dips.
            let pull_mps2 = (world.hud().speed_mps - before_mps) * 60.0;
            level_ticks = if pull_mps2.abs() > 0.5 { 0 } else { level_ticks + 1 };
            if !world.tick().is_multiple_of(30) || level_ticks < 30 {
                continue;
            }
            let frame = renderer.draw(&world.scene(), &camera).unwrap();
            let (plane, depths) = instances(&frame);
            let found = road_users(&plane, (frame.width, frame.height), &frame.class_ids);
            assert_eq!(found.len(), depths.len());
            for (person, depths) in found.iter().zip(&depths) {
                assert_eq!((person.pixels, person.hits), (depths.len() as u64, depths.len() as u64));
                let measured_m = f64::from(depths[depths.len() / 2]);
                if measured_m < 40.0 && person.height_px >= 4 {
                    near += 1;
                    errors.extend(person.distance_m.map(|told_m| (told_m / measured_m - 1.0).abs()));
                }
            }
        }
    }
    errors.sort_by(f64::total_cmp);
    let at = |share: f64| errors[(share * (errors.len() - 1) as f64) as usize];
    let seen = format!("{near} people, {} with feet: errors {} and {}", errors.len(), at(0.5), at(0.75));
    assert!(errors.len() > 50 && errors.len() * 3 > near * 2 && at(0.5) < 0.12 && at(0.75) < 0.2, "{seen}");
}
