//! Puts a window of a log into a file: simulates it again, comparing every tick, and draws.

use std::fmt;
use std::io::Write;
use std::sync::Arc;

use anyhow::Context;
use base::png;
use drivers::vision::Eye;
use kernel::scene::{EgoScene, SceneSnapshot};
use kernel::time::{CLIP_STRIDE_TICKS, TICK_HZ, Tick};
use kernel::{RoadNetwork, World};
use measures::criticality::{SAMPLE_TICKS, Sampler, WARM_UP_SAMPLES};
use measures::footage::Window;
use replay::{Log, Replayer, nanoseconds};
use serde::Serialize;
use viewers::messages::actors::actors;
use viewers::messages::camera::image;
use viewers::messages::ground::ground;
use viewers::messages::poses::{ego_path, ego_pose, transforms};
use viewers::messages::telemetry::Telemetry;

use super::criticality::Criticality;
use super::happenings;
use super::sink::Sink;
use super::topics::Topics;
use crate::cameras::Named;
use crate::looks::{Studio, look};

/// What is written of a window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Ticks with a picture.
    pub frames: usize,
    /// Poses of the ego car.
    pub poses: usize,
    /// Happenings.
    pub events: usize,
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frames, poses, events } = self;
        write!(f, "{frames} frames")?;
        match (poses, events) {
            (0, 0) => Ok(()),
            _ => write!(f, ", {poses} poses, {events} events"),
        }
    }
}

impl Counts {
    /// That of a window of a log.
    pub fn of(log: &Log, window: &Window) -> Self {
        Self {
            frames: window.pictures().count(),
            poses: window.ticks.clone().count(),
            events: happenings::lines(log, &window.ticks).len(),
        }
    }
}

/// What turns scenes into pictures and masks.
pub struct Camera<'a> {
    /// Draws.
    pub studio: &'a mut Studio,
    /// Look at what was drawn.
    pub eyes: &'a mut [Eye],
    /// Cameras beside the drivers'.
    pub others: &'a [Named],
}

/// Writes a window of a log. `go_on` is asked after each picture; when it says no, an error ends the work.
pub fn shoot<W: Write>(
    (log, network): (&Log, &Arc<RoadNetwork>),
    window: &Window,
    camera: &mut Camera<'_>,
    sink: &mut Sink<W>,
    mut go_on: impl FnMut() -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    let topics = Topics::declare(sink, camera.eyes.iter().map(Eye::name), camera.others)?;
    let (first, last) = (*window.ticks.start(), *window.ticks.end());
    sink.put(&topics.ground, first, &ground(network, nanoseconds(first)))?;
    sink.put(&topics.path, first, &ego_path(&path(log, network, window)?, nanoseconds(first)))?;
    let mut happenings = happenings::lines(log, &window.ticks).into_iter().peekable();
    let mut replayer = Replayer::new(log, network.clone())?;
    // Some ticks before the window, so that everyone's change of speed is known in it.
    let mut sampler = Sampler::default();
    replayer.seek(first.saturating_sub(WARM_UP_SAMPLES * SAMPLE_TICKS).max(log.first_tick()))?;
    loop {
        let scene = replayer.world().scene();
        let (tick, inside) = (scene.tick, window.ticks.contains(&scene.tick));
        if tick.abs_diff(window.anchor).is_multiple_of(SAMPLE_TICKS) {
            let sample = sampler.look(replayer.world(), &scene);
            if inside {
                sink.put(&topics.criticality, tick, &Criticality::of(&sample))?;
            }
        }
        if inside {
            sink.put(&topics.pose, tick, &ego_pose(&scene.ego, nanoseconds(tick)))?;
            while let Some((_, line)) = happenings.next_if(|(at, _)| *at <= tick) {
                sink.put(&topics.events, tick, &line)?;
            }
            if window.has_picture(tick) {
                picture(&scene, network, camera, &topics, sink)?;
                go_on()?;
            }
        }
        if tick >= last {
            return Ok(());
        }
        let (telemetry, tick) = (step(&mut replayer)?, tick + 1);
        if window.ticks.contains(&tick) {
            sink.put(&topics.telemetry, tick, &telemetry)?;
        }
    }
}

/// Goes on by a tick and gives its figures.
fn step(replayer: &mut Replayer<'_>) -> anyhow::Result<Telemetry> {
    let log = replayer.log();
    let output = replayer.step()?.context("the log ends within the window")?;
    let input = log.input(output.tick).context("a tick without input")?;
    let milliseconds = |ticks: Tick| 1e3 * ticks as f64 / f64::from(TICK_HZ);
    let mask_age_ms = log.mask_at(output.tick).map(|mask| milliseconds(mask.age_at(output.tick)));
    Ok(Telemetry::of_step(replayer.world(), input, &output, mask_age_ms))
}

/// Ten places of the ego car a second.
fn path(log: &Log, network: &Arc<RoadNetwork>, window: &Window) -> anyhow::Result<Vec<EgoScene>> {
    let mut replayer = Replayer::new(log, network.clone())?;
    let mut place = |tick| {
        replayer.seek(tick)?;
        Ok(World::scene(replayer.world()).ego)
    };
    window.ticks.clone().step_by(CLIP_STRIDE_TICKS as usize).map(&mut place).collect()
}

fn picture<W: Write>(
    scene: &SceneSnapshot,
    network: &RoadNetwork,
    camera: &mut Camera<'_>,
    topics: &Topics,
    sink: &mut Sink<W>,
) -> anyhow::Result<()> {
    let (tick, time_ns, driver) = (scene.tick, nanoseconds(scene.tick), *camera.studio.camera());
    let frame = camera.studio.draw(network, scene)?;
    let size = (frame.width, frame.height);
    let others = topics.others.iter().zip(camera.others.iter().map(|named| &named.camera));
    let mounted = [(&topics.driver, &driver)].into_iter().chain(others.clone());
    let mounted = mounted.map(|(pictures, camera)| (pictures.frame(), camera));
    sink.put(&topics.transforms, tick, &transforms(scene, mounted, time_ns))?;
    sink.put(&topics.actors, tick, &actors(scene, time_ns))?;
    topics.driver.put(sink, &driver, &frame)?;
    for (topic, mask) in topics.predicted.iter().zip(look(camera.eyes, &frame)?) {
        sink.put(topic, tick, &image(png::tags(size, &mask.ids)?, topics.driver.frame(), time_ns))?;
    }
    for (pictures, other) in others {
        pictures.put(sink, other, &camera.studio.draw_through(network, scene, other)?)?;
    }
    Ok(())
}
