//! Statistics as tables.

use std::fmt::Write;

use super::{Comparison, Share, Statistics};

/// The paper's table, then rates by exposure, for each name.
pub fn table<'a>(columns: impl Iterator<Item = (&'a str, &'a Statistics, Option<&'a Comparison>)> + Clone) -> String {
    let width = columns.clone().map(|(name, ..)| name.len()).max().unwrap_or(0).max(10);
    let mut text = format!("{:width$}        km      min  cases    km/CC mean (std)   min/CC mean (std)", "checkpoint");
    for (name, s, _) in columns.clone() {
        let legs = &s.legs;
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "\n{name:width$} {:>9.2} {:>8.1} {:>6} {:>19} {:>19}",
            s.km,
            s.minutes,
            s.cases,
            with_deviation(legs.km_mean, legs.km_std),
            with_deviation(legs.minutes_mean, legs.minutes_std),
        );
    }
    let _ = write!(
        text,
        "\n\nby exposure, unfinished legs included; 95 % intervals and p {}:",
        resting_on(columns.clone())
    );
    for (name, s, comparison) in columns {
        let (low, high) = s.cases_per_km_95;
        let _ = write!(text, "\n{name:width$} {:.3} cases/km [{low:.3}, {high:.3}]", s.cases_per_km);
        if let Some((low, high)) = s.cases_per_km_95_of_rides {
            let _ = write!(text, ", by rides [{low:.3}, {high:.3}]");
        }
        let (low, high) = s.cases_per_min_95;
        let _ = write!(text, "; {:.4} cases/min [{low:.4}, {high:.4}]", s.cases_per_min);
        let labels: Vec<_> = s.cases_by_label.iter().map(|(label, n)| format!("{n} {label}")).collect();
        let _ = write!(text, "; {} by perception", s.perception_caused);
        if !labels.is_empty() {
            let _ = write!(text, "; {}", labels.join(", "));
        }
        if let Some(comparison) = comparison {
            let _ = write!(text, "\n{:width$} {}", "", against(comparison));
        }
        for (seat, shares) in [("semantic", &s.by_semantic_temper), ("safety", &s.by_safety_temper)] {
            let words = |(temper, share): (&&str, &Share)| format!("{temper} {} in {:.1} km", share.cases, share.km);
            let words: Vec<String> = shares.iter().map(words).collect();
            if !words.is_empty() {
                let _ = write!(text, "\n{:width$} {seat} drivers: {}", "", words.join(", "));
            }
        }
    }
    text
}

/// What the intervals rest on; each once.
fn resting_on<'a>(columns: impl Iterator<Item = (&'a str, &'a Statistics, Option<&'a Comparison>)>) -> String {
    let mut words: Vec<&str> = columns.map(|(_, statistics, _)| statistics.sampling.words()).collect();
    words.dedup();
    words.join(", and ")
}

fn with_deviation(mean: Option<f64>, deviation: Option<f64>) -> String {
    match (mean, deviation) {
        (Some(mean), Some(deviation)) => format!("{mean:.2} ({deviation:.2})"),
        (Some(mean), None) => format!("{mean:.2} (-)"),
        _ => "-".into(),
    }
}

fn against(comparison: &Comparison) -> String {
    let Comparison { ratio, ratio_95: (low, high), p, power, km_for_power_80 } = comparison;
    let Some((ratio, p)) = ratio.zip(*p) else { return "no ratio: the reference has no corner case".into() };
    let power = power.map(|power| format!(", power {:.0} %", 100.0 * power)).unwrap_or_default();
    let km = km_for_power_80.map(|km| format!(" (80 % at {km:.0} km)")).unwrap_or_default();
    format!("{ratio:.2} [{low:.2}, {high:.2}] times the reference's rate, p = {p:.3}{power}{km}")
}
