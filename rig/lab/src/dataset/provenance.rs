//! `frames.jsonl`: a line for each frame of a dataset says where it comes from.

use std::collections::BTreeMap;

use anyhow::anyhow;
use base::files::check_name;
use base::json::{Typed, json_line};
use drivers::vision::named_camera_text;
use kernel::SceneSnapshot;
use kernel::scene::Weather;
use kernel::time::Tick;
use perception::cityscapes::{Kind, Place};
use perception::classes::{PEDESTRIAN, TRAIN_CLASSES, train_id};
use render::Frame;
use serde::{Deserialize, Serialize};

use super::views::View;
use crate::cityscapes;

/// A frame's provenance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrameLine {
    /// The picture, below the dataset's folder.
    pub image: String,
    /// Its train ids, below the dataset's folder.
    pub labels: String,
    /// `train`, `val` or `test`.
    pub split: String,
    /// The map, as it stands in file names.
    pub map: String,
    /// Number of the scene within its split.
    pub scene: u32,
    /// Number of the frame within its scene.
    pub frame: u32,
    /// Name of the camera that took it, in datasets of several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera_name: Option<String>,
    /// Where a mix has it from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<Part>,
    /// BLAKE3 of the recording of the drive: of a corner case the one that it was cut from, of natural
    /// frames the one below `drives`.
    pub recording: String,
    /// The drive's seed.
    pub seed: u64,
    /// Tick of the drive.
    pub tick: Tick,
    /// Low 32 bits of the hash of the world's state at that tick; none for the first tick of a case.
    pub state_hash: Option<String>,
    /// The drive's weather.
    pub weather: WeatherLine,
    /// What the corner case was labelled as.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
    /// Which camera, size and quality of its picture, what its sensor does, and whose models stand in it.
    pub camera: String,
    /// Version of the renderer.
    pub renderer: String,
    /// The graphics adapter and its driver.
    pub adapter: String,
    /// Pixels of each class that counts; those that are not in the picture are left out.
    pub class_pixels: BTreeMap<String, u64>,
    /// BLAKE3 over the picture's bytes, before they are compressed.
    pub rgb_digest: String,
    /// BLAKE3 over label ids (a byte a pixel) and instance ids (two, low one first).
    pub labels_digest: String,
}

/// A line of `frames.jsonl`.
impl Typed for FrameLine {
    const TYPE: &'static str = "aeye.dataset.frame";
}

/// Weather as it is written.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WeatherLine {
    /// Share of the sky under clouds, percent.
    pub cloudiness_pct: f32,
    /// Wind in percent of a storm.
    pub wind_pct: f32,
    /// Height of the sun, degrees.
    pub sun_altitude_deg: f32,
    /// Direction to the sun, degrees counter-clockwise from east.
    pub sun_azimuth_deg: f32,
    /// Rain in percent of a cloudburst.
    #[serde(default)]
    pub precipitation_pct: f32,
    /// Water that stands on the road, percent.
    #[serde(default)]
    pub puddles_pct: f32,
    /// How wet surfaces are, percent.
    #[serde(default)]
    pub wetness_pct: f32,
    /// Fog in percent of one in which one sees 50 m.
    #[serde(default)]
    pub fog_density_pct: f32,
    /// Where the fog begins, metres from the eye.
    #[serde(default)]
    pub fog_distance_m: f32,
}

impl From<Weather> for WeatherLine {
    fn from(w: Weather) -> Self {
        Self {
            cloudiness_pct: w.cloudiness_pct,
            wind_pct: w.wind_pct,
            sun_altitude_deg: w.sun_altitude_deg,
            sun_azimuth_deg: w.sun_azimuth_deg,
            precipitation_pct: w.precipitation_pct,
            puddles_pct: w.puddles_pct,
            wetness_pct: w.wetness_pct,
            fog_density_pct: w.fog_density_pct,
            fog_distance_m: w.fog_distance_m,
        }
    }
}

/// The datasets that a mix is made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Part {
    /// The one whose frames are replaced.
    Natural,
    /// Drives among more people.
    Pool,
    /// Corner cases.
    Cases,
}

/// The drive that frames come from.
pub(super) struct Drive<'a> {
    /// BLAKE3 of its recording.
    pub recording: String,
    pub seed: u64,
    pub label: Option<&'a str>,
}

impl FrameLine {
    /// That of a frame drawn just now by an adapter from a scene of a drive.
    pub(super) fn new(
        place: &Place<'_>,
        (frame, view): (&Frame, &View),
        (scene, state_hash): (&SceneSnapshot, Option<u32>),
        drive: &Drive<'_>,
        adapter: &str,
    ) -> Self {
        Self {
            image: place.path(Kind::Image),
            labels: place.path(Kind::TrainIds),
            split: place.split.to_owned(),
            map: place.city.to_owned(),
            scene: place.scene,
            frame: place.frame,
            camera_name: view.name.clone(),
            part: None,
            recording: drive.recording.clone(),
            seed: drive.seed,
            tick: frame.tick,
            state_hash: state_hash.map(|hash| format!("{hash:08x}")),
            weather: scene.weather.into(),
            label: drive.label.map(str::to_owned),
            camera: named_camera_text(view.name.as_deref().unwrap_or("driver"), &view.camera),
            renderer: render::identity(),
            adapter: adapter.to_owned(),
            class_pixels: class_pixels(&frame.class_ids),
            rgb_digest: blake3::hash(&frame.rgb).to_hex().to_string(),
            labels_digest: labels_digest(&frame.class_ids, &cityscapes::instances(frame)),
        }
    }

    fn parse(text: &str) -> anyhow::Result<Self> {
        let line: Self = serde_json::from_str(text)?;
        let names = [&line.split, &line.map].into_iter().chain(&line.camera_name);
        names.into_iter().try_for_each(|name| check_name(name)).map_err(|reason| anyhow!(reason))?;
        Ok(line)
    }

    /// Where its files lie.
    pub(super) fn place(&self) -> Place<'_> {
        let camera = self.camera_name.as_deref();
        Place { split: &self.split, city: &self.map, scene: self.scene, frame: self.frame, camera }
    }

    /// Pixels that show pedestrians.
    pub fn pedestrian_pixels(&self) -> u64 {
        self.class_pixels.get(TRAIN_CLASSES[PEDESTRIAN].name).copied().unwrap_or(0)
    }
}

/// BLAKE3 over what the files of label and instance ids hold, in hexadecimal digits.
pub(super) fn labels_digest(label_ids: &[u8], instance_ids: &[u16]) -> String {
    let mut digest = blake3::Hasher::new();
    digest.update(label_ids);
    let bytes: Vec<u8> = instance_ids.iter().flat_map(|id| id.to_le_bytes()).collect();
    digest.update(&bytes).finalize().to_hex().to_string()
}

fn class_pixels(tags: &[u8]) -> BTreeMap<String, u64> {
    let mut pixels = [0; TRAIN_CLASSES.len()];
    tags.iter().filter_map(|tag| train_id(*tag)).for_each(|id| pixels[usize::from(id)] += 1);
    let named = TRAIN_CLASSES.iter().zip(pixels).filter(|(_, count)| *count > 0);
    named.map(|(class, count)| (class.name.to_owned(), count)).collect()
}

/// Lines as they stand in the file.
pub(super) fn text(lines: &[FrameLine]) -> anyhow::Result<String> {
    lines.iter().map(|line| Ok(json_line(line)? + "\n")).collect()
}

/// The lines of such a text.
pub(super) fn parse(text: &str) -> anyhow::Result<Vec<FrameLine>> {
    text.lines().map(FrameLine::parse).collect()
}
