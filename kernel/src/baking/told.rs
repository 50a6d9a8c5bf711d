//! What a file says that a map does not keep, for those who show it to people.

use std::collections::BTreeSet;

use super::catalogue::Meaning;
use super::marks::{self, Mark};
use super::signs::Governed;
use super::source::Source;
use crate::map_data::{LaneId, LaneKind, MapData, circles};

/// What tells who goes first at a junction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Control {
    /// Traffic lights.
    Lights,
    /// Who comes into a circle waits.
    Roundabout,
    /// Stop signs.
    Stop,
    /// Signs to give way.
    Yield,
    /// Signs of priority, or records of the file.
    Priority,
    /// Nothing: right before left.
    Right,
    /// Nobody's way meets another's.
    Open,
}

/// What a file says beside its map.
#[derive(Clone, Debug)]
pub struct Told {
    /// Version of OpenDRIVE that the file declares, such as `1.6`; empty without one.
    pub version: String,
    /// What wrote the file, as it says.
    pub vendor: String,
    /// Countries of roads and signals, as the file writes them, in alphabetical order.
    pub countries: Vec<String>,
    /// Roads that have a lane.
    pub roads: usize,
    /// Those of them that lead through junctions.
    pub roads_inside: usize,
    /// What each lane is by its type in OpenDRIVE, by [`LaneId`].
    pub lane_types: Vec<&'static str>,
    /// Driving lanes on the right of the line that their road is measured along, as traffic on the right has them, and
    /// those on the left.
    pub sides: [usize; 2],
    /// What tells who goes first, by junction.
    pub controls: Vec<Control>,
    /// Lanes of each roundabout.
    pub roundabouts: Vec<Vec<LaneId>>,
    /// Painted lines.
    pub marks: Vec<Mark>,
    /// How many of the map's props the file names: the first ones. The others dress the map.
    pub named_props: usize,
}

impl Told {
    /// What the file of a map says.
    pub(super) fn of(source: &Source, map: &MapData, governed: &[Governed], named_props: usize) -> Self {
        let header = source.net.header();
        let version = header.rev_major.map(|major| format!("{major}.{}", header.rev_minor.unwrap_or_default()));
        let roads: BTreeSet<usize> = source.origins.iter().map(|origin| origin.road).collect();
        let is_inside = |road: &&usize| source.net.road(xodr::RoadId(**road)).is_some_and(|r| r.junction().is_some());
        let lane_type = |lane| source.net.lane(lane).map_or("", |lane| lane.kind.as_str());
        let roundabouts: Vec<_> = circles(&map.lanes).into_iter().map(|circle| circle.lanes).collect();
        Self {
            version: version.unwrap_or_default(),
            vendor: header.vendor.clone(),
            countries: countries(source),
            roads_inside: roads.iter().filter(is_inside).count(),
            roads: roads.len(),
            lane_types: source.origins.iter().map(|origin| lane_type(origin.lane)).collect(),
            sides: sides(source, map),
            controls: controls(source, map, governed, &roundabouts),
            roundabouts,
            marks: marks::of(source),
            named_props,
        }
    }
}

fn countries(source: &Source) -> Vec<String> {
    let roads = source.net.road_countries().iter().map(|country| &country.value);
    let signals = source.net.signals().iter().map(|signal| &signal.country);
    let named: BTreeSet<&str> = roads.chain(signals).map(|country| country.trim()).collect();
    named.into_iter().filter(|country| !country.is_empty()).map(str::to_owned).collect()
}

/// Lanes that are driven in one direction, by the side of their road that is meant for it: right, then left.
fn sides(source: &Source, map: &MapData) -> [usize; 2] {
    let mut sides = [0, 0];
    for (lane, origin) in map.lanes.iter().zip(&source.origins) {
        let two_way = source.net.lane(origin.lane).is_some_and(|lane| lane.direction == xodr::Direction::Both);
        if lane.kind == LaneKind::Driving && !two_way {
            sides[usize::from(origin.forward != (origin.od_id < 0))] += 1;
        }
    }
    sides
}

/// What tells who goes first at each junction.
fn controls(source: &Source, map: &MapData, governed: &[Governed], roundabouts: &[Vec<LaneId>]) -> Vec<Control> {
    let round: BTreeSet<LaneId> = roundabouts.iter().flatten().copied().collect();
    let recorded: BTreeSet<usize> = source.net.priorities().iter().flat_map(|p| [p.low.0, p.high.0]).collect();
    let mut signs: Vec<BTreeSet<Control>> = vec![BTreeSet::new(); map.junctions.len()];
    for g in governed {
        let control = match g.meaning {
            Meaning::Stop => Control::Stop,
            Meaning::Yield => Control::Yield,
            Meaning::Priority => Control::Priority,
            Meaning::Light(_) | Meaning::Limit(_) | Meaning::BusStop => continue,
        };
        signs[g.junction as usize].insert(control);
    }
    let control = |(junction, signs): (&crate::map_data::Junction, BTreeSet<Control>)| {
        let lanes = || junction.lanes.iter().map(|&id| (id, &map.lanes[id as usize]));
        let road = |id: LaneId| source.origins[id as usize].road;
        let is_recorded = |id: LaneId| recorded.contains(&road(id));
        if !junction.light_groups.is_empty() {
            Control::Lights
        } else if lanes().any(|(id, _)| round.contains(&id)) {
            Control::Roundabout
        } else if let Some(first) = signs.first() {
            *first
        } else if lanes().any(|(id, lane)| is_recorded(id) || lane.predecessors.iter().any(|&p| is_recorded(p))) {
            Control::Priority
        } else if lanes().any(|(_, lane)| !lane.conflicts.is_empty()) {
            Control::Right
        } else {
            Control::Open
        }
    };
    map.junctions.iter().zip(signs).map(control).collect()
}
