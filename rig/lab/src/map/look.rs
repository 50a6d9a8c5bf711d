//! Bakes a map and puts what is in it into figures.

use anyhow::Context;
use base::maps;
use kernel::map::{Baked, Passed, PassedOver, bake_with_notes};

use super::figures::{Inspected, NotUnderstood};
use super::{measure, reach};

/// What is in a map, which is named as everywhere: a bundled one or a file.
pub fn inspect(name: &str) -> anyhow::Result<Inspected> {
    Ok(figures(name, baked(name)?))
}

/// A map with all that its file says.
pub(super) fn baked(name: &str) -> anyhow::Result<Baked> {
    let (stem, text) = maps::text_of(name)?;
    bake_with_notes(&stem, &text).with_context(|| name.to_owned())
}

fn figures(file: &str, baked: Baked) -> Inspected {
    let Baked { map, told, passed_over } = &baked;
    let lit = map.crosswalks.iter().filter(|crosswalk| crosswalk.junction.is_some()).count();
    Inspected {
        file: file.to_owned(),
        name: map.name.clone(),
        digest: format!("{:032x}", map.digest),
        opendrive: told.version.clone(),
        vendor: told.vendor.clone(),
        origin_m: map.origin_m,
        countries: told.countries.clone(),
        traffic_side: match told.sides {
            [_, 0] => "right",
            [0, _] => "left",
            _ => "both",
        },
        extent_m: measure::extent_m(map),
        relief: measure::relief(map),
        lanes: measure::lanes(map, told),
        limits: measure::limits(map),
        roads: told.roads,
        roads_inside: told.roads_inside,
        junctions: measure::junctions(told),
        roundabouts: told.roundabouts.len(),
        crosswalks_lit: lit,
        crosswalks_unlit: map.crosswalks.len() - lit,
        bus_stops: map.bus_stops.len(),
        parking: measure::parking(map),
        props: measure::props(map, told),
        walkways: reach::walkways(map),
        reach: reach::of(map),
        not_understood: passed_over.iter().map(not_understood).collect(),
    }
}

fn not_understood(group: &PassedOver) -> NotUnderstood {
    let PassedOver { kind, what, why, count, first } = group.clone();
    let kind = match kind {
        Passed::Warning => "warning",
        Passed::Reference => "reference",
        Passed::Signal => "signal",
        Passed::Object => "object",
        Passed::Lane => "lane",
        Passed::RoadMark => "road mark",
        Passed::Surface => "surface",
        Passed::Element => "element",
    };
    NotUnderstood { kind, what, why, count, first }
}
