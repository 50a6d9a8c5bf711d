//! Says what this machine has and how fast it is.

use std::fmt::Write;

use base::clock::seconds_of;
use base::failure::{Usage, sentence};
use base::json::Typed;
use base::maps::Map;
use drivers::checkpoint::CheckpointChoice;
use drivers::vision::{DEFAULT_SIZE, Eye};
use kernel::{TickInput, World};
use perception::Compute;
use render::{Camera, RenderOptions, Renderer};
use serde::Serialize;

use super::windows::{self, LiveFigures};
use crate::cli::DoctorArgs;
use crate::exit::Verdict;
use crate::print::print;

/// Ticks, frames and inferences that are measured.
const TICKS: u32 = 600;
const FRAMES: u32 = 20;

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
    if let Err(error) = measure(&mut findings) {
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

/// World step, rendering and inference, as a drive needs them.
fn measure(findings: &mut Findings) -> anyhow::Result<()> {
    let mut each = |what: &str, ms: f64, needed_ms: f64| {
        findings.budgets.push(Budget { what: what.into(), ms, times_real_time: needed_ms / ms });
    };
    let map = Map::find(kernel::map::BUNDLED[0])?;
    let mut world = World::new(&map.scenario(1), &map.network)?;
    let ((), s) = seconds_of(|| (0..TICKS).for_each(|_| drop(world.step(&TickInput::default()))));
    each("world step", 1e3 * s / f64::from(TICKS), 1e3 / f64::from(kernel::time::TICK_HZ));

    let mut renderer = Renderer::new(&map.network, &RenderOptions::default())?;
    let camera = Camera::driver(DEFAULT_SIZE.0, DEFAULT_SIZE.1);
    let frame = renderer.draw(&world.scene(), &camera)?;
    let (drawn, s) = seconds_of(|| (0..FRAMES).try_for_each(|_| renderer.draw(&world.scene(), &camera).map(drop)));
    drawn?;
    each("frame 256x128", 1e3 * s / f64::from(FRAMES), 100.0);

    for compute in Compute::ALL {
        let opened = Eye::open_on(compute, &CheckpointChoice::Bundled(perception::BUNDLED[0]), None);
        let mut eye = match opened {
            // Drives can do without a GPU.
            Err(error) if compute != Compute::Cpu => {
                findings.notes.push(sentence(&error));
                continue;
            }
            opened => opened?,
        };
        let (seen, s) = seconds_of(|| (0..FRAMES).try_for_each(|_| eye.see(frame.clone()).map(drop)));
        seen?;
        each(&format!("inference 256x128 on {}", compute.name()), 1e3 * s / f64::from(FRAMES), 100.0);
    }
    Ok(())
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
