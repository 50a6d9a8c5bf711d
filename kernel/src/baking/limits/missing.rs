//! References to roads, junctions and lanes that the file does not have, where the parser says nothing of them.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::document::children;
use super::place::{place, said};
use crate::baking::notes::{Notes, Passed};

/// What the file has, by ids.
struct Known<'a> {
    /// Roads, with the lanes of all their sections.
    roads: BTreeMap<&'a str, BTreeSet<&'a str>>,
    junctions: BTreeSet<&'a str>,
}

/// Notes every such reference.
pub fn note<'a>(root: Node<'a, 'a>, notes: &mut Notes) {
    if !notes.are_wanted() {
        return;
    }
    let id = |node: Node<'a, 'a>| node.attribute("id");
    let roads = children(root, "road").filter_map(|road| Some((id(road)?, lanes(road))));
    let known = Known { roads: roads.collect(), junctions: children(root, "junction").filter_map(id).collect() };
    for road in children(root, "road") {
        known.of_road(road, notes);
    }
    for junction in children(root, "junction") {
        for connection in children(junction, "connection") {
            known.of_connection(connection, notes);
        }
    }
}

/// The ids of all lanes of a road.
fn lanes<'a>(road: Node<'a, 'a>) -> BTreeSet<&'a str> {
    let sections = children(road, "lanes").flat_map(|lanes| children(lanes, "laneSection"));
    let sides = sections.flat_map(|section| section.children());
    sides.flat_map(|side| children(side, "lane")).filter_map(|lane| lane.attribute("id")).collect()
}

impl<'a> Known<'a> {
    fn of_road(&self, road: Node<'a, 'a>, notes: &mut Notes) {
        let within = road.attribute("junction").filter(|junction| *junction != "-1");
        self.junction(road, within, notes);
        let links = children(road, "link").flat_map(|link| link.children());
        for link in links.filter(|n| n.has_tag_name("predecessor") || n.has_tag_name("successor")) {
            let to = link.attribute("elementId");
            match link.attribute("elementType") {
                Some("junction") => self.junction(link, to, notes),
                _ => self.road(link, to, notes),
            }
        }
    }

    fn of_connection(&self, connection: Node<'a, 'a>, notes: &mut Notes) {
        let [from, through, direct] =
            ["incomingRoad", "connectingRoad", "linkedRoad"].map(|name| connection.attribute(name));
        [from, through, direct].into_iter().for_each(|road| self.road(connection, road, notes));
        for link in children(connection, "laneLink") {
            for (road, lane) in [(from, link.attribute("from")), (through.or(direct), link.attribute("to"))] {
                let (Some(lanes), Some(lane)) = (road.and_then(|road| self.roads.get(road)), lane) else { continue };
                if !lanes.contains(lane.trim()) {
                    let what = || format!("<laneLink> to lane {} of road {}", said(lane), said(road.unwrap_or("")));
                    notes.pass(Passed::Reference, "there is no such lane", what, || place(link));
                }
            }
        }
    }

    fn road(&self, node: Node<'_, '_>, road: Option<&str>, notes: &mut Notes) {
        let Some(road) = road.filter(|road| !self.roads.contains_key(road)) else { return };
        let what = || format!("<{}> to road {}", node.tag_name().name(), said(road));
        notes.pass(Passed::Reference, "there is no such road", what, || place(node));
    }

    fn junction(&self, node: Node<'_, '_>, junction: Option<&str>, notes: &mut Notes) {
        let Some(junction) = junction.filter(|junction| !self.junctions.contains(junction)) else { return };
        let what = || format!("<{}> to junction {}", node.tag_name().name(), said(junction));
        notes.pass(Passed::Reference, "there is no such junction", what, || place(node));
    }
}
