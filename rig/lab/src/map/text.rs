//! The figures of a map in words.

use std::fmt;

use base::say::printable;
use base::words;

use super::figures::{Inspected, Junctions, NotUnderstood, Props};
use super::reach::NAMED;

impl fmt::Display for Inspected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut lines = self.about();
        lines.extend(self.roads());
        lines.extend(self.around());
        match self.not_understood.is_empty() {
            true => lines.push(("passed over", "nothing".into())),
            false => lines.extend(self.not_understood.iter().map(|group| (group.kind, passed_over(group)))),
        }
        let line = |(name, value): &(&str, String)| format!("{name:<12} {}", printable(value));
        f.write_str(&lines.iter().map(line).collect::<Vec<_>>().join("\n"))
    }
}

/// A name and what is said of it.
type Line = (&'static str, String);

impl Inspected {
    fn about(&self) -> Vec<Line> {
        let by = if self.vendor.is_empty() { String::new() } else { format!(" by {}", self.vendor) };
        let version = if self.opendrive.is_empty() { "without a version" } else { &self.opendrive };
        let countries = if self.countries.is_empty() { "none named".into() } else { self.countries.join(", ") };
        let [east_m, north_m] = self.extent_m;
        let relief = &self.relief;
        let steepest = if relief.steepest.is_empty() { String::new() } else { format!(" (lane {})", relief.steepest) };
        vec![
            ("map", format!("{} ({}, OpenDRIVE {version}{by})", self.name, self.file)),
            ("digest", self.digest.clone()),
            ("origin", format!("{} m east and {} m north subtracted", self.origin_m[0], self.origin_m[1])),
            ("country", countries),
            ("traffic", format!("on {}", if self.traffic_side == "both" { "both sides" } else { self.traffic_side })),
            ("extent", format!("{east_m:.1} m from west to east, {north_m:.1} m from south to north")),
            (
                "heights",
                format!(
                    "{:.2} to {:.2} m, gradients up to {:.2} %{steepest}",
                    relief.lowest_m, relief.highest_m, relief.gradient_pct
                ),
            ),
        ]
    }

    fn roads(&self) -> Vec<Line> {
        let mut lines: Vec<Line> = Vec::new();
        for lanes in &self.lanes {
            let what = match lanes.lane_type == lanes.kind {
                true => lanes.kind.to_owned(),
                false => format!("{} (type {})", lanes.kind, lanes.lane_type),
            };
            lines.push(("lanes", format!("{:.3} km {what}, {}", lanes.km, words::count(lanes.count, "lane"))));
        }
        let limits: Vec<String> =
            self.limits.iter().map(|limit| format!("{:.3} km at {} km/h", limit.km, limit.kmh)).collect();
        lines.push(("limits", limits.join(", ")));
        lines.push(("roads", format!("{}, {} of them in junctions", self.roads, self.roads_inside)));
        lines.push(("junctions", junctions(&self.junctions)));
        lines.push(("roundabouts", self.roundabouts.to_string()));
        let reach = &self.reach;
        let reached = match reach.parts {
            1 => "every driving lane leads to every other".to_owned(),
            parts => format!(
                "{parts} parts that do not all lead to each other, {:.3} of {:.3} km outside the largest: {}",
                reach.outside_km,
                reach.km,
                listed(&reach.outside, reach.outside_lanes)
            ),
        };
        lines.push(("reach", reached));
        let ends = match reach.dead_ends {
            0 => "none".to_owned(),
            count => format!("{}: {}", words::count(count, "lane"), listed(&reach.dead_end_lanes, count)),
        };
        lines.push(("dead ends", ends));
        lines
    }

    fn around(&self) -> Vec<Line> {
        let mut lines: Vec<Line> = Vec::new();
        let walkways = &self.walkways;
        lines.push(("crosswalks", format!("{} with lights, {} without", self.crosswalks_lit, self.crosswalks_unlit)));
        lines.push(("walkways", format!("{:.3} km in {}", walkways.km, words::count(walkways.parts, "part"))));
        lines.push(("bus stops", self.bus_stops.to_string()));
        let cars = words::count(self.parking.cars, "parked car");
        lines.push(("parking", format!("{:.3} km of lanes, {cars}", self.parking.lanes_km)));
        let props = self.props.iter().map(|Props { kind, named, made_up }| {
            let all = named + made_up;
            // Furniture is not counted.
            let many = if *kind == "furniture" { format!("{all} {kind}") } else { words::count(all, kind) };
            if *made_up > 0 { format!("{many} ({made_up} made up)") } else { many }
        });
        let props: Vec<String> = props.collect();
        lines.push(("props", if props.is_empty() { "none".into() } else { props.join(", ") }));
        lines
    }
}

fn junctions(junctions: &Junctions) -> String {
    let kinds = [
        (junctions.signals, "with signals"),
        (junctions.roundabout, "of roundabouts"),
        (junctions.stop, "with stop signs"),
        (junctions.give_way, "with signs to give way"),
        (junctions.priority, "with priority"),
        (junctions.right_before_left, "right before left"),
        (junctions.open, "where no ways meet"),
    ];
    let kinds: Vec<String> =
        kinds.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
    match junctions.count {
        0 => "none".to_owned(),
        count => format!("{count}: {}", kinds.join(", ")),
    }
}

/// Names, and whether there are more.
fn listed(names: &[String], count: usize) -> String {
    let more = if names.len() == NAMED && count > NAMED { ", ..." } else { "" };
    format!("{}{more}", names.join(", "))
}

/// A group in a line: `type 283, no subtype, country DE: is in none of the catalogues, 3 times, first at road 5, s 2.0 m`.
fn passed_over(group: &NotUnderstood) -> String {
    let why = if group.why.is_empty() { String::new() } else { format!(": {}", group.why) };
    let times = if group.count == 1 { "once".to_owned() } else { format!("{} times", group.count) };
    let at = match (group.first.is_empty(), group.why.is_empty(), group.count) {
        (true, ..) => String::new(),
        // What the parser says is a sentence.
        (_, true, _) => format!(": {}", group.first),
        (_, _, 1) => format!(", at {}", group.first),
        _ => format!(", first at {}", group.first),
    };
    format!("{}{why}, {times}{at}", group.what)
}
