//! The simulated semantic driver is a function of mask and HUD: what the mask shows changes what it
//! does, and the truth behind it does not.

use drivers::readout::Readout;
use drivers::semantic::SemanticBot;
use drivers::{Driver, MaskView, SemanticView};
use kernel::Controls;
use kernel::map::Turn;
use render::SemanticTag;

const WIDTH: usize = 256;
const HEIGHT: usize = 128;

fn hud() -> Readout {
    let (turn, junction_m) = (Turn::Straight, Some(120));
    Readout { speed_kmh: 32, limit_kmh: 50, light: None, light_m: 0, turn, junction_m, bearing_deg: 0 }
}

/// A straight road in the lower half: its right edge 1.75 m to the right, a line to the left.
fn street() -> Vec<u8> {
    let mut ids = vec![SemanticTag::Sky as u8; WIDTH * HEIGHT];
    for row in HEIGHT / 2..HEIGHT {
        let metres_a_pixel = 1.5 / (row as f32 + 0.5 - 0.5 * HEIGHT as f32);
        for column in 0..WIDTH {
            let left_m = (0.5 * WIDTH as f32 - column as f32 - 0.5) * metres_a_pixel;
            ids[row * WIDTH + column] = match left_m {
                l if (1.7..1.85).contains(&l) => SemanticTag::RoadLine,
                l if (-1.75..5.25).contains(&l) => SemanticTag::Road,
                _ => SemanticTag::SideWalk,
            } as u8;
        }
    }
    ids
}

/// What the bot does after a second in front of an unchanged screen.
fn controls(ids: &[u8]) -> Controls {
    let mut bot = SemanticBot::default();
    let view = SemanticView { mask: MaskView { width: WIDTH, height: HEIGHT, ids }, hud: hud() };
    (0..60).map(|_| bot.controls(&view)).last().expect("60 ticks")
}

#[test]
fn an_all_road_mask_and_a_wall_of_people_change_the_controls() {
    let street_ids = street();
    let free = controls(&street_ids);
    assert!(free.throttle > 0 && free.brake == 0, "{free:?}");

    // A street whose right edge is a metre nearer: the bot keeps away from it; all road: it cannot know.
    let nearer: Vec<u8> = (0..WIDTH * HEIGHT)
        .map(|i| {
            let (row, column) = (i / WIDTH, i % WIDTH);
            let below = row as f32 + 0.5 - 0.5 * HEIGHT as f32;
            let left_m = (0.5 * WIDTH as f32 - column as f32 - 0.5) * 1.5 / below;
            if below > 0.0 && left_m < -0.75 { SemanticTag::SideWalk as u8 } else { street_ids[i] }
        })
        .collect();
    let all_road = vec![SemanticTag::Road as u8; WIDTH * HEIGHT];
    assert!(controls(&nearer).steer < controls(&all_road).steer, "steers left, away from the edge");

    let mut wall = street_ids.clone();
    for row in 50..84 {
        wall[row * WIDTH..(row + 1) * WIDTH].fill(SemanticTag::Pedestrian as u8);
    }
    let wall = controls(&wall);
    assert!(wall.brake > 20_000 && wall.throttle == 0, "{wall:?}");
}

#[test]
fn the_same_view_gives_the_same_controls() {
    let ids = street();
    assert_eq!(controls(&ids), controls(&ids));
}
