//! Whom the simulated safety driver sees is whom the renderer shows: two ways to the same answer.

use drivers::safety::in_sight;
use render::{AdapterChoice, Camera, Renderer};
use tests::scenes;

/// So many pixels of somebody are a sight, in a picture of 512x256.
const PLAIN_PX: usize = 40;
/// Farther off the safety driver looks for nobody, metres; what is near that is left out.
const NEAR_M: f32 = 55.0;

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn who_is_seen_is_in_the_picture_and_who_is_hidden_is_not() {
    let (mut world, network) = (scenes::busy_city().world(), scenes::busy_city().network);
    let mut renderer = Renderer::new(&network, &AdapterChoice::default()).unwrap();
    let camera = Camera::driver(512, 256);
    let (mut shown, mut missed, mut hidden, mut imagined) = (0, 0, 0, 0);
    for second in 0..60 {
        for _ in 0..60 {
            let input = scenes::follow_route(&world);
            world.step(&input);
        }
        let scene = world.scene();
        let seen = in_sight(&network, &scene);
        let frame = renderer.draw(&scene, &camera).unwrap();
        for actor in &scene.actors {
            let pixels = frame.instance_ids.iter().filter(|id| u32::from(**id) == actor.id).count();
            let is_near = actor.position.distance(scene.ego.position) < NEAR_M;
            let is_seen = seen.contains(&actor.id);
            if is_near && pixels >= PLAIN_PX {
                shown += 1;
                missed += u32::from(!is_seen);
            }
            if is_near && pixels == 0 {
                hidden += 1;
                imagined += u32::from(is_seen);
            }
        }
        assert!(seen.len() < scene.actors.len(), "second {second}: everybody is seen");
    }
    // A leg or a wheel may be all that is shown of somebody, and a head that is seen less than a pixel.
    assert!(shown > 25 && 20 * missed <= shown, "{missed} of {shown} who are shown are not seen");
    assert!(hidden > 40 && 20 * imagined <= hidden, "{imagined} of {hidden} who are hidden are seen");
}
