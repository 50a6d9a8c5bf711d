//! The contents of files in words.

use std::fmt;

use base::say::printable;
use base::words;
use kernel::time::{TICK_HZ, Tick};
use measures::{Criticality, human};

use super::contents::{Contents, Overall};

/// Names and values as lines.
fn paragraph<N: AsRef<str>>(lines: Vec<(N, String)>) -> String {
    let line = |(name, value): &(N, String)| format!("{:<12} {}", printable(name.as_ref()), printable(value));
    let lines: Vec<String> = lines.iter().map(line).collect();
    lines.join("\n")
}

impl fmt::Display for Contents {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&text(self))
    }
}

impl fmt::Display for Overall {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&paragraph(self.tally.lines()))
    }
}

fn text(c: &Contents) -> String {
    let mut lines: Vec<(String, String)> = Vec::new();
    let mut line = |name: &str, value: String| lines.push((name.to_owned(), value));
    let at = |tick: Tick| format!("tick {tick} ({:.2} s)", tick as f64 / f64::from(TICK_HZ));
    line("file", format!("{} ({}, {} bytes)", c.file, c.kind, c.bytes));
    line("map", format!("{}{}", c.figures.map, if c.embedded_map { " (embedded)" } else { "" }));
    line("seed", c.figures.seed.to_string());
    if !c.figures.drawn.is_empty() {
        let values: Vec<String> = c.figures.drawn.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        line("drawn", values.join(", "));
    }
    if let Some(missing) = c.figures.missing.and_then(|missing| missing.of(&c.figures.asked)) {
        line("no room for", missing);
    }
    line("ticks", format!("{} to {}{}", c.first_tick, c.last_tick, if c.finished { "" } else { " (cut off)" }));
    line("driven", format!("{:.3} km, {:.2} min", c.figures.km, c.figures.minutes));
    line("outcome", format!("{} ({})", c.figures.outcome, c.figures.outcome.meaning()));
    line(
        "holds",
        [(c.keyframes, "keyframe"), (c.masks, "mask"), (c.events.len(), "event")]
            .map(|(n, what)| words::count(n, what))
            .join(", "),
    );
    for (name, value) in &c.provenance {
        line(name, value.clone());
    }
    if c.figures.familiarisation {
        line("counts", "no: a drive to get used to the rig".into());
    }
    for (question, answer) in c.questionnaire.answers() {
        line("answer", format!("{question} = {answer}"));
    }
    if let Some(i) = &c.intervention {
        line("takeover", format!("{} at {} km/h", at(i.tick), words::kmh(i.speed_mps.into())));
    }
    let by = match c.figures.perception_caused {
        Some(true) => ", caused by perception",
        Some(false) => ", not caused by perception",
        None => "",
    };
    match (c.figures.label, c.figures.comment.as_deref()) {
        (Some(label), Some(comment)) => line("label", format!("{label}: {comment}{by}")),
        (None, Some(comment)) if !comment.is_empty() => line("comment", comment.to_owned()),
        _ => {}
    }
    if let Some(w) = &c.window {
        line("window", format!("ticks {} to {}, {}", w.from, w.to, words::count(w.scenes, "scene")));
    }
    for e in &c.events {
        line("event", format!("{}: {}", at(e.tick), e.words));
    }
    for n in &c.notes {
        let whose = n.seat.map_or(String::new(), |seat| format!(" ({seat} driver)"));
        line("note", format!("{}: {}{whose}", at(n.tick), n.kind));
    }
    match (&c.measures, &c.unmeasured) {
        (Some(measures), _) => human::lines(measures).into_iter().for_each(|(name, value)| line(name, value)),
        (None, why) => line("measures", format!("none: {}", why.as_deref().unwrap_or_default())),
    }
    for (name, value) in c.criticality.iter().flat_map(Criticality::lines) {
        line(name, value);
    }
    paragraph(lines)
}
