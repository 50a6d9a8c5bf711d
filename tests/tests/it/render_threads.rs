//! Renderers on many threads at once.

use std::sync::Barrier;
use std::{fs, thread};

use kernel::World;
use render::{AdapterChoice, Camera, Renderer};
use tests::scenes::busy_city;

const THREADS: u32 = 4;
const FRAMES: u32 = 200;

/// Screens of Mesa's CPU driver that are at work in this process: each has threads `llvmpipe-0`, `llvmpipe-1` and so on.
fn screens() -> usize {
    let name = |thread: fs::DirEntry| fs::read_to_string(thread.path().join("comm"));
    let threads = fs::read_dir("/proc/self/task").expect("Linux").flatten();
    threads.filter_map(|thread| name(thread).ok()).filter(|name| name.trim() == "llvmpipe-0").count()
}

/// That driver (22.3) looks into the scenes that all devices of a screen are drawing, without waiting for them: who read a
/// picture back while another one drew ended the process by SIGSEGV, once in some hours.
#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn renderers_on_many_threads_do_not_meet_in_the_driver() {
    let scene = busy_city();
    let snapshot = World::new(&scene.scenario, &scene.network).expect("a world").scene();
    let all_are_there = Barrier::new(THREADS as usize);
    let draw_all = &|number: u32| {
        let mut renderer = Renderer::new(&scene.network, &AdapterChoice::default()).expect("a renderer");
        let mut draw = |turn: u32| {
            let camera = Camera::driver(128 + 64 * ((turn + number) % 3), 128);
            renderer.draw(&snapshot, &camera).expect("a picture").rgb.len()
        };
        let first = draw(0);
        all_are_there.wait();
        let screens = screens();
        all_are_there.wait();
        (1..FRAMES).for_each(|turn| assert!(draw(turn) > 0));
        (first, screens)
    };
    let done: Vec<_> = thread::scope(|scope| {
        let start = |number| scope.spawn(move || draw_all(number));
        let all: Vec<_> = (0..THREADS).map(start).collect();
        all.into_iter().map(|thread| thread.join().expect("no panic")).collect()
    });
    let found = AdapterChoice::default().find().expect("an adapter");
    if found.name.contains("llvmpipe") && found.backend == "vulkan" {
        assert!(done.iter().all(|(_, screens)| *screens >= THREADS as usize), "{done:?}: a screen for each renderer");
    }
}
