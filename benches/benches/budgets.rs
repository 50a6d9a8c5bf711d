//! Measures each part and the whole frame, then holds the results against the budgets.
//!
//! `cargo bench -p benches` exits with 3 when a budget is broken, and with 1 when a scene is not its
//! golden or nothing could be measured.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use benches::scenes::{BusyDrive, SCALE_S, STEP_S, bare, recorded, town};
use benches::{Against, Budget, check, mean_seconds};
use criterion::{BatchSize, Criterion};
use kernel::RoadNetwork;
use kernel::time::CLIP_FPS;
use perception::{Checkpoint, RgbView, Segmenter};
use render::{AdapterChoice, Camera, Renderer};
use replay::Replayer;

/// The size of the bundled checkpoints, pixels.
const SIZE: (u32, u32) = (256, 128);

/// The budgets of the rig. Real-time factors hold on one core of a desktop machine; the ratios to
/// references hold wherever both run.
const BUDGETS: [Budget; 8] = [
    Budget { bench: "kernel/step", against: Against::RealTime(STEP_S as f64), at_least: 150.0 },
    Budget { bench: "replay/verify", against: Against::RealTime(STEP_S as f64), at_least: 100.0 },
    // Road users cost no more each where there are more of them.
    Budget { bench: "kernel/scale_1000", against: Against::Reference("kernel/scale_150"), at_least: 150.0 / 1000.0 },
    // Keyframes are 7 s apart: what lies between two is driven again.
    Budget { bench: "replay/seek", against: Against::RealTime(KEYFRAMES_S), at_least: 100.0 },
    // Four times the roads take four times as long, and a little more.
    Budget { bench: "kernel/bake_40km", against: Against::Reference("kernel/bake_10km"), at_least: 0.2 },
    Budget { bench: "render/frame", against: Against::Reference("reference/bare_draw"), at_least: 0.15 },
    Budget { bench: "perception/infer", against: Against::Reference("reference/matrix_product"), at_least: 0.5 },
    Budget { bench: "rig/frame", against: Against::RealTime(1.0 / CLIP_FPS as f64), at_least: 2.0 },
];

