//! How critical a case was over time, as a picture.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use kernel::time::{TICK_HZ, Tick};
use measures::Criticality;
use measures::criticality::{CRITICAL_S, HORIZON_S, Sample, Worst};
use measures::footage::{Footage, decisive_tick};
use serde::Serialize;

use super::super::plot::{Axis, Line, Plot, row};

/// Required decelerations above this are cut off, m/s^2: no tyre gives them.
const HIGHEST_MPS2: f64 = 12.0;
/// What hard braking on dry asphalt gives, m/s^2.
const HARD_BRAKING_MPS2: f64 = 8.0;

/// The picture and what there is to say about it.
#[derive(Serialize)]
pub struct Trace {
    /// An SVG file in base 64.
    svg: String,
    caption: String,
}

/// That of a case; `None` for a recording, and for a case of another kernel.
pub fn of(footage: &Footage) -> Option<Trace> {
    let criticality = Criticality::of_case(&footage.log, &footage.network).ok()??;
    let end = decisive_tick(&footage.log);
    let moment = if footage.log.intervention.is_some() { "takeover" } else { "collision" };
    let svg = STANDARD.encode(picture(&criticality.samples, end, moment));
    let extremes = criticality.lines().into_iter().map(|(name, value)| format!("{name} {value}"));
    let caption = extremes.collect::<Vec<_>>().join("; ");
    Some(Trace { svg, caption })
}

fn picture(samples: &[Sample], end: Tick, moment: &str) -> String {
    let seconds = |tick: Tick| (tick as f64 - end as f64) / f64::from(TICK_HZ);
    let edge = |sample: Option<&Sample>| sample.map_or(0.0, |sample| seconds(sample.tick));
    let (low, high) = (edge(samples.first()), edge(samples.last()));
    let name = format!("seconds from the {moment}");
    let x = Axis { name: &name, low, high: high.max(low + 1.0) };
    let line = |name, colour, of: fn(&Sample) -> &Option<Worst>, highest: f64| {
        let value = |sample| of(sample).as_ref().map_or(f64::NAN, |worst| worst.value.min(highest));
        Line { name, colour, points: samples.iter().map(|sample| (seconds(sample.tick), value(sample))).collect() }
    };
    let level = |name, value| Line { name, colour: "#98a3ae", points: vec![(x.low, value), (x.high, value)] };
    row(&[
        Plot {
            title: "Time left",
            x,
            y: Axis { name: "s", low: 0.0, high: HORIZON_S },
            lines: vec![
                level("critical", CRITICAL_S),
                line("to collision", "#c8102e", |sample| &sample.ttc_s, HORIZON_S),
                line("PET, predicted", "#1f6feb", |sample| &sample.pret_s, HORIZON_S),
            ],
        },
        Plot {
            title: "Braking required",
            x,
            y: Axis { name: "m/s\u{b2}", low: 0.0, high: HIGHEST_MPS2 },
            lines: vec![
                level("hard braking", HARD_BRAKING_MPS2),
                line("not to collide", "#b8860b", |sample| &sample.required_deceleration_mps2, HIGHEST_MPS2),
            ],
        },
    ])
}
