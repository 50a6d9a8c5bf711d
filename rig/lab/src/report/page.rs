//! The page itself: parts as plain data, put into the template.

use anyhow::Context;
use drivers::vision::Eye;
use kernel::time::CLIP_FPS;
use measures::Tally;
use measures::stats::Spread;
use perception::ConfusionMatrix;
use perception::classes::{TRAIN_CLASSES, train_id};
use serde::Serialize;

use super::super::figures::{Figures, decimal};
use super::exposure::Exposure;
use super::fact::Fact;
use super::story::Story;
use super::strip::{Moment, PictureRow, Seen, Strip};
use super::trace::Trace;

const TEMPLATE: &str = include_str!("template.html");
/// How all pages look.
pub const STYLE: &str = include_str!("style.css");

#[derive(Serialize)]
struct Tile {
    name: &'static str,
    value: String,
}

/// A checkpoint that is looked through.
#[derive(Serialize)]
struct Checkpoint {
    name: String,
    digest: String,
}

/// A row of a table of scores.
#[derive(Serialize)]
struct Row {
    name: &'static str,
    /// Share of the pixels of the ground truth; empty for means.
    share: String,
    cells: Vec<String>,
}

/// A class in the legend.
#[derive(Serialize)]
pub struct Class {
    name: &'static str,
    rgb: String,
    scored: bool,
}

/// The classes that appear in pictures, in their colours.
pub fn legend(seen: &Seen) -> Vec<Class> {
    let class = |tag: &render::SemanticTag| {
        let [r, g, b] = tag.colour();
        let scored = train_id(*tag as u8).is_some();
        seen.has(*tag as u8).then(|| Class { name: tag.name(), rgb: format!("{r}, {g}, {b}"), scored })
    };
    render::tags::TAGS.iter().filter_map(class).collect()
}

/// A case on the page.
#[derive(Serialize)]
pub struct CasePart {
    name: String,
    label: String,
    comment: String,
    facts: Vec<Fact>,
    map_svg: String,
    trace: Option<Trace>,
    scores: Vec<Row>,
    moments: Vec<Moment>,
    rows: Vec<PictureRow>,
}

impl CasePart {
    /// From what is known and what was drawn.
    pub fn new(name: &str, story: Story, strip: Strip, trace: Option<Trace>) -> Self {
        Self {
            name: name.strip_suffix(".case").unwrap_or(name).to_owned(),
            label: story.label,
            comment: story.comment,
            facts: story.facts,
            map_svg: story.map_svg,
            trace,
            scores: score_rows(strip.matrices(), false),
            moments: strip.moments,
            rows: strip.rows,
        }
    }
}

/// Rows of a table of scores: the mean and pedestrians, or the mean and every class.
fn score_rows(matrices: &[ConfusionMatrix], every_class: bool) -> Vec<Row> {
    let figures: Vec<Figures> = matrices.iter().map(Figures::from).collect();
    let row = |name, share, of: &dyn Fn(&Figures) -> Option<f64>| Row {
        name,
        share,
        cells: figures.iter().map(|f| decimal(of(f))).collect(),
    };
    let share = |id: usize| {
        let matrix = matrices.first()?;
        Some(100.0 * matrix.truth_pixels(id as u8) as f64 / matrix.scores().pixels as f64)
    };
    let class = |(id, class): (usize, &perception::classes::TrainClass)| {
        let share = share(id).map_or(String::new(), |percent| format!("{percent:.2}"));
        row(class.name, share, &|f| f.iou[class.name])
    };
    let mean = row("mean", String::new(), &|f| f.miou);
    if every_class {
        std::iter::once(mean).chain(TRAIN_CLASSES.iter().enumerate().map(class)).collect()
    } else {
        vec![mean, row("Pedestrian", String::new(), &|f| f.pedestrian_iou)]
    }
}

/// The whole page.
#[derive(Serialize)]
pub struct Page {
    style: &'static str,
    version: &'static str,
    fps: u32,
    /// Of the pictures, as in `256x128`.
    size: String,
    checkpoints: Vec<Checkpoint>,
    tiles: Vec<Tile>,
    overall: Vec<Row>,
    legend: Vec<Class>,
    cases: Vec<CasePart>,
}

impl Page {
    /// From its parts; `seen` is what appears in any picture.
    pub fn new(
        eyes: &[Eye],
        (width, height): (u32, u32),
        overall: &[ConfusionMatrix],
        seen: &Seen,
        (exposure, tally): (&Exposure, &Tally),
        cases: Vec<CasePart>,
    ) -> Self {
        let tile = |name, value| Tile { name, value };
        let mut tiles = vec![tile("corner cases", cases.len().to_string())];
        if exposure.recordings > 0 {
            tiles.push(tile("runs", exposure.recordings.to_string()));
            tiles.push(tile("kilometres driven", format!("{:.2}", exposure.km)));
            tiles.push(tile("minutes driven", format!("{:.1}", exposure.minutes)));
            tiles.push(tile("km per corner case", format!("{:.2}", exposure.km / cases.len().max(1) as f64)));
        }
        if tally.labelled > 0 {
            tiles.push(tile("takeovers out of boredom", format!("{} of {}", tally.boredom, tally.labelled)));
        }
        if let Some(Spread { median, n, .. }) = tally.intervention_ms {
            tiles.push(tile("median from hazard to takeover", format!("{median:.0} ms (n = {n})")));
        }
        let checkpoint = |eye: &Eye| Checkpoint { name: eye.name().to_owned(), digest: eye.digest() };
        Self {
            style: STYLE,
            version: env!("CARGO_PKG_VERSION"),
            fps: CLIP_FPS,
            size: format!("{width}x{height}"),
            checkpoints: eyes.iter().map(checkpoint).collect(),
            tiles,
            overall: score_rows(overall, true),
            legend: legend(seen),
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
