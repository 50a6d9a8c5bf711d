//! The text of a file as a tree.

use roxmltree::{Document, Error, Node, ParsingOptions};

use super::constants::{ATTRIBUTES, FILE_BYTES, NODES};
use crate::baking::error::BakeError;

/// The children of an element with some tag.
pub fn children<'a>(node: Node<'a, 'a>, tag: &'static str) -> impl Iterator<Item = Node<'a, 'a>> + Clone {
    node.children().filter(move |n| n.has_tag_name(tag))
}

/// The text without what some programs write before the XML declaration, and without that.
pub fn body(text: &str) -> Result<std::borrow::Cow<'_, str>, BakeError> {
    if text.len() > FILE_BYTES {
        return whole(format!("expected at most {} MiB, but it has {}", FILE_BYTES >> 20, text.len() >> 20));
    }
    let text = text.trim_start_matches('\u{feff}');
    let declaration = text.find("<?xml").filter(|&at| is_comments(&text[..at]));
    let end = declaration.and_then(|at| Some(at + text[at..].find("?>")? + 2));
    Ok(match (declaration, end) {
        (Some(at), Some(end)) => format!("{}{}", &text[..at], &text[end..]).into(),
        _ => text.into(),
    })
}

/// Whether a text is nothing but comments.
fn is_comments(text: &str) -> bool {
    let mut rest = text.trim_start();
    while let Some((_, after)) = rest.strip_prefix("<!--").and_then(|comment| comment.split_once("-->")) {
        rest = after.trim_start();
    }
    rest.is_empty()
}

/// The tree of a [`body`].
pub fn parse(body: &str) -> Result<Document<'_>, BakeError> {
    if let Some(tag) = body.split('<').skip(1).find(|tag| attributes(tag) > ATTRIBUTES) {
        let start = tag.as_ptr().addr() - body.as_ptr().addr();
        let line = 1 + body[..start].matches('\n').count();
        let reason = format!("expected at most {ATTRIBUTES} attributes of an element, but it has {}", attributes(tag));
        return Err(BakeError { place: format!("line {line}"), reason });
    }
    let options = ParsingOptions { nodes_limit: NODES, ..ParsingOptions::default() };
    Document::parse_with_options(body, options).map_err(|error| match error {
        Error::NodesLimitReached => BakeError {
            place: "the whole file".to_owned(),
            reason: format!("expected at most {NODES} elements and texts"),
        },
        error => malformed(&error),
    })
}

/// The refusal of a text that is no XML.
pub fn malformed(error: &Error) -> BakeError {
    BakeError {
        place: format!("line {}", error.pos().row),
        reason: format!("expected well-formed OpenDRIVE XML, but {}", super::place::said(&error.to_string())),
    }
}

/// Quoted values in what follows a `<`, up to its `>`.
fn attributes(tag: &str) -> usize {
    let (mut quote, mut count) = (None, 0);
    for byte in tag.bytes() {
        match (quote, byte) {
            (Some(open), _) if byte == open => quote = None,
            (None, b'"' | b'\'') => (quote, count) = (Some(byte), count + 1),
            (None, b'>') => break,
            _ => {}
        }
    }
    count
}

fn whole<T>(reason: String) -> Result<T, BakeError> {
    Err(BakeError { place: "the whole file".to_owned(), reason })
}
