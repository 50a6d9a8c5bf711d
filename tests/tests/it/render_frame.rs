//! A frame is the same bits whenever it is drawn, its planes belong together, and what cannot be
//! drawn is refused with a sentence.

use glam::{Quat, Vec3};
use kernel::map::{self, Lane, LaneKind};
use kernel::{Scenario, World};
use render::{AdapterChoice, Camera, Frame, Quality, RenderError, Renderer, SemanticTag};
use tests::{roads, street};

fn renderer() -> Renderer {
    Renderer::new(&street::network(), &AdapterChoice::default()).unwrap()
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_frame_is_the_same_whatever_was_drawn_before() {
    let camera = Camera::driver(256, 128);
    let first = renderer().draw(&street::scene(3), &camera).unwrap();
    let mut used = renderer();
    for moment in [9, 14, 3] {
        used.draw(&street::scene(moment), &Camera::chase(320, 200)).unwrap();
        let again = used.draw(&street::scene(moment), &camera).unwrap();
        assert_eq!(again, used.draw(&street::scene(moment), &camera).unwrap());
        assert_eq!(again == first, moment == 3);
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn every_quality_gives_the_same_truth() {
    let camera = Camera::driver(192, 96);
    let mut renderer = renderer();
    for moment in 0..4 {
        let scene = street::scene(moment);
        let [plain, standard, fine] = Quality::ALL.map(|quality| renderer.draw(&scene, &camera.at(quality)).unwrap());
        assert!(plain.rgb != standard.rgb && standard.rgb != fine.rgb);
        assert!(Frame { rgb: Vec::new(), ..plain.clone() } == Frame { rgb: Vec::new(), ..standard }, "moment {moment}");
        let differing = plain.fine_ids.iter().zip(&fine.fine_ids).filter(|(x, y)| x != y).count();
        assert!(differing * 1000 < plain.fine_ids.len(), "{differing} pixels differ at moment {moment}");
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn pictures_of_one_quality_leave_nothing_behind_for_another() {
    let (scene, mut used) = (street::scene(5), renderer());
    // As many samples, at first nine a pixel.
    let cameras =
        [(64, 32, Quality::Fine), (192, 96, Quality::Plain), (192, 96, Quality::Standard), (64, 32, Quality::Fine)];
    for (width, height, quality) in cameras {
        let camera = Camera::driver(width, height).at(quality);
        assert!(used.draw(&scene, &camera).unwrap() == renderer().draw(&scene, &camera).unwrap(), "{camera:?}");
    }
}

/// Against two plain pictures: one of the pixels' middles, and one that is larger by half a pixel on each side, of their
/// corners. A corner whose four pixels are alike may be their mean instead.
#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn half_of_a_standard_pixel_is_its_middle_and_half_its_corners() {
    let (width, height) = (192usize, 96usize);
    let middles = Camera::driver(width as u32, height as u32).at(Quality::Plain);
    let wider = kernel::ops::tan(0.5 * middles.fov_x_rad) * (width + 1) as f32 / width as f32;
    let fov_x_rad = 2.0 * kernel::ops::atan2(wider, 1.0);
    let corners = Camera { fov_x_rad, ..Camera::driver(width as u32 + 1, height as u32 + 1).at(Quality::Plain) };
    let scene = street::scene(2);
    let mut renderer = renderer();
    let [plain, corners] = [middles, corners].map(|camera| renderer.draw(&scene, &camera).unwrap());
    let standard = renderer.draw(&scene, &middles.at(Quality::Standard)).unwrap().rgb;
    let square = |byte: u8| (f64::from(byte) / 255.0).powi(2);
    // The pixels around a corner; beyond the edges they are as at them.
    let around = |x: usize, y: usize| {
        let (left, right) = (x.saturating_sub(1), x.min(width - 1));
        let (above, below) = (y.saturating_sub(1), y.min(height - 1));
        [(left, above), (right, above), (left, below), (right, below)].map(|(x, y)| y * width + x)
    };
    let alike = |pixels: &[usize; 4]| {
        let spread = |channel: usize| {
            let bytes = pixels.map(|at| plain.rgb[3 * at + channel]);
            bytes.iter().max().unwrap() - bytes.iter().min().unwrap()
        };
        pixels.iter().all(|at| plain.class_ids[*at] == plain.class_ids[pixels[0]]) && (0..3).all(|c| spread(c) <= 12)
    };
    // Least and greatest that a corner may be.
    let corner = |x: usize, y: usize, channel: usize| {
        let drawn = square(corners.rgb[3 * (y * (width + 1) + x) + channel]);
        let pixels = around(x, y);
        let mean = 0.25 * pixels.map(|at| square(plain.rgb[3 * at + channel])).iter().sum::<f64>();
        if alike(&pixels) { [drawn.min(mean), drawn.max(mean)] } else { [drawn; 2] }
    };
    let far = (0..standard.len()).filter(|i| {
        let (x, y, channel) = (i / 3 % width, i / 3 / width, i % 3);
        let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| corner(x + dx, y + dy, channel));
        let [least, most] = [0, 1].map(|end| {
            let sum: f64 = four.iter().map(|ends| ends[end]).sum();
            255.0 * (0.5 * square(plain.rgb[*i]) + 0.125 * sum).sqrt()
        });
        !(least - 1.5..=most + 1.5).contains(&f64::from(standard[*i]))
    });
    // The larger picture's own rounding moves edges across a few samples.
    let (far, all) = (far.count(), standard.len());
    assert!(far * 200 < all, "{far} of {all}");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_hundred_kilometres_of_road_can_be_drawn_from_end_to_end() {
    let network = map::bake("long", &roads::winding(100, 1_000.0)).expect("it bakes");
    let mut renderer = Renderer::new(&network, &AdapterChoice::default()).unwrap();
    let camera = Camera::driver(128, 64);
    for km in (0..100).step_by(9) {
        let names = |lane: &&Lane| lane.kind == LaneKind::Driving && lane.name.starts_with(&format!("{km}/"));
        let lane = network.lanes.iter().find(names).expect("each road has lanes");
        let at = lane.at(0.5 * lane.length_m);
        let mut scene = street::scene(0);
        scene.actors.clear();
        scene.lights.clear();
        scene.ego.position = at.position;
        scene.ego.rotation = Quat::from_rotation_z(at.heading_rad);
        let frame = renderer.draw(&scene, &camera).unwrap();
        let road = frame.class_ids.iter().filter(|id| **id == SemanticTag::Road as u8).count();
        assert!(road * 8 > frame.class_ids.len(), "kilometre {km}: {road} pixels of road");
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn classes_alone_are_those_of_the_picture_with_colours() {
    for quality in Quality::ALL {
        let new = renderer;
        let (mut whole, mut both) = (new(), new());
        for moment in 0..6 {
            let scene = street::scene(moment);
            for camera in [Camera::driver(256, 128), Camera::chase(320, 200)].map(|camera| camera.at(quality)) {
                let frame = whole.draw(&scene, &camera).unwrap();
                let classes = both.draw_classes(&scene, &camera).unwrap();
                assert!(classes.rgb.is_empty() && classes.class_ids.iter().any(|id| *id != classes.class_ids[0]));
                assert_eq!(classes, Frame { rgb: Vec::new(), ..frame.clone() }, "moment {moment}");
                // And leave nothing behind for the next picture.
                assert_eq!(both.draw(&scene, &camera).unwrap(), frame, "moment {moment}");
            }
        }
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn planes_belong_together() {
    let scene = street::scene(1);
    let frame = renderer().draw(&scene, &Camera::driver(512, 256)).unwrap();
    let pixels = 512 * 256;
    assert_eq!((frame.tick, frame.width, frame.height), (scene.tick, 512, 256));
    assert_eq!(frame.rgb.len(), 3 * pixels);
    let mut people = 0;
    for at in 0..pixels {
        let fine = SemanticTag::from_id(frame.fine_ids[at]).expect("a tag in every pixel");
        assert_eq!(frame.class_ids[at], fine.coarse() as u8);
        assert_eq!(frame.depth_m[at].is_infinite(), fine == SemanticTag::Sky);
        let actor = scene.actors.iter().find(|a| a.id == u32::from(frame.instance_ids[at]));
        if let Some(actor) = actor {
            let walks = actor.kind.is_on_foot();
            assert_eq!(fine == SemanticTag::Pedestrian, walks, "instance {} is {fine:?}", actor.id);
            people += u32::from(walks);
        }
    }
    assert!(people > 200, "{people} pixels of people");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_lamp_shows_its_phase() {
    let mut renderer = renderer();
    let mut scene = street::scene(0);
    scene.actors.clear();
    let mut brightest = |phase| {
        scene.lights = vec![phase];
        let frame = renderer.draw(&scene, &Camera::driver(512, 256)).unwrap();
        let lamps = (0..frame.class_ids.len()).filter(|&i| frame.class_ids[i] == SemanticTag::TrafficLight as u8);
        let pixel = |i: usize| [frame.rgb[3 * i], frame.rgb[3 * i + 1], frame.rgb[3 * i + 2]];
        lamps.map(pixel).max_by_key(|p| p.iter().max().unwrap() - p.iter().min().unwrap()).unwrap()
    };
    let [red, green] = [kernel::signals::LightPhase::Red, kernel::signals::LightPhase::Green].map(&mut brightest);
    assert!(red[0] > 2 * red[1], "{red:?}");
    assert!(u16::from(green[1]) > 3 * u16::from(green[0]) / 2, "{green:?}");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn what_cannot_be_drawn_is_refused() {
    let mut renderer = renderer();
    let scene = street::scene(0);
    let refused = renderer.draw(&scene, &Camera::driver(0, 128)).unwrap_err();
    assert!(matches!(refused, RenderError::ImageSize { width: 0, .. }), "{refused}");
    let mut foreign = scene.clone();
    foreign.lights.clear();
    let refused = renderer.draw(&foreign, &Camera::driver(64, 32)).unwrap_err();
    assert_eq!(refused, RenderError::OtherMap { expected: 1, got: 0 });
    assert!(renderer.draw(&scene, &Camera::driver(64, 32)).is_ok());
}

#[test]
fn an_unknown_adapter_is_refused_with_what_to_do() {
    let options = AdapterChoice::Named("no such adapter".into());
    let sentence = Renderer::new(&street::network(), &options).err().unwrap().to_string();
    assert!(sentence.contains("no such adapter") && sentence.contains("mesa-vulkan-drivers"), "{sentence}");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn windows_do_not_flicker_when_the_car_creeps() {
    let network = map::bundled("rural").expect("it is bundled");
    let world = World::new(&Scenario::default_for("rural", 1), &network).expect("it fits");
    let mut scene = world.scene();
    scene.actors.clear();
    // Between houses whose windows lie near the boundary of two kinds.
    scene.ego.position = Vec3::new(421.4912, 1007.1074, 3.630_859_4);
    scene.ego.rotation = Quat::from_xyzw(-0.000_244_140_63, -0.000_671_386_7, -0.303_588_87, 0.952_819_8);
    let mut renderer = Renderer::new(&network, &AdapterChoice::default()).unwrap();
    let before = renderer.draw(&scene, &Camera::driver(640, 360)).unwrap();
    scene.ego.position += scene.ego.rotation * Vec3::X * 0.001;
    let after = renderer.draw(&scene, &Camera::driver(640, 360)).unwrap();
    let house = |frame: &Frame, at: usize| frame.fine_ids[at] == SemanticTag::Building as u8;
    let houses: Vec<usize> = (0..640 * 360).filter(|at| house(&before, *at) && house(&after, *at)).collect();
    let flickers = |at: usize| (3 * at..3 * at + 3).any(|i| before.rgb[i].abs_diff(after.rgb[i]) > 30);
    let flickering = houses.iter().filter(|at| flickers(**at)).count();
    assert!(houses.len() > 20_000 && flickering < 50, "{flickering} of {}", houses.len());
}
