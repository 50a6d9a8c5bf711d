//! The page itself: parts as plain data, put into the template.

use anyhow::Context;
use drivers::vision::Eye;
use kernel::time::CLIP_FPS;
use measures::Tally;
use measures::statistics::{Group, Ride};
use measures::stats::Spread;
use perception::ConfusionMatrix;
use perception::classes::{TRAIN_CLASSES, train_id};
use serde::Serialize;

use super::super::figures::{Figures, decimal};
use super::fact::Fact;
use super::story::Story;
use super::strip::{Moment, PictureRow, Seen, Strip};
use super::trace::Trace;

const TEMPLATE: &str = include_str!("template.html");
/// How all pages look.
pub const STYLE: &str = include_str!("style.css");

#[derive(Serialize)]
struct Tile {
    name: String,
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

/// The figures at the top. Kilometres and the corner cases that they are divided by are those of the same
/// rides, however many cases are shown, and of each checkpoint for itself.
fn tiles(shown: usize, driven: &[Group], tally: &Tally) -> Vec<Tile> {
    let mut tiles = Vec::new();
    let mut tile = |name: &str, value| tiles.push(Tile { name: name.to_owned(), value });
    tile("corner cases shown", shown.to_string());
    if !driven.is_empty() {
        tile("runs", rides(driven).count().to_string());
        tile("kilometres driven", format!("{:.2}", km(rides(driven))));
        tile("minutes driven", format!("{:.1}", rides(driven).map(|ride| ride.minutes).sum::<f64>()));
        tile("corner cases in these runs", cases(rides(driven)).to_string());
    }
    for group in driven {
        let through = if driven.len() > 1 { format!(" ({})", group.checkpoint) } else { String::new() };
        tile(&format!("km per corner case of these runs{through}"), km_per_case(&group.rides));
    }
    if tally.labelled > 0 {
        tile("takeovers out of boredom", format!("{} of {}", tally.boredom, tally.labelled));
    }
    if let Some(Spread { median, n, .. }) = tally.intervention_ms {
        tile("median from hazard to takeover", format!("{median:.0} ms (n = {n})"));
    }
    tiles
}

fn rides(driven: &[Group]) -> impl Iterator<Item = &Ride> {
    driven.iter().flat_map(|group| &group.rides)
}

fn km<'a>(rides: impl Iterator<Item = &'a Ride>) -> f64 {
    rides.map(|ride| ride.km).sum()
}

fn cases<'a>(rides: impl Iterator<Item = &'a Ride>) -> usize {
    rides.filter(|ride| ride.is_case).count()
}

fn km_per_case(rides: &[Ride]) -> String {
    match cases(rides.iter()) {
        0 => "-".into(),
        cases => format!("{:.2}", km(rides.iter()) / cases as f64),
    }
}

/// What the tiles count, in a sentence.
fn beside(shown: usize, driven: &[Group]) -> String {
    if driven.is_empty() {
        return String::new();
    }
    let each = if driven.len() > 1 {
        "; kilometres a case are told of each checkpoint that they were driven with"
    } else {
        ""
    };
    let selection = if shown < cases(rides(driven)) { "; those shown are a selection of them" } else { "" };
    format!(
        "Runs, kilometres, minutes and their corner cases are those of all recordings in the folders that were given \
         and beside the cases that were given{each}{selection}."
    )
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
    /// What the tiles count; empty where no recordings lie beside the cases.
    beside: String,
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
        (driven, tally): (&[Group], &Tally),
        cases: Vec<CasePart>,
    ) -> Self {
        let checkpoint = |eye: &Eye| Checkpoint { name: eye.name().to_owned(), digest: eye.digest() };
        Self {
            style: STYLE,
            version: env!("CARGO_PKG_VERSION"),
            fps: CLIP_FPS,
            size: format!("{width}x{height}"),
            checkpoints: eyes.iter().map(checkpoint).collect(),
            tiles: tiles(cases.len(), driven, tally),
            beside: beside(cases.len(), driven),
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
