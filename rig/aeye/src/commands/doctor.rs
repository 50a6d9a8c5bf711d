//! Says what this machine has and how fast it is.

use std::fmt::Write;

use base::clock::seconds_of;
use base::failure::{Usage, sentence};
use base::json::Typed;
use base::maps::Map;
use drivers::vision::{DEFAULT_SIZE, Eye};
use kernel::{TickInput, World};
use perception::Compute;
use render::{AdapterChoice, Camera, Imaging, Renderer};
use serde::Serialize;

use super::windows::{self, LiveFigures};
use crate::cli::DoctorArgs;
use crate::exit::Verdict;
use crate::print::print;

/// Ticks, frames and inferences that are measured.
const TICKS: u32 = 600;
const FRAMES: u32 = 20;
/// Time that a live drive gives a frame, ms.
const FRAME_MS: f64 = 100.0;

/// What this machine has.
#[derive(Debug, Serialize)]
struct Findings {
    /// Cores of the processor.
    cores: usize,
    /// Graphics adapters.
    adapters: Vec<Adapter>,
    /// Wheels and gamepads.
    devices: Vec<String>,
    /// Measured times.
    budgets: Vec<Budget>,
    /// How well drives in windows keep real time, where there is a display.
    live: Option<LiveFigures>,
    /// What to use here.
    advice: Vec<String>,
    /// What drives need and does not work, and what to do about it.
    problems: Vec<String>,
    /// What does not work and drives can do without.
    notes: Vec<String>,
}

/// What `aeye doctor` prints.
impl Typed for Findings {
    const TYPE: &'static str = "aeye.doctor";
}

/// A graphics adapter.
#[derive(Debug, Serialize)]
struct Adapter {
    /// Its name.
    name: String,
    /// The graphics interface.
    backend: String,
    /// Its driver.
    driver: String,
    /// Whether it computes on the CPU.
    is_cpu: bool,
}

/// A measured time.
#[derive(Debug, Serialize)]
struct Budget {
    /// What was measured.
    what: String,
    /// How long it took, ms.
    ms: f64,
    /// How many of it fit into the time that a live drive gives it.
    times_real_time: f64,
}

/// Runs `aeye doctor`.
pub fn run(args: &DoctorArgs, json: bool) -> anyhow::Result<Verdict> {
    let mut findings = Findings {
        cores: std::thread::available_parallelism().map_or(1, |n| n.get()),
        adapters: adapters(),
        devices: Vec::new(),
        budgets: Vec::new(),
        live: None,
        advice: Vec::new(),
        problems: Vec::new(),
        notes: Vec::new(),
    };
    match windows::devices() {
        Ok(devices) => findings.devices = devices,
        Err(error) => findings.notes.push(sentence(&error)),
    }
    if let Err(error) = measure(args, &mut findings) {
        findings.problems.push(sentence(&error));
    }
    if args.seconds > 0 && findings.problems.is_empty() {
        match windows::trial(args) {
            Ok((figures, advice)) => {
                findings.advice = advice;
                findings.live = Some(figures);
            }
            Err(error) if error.is::<Usage>() => return Err(error),
            Err(error) => findings.notes.push(format!("real time was not measured: {}", sentence(&error))),
        }
    }
    print(json, &findings, || text(&findings))?;
    Ok(if findings.problems.is_empty() { Verdict::Ok } else { Verdict::CheckFailed })
}

fn adapters() -> Vec<Adapter> {
    let adapters = render::adapters().into_iter();
    adapters.map(|a| Adapter { name: a.name, backend: a.backend, driver: a.driver, is_cpu: a.is_cpu }).collect()
}

/// World step, rendering and inference, as the drive that was asked for needs them.
fn measure(args: &DoctorArgs, findings: &mut Findings) -> anyhow::Result<()> {
    let mut each = |what: String, ms: f64, needed_ms: f64| {
        findings.budgets.push(Budget { what, ms, times_real_time: needed_ms / ms });
    };
    let map = Map::find(kernel::map::BUNDLED[0])?;
    let mut world = World::new(&map.scenario(1), &map.network)?;
    let ((), s) = seconds_of(|| (0..TICKS).for_each(|_| drop(world.step(&TickInput::default()))));
    each("world step".into(), 1e3 * s / f64::from(TICKS), 1e3 / f64::from(kernel::time::TICK_HZ));

    let mut renderer = Renderer::new(&map.network, &AdapterChoice::default())?;
    let seen = args.pictures.mask_size.unwrap_or(DEFAULT_SIZE);
    let ((width, height), image) = (seen, args.pictures.image_size);
    let small = Camera::driver(width, height).at(Imaging::from(args.pictures.imaging));
    let large = small.imaging().in_quality(renderer.quality_for_people());
    let mut cameras = vec![small, Camera::driver(image.0, image.1).at(large)];
    cameras.dedup();
    for camera in cameras {
        let (width, height) = (camera.width, camera.height);
        let ms = milliseconds(|| renderer.draw(&world.scene(), &camera).map(drop).map_err(Into::into))?;
        each(format!("frame {width}x{height}"), ms, FRAME_MS);
    }

    let frame = renderer.draw(&world.scene(), &small)?;
    for compute in Compute::ALL {
        let opened = Eye::open_on(compute, &args.checkpoint, args.pictures.mask_size);
        let mut eye = match opened {
            // Drives can do without a GPU and onnxruntime.
            Err(error) if compute != Compute::Cpu => {
                findings.notes.push(sentence(&error));
                continue;
            }
            opened => opened?,
        };
        let ms = milliseconds(|| eye.see(frame.clone()).map(drop))?;
        each(format!("inference {}x{} of {} on {}", seen.0, seen.1, eye.name(), compute.name()), ms, FRAME_MS);
    }
    Ok(())
}

/// How long a piece of work takes when it is done again and again; the first time, which makes ready, is left out.
fn milliseconds(mut work: impl FnMut() -> anyhow::Result<()>) -> anyhow::Result<f64> {
    work()?;
    let (done, s) = seconds_of(|| (0..FRAMES).try_for_each(|_| work()));
    done.map(|()| 1e3 * s / f64::from(FRAMES))
}

fn text(findings: &Findings) -> String {
    let mut text = format!("cores     {}", findings.cores);
    // Writing to a string cannot fail.
    let mut line = |name: &str, value: String| {
        let _ = write!(text, "\n{name:<9} {value}");
    };
    if findings.adapters.is_empty() {
        line("adapter", "none".into());
    }
    for a in &findings.adapters {
        let kind = if a.is_cpu { "CPU" } else { "GPU" };
        line("adapter", format!("{} ({kind}, {}, {})", a.name, a.backend, a.driver));
    }
    if findings.devices.is_empty() {
        line("device", windows::none_found());
    }
    for device in &findings.devices {
        line("device", device.clone());
    }
    for b in &findings.budgets {
        line("measured", format!("{}: {:.3} ms, {:.1} times real time", b.what, b.ms, b.times_real_time));
    }
    if let Some(figures) = &findings.live {
        line("measured", figures.to_string());
    }
    for advice in &findings.advice {
        line("advice", advice.clone());
    }
    for problem in &findings.problems {
        line("problem", problem.clone());
    }
    for note in &findings.notes {
        line("note", note.clone());
    }
    text
}