/// How far apart keyframes are, seconds.
const KEYFRAMES_S: f64 = 7.0;
/// The recording in which is sought, seconds.
const SOUGHT_S: u32 = 30 * 60;

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(3),
        Err(reason) => {
            eprintln!("{reason}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<bool, String> {
    let drive = BusyDrive::prepare()?;
    let results = results_folder();
    let mut criterion = Criterion::default()
        .output_directory(&results)
        .without_plots()
        .sample_size(20)
        .warm_up_time(Duration::from_secs(1))
        .measurement_time(Duration::from_secs(4));
    kernel_step(&mut criterion, &drive);
    let towns = kernel_scale(&mut criterion);
    kernel_bake(&mut criterion);
    replay_verify(&mut criterion, &drive)?;
    replay_seek(&mut criterion, &drive)?;
    let mut sight = Sight::open(&drive.scene.network)?;
    references(&mut criterion, &drive)?;
    sight.render(&mut criterion, &drive);
    sight.infer(&mut criterion, &drive);
    sight.whole_frame(&mut criterion, &drive);
    let seconds_of = |name: &str| {
        mean_seconds(&fs::read_to_string(results.join(name.replace('/', "_")).join("new/estimates.json")).ok()?)
    };
    let checked = check(&BUDGETS, seconds_of)?;
    for (name, placed) in towns {
        let seconds = seconds_of(name).ok_or_else(|| format!("{name}: not measured"))?;
        println!("{name:18} {placed} road users: {:.0} agent-seconds a second", f64::from(placed * SCALE_S) / seconds);
    }
    checked.iter().for_each(|line| println!("{line}"));
    Ok(checked.iter().all(benches::Checked::kept))
}

/// Below the build folder, whatever it is called.
fn results_folder() -> PathBuf {
    let exe = std::env::current_exe().unwrap_or_default();
    exe.ancestors().nth(3).unwrap_or(Path::new("target")).join("criterion")
}

fn kernel_step(criterion: &mut Criterion, drive: &BusyDrive) {
    criterion.bench_function("kernel/step", |b| {
        b.iter_batched_ref(
            || drive.world.clone(),
            |world| drive.inputs.iter().for_each(|input| drop(world.step(input))),
            BatchSize::LargeInput,
        )
    });
}

/// Towns with room for all; gives the road users of each.
fn kernel_scale(criterion: &mut Criterion) -> [(&'static str, u32); 2] {
    [("kernel/scale_150", 150, 6, 5), ("kernel/scale_1000", 1000, 16, 13)].map(|(name, actors, columns, rows)| {
        let drive = town(actors, columns, rows);
        criterion.bench_function(name, |b| {
            b.iter_batched_ref(
                || drive.world.clone(),
                |world| drive.inputs.iter().for_each(|input| drop(world.step(input))),
                BatchSize::LargeInput,
            )
        });
        (name, drive.placed)
    })
}

fn kernel_bake(criterion: &mut Criterion) {
    for km in [10, 40] {
        let text = ::tests::roads::winding(km, 1_000.0);
        criterion.bench_function(&format!("kernel/bake_{km}km"), |b| {
            b.iter(|| kernel::map::bake("winding", &text).expect("it bakes"))
        });
    }
}

fn replay_verify(criterion: &mut Criterion, drive: &BusyDrive) -> Result<(), String> {
    let log = recorded(&drive.scene, STEP_S)?;
    criterion.bench_function("replay/verify", |b| {
        b.iter(|| {
            let report = replay::verify(&log, &drive.scene.network).expect("the log fits its map");
            assert_eq!(report.divergence, None, "the recording replays");
        })
    });
    Ok(())
}

/// To the tick of half an hour that is farthest from the keyframe before it, from the beginning and back.
fn replay_seek(criterion: &mut Criterion, drive: &BusyDrive) -> Result<(), String> {
    let log = recorded(&drive.scene, SOUGHT_S)?;
    let gaps = log.keyframes.windows(2).map(|pair| (pair[1].tick - pair[0].tick, pair[1].tick - 1));
    let (_, farthest) = gaps.max().ok_or("a recording with keyframes")?;
    let mut replayer = Replayer::new(&log, drive.scene.network.clone()).map_err(|e| e.to_string())?;
    criterion.bench_function("replay/seek", |b| {
        b.iter(|| [log.first_tick(), farthest].map(|tick| replayer.seek(tick).expect("a tick of the log")))
    });
    Ok(())
}

/// Renderer and network of a drive.
struct Sight {
    renderer: Renderer,
    segmenter: Segmenter,
    camera: Camera,
}

impl Sight {
    fn open(network: &RoadNetwork) -> Result<Self, String> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../perception/checkpoints/early.onnx");
        let checkpoint = Checkpoint::load(&path).map_err(|e| e.to_string())?;
        let segmenter = Segmenter::new(&checkpoint, SIZE.0 as usize, SIZE.1 as usize).map_err(|e| e.to_string())?;
        let renderer = Renderer::new(network, &AdapterChoice::default()).map_err(|e| e.to_string())?;
        Ok(Self { renderer, segmenter, camera: Camera::driver(SIZE.0, SIZE.1) })
    }

    fn render(&mut self, criterion: &mut Criterion, drive: &BusyDrive) {
        criterion.bench_function("render/frame", |b| {
            b.iter(|| self.renderer.draw(&drive.snapshot, &self.camera).expect("a frame"))
        });
    }

    fn infer(&mut self, criterion: &mut Criterion, drive: &BusyDrive) {
        let frame = self.renderer.draw(&drive.snapshot, &self.camera).expect("a frame");
        let view = RgbView::new(SIZE.0 as usize, SIZE.1 as usize, &frame.rgb).expect("the frame's size");
        criterion.bench_function("perception/infer", |b| b.iter(|| self.segmenter.run(view).expect("a mask")));
    }

    /// Ticks, picture and prediction of one frame at 10 frames a second.
    fn whole_frame(&mut self, criterion: &mut Criterion, drive: &BusyDrive) {
        let ticks = &drive.inputs[..kernel::time::CLIP_STRIDE_TICKS as usize];
        criterion.bench_function("rig/frame", |b| {
            b.iter_batched_ref(
                || drive.world.clone(),
                |world| {
                    ticks.iter().for_each(|input| drop(world.step(input)));
                    let frame = self.renderer.draw(&world.scene(), &self.camera).expect("a frame");
                    let view = RgbView::new(SIZE.0 as usize, SIZE.1 as usize, &frame.rgb).expect("the frame's size");
                    self.segmenter.run(view).expect("a mask")
                },
                BatchSize::LargeInput,
            )
        });
    }
}

/// What the budgets of picture and prediction are held against.
fn references(criterion: &mut Criterion, drive: &BusyDrive) -> Result<(), String> {
    let mut renderer =
        Renderer::new(&bare(&drive.scene.network), &AdapterChoice::default()).map_err(|e| e.to_string())?;
    let mut empty = drive.snapshot.clone();
    empty.actors.clear();
    let camera = Camera::driver(SIZE.0, SIZE.1);
    criterion.bench_function("reference/bare_draw", |b| b.iter(|| renderer.draw(&empty, &camera).expect("a frame")));
    criterion.bench_function("reference/matrix_product", |b| b.iter(|| benches::matrix_product(384)));
    Ok(())
}
