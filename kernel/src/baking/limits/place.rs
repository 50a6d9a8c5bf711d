//! Where in a file something stands, and what is wrong with it.

use std::collections::BTreeSet;

use roxmltree::Node;

use crate::baking::error::BakeError;

/// Characters of an id that are said.
const SAID: usize = 40;

/// The refusal of what stands at `node`.
pub fn refused(node: Node<'_, '_>, reason: String) -> BakeError {
    BakeError { place: place(node), reason }
}

/// The road, section and lane that hold a node, or the junction; else its line. Of those inside each other the inmost.
pub fn place(node: Node<'_, '_>) -> String {
    let mut kinds = BTreeSet::new();
    let mut around: Vec<_> = node.ancestors().filter(|n| kinds.insert(n.tag_name().name())).filter_map(name).collect();
    around.reverse();
    match around.as_slice() {
        [] => format!("line {}", node.document().text_pos_at(node.range().start).row),
        names => names.join(", "),
    }
}

fn name(node: Node<'_, '_>) -> Option<String> {
    let named = |what: &str| Some(format!("{what} {}", said(node.attribute("id").unwrap_or("without an id"))));
    match node.tag_name().name() {
        "road" => named("road"),
        "laneSection" => {
            let before = node.prev_siblings().skip(1).filter(|n| n.has_tag_name("laneSection")).count();
            Some(format!("section {before}"))
        }
        "lane" => named("lane"),
        "junction" => named("junction"),
        "connection" => named("connection"),
        "object" => named("object"),
        "signal" => named("signal"),
        _ => None,
    }
}

/// A text of the file, fit for one line.
pub fn said(text: &str) -> String {
    if text.trim().is_empty() {
        return "nothing".to_owned();
    }
    let mut said: String = text.chars().take(SAID).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.chars().nth(SAID).is_some() {
        said.push_str("...");
    }
    said
}
