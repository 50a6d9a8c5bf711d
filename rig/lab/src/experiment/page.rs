//! All of an experiment on one page.

use std::path::{Path, PathBuf};

use anyhow::Context;
use base::files::{self, most};
use base::json;
use measures::statistics::CheckpointStatistics;
use serde::Serialize;

use super::pictures::{Shot, name_of, shots};
use super::recipe::Recipe;
use super::set::Set;
use super::stages::Results;
use super::table_1::{Row, Score};
use super::{forest, paper, text};
use crate::campaign::CampaignFigures;
use crate::figures::decimal;
use crate::plot::{Axis, Line, Plot, row};
use crate::report::{Class, STYLE, Seen, legend};

const TEMPLATE: &str = include_str!("template.html");
/// Colours of the three sets' lines.
const COLOURS: [&str; 3] = ["#5d6873", "#1f6feb", "#c8102e"];

#[derive(Serialize)]
struct Page<'a> {
    style: &'static str,
    version: &'static str,
    recipe: &'a Recipe,
    recipe_toml: String,
    pedestrian_cases: usize,
    driving: DrivingPart,
    views: Vec<Shot>,
    table_1: Vec<Line1>,
    forest: Option<String>,
    predictions: Vec<Shot>,
    table_2: Vec<Line2>,
    cases_over_km: String,
    curves: Vec<Curves>,
    made_of: Vec<(String, String)>,
    legend: Vec<Class>,
}

/// The first campaign.
#[derive(Serialize)]
struct DrivingPart {
    km: String,
    cases: u64,
    rate: String,
    legs: String,
    labels: String,
    interventions: String,
}

/// A row of Table 1 beside the paper's.
#[derive(Serialize)]
struct Line1 {
    set: &'static str,
    pixels: String,
    /// IoU of pedestrians and mean IoU, safety-critical then natural: mean, gain with interval, paper's.
    scores: Vec<(String, String, String)>,
    paper_pixels: String,
}

/// A row of Table 2 beside the paper's.
#[derive(Serialize)]
struct Line2 {
    checkpoint: String,
    ours: Vec<String>,
    paper: Vec<String>,
    rate: String,
    against: String,
}

/// How a training went.
#[derive(Serialize)]
struct Curves {
    name: String,
    svg: String,
}

/// The page as HTML.
pub fn render(recipe: &Recipe, results: &Results) -> anyhow::Result<String> {
    let mut seen = Seen::nothing();
    let driving = std::slice::from_ref(&results.driving);
    let page = Page {
        style: STYLE,
        version: env!("CARGO_PKG_VERSION"),
        recipe,
        recipe_toml: recipe.to_toml()?,
        pedestrian_cases: results.training_cases.len() + results.test_cases.len(),
        driving: driving_part(&results.first_campaign)?,
        views: shots(&results.training_cases, driving, (recipe.size, recipe.imaging()), false, &mut seen)?,
        table_1: results.tables.table_1.iter().zip(paper::TABLE_1).map(line_1).collect(),
        forest: forest::picture(&results.tables.table_1),
        predictions: shots(&results.test_cases, &results.networks, (recipe.size, recipe.imaging()), true, &mut seen)?,
        table_2: results.tables.table_2.iter().zip(paper::TABLE_2).map(line_2).collect(),
        cases_over_km: cases_over_km(results),
        curves: driving.iter().chain(&results.networks).map(|c| curves(c)).collect::<Result<_, _>>()?,
        made_of: made_of(results)?,
        legend: legend(&seen),
    };
    let environment = minijinja::Environment::new();
    let values = minijinja::Value::from(minijinja::value::Serde(&page));
    environment.render_named_str("report.html", TEMPLATE, values).context("report template")
}

fn driving_part(figures: &CampaignFigures) -> anyhow::Result<DrivingPart> {
    let of = figures.checkpoints.first().context("a campaign without a checkpoint")?;
    let s = &of.statistics;
    let counts =
        |counts: Vec<(&str, u64)>| counts.iter().map(|(name, n)| format!("{n} {name}")).collect::<Vec<_>>().join(", ");
    Ok(DrivingPart {
        km: format!("{:.1}", s.km),
        cases: s.cases,
        rate: rate(s.cases_per_km, s.cases_per_km_95),
        legs: format!("{:.2}", s.legs.km_mean.unwrap_or(f64::NAN)),
        labels: counts(s.cases_by_label.iter().map(|(name, n)| (*name, *n)).collect()),
        interventions: counts(of.interventions.iter().map(|(name, n)| (*name, u64::from(*n))).collect()),
    })
}

fn rate(value: f64, (low, high): (f64, f64)) -> String {
    format!("{value:.3} [{low:.3}, {high:.3}]")
}

