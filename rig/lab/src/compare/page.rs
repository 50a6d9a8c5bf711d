//! The comparison as one self-contained page.

use anyhow::{Context, bail};
use base::library::Entry;
use base::png;
use base::progress::Interrupt;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use drivers::vision::Eye;
use kernel::time::{CLIP_FPS, CLIP_TICKS, TICK_HZ};
use measures::footage::Footage;
use perception::classes::TRAIN_CLASSES;
use serde::Serialize;

use super::super::figures::decimal;
use super::super::looks::{Studio, look};
use super::super::report::{Class, STYLE, Seen, legend};
use super::contest::{Change, Contest};
use super::differing::Differing;
use super::metrics::Metric;
use super::summary::{CaseLine, CheckpointLine, LookLine, Scoreboard};
use super::text::{difference, sight};

const TEMPLATE: &str = include_str!("template.html");

#[derive(Serialize)]
struct Page<'a> {
    style: &'static str,
    version: &'static str,
    summary: &'a Scoreboard,
    frames: usize,
    metrics: Vec<Row>,
    classes: Vec<Row>,
    cases: Vec<CaseRow<'a>>,
    moments: Vec<Moment<'a>>,
    legend: Vec<Class>,
}

/// A figure of every checkpoint, of all but the first with the difference.
#[derive(Serialize)]
struct Row {
    name: &'static str,
    cells: Vec<String>,
}

#[derive(Serialize)]
struct CaseRow<'a> {
    file: &'a str,
    hazard: &'a str,
    looks: Vec<LookCell>,
}

#[derive(Serialize)]
struct LookCell {
    sight: String,
    pedestrian_iou: String,
    verdict: &'static str,
}

/// A frame on which the checkpoints differ.
#[derive(Serialize)]
struct Moment<'a> {
    file: &'a str,
    /// When it is, seen from the end.
    time: String,
    hazard: &'a str,
    pixels: u64,
    pictures: Vec<Picture>,
}

#[derive(Serialize)]
struct Picture {
    name: String,
    class: &'static str,
    png: String,
}

/// The page, with pictures of these frames.
pub fn render(
    summary: &Scoreboard,
    cases: &[Entry],
    (eyes, studio): (&mut [Eye], &mut Studio),
    differing: &[Differing],
    interrupt: &Interrupt,
) -> anyhow::Result<String> {
    let mut seen = Seen::nothing();
    let mut moments = Vec::new();
    for each in differing {
        if interrupt.is_raised() {
            bail!("interrupted before the report; the same command goes on from there");
        }
        moments.push(moment(summary, cases, eyes, each, studio, &mut seen)?);
    }
    let page = Page {
        style: STYLE,
        version: env!("CARGO_PKG_VERSION"),
        summary,
        frames: summary.cases.iter().map(|case| case.frames).sum(),
        metrics: Metric::OWN.iter().chain(&Metric::OF_TRUST).map(|metric| metric_row(summary, *metric)).collect(),
        classes: TRAIN_CLASSES.iter().map(|class| class_row(summary, class.name)).collect(),
        cases: case_rows(summary),
        moments,
        legend: legend(&seen),
    };
    let values = minijinja::Value::from(minijinja::value::Serde(&page));
    minijinja::Environment::new().render_named_str("compare.html", TEMPLATE, values).context("comparison template")
}

fn metric_row(summary: &Scoreboard, metric: Metric) -> Row {
    let cells = |checkpoint: &CheckpointLine| {
        let found = |contest: &Contest| contest.differences.iter().find(|each| each.metric == metric).map(difference);
        let own = decimal(checkpoint.own(metric));
        let against = checkpoint.against_baseline.as_ref();
        std::iter::once(own).chain(against.map(|contest| found(contest).unwrap_or_default())).collect::<Vec<_>>()
    };
    Row { name: metric.title(), cells: summary.checkpoints.iter().flat_map(cells).collect() }
}

fn class_row(summary: &Scoreboard, name: &'static str) -> Row {
    Row { name, cells: summary.checkpoints.iter().map(|each| decimal(each.figures.iou[name])).collect() }
}

fn case_rows(summary: &Scoreboard) -> Vec<CaseRow<'_>> {
    summary.cases.iter().map(case_row).collect()
}

fn case_row(case: &CaseLine) -> CaseRow<'_> {
    let cell = |look: &LookLine| LookCell {
        sight: sight(look),
        pedestrian_iou: decimal(look.figures.pedestrian_iou),
        verdict: look.verdict.map_or("", Change::words),
    };
    CaseRow { file: &case.file, hazard: hazard(case), looks: case.checkpoints.iter().map(cell).collect() }
}

fn hazard(case: &CaseLine) -> &str {
    case.hazard.as_deref().unwrap_or("-")
}

fn moment<'a>(
    summary: &'a Scoreboard,
    cases: &[Entry],
    eyes: &mut [Eye],
    each: &Differing,
    studio: &mut Studio,
    seen: &mut Seen,
) -> anyhow::Result<Moment<'a>> {
    let footage = Footage::read(&cases[each.case].path, CLIP_TICKS, CLIP_FPS)?;
    let scene = &footage.scenes[each.frame];
    let frame = studio.draw(&footage.network, scene)?;
    let masks = look(eyes, &frame)?;
    let picture = |name: &str, class, png: Vec<u8>| Picture { name: name.to_owned(), class, png: STANDARD.encode(png) };
    let mut pictures = vec![picture("camera", "rgb", png::rgb(summary.size, &frame.rgb)?)];
    let names = eyes.iter().map(Eye::name);
    let masks = masks.iter().map(|mask| mask.ids.as_slice());
    for (name, ids) in std::iter::once(("ground truth", frame.class_ids.as_slice())).chain(names.zip(masks)) {
        seen.add(ids);
        pictures.push(picture(name, "mask", png::tags(summary.size, ids)?));
    }
    let before = footage.scenes.last().map_or(0, |last| last.tick - scene.tick);
    let case = &summary.cases[each.case];
    let time = match before {
        0 => "at the end".into(),
        ticks => format!("{:.1} s before the end", ticks as f64 / f64::from(TICK_HZ)),
    };
    Ok(Moment { file: &case.file, time, hazard: hazard(case), pixels: each.pixels, pictures })
}
