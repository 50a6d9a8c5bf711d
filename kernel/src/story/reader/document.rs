//! A text as a tree that knows which of its elements were read.

use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, BTreeSet};

use roxmltree::{Document, Error, Node, ParsingOptions};

use super::coverage::{self, Support};
use super::value;
use crate::story::error::StoryError;

/// Longest text, bytes.
pub const BYTES: usize = 16 << 20;
/// Most elements, texts and comments.
const NODES: u32 = 400_000;
/// Most acts, groups, events, conditions, actions of all actors, and corners of lines that are told by where somebody is: all are
/// in every keyframe.
const PARTS: usize = 10_000;
/// Most attributes of an element, declarations of namespaces, and how deep elements may lie in each other.
const ATTRIBUTES: usize = 64;
const NAMESPACES: usize = 32;
const DEPTH: usize = 100;
/// How many times values of parameters may name others, and the longest one, bytes: it is copied wherever it is named.
const REFERENCES: usize = 8;
const VALUE: usize = 4096;

/// What all elements share.
pub struct Shared {
    /// Values of parameters, by the element that declares them and their names.
    parameters: BTreeMap<usize, BTreeMap<String, String>>,
    /// Those that are known already.
    values: RefCell<BTreeMap<(usize, String), String>>,
    read: RefCell<BTreeSet<usize>>,
    /// Those that are passed over as a rule and yet changed something.
    used: RefCell<BTreeSet<usize>>,
    /// What is still left of [`PARTS`].
    parts: Cell<usize>,
}

/// An element of the text.
#[derive(Clone, Copy)]
pub struct Element<'a> {
    node: Node<'a, 'a>,
    shared: &'a Shared,
}

/// Parses a text into a tree.
pub fn parse(text: &str) -> Result<Document<'_>, StoryError> {
    if text.len() > BYTES {
        let mib = text.len() >> 20;
        return Err(StoryError::at(1, format!("expected at most {} MiB, but it has {mib}", BYTES >> 20)));
    }
    check_tags(text)?;
    let options = ParsingOptions { nodes_limit: NODES, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|error| match error {
        Error::NodesLimitReached => StoryError::at(1, format!("expected at most {NODES} elements and texts")),
        error => {
            StoryError::at(error.pos().row, format!("expected well-formed OpenSCENARIO XML, but {}", said(&error)))
        }
    })
}

/// Refuses what was written before the standard's first version.
pub fn check_version(document: &Document<'_>) -> Result<(), StoryError> {
    let header = document.root_element().children().find(|n| n.has_tag_name("FileHeader"));
    match header.filter(|header| header.attribute("revMajor") == Some("0")) {
        Some(header) => {
            Err(StoryError::at(line_of(header), "it is OpenSCENARIO 0.9 or older, expected 1.0 to 1.2".into()))
        }
        None => Ok(()),
    }
}