fn line_1((row, paper): (&Row, [f64; 5])) -> Line1 {
    let [paper_pixels, scores @ ..] = paper;
    let ours: [&Score; 4] = [
        &row.safety_critical.pedestrian_iou,
        &row.safety_critical.miou,
        &row.natural.pedestrian_iou,
        &row.natural.miou,
    ];
    let cell = |(score, paper): (&Score, f64)| {
        let gain = if score.gain.is_some() { text::gain(score) } else { String::new() };
        (decimal(score.mean), gain, format!("{paper:.3}"))
    };
    Line1 {
        set: row.set.name(),
        pixels: format!("{:.1}", row.pedestrian_pixels_per_frame),
        scores: ours.into_iter().zip(scores).map(cell).collect(),
        paper_pixels: format!("{paper_pixels:.1}"),
    }
}

fn line_2((ours, paper): (&CheckpointStatistics, [f64; 7])) -> Line2 {
    let s = &ours.statistics;
    let number = |v: Option<f64>| v.map_or("-".into(), |v| format!("{v:.2}"));
    let [km, minutes, cases, km_mean, km_std, minutes_mean, minutes_std] = paper;
    let against = ours.against_reference.as_ref().map(|c| {
        let (ratio, p) = (number(c.ratio), c.p.map_or("-".into(), |p| format!("{p:.3}")));
        let power = c.power.map_or("-".into(), |power| format!("{:.0} %", 100.0 * power));
        let km = c.km_for_power_80.map(|km| format!("; 80 % at {km:.0} km")).unwrap_or_default();
        format!("ratio {ratio} [{:.2}, {:.2}], p = {p}, power {power}{km}", c.ratio_95.0, c.ratio_95.1)
    });
    Line2 {
        checkpoint: ours.checkpoint.clone(),
        ours: vec![
            format!("{:.2}", s.km),
            format!("{:.1}", s.minutes),
            s.cases.to_string(),
            format!("{} ({})", number(s.legs.km_mean), number(s.legs.km_std)),
            format!("{} ({})", number(s.legs.minutes_mean), number(s.legs.minutes_std)),
        ],
        paper: vec![
            format!("{km:.2}"),
            format!("{minutes:.0}"),
            format!("{cases:.0}"),
            format!("{km_mean:.2} ({km_std:.2})"),
            format!("{minutes_mean:.2} ({minutes_std:.2})"),
        ],
        rate: rate(s.cases_per_km, s.cases_per_km_95),
        against: against.unwrap_or_default(),
    }
}

/// Corner cases of the second campaign over the kilometres driven.
fn cases_over_km(results: &Results) -> String {
    let of = |(name, colour): (&'static str, _)| {
        let runs = results.second_campaign.runs.iter().filter(|run| run.checkpoint.starts_with(name));
        let mut points = vec![(0.0, 0.0)];
        let (mut km, mut cases) = (0.0, 0.0);
        for run in runs {
            km += run.figures.km;
            points.push((km, cases));
            if run.case.is_some() {
                cases += 1.0;
                points.push((km, cases));
            }
        }
        Line { name, colour, points }
    };
    let lines: Vec<Line<'_>> = Set::ALL.map(Set::name).into_iter().zip(COLOURS).map(of).collect();
    let ends = lines.iter().filter_map(|line| line.points.last());
    let (km, cases) = ends.fold((1.0f64, 1.0f64), |(km, cases), end| (km.max(end.0), cases.max(end.1)));
    row(&[Plot {
        title: "Second campaign",
        x: Axis { name: "driven, km", low: 0.0, high: km },
        y: Axis { name: "corner cases", low: 0.0, high: cases },
        lines,
    }])
}

fn curves(checkpoint: &Path) -> anyhow::Result<Curves> {
    let path = checkpoint.with_extension("svg");
    let svg = files::read_text(&path, most::TEXT)?;
    Ok(Curves { name: name_of(checkpoint), svg })
}

/// Digests of what the tables follow from.
fn made_of(results: &Results) -> anyhow::Result<Vec<(String, String)>> {
    let digest = |path: &PathBuf| -> anyhow::Result<(String, String)> {
        let bytes = files::read(path, most::NETWORK)?;
        Ok((name_of(path), blake3::hash(&bytes).to_hex().to_string()))
    };
    let networks = std::iter::once(&results.driving).chain(&results.networks).map(digest);
    let datasets = results.datasets.iter().map(|(name, manifest)| Ok((name.clone(), manifest.digest.clone())));
    let tables = json::json_file(&results.tables)?;
    let tables = Ok(("tables.json".to_owned(), blake3::hash(tables.as_bytes()).to_hex().to_string()));
    datasets.chain(networks).chain(std::iter::once(tables)).collect()
}
