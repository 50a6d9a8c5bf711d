//! Gains with their intervals, as a picture (a forest plot).

use std::fmt::Write;

use super::table_1::{Row, Score};

/// Width of names on the left and of figures on the right, pixels.
const NAMES_PX: f64 = 330.0;
const FIGURES_PX: f64 = 170.0;
/// Width of the axis, pixels.
const AXIS_PX: f64 = 420.0;
/// Height of a line, pixels.
const LINE_PX: f64 = 22.0;
/// Room above and below, pixels.
const MARGIN_PX: f64 = 26.0;

/// A gain against natural data.
struct Gain {
    name: String,
    value: f64,
    interval: (f64, f64),
}

/// The gains of a table's rows as SVG; `None` where there is nothing to show.
pub fn picture(rows: &[Row]) -> Option<String> {
    let gains: Vec<Gain> = rows.iter().flat_map(gains).collect();
    let widest = gains.iter().flat_map(|g| [g.interval.0.abs(), g.interval.1.abs()]).fold(0.0, f64::max);
    if gains.is_empty() || widest <= 0.0 {
        return None;
    }
    let step = step(widest);
    let limit = step * (widest / step).ceil();
    let (width, height) = (NAMES_PX + AXIS_PX + FIGURES_PX, 2.0 * MARGIN_PX + LINE_PX * gains.len() as f64);
    let x = |value: f64| NAMES_PX + AXIS_PX * 0.5 * (1.0 + value / limit);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"system-ui, sans-serif\" font-size=\"12\">"
    );
    let steps = (limit / step).round() as i32;
    let digits = (-step.log10() - 1e-9).ceil().max(0.0) as usize;
    // Writing to a string cannot fail.
    for i in -steps..=steps {
        let (at, bottom) = (x(f64::from(i) * step), height - MARGIN_PX);
        let ink = if i == 0 { "#5d6873" } else { "#dde2e7" };
        let _ =
            write!(svg, "<line x1=\"{at:.1}\" x2=\"{at:.1}\" y1=\"{MARGIN_PX}\" y2=\"{bottom}\" stroke=\"{ink}\"/>");
        let (text, below) = (f64::from(i) * step, bottom + 16.0);
        let _ = write!(svg, "<text x=\"{at:.1}\" y=\"{below}\" text-anchor=\"middle\">{text:+.digits$}</text>");
    }
    for (i, gain) in gains.iter().enumerate() {
        let y = MARGIN_PX + LINE_PX * (i as f64 + 0.5);
        let (low, high) = gain.interval;
        let _ = write!(
            svg,
            "<text x=\"0\" y=\"{:.1}\">{}</text>\
             <line x1=\"{:.1}\" x2=\"{:.1}\" y1=\"{y:.1}\" y2=\"{y:.1}\" stroke=\"#1f6feb\" stroke-width=\"2\"/>\
             <circle cx=\"{:.1}\" cy=\"{y:.1}\" r=\"4.5\" fill=\"#1f6feb\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\">{:+.3} [{low:+.3}, {high:+.3}]</text>",
            y + 4.0,
            gain.name,
            x(low),
            x(high),
            x(gain.value),
            NAMES_PX + AXIS_PX + 14.0,
            y + 4.0,
            gain.value,
        );
    }
    svg += "</svg>";
    Some(svg)
}

fn gains(row: &Row) -> Vec<Gain> {
    let tests = [("safety-critical", &row.safety_critical), ("natural", &row.natural)];
    let named = |what: &str, test: &str, score: &Score| {
        let (value, interval) = score.gain.zip(score.gain_95)?;
        Some(Gain { name: format!("{}: {what}, {test} frames", row.set.name()), value, interval })
    };
    let of = |(test, scores): (&str, &super::table_1::TestScores)| {
        [named("IoU pedestrian", test, &scores.pedestrian_iou), named("mean IoU", test, &scores.miou)]
    };
    tests.into_iter().flat_map(of).flatten().collect()
}

/// A round step of which one to five reach so far.
fn step(widest: f64) -> f64 {
    let power = 10f64.powf(widest.log10().floor());
    [0.2, 0.5, 1.0].map(|n| n * power).into_iter().find(|step| widest / step <= 5.0).unwrap_or(2.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_to_five_steps_reach_the_widest() {
        for widest in [0.003, 0.01, 0.049, 0.1, 0.23, 0.5, 0.77, 1.0] {
            assert!((1.0..=5.0).contains(&(widest / step(widest))), "{widest}");
        }
    }
}