/// Refuses what takes the parser long: it compares attributes and namespaces each with all others.
fn check_tags(text: &str) -> Result<(), StoryError> {
    let refused = |at: usize, most: usize, what: &str| {
        let line = text.as_bytes()[..at].iter().filter(|byte| **byte == b'\n').count() as u32 + 1;
        Err(StoryError::at(line, format!("expected at most {most} {what}")))
    };
    if let Some((at, _)) = text.match_indices("xmlns").nth(NAMESPACES) {
        return refused(at, NAMESPACES, "declarations of namespaces");
    }
    let (mut at, mut depth) = (0, 0_usize);
    while let Some(begins) = text[at..].find('<').map(|to| at + to) {
        let rest = &text[begins..];
        let skipped =
            [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")].into_iter().find(|(from, _)| rest.starts_with(from));
        if let Some((_, to)) = skipped {
            at = rest.find(to).map_or(text.len(), |end| begins + end + to.len());
            continue;
        }
        let (mut quote, mut values, mut ends) = (None, 0, text.len());
        for (k, byte) in rest.bytes().enumerate().skip(1) {
            match (quote, byte) {
                (None, b'"' | b'\'') => (quote, values) = (Some(byte), values + 1),
                (Some(open), _) if open == byte => quote = None,
                (None, b'>') => {
                    ends = begins + k;
                    break;
                }
                _ => {}
            }
        }
        if values > ATTRIBUTES {
            return refused(begins, ATTRIBUTES, "attributes of an element");
        }
        if rest.starts_with("</") {
            depth = depth.saturating_sub(1);
        } else if !text[..ends].ends_with('/') {
            depth += 1;
        }
        if depth > DEPTH {
            return refused(begins, DEPTH, "elements in each other");
        }
        at = ends;
    }
    Ok(())
}

/// What the parser says, on one line and not too long.
fn said(error: &Error) -> String {
    error.to_string().chars().filter(|c| !c.is_control()).take(200).collect()
}

impl Shared {
    /// With the parameters that the text declares: stories and manoeuvres have some of their own.
    pub fn of(document: &Document<'_>) -> Self {
        let mut parameters: BTreeMap<usize, BTreeMap<String, String>> = BTreeMap::new();
        for node in document.descendants().filter(|n| n.has_tag_name("ParameterDeclaration")) {
            let owner = node.parent_element().and_then(|all| all.parent_element());
            if let (Some(owner), Some(name), Some(value)) = (owner, node.attribute("name"), node.attribute("value")) {
                // Some programs write the sign of a reference as part of the name.
                let name = name.trim_start_matches('$').to_owned();
                parameters.entry(owner.id().get_usize()).or_default().insert(name, value.to_owned());
            }
        }
        let (values, read, used) = Default::default();
        Self { parameters, values, read, used, parts: Cell::new(PARTS) }
    }

    /// The text of an attribute with the values of parameters for it, as they are in an element.
    pub fn value(&self, node: Node<'_, '_>, text: &str) -> Result<String, String> {
        self.value_within(node, text, 0)
    }

    /// The nearest declaration around an element counts; its value may name others.
    fn value_within(&self, node: Node<'_, '_>, text: &str, depth: usize) -> Result<String, String> {
        if depth > REFERENCES {
            return Err(format!("expected parameters that refer to each other at most {REFERENCES} times"));
        }
        let find = |name: &str| {
            let declared = |at: &Node<'_, '_>| self.parameters.get(&at.id().get_usize()).and_then(|all| all.get(name));
            let Some(owner) = node.ancestors().find(|at| declared(at).is_some()) else { return Ok(None) };
            let value = declared(&owner).map_or("", String::as_str);
            if value.len() > VALUE {
                return Err(format!("expected a parameter of at most {VALUE} bytes, but it has {}", value.len()));
            }
            let key = (owner.id().get_usize(), name.to_owned());
            if let Some(known) = self.values.borrow().get(&key) {
                return Ok(Some(known.clone()));
            }
            let value = self.value_within(owner, value, depth + 1)?;
            self.values.borrow_mut().insert(key, value.clone());
            Ok(Some(value))
        };
        value::of(text, &find)
    }

    /// Refuses what was not read and is not harmless; gives what is harmless, each once, by line.
    pub fn leftovers(&self, document: &Document<'_>) -> Result<Vec<(u32, String)>, StoryError> {
        let read = self.read.borrow();
        // Lines are counted from the beginning: only of those that are told.
        let mut passed: BTreeMap<&str, Node<'_, '_>> = BTreeMap::new();
        let mut rest = vec![document.root_element()];
        while let Some(node) = rest.pop() {
            let tag = node.tag_name().name();
            let refused = |why: String| StoryError::at(line_of(node), why);
            match coverage::support(tag) {
                None => return Err(refused(format!("<{tag}> is no element of OpenSCENARIO 1.0 to 1.2"))),
                Some(Support::No) => return Err(refused(format!("<{tag}> is not supported"))),
                Some(Support::Ignored) => {
                    // Its catalogs were put in.
                    if tag == "CatalogLocations" || self.used.borrow().contains(&node.id().get_usize()) {
                        continue;
                    }
                    let first = passed.entry(tag).or_insert(node);
                    if node.range().start < first.range().start {
                        *first = node;
                    }
                    continue;
                }
                Some(Support::Yes | Support::Partly) if !read.contains(&node.id().get_usize()) => {
                    let parent = node.parent_element().map_or("", |parent| parent.tag_name().name());
                    return Err(refused(format!("<{tag}> is not supported in <{parent}>")));
                }
                Some(_) => {}
            }
            rest.extend(node.children().filter(Node::is_element));
        }
        let mut told: Vec<(u32, String)> =
            passed.into_iter().map(|(tag, node)| (line_of(node), tag.to_owned())).collect();
        told.sort();
        Ok(told)
    }
}

/// The line that an element begins on.
pub fn line_of(node: Node<'_, '_>) -> u32 {
    node.document().text_pos_at(node.range().start).row
}

impl<'a> Element<'a> {
    /// The root of a text.
    pub fn root(document: &'a Document<'a>, shared: &'a Shared) -> Result<Self, StoryError> {
        let root = Self { node: document.root_element(), shared };
        shared.read.borrow_mut().insert(root.node.id().get_usize());
        match root.tag() {
            "OpenSCENARIO" => Ok(root),
            tag => Err(root.wrong(format!("expected <OpenSCENARIO>, but it is <{tag}>"))),
        }
    }

    /// Its name.
    pub fn tag(&self) -> &'a str {
        self.node.tag_name().name()
    }

    /// The element in the tree.
    pub fn node(&self) -> Node<'a, 'a> {
        self.node
    }

    /// Where it begins, bytes from the beginning of the text.
    pub fn begins(&self) -> usize {
        self.node.range().start
    }

    /// Counts parts of a story, of which there may be so many only.
    pub fn spend(&self, parts: usize) -> Result<(), StoryError> {
        let left = self.shared.parts.get().checked_sub(parts);
        let Some(left) = left else {
            let what = "acts, groups, events, conditions, actions of all actors, and corners told by where somebody is";
            return Err(self.wrong(format!("expected at most {PARTS} {what}")));
        };
        self.shared.parts.set(left);
        Ok(())
    }

    /// A length within what a map may have, metres.
    pub fn metres(&self, name: &str) -> Result<f32, StoryError> {
        const MOST_M: f64 = 10_000.0;
        let metres = self.or_zero(name)?;
        if metres.abs() > MOST_M {
            return Err(self.misfit(name, &metres.to_string(), &format!("metres from -{MOST_M} to {MOST_M}")));
        }
        Ok(metres as f32)
    }

    /// The same of one that must be there.
    pub fn need_metres(&self, name: &str) -> Result<f32, StoryError> {
        self.text(name)?;
        self.metres(name)
    }

    /// It changes something, though elements of its name are passed over as a rule.
    pub fn is_used(&self) {
        self.shared.used.borrow_mut().insert(self.node.id().get_usize());
    }

    /// A refusal at its line.
    pub fn wrong(&self, reason: impl Into<String>) -> StoryError {
        StoryError::at(line_of(self.node), reason.into())
    }

    fn read(&self, node: Node<'a, 'a>) -> Self {
        self.shared.read.borrow_mut().insert(node.id().get_usize());
        Self { node, shared: self.shared }
    }

    /// Its children of a name, which count as read.
    pub fn all(self, tag: &'static str) -> impl Iterator<Item = Self> {
        self.node.children().filter(move |n| n.has_tag_name(tag)).map(move |n| self.read(n))
    }

    /// The first child of a name.
    pub fn child(self, tag: &'static str) -> Option<Self> {
        self.all(tag).next()
    }

    /// The same, which must be there.
    pub fn need(self, tag: &'static str) -> Result<Self, StoryError> {
        self.child(tag).ok_or_else(|| self.wrong(format!("<{}> has no <{tag}>", self.tag())))
    }

    /// Reads a choice: its only child but for those that it asked for before, and counts it as read.
    pub fn choice(self) -> Result<Self, StoryError> {
        let unread = |n: &Node<'a, 'a>| n.is_element() && !self.shared.read.borrow().contains(&n.id().get_usize());
        let first = self.node.children().find(unread);
        first.map(|n| self.read(n)).ok_or_else(|| self.wrong(format!("<{}> is empty", self.tag())))
    }

    /// The refusal of a choice that is not supported here.
    pub fn unsupported(&self) -> StoryError {
        let parent = self.node.parent_element().map_or("", |parent| parent.tag_name().name());
        match coverage::support(self.tag()) {
            None => self.wrong(format!("<{}> is no element of OpenSCENARIO 1.0 to 1.2", self.tag())),
            Some(Support::No) => self.wrong(format!("<{}> is not supported", self.tag())),
            Some(_) => self.wrong(format!("<{}> is not supported in <{parent}>", self.tag())),
        }
    }

    /// An attribute with its parameters' values, if it is there.
    pub fn given(&self, name: &str) -> Result<Option<String>, StoryError> {
        let Some(text) = self.node.attribute(name) else { return Ok(None) };
        let value = self.shared.value(self.node, text.trim());
        value.map(Some).map_err(|why| self.wrong(format!("{name} of <{}> is {}: {why}", self.tag(), shown(text))))
    }

    /// The value of the parameter that an attribute names; nothing where none of that name is declared around it.
    pub fn parameter(&self, attribute: &str) -> Result<Option<String>, StoryError> {
        let missing = || self.wrong(format!("<{}> has no {attribute}", self.tag()));
        let name = self.node.attribute(attribute).ok_or_else(missing)?.trim().trim_start_matches('$');
        let declared = |at: Node<'_, '_>| self.shared.parameters.get(&at.id().get_usize());
        let is_declared = self.node.ancestors().any(|at| declared(at).is_some_and(|all| all.contains_key(name)));
        let value = || self.shared.value(self.node, &format!("${name}")).map_err(|why| self.wrong(why));
        is_declared.then(value).transpose()
    }

    /// An attribute that must be there.
    pub fn text(&self, name: &str) -> Result<String, StoryError> {
        self.given(name)?.ok_or_else(|| self.wrong(format!("<{}> has no {name}", self.tag())))
    }

    fn misfit(&self, name: &str, text: &str, expected: &str) -> StoryError {
        self.wrong(format!("{name} of <{}> is {}, expected {expected}", self.tag(), shown(text)))
    }

    /// A number, if it is there. Infinity, which the standard calls INF, is a very large one.
    pub fn number_given(&self, name: &str) -> Result<Option<f64>, StoryError> {
        const MOST: f64 = 1e9;
        let Some(text) = self.given(name)? else { return Ok(None) };
        let number = match text.as_str() {
            "INF" | "inf" | "Infinity" => Some(MOST),
            "-INF" | "-inf" | "-Infinity" => Some(-MOST),
            other => other.parse::<f64>().ok().filter(|number| number.is_finite()),
        };
        let number = number.ok_or_else(|| self.misfit(name, &text, "a number"))?;
        Ok(Some(number.clamp(-MOST, MOST)))
    }

    /// A number that must be there.
    pub fn number(&self, name: &str) -> Result<f64, StoryError> {
        self.number_given(name)?.ok_or_else(|| self.wrong(format!("<{}> has no {name}", self.tag())))
    }

    /// The same for what is not exact.
    pub fn float(&self, name: &str) -> Result<f32, StoryError> {
        Ok(self.number(name)? as f32)
    }

    /// A number that is 0 where it is not there.
    pub fn or_zero(&self, name: &str) -> Result<f64, StoryError> {
        Ok(self.number_given(name)?.unwrap_or(0.0))
    }

    /// A number that is not negative.
    pub fn amount(&self, name: &str) -> Result<f32, StoryError> {
        let number = self.number(name)?;
        if number < 0.0 { Err(self.misfit(name, &number.to_string(), "a number from 0 on")) } else { Ok(number as f32) }
    }

    /// A whole number of a lane.
    pub fn whole(&self, name: &str) -> Result<i32, StoryError> {
        let text = self.text(name)?;
        text.parse().map_err(|_| self.misfit(name, &text, "a whole number"))
    }

    /// Yes or no, if it is there.
    pub fn switch(&self, name: &str) -> Result<Option<bool>, StoryError> {
        let Some(text) = self.given(name)? else { return Ok(None) };
        // Python writes them large.
        match text.to_ascii_lowercase().as_str() {
            "true" | "1" => Ok(Some(true)),
            "false" | "0" => Ok(Some(false)),
            _ => Err(self.misfit(name, &text, "true or false")),
        }
    }

    /// One of some words, if it is there.
    pub fn word_given<T: Copy>(&self, name: &str, words: &[(&str, T)]) -> Result<Option<T>, StoryError> {
        let Some(text) = self.given(name)? else { return Ok(None) };
        let found = words.iter().find(|(word, _)| *word == text).map(|(_, meant)| *meant);
        let expected = || words.iter().map(|(word, _)| *word).collect::<Vec<_>>().join(" or ");
        found.map(Some).ok_or_else(|| self.misfit(name, &text, &expected()))
    }

    /// One of some words.
    pub fn word<T: Copy>(&self, name: &str, words: &[(&str, T)]) -> Result<T, StoryError> {
        self.word_given(name, words)?.ok_or_else(|| self.wrong(format!("<{}> has no {name}", self.tag())))
    }
}

/// A value as a refusal shows it.
pub fn shown(text: &str) -> String {
    let mut shown: String = text.chars().filter(|c| !c.is_control()).take(40).collect();
    if text.chars().count() > 40 {
        shown.push_str("...");
    }
    format!("{shown:?}")
}
