//! Elements of a file that nothing here reads: those of the standard that have no place in a map, and those of others.

use roxmltree::Node;

use super::place::place;
use crate::baking::notes::{Notes, Passed};

/// The elements that are read, by those that they are in.
const READ: [(&str, &[&str]); 48] = [
    ("OpenDRIVE", &["header", "road", "junction", "controller"]),
    ("header", &["defaultRegulations"]),
    ("defaultRegulations", &["roadRegulations"]),
    ("roadRegulations", &["semantics"]),
    ("road", &["link", "type", "planView", "elevationProfile", "lateralProfile", "lanes", "objects", "signals"]),
    ("link", &["predecessor", "successor"]),
    // That of a road, and that of a road mark.
    ("type", &["speed", "line"]),
    ("planView", &["geometry"]),
    ("geometry", &["line", "arc", "spiral", "poly3", "paramPoly3"]),
    ("elevationProfile", &["elevation"]),
    ("lateralProfile", &["superelevation", "shape", "crossfall", "crossSectionSurface"]),
    ("crossSectionSurface", &["tOffset", "surfaceStrips"]),
    ("tOffset", &["coefficients"]),
    ("surfaceStrips", &["strip"]),
    ("strip", &["width", "constant", "linear", "quadratic", "cubic"]),
    ("width", &["coefficients"]),
    ("constant", &["coefficients"]),
    ("linear", &["coefficients"]),
    ("quadratic", &["coefficients"]),
    ("cubic", &["coefficients"]),
    ("lanes", &["laneOffset", "laneSection"]),
    ("laneSection", &["left", "center", "right"]),
    ("left", &["lane"]),
    ("center", &["lane"]),
    ("right", &["lane"]),
    ("lane", &["link", "width", "border", "roadMark", "height", "speed", "material"]),
    ("roadMark", &["type", "explicit", "sway"]),
    ("explicit", &["line"]),
    ("objects", &["object", "objectReference", "bridge", "tunnel"]),
    ("object", &["repeat", "outlines", "outline"]),
    ("bridge", &["validity"]),
    ("tunnel", &["validity"]),
    ("outlines", &["outline"]),
    ("outline", &["cornerRoad", "cornerLocal", "curveLocal"]),
    ("curveLocal", &["line", "arc", "paramPoly3"]),
    ("signals", &["signal", "signalReference"]),
    ("signal", &["validity", "positionRoad", "positionInertial", "semantics"]),
    ("semantics", &["speed"]),
    ("signalReference", &["validity"]),
    ("controller", &["control"]),
    ("junction", &["connection", "priority", "controller", "planView", "objects", "elevationGrid", "boundary"]),
    ("connection", &["laneLink"]),
    ("elevationGrid", &["elevation"]),
    ("boundary", &["segment"]),
    // They hold nothing.
    ("predecessor", &[]),
    ("successor", &[]),
    ("speed", &[]),
    ("laneLink", &[]),
];

/// Notes every element that is not read, and does not look into it.
pub fn note(root: Node<'_, '_>, notes: &mut Notes) {
    if !notes.are_wanted() {
        return;
    }
    let mut open = vec![root];
    while let Some(node) = open.pop() {
        let parent = node.tag_name().name();
        let read = READ.iter().find(|(of, _)| *of == parent).map_or(&[][..], |(_, read)| read);
        let mut inside = Vec::new();
        for child in node.children().filter(Node::is_element) {
            let name = child.tag_name().name();
            if read.contains(&name) {
                inside.push(child);
            } else {
                notes.pass(Passed::Element, "is not read", || format!("<{name}> in <{parent}>"), || place(child));
            }
        }
        // In the order of the file, so that the first place is the first one.
        open.extend(inside.into_iter().rev());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_read_is_told_once_with_its_place_and_not_looked_into() {
        let text = "<OpenDRIVE><header><geoReference/></header><road id=\"4\"><objects><station><userData/></station>\
                    <object id=\"1\"/></objects></road><road id=\"5\"><objects><station/></objects><lanes/></road>\
                    <station/></OpenDRIVE>";
        let document = roxmltree::Document::parse(text).expect("XML");
        let mut notes = Notes::wanted();
        note(document.root_element(), &mut notes);
        let told: Vec<_> = notes.finish().into_iter().map(|g| (g.what, g.count, g.first)).collect();
        let expected = [
            ("<station> in <objects>", 2, "road 4"),
            ("<geoReference> in <header>", 1, "line 1"),
            ("<station> in <OpenDRIVE>", 1, "line 1"),
        ];
        assert_eq!(told, expected.map(|(what, count, first)| (what.to_owned(), count, first.to_owned())));
    }
}
