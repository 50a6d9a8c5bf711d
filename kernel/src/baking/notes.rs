//! What a file holds and a map has no use for, told by those who pass over it.

use std::collections::BTreeMap;

/// Groups of one kind; what more there is counts among the others.
const GROUPS: usize = 200;
/// Characters of a text of the file.
const SAID: usize = 200;
/// What stands for what comes after so many groups.
const OTHERS: &str = "others";

/// What kind of thing was passed over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Passed {
    /// The parser left something out, or read it against the standard.
    Warning,
    /// Something refers to what the file does not have, or to what lies elsewhere.
    Reference,
    /// A signal or sign.
    Signal,
    /// An object.
    Object,
    /// A lane.
    Lane,
    /// A road mark.
    RoadMark,
    /// What a road is made of.
    Surface,
    /// An element of the file that nothing here reads.
    Element,
}

/// Things of a file that were passed over alike.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PassedOver {
    /// What kind of thing.
    pub kind: Passed,
    /// What the file calls it.
    pub what: String,
    /// Why, or what became of it instead; empty where `first` says so.
    pub why: &'static str,
    /// How many of them.
    pub count: usize,
    /// Where the first of them is.
    pub first: String,
}

/// Collects what is passed over while a map is baked.
pub(super) struct Notes {
    wanted: bool,
    kinds: BTreeMap<Passed, usize>,
    groups: BTreeMap<(Passed, String, &'static str), (usize, String)>,
}

impl Notes {
    /// For nobody: what is passed over is not even put into words.
    pub fn unwanted() -> Self {
        Self { wanted: false, kinds: BTreeMap::new(), groups: BTreeMap::new() }
    }

    /// For somebody.
    pub fn wanted() -> Self {
        Self { wanted: true, ..Self::unwanted() }
    }

    /// Whether somebody will read them.
    pub fn are_wanted(&self) -> bool {
        self.wanted
    }

    /// Something at a place is passed over.
    pub fn pass(
        &mut self,
        kind: Passed,
        why: &'static str,
        what: impl FnOnce() -> String,
        place: impl FnOnce() -> String,
    ) {
        self.pass_all(1, kind, why, what, place);
    }

    /// So many things are passed over, the first of them at a place.
    pub fn pass_all(
        &mut self,
        count: usize,
        kind: Passed,
        why: &'static str,
        what: impl FnOnce() -> String,
        place: impl FnOnce() -> String,
    ) {
        if !self.wanted || count == 0 {
            return;
        }
        let mut key = (kind, said(&what()), why);
        if !self.groups.contains_key(&key) {
            let known = self.kinds.entry(kind).or_default();
            if *known >= GROUPS {
                key = (kind, OTHERS.to_owned(), "");
            }
            *known += 1;
        }
        self.groups.entry(key).or_insert_with(|| (0, said(&place()))).0 += count;
    }

    /// All groups, by kind, the largest first.
    pub fn finish(self) -> Vec<PassedOver> {
        let group = |((kind, what, why), (count, first))| PassedOver { kind, what, why, count, first };
        let mut groups: Vec<PassedOver> = self.groups.into_iter().map(group).collect();
        groups.sort_by(|a, b| {
            let others = |group: &PassedOver| group.what == OTHERS;
            a.kind.cmp(&b.kind).then(others(a).cmp(&others(b))).then(b.count.cmp(&a.count))
        });
        groups
    }
}

/// A text of the file, fit for one line.
fn said(text: &str) -> String {
    let mut said: String = text.chars().take(SAID).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.chars().nth(SAID).is_some() {
        said.push_str("...");
    }
    said
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pass(notes: &mut Notes, kind: Passed, what: &str, place: &str) {
        notes.pass(kind, "why", || what.to_owned(), || place.to_owned());
    }

    #[test]
    fn alike_things_are_one_group_with_the_first_place() {
        let mut notes = Notes::wanted();
        pass(&mut notes, Passed::Object, "b", "road 1");
        pass(&mut notes, Passed::Signal, "a", "road 2");
        pass(&mut notes, Passed::Signal, "b", "road 3\n");
        pass(&mut notes, Passed::Signal, "b", "road 4");
        notes.pass_all(0, Passed::Signal, "why", || "none".into(), String::new);
        let told: Vec<_> = notes.finish().into_iter().map(|g| (g.what, g.count, g.first)).collect();
        let expected = [("b", 2, "road 3 "), ("a", 1, "road 2"), ("b", 1, "road 1")];
        assert_eq!(told, expected.map(|(what, count, first)| (what.to_owned(), count, first.to_owned())));
    }

    #[test]
    fn a_file_of_a_thousand_types_has_a_last_group() {
        let mut notes = Notes::wanted();
        (0..1000).for_each(|k| pass(&mut notes, Passed::Signal, &format!("{}{k}", "x".repeat(1000)), "here"));
        pass(&mut notes, Passed::Object, "one", "there");
        let told = notes.finish();
        // Long names are alike after their first characters, so these are one group.
        assert_eq!((told.len(), told[0].count), (2, 1000));
        let mut notes = Notes::wanted();
        (0..1000).for_each(|k| pass(&mut notes, Passed::Signal, &k.to_string(), "here"));
        let told = notes.finish();
        assert_eq!((told.len(), told[GROUPS].what.as_str(), told[GROUPS].count), (GROUPS + 1, OTHERS, 1000 - GROUPS));
    }

    #[test]
    fn what_nobody_wants_is_not_put_into_words() {
        let mut notes = Notes::unwanted();
        notes.pass(Passed::Lane, "", || panic!("for nobody"), || panic!("for nobody"));
        assert!(notes.finish().is_empty());
    }
}
