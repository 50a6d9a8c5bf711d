//! The page itself: parts as plain data, put into the template.

use anyhow::Context;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use kernel::time::{TICK_HZ, Tick};
use perception::classes::{TRAIN_CLASSES, train_id};
use perception::{ConfusionMatrix, Mask};
use render::Frame;
use serde::Serialize;

use super::super::figures::{Figures, decimal};
use super::super::footage::Footage;
use super::super::png;
use super::Exposure;
use super::story::{Fact, Story};
use crate::vision::Eye;

const TEMPLATE: &str = include_str!("template.html");

#[derive(Serialize)]
struct Tile {
    name: &'static str,
    value: String,
}

#[derive(Serialize)]
struct Row {
    name: String,
    cells: Vec<String>,
}

#[derive(Serialize)]
struct Class {
    name: &'static str,
    rgb: String,
}

#[derive(Serialize)]
struct Picture {
    png: String,
    caption: String,
}

#[derive(Serialize)]
struct PictureRow {
    name: String,
    class: &'static str,
    cells: Vec<Picture>,
}

/// The pictures of a case, a row for the camera, the truth and each eye.
pub struct Strip {
    last: Tick,
    /// What the last frame shows.
    end: &'static str,
    times: Vec<String>,
    rows: Vec<PictureRow>,
    matrices: Vec<ConfusionMatrix>,
}

impl Strip {
    /// An empty strip for the frames of a window.
    pub fn new(eyes: &[Eye], footage: &Footage) -> Self {
        let last = footage.scenes.last().map_or(0, |scene| scene.tick);
        let end = if footage.log.intervention.is_some() { "takeover" } else { "collision" };
        let row = |name: &str, class| PictureRow { name: name.to_owned(), class, cells: Vec::new() };
        let mut rows = vec![row("camera", "rgb"), row("truth", "mask")];
        rows.extend(eyes.iter().map(|eye| row(eye.name(), "mask")));
        Self { last, end, times: Vec::new(), rows, matrices: vec![ConfusionMatrix::default(); eyes.len()] }
    }

    /// Adds a frame and what each eye made of it.
    pub fn add(&mut self, frame: &Frame, masks: &[Mask]) -> anyhow::Result<()> {
        let size = (frame.width, frame.height);
        let before_s = (self.last - frame.tick) as f64 / f64::from(TICK_HZ);
        self.times.push(if before_s > 0.0 { format!("-{before_s:.1} s") } else { self.end.into() });
        let mut pictures = vec![
            Picture { png: STANDARD.encode(png::rgb(size, &frame.rgb)?), caption: String::new() },
            Picture { png: STANDARD.encode(png::tags(size, &frame.class_ids)?), caption: pedestrian_pixels(frame) },
        ];
        for (mask, sum) in masks.iter().zip(&mut self.matrices) {
            let mut matrix = ConfusionMatrix::default();
            matrix.add(&frame.class_ids, &mask.ids);
            let figures = Figures::from(&matrix);
            let caption = format!("pedestrian {}, mean {}", decimal(figures.pedestrian_iou), decimal(figures.miou));
            pictures.push(Picture { png: STANDARD.encode(png::tags(size, &mask.ids)?), caption });
            sum.merge(&matrix);
        }
        self.rows.iter_mut().zip(pictures).for_each(|(row, picture)| row.cells.push(picture));
        Ok(())
    }

    /// The matrix of each eye over all frames.
    pub fn matrices(&self) -> &[ConfusionMatrix] {
        &self.matrices
    }
}

fn pedestrian_pixels(frame: &Frame) -> String {
    let tag = perception::classes::PEDESTRIAN_TAG;
    format!("{} pedestrian pixels", frame.class_ids.iter().filter(|id| **id == tag).count())
}

/// A case on the page.
#[derive(Serialize)]
pub struct CasePart {
    name: String,
    label: String,
    facts: Vec<Fact>,
    map_svg: String,
    scores: Vec<Row>,
    times: Vec<String>,
    rows: Vec<PictureRow>,
}

impl CasePart {
    /// From what is known and what was drawn.
    pub fn new(name: &str, story: &Story, strip: Strip) -> Self {
        Self {
            name: name.strip_suffix(".case").unwrap_or(name).to_owned(),
            label: story.label.clone(),
            facts: story.facts.clone(),
            map_svg: story.map_svg.clone(),
            scores: score_rows(strip.matrices(), false),
            times: strip.times,
            rows: strip.rows,
        }
    }
}

/// Rows of a table of scores: pedestrian and mean, and on demand every class.
fn score_rows(matrices: &[ConfusionMatrix], every_class: bool) -> Vec<Row> {
    let figures: Vec<Figures> = matrices.iter().map(Figures::from).collect();
    let row = |name: &str, of: &dyn Fn(&Figures) -> Option<f64>| Row {
        name: name.to_owned(),
        cells: figures.iter().map(|f| decimal(of(f))).collect(),
    };
    let mut rows = vec![row("pedestrian", &|f| f.pedestrian_iou), row("mean", &|f| f.miou)];
    if every_class {
        rows.extend(TRAIN_CLASSES.iter().map(|class| row(class.name, &|f| f.iou[class.name])));
    }
    rows
}

/// The whole page.
#[derive(Serialize)]
pub struct Page {
    title: &'static str,
    checkpoints: Vec<String>,
    tiles: Vec<Tile>,
    overall: Vec<Row>,
    legend: Vec<Class>,
    cases: Vec<CasePart>,
}

impl Page {
    /// From its parts.
    pub fn new(eyes: &[Eye], overall: &[ConfusionMatrix], exposure: &Exposure, cases: Vec<CasePart>) -> Self {
        let tile = |name, value| Tile { name, value };
        let mut tiles = vec![tile("corner cases", cases.len().to_string())];
        if exposure.recordings > 0 {
            tiles.push(tile("runs", exposure.recordings.to_string()));
            tiles.push(tile("kilometres", format!("{:.2}", exposure.km)));
            tiles.push(tile("minutes", format!("{:.1}", exposure.minutes)));
            tiles.push(tile("km per corner case", format!("{:.2}", exposure.km / cases.len().max(1) as f64)));
        }
        let class = |tag: &render::SemanticTag| {
            let [r, g, b] = tag.colour();
            train_id(*tag as u8).map(|_| Class { name: tag.name(), rgb: format!("{r}, {g}, {b}") })
        };
        Self {
            title: "A-Eye: corner cases",
            checkpoints: eyes.iter().map(|eye| eye.name().to_owned()).collect(),
            tiles,
            overall: score_rows(overall, true),
            legend: render::tags::TAGS.iter().filter_map(class).collect(),
            cases,
        }
    }

    /// The page as HTML.
    pub fn render(&self) -> anyhow::Result<String> {
        let environment = minijinja::Environment::new();
        let values = minijinja::Value::from(minijinja::value::Serde(self));
        environment.render_named_str("report.html", TEMPLATE, values).context("report template")
    }
}
