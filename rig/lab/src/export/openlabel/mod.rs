//! A window of a recording as labels of ASAM OpenLABEL 1.0: where everybody is, in each frame, and what happened.

mod document;
mod kinds;
mod story;
mod tags;
mod tracks;

use std::path::{Path, PathBuf};

use anyhow::{bail, ensure};
use base::files::{self, most};
use base::output;
use base::progress::Interrupt;
use kernel::RoadNetwork;
use kernel::scene::Weather;
use kernel::time::Tick;
use measures::footage::{self, Window};
use render::Camera;
use render::camera::OPTICAL;
use replay::{Log, Recording};

use self::document::{Document, Interval, Labels, Metadata, Pinhole, Stream, StreamProperties, System};
use self::story::Story;
use self::tracks::{EGO, Tracks, WORLD, pose};
use super::film::Counts;
use super::options::{Export, Options};
use crate::cameras::Named;
use crate::looks::Size;
use crate::redrive::Counterfactual;

/// The driver's view: a stream, and its coordinate system (x right, y down, z ahead).
const CAMERA: &str = "camera";
/// What tells labels that this program wrote.
const ANNOTATOR: &str = "\"annotator\":\"A-Eye ";
/// Most boxes of all frames.
const BOXES: usize = 1_000_000;

/// Writes the file, unless it is there.
pub fn export(
    (args, size): (&Options, Size),
    file: &Path,
    out: PathBuf,
    others: &[Named],
    interrupt: &Interrupt,
) -> anyhow::Result<Export> {
    let recording = Recording::open(file)?;
    let (log, network) = (recording.log(), recording.network()?);
    let window = Window::of(log, &args.asked())?;
    let ticks: Vec<Tick> = window.pictures().collect();
    let (Some(&from), Some(&to)) = (ticks.first(), ticks.last()) else {
        bail!("no frame falls into the window; expected a longer one, or more frames a second");
    };
    let (mut tracks, mut weather) = (Tracks::default(), log.manifest.scenario.weather);
    footage::each_scene(log, &network, &ticks, |_, scene| {
        ensure!(!interrupt.is_raised(), "interrupted; nothing of its export is kept");
        tracks.add(&scene);
        weather = scene.weather;
        ensure!(tracks.boxes <= BOXES, "has over {BOXES} boxes; --last, --from and --to ask for less");
        Ok(())
    })?;
    tracks.point();
    let source = log.manifest.case.as_ref().map_or(recording.digest(), |case| case.source);
    let verdict = Counterfactual::beside(file, &source);
    let story = Story::of(log, window.ticks.clone().into_inner(), verdict.as_ref(), &mut tracks);
    let counts = Counts { frames: ticks.len(), poses: tracks.frames.len(), events: story.events.len() };
    let metadata = metadata(file, &recording, &network);
    let driver = Camera::driver(size.0, size.1).at(args.imaging);
    let labels = labels(metadata, &weather, &sensors(driver, others), tracks, story);
    let text = serde_json::to_string(&Document { openlabel: labels })?;
    let kept = is_there(&out, &text)?;
    if !kept {
        output::write_file(&out, text.as_bytes())?;
    }
    Ok(Export { file: file.to_owned(), out, from, to, kept, counts })
}

/// Whether a file holds the labels; refuses one that is not of this program.
fn is_there(out: &Path, text: &str) -> anyhow::Result<bool> {
    if !out.exists() {
        return Ok(false);
    }
    let there = files::read(out, most::TABLE).unwrap_or_default();
    let is_ours = there.windows(ANNOTATOR.len()).any(|part| part == ANNOTATOR.as_bytes());
    ensure!(is_ours, "{}: exists already and is no export; expected another place", out.display());
    Ok(there == text.as_bytes())
}

fn metadata(file: &Path, recording: &Recording, network: &RoadNetwork) -> Metadata {
    let Log { manifest, .. } = recording.log();
    Metadata {
        schema_version: "1.0.0",
        annotator: format!("A-Eye {}", env!("CARGO_PKG_VERSION")),
        comment: format!("A simulated drive, seed {}", manifest.scenario.seed),
        tagged_file: file.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        tagged_file_blake3: blake3::Hash::from_bytes(recording.digest()).to_hex().to_string(),
        map: manifest.scenario.map.clone(),
        origin_m: network.origin_m,
    }
}

/// A camera, what it is called and what is said of it.
struct Sensor {
    name: String,
    description: String,
    camera: Camera,
}

/// The drivers' camera, and others.
fn sensors(driver: Camera, others: &[Named]) -> Vec<Sensor> {
    let driver = Sensor { name: CAMERA.to_owned(), description: "What both drivers see".to_owned(), camera: driver };
    let of = |Named { name, camera }: &Named| Sensor {
        name: format!("cameras/{name}"),
        description: format!("What the camera {name} sees"),
        camera: *camera,
    };
    std::iter::once(driver).chain(others.iter().map(of)).collect()
}

fn labels(metadata: Metadata, weather: &Weather, sensors: &[Sensor], tracks: Tracks, story: Story) -> Labels {
    let last = tracks.frames.len().saturating_sub(1) as u32;
    let system = |r#type, parent, children, pose_wrt_parent| System { r#type, parent, children, pose_wrt_parent };
    let names = sensors.iter().map(|sensor| sensor.name.clone()).collect();
    let systems = [
        (WORLD.to_owned(), system("scene_cs", "", vec![EGO.to_owned()], None)),
        (EGO.to_owned(), system("local_cs", WORLD, names, None)),
    ];
    let mounted = |Sensor { name, camera, .. }: &Sensor| {
        let mounting = pose(camera.position, camera.rotation * OPTICAL);
        (name.clone(), system("sensor_cs", EGO, Vec::new(), Some(mounting)))
    };
    Labels {
        metadata,
        ontologies: tags::ontologies(),
        coordinate_systems: systems.into_iter().chain(sensors.iter().map(mounted)).collect(),
        streams: sensors.iter().map(|sensor| (sensor.name.clone(), stream(sensor))).collect(),
        tags: tags::tags(weather, &tracks.classes()),
        frame_intervals: vec![Interval { frame_start: 0, frame_end: last }],
        objects: tracks.objects,
        events: story.events,
        actions: story.actions,
        relations: story.relations,
        frames: tracks.frames,
    }
}

fn stream(Sensor { description, camera, .. }: &Sensor) -> Stream {
    let [fx, _, cx, _, fy, cy, ..] = camera.intrinsics();
    let intrinsics_pinhole = Pinhole {
        width_px: camera.width,
        height_px: camera.height,
        camera_matrix: [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
        distortion_coeffs: camera.distortion(),
    };
    let stream_properties = StreamProperties { intrinsics_pinhole };
    Stream { r#type: "camera", description: description.clone(), stream_properties }
}
