//! How fast a world steps: `cargo run --release -p kernel --example step -- [MAP] [ACTORS]`.
#![allow(clippy::disallowed_methods, clippy::disallowed_types, reason = "a measurement needs a clock")]

#[path = "../tests/common/script.rs"]
mod script;

use std::time::Instant;

use kernel::World;
use kernel::map;
use kernel::scenario::Scenario;
use kernel::time::TICK_HZ;

fn main() {
    let mut args = std::env::args().skip(1);
    let name = args.next().unwrap_or_else(|| String::from("city"));
    let actors: u16 = args.next().and_then(|n| n.parse().ok()).unwrap_or(100);
    let network = map::bundled(&name).expect("a bundled map");
    let mut scenario = Scenario::default_for(&name, 1);
    let traffic = &mut scenario.traffic;
    (traffic.pedestrians, traffic.bicycles, traffic.motorcycles) = (actors * 2 / 5, actors / 10, actors / 20);
    traffic.cars = actors - traffic.pedestrians - traffic.bicycles - traffic.motorcycles;
    let start = Instant::now();
    let mut world = World::new(&scenario, &network).expect("the scenario fits");
    println!("start {:.2} ms, {} actors", start.elapsed().as_secs_f64() * 1e3, world.scene().actors.len());

    let ticks = 7200;
    let (mut keyframe_s, mut keyframes, mut near, mut moving) = (0.0, 0, 0, 0);
    let mut total_s = 0.0;
    for _ in 0..ticks {
        let input = kernel::TickInput { semantic: script::polite(&world), ..Default::default() };
        let start = Instant::now();
        let output = world.step(&input);
        let step_s = start.elapsed().as_secs_f64();
        total_s += step_s;
        if let Some(keyframe) = output.keyframe {
            (keyframe_s, keyframes) = (keyframe_s + step_s, keyframes + 1);
            let scene = world.scene();
            near += scene.actors.iter().filter(|a| a.position.distance(scene.ego.position) < 60.0).count();
            moving += scene.actors.iter().filter(|a| a.speed_mps > 0.1).count();
            if keyframes == 1 {
                println!("keyframe {} bytes", keyframe.bytes.len());
            }
        }
    }
    let step_us = total_s / f64::from(ticks) * 1e6;
    println!("step {step_us:.1} us, {:.0} times real time", 1e6 / step_us / f64::from(TICK_HZ));
    println!("step with keyframe {:.1} us", keyframe_s / f64::from(keyframes) * 1e6);
    println!(
        "near {} moving {}, {} m driven",
        near / keyframes as usize,
        moving / keyframes as usize,
        world.odometer_mm() / 1000
    );
}
