//! What operators enter about the end of a run: what kind of corner case it is, or why it is none.

use replay::{Annotation, Label};

use super::press::Press;
use super::wish::Wish;

/// Longest comment, characters.
const MAX_COMMENT: usize = 400;

/// What the operators have entered so far.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dialog {
    pub(super) is_case: bool,
    /// The label, once chosen.
    pub label: Option<Label>,
    /// The comment as typed.
    pub comment: String,
}

impl Dialog {
    /// About a corner case, with the label that it was given before its end.
    pub fn of_case(label: Option<Label>) -> Self {
        Self { is_case: true, label, comment: String::new() }
    }

    /// About a run that was broken off.
    pub fn of_broken_off() -> Self {
        Self { is_case: false, label: None, comment: String::new() }
    }

    /// The labels to choose from, each with the number of its key.
    pub fn choices(&self) -> impl Iterator<Item = (usize, Label)> {
        let is_case = self.is_case;
        Label::all().enumerate().filter(move |(_, label)| is_case || !label.is_case()).map(|(i, label)| (i + 1, label))
    }

    /// Whether the run may end without a label: as one that was stopped.
    pub fn may_be_empty(&self) -> bool {
        !self.is_case
    }

    pub(super) fn is_empty(&self) -> bool {
        self.label.is_none() && self.comment.is_empty()
    }

    /// The label comes first, so that keys still held from driving type nothing.
    pub(super) fn press(&mut self, press: &Press, repeated: bool) -> Wish {
        match (press, self.label) {
            (Press::Text { command, .. }, None) if !repeated => self.label = command.and_then(|c| self.chosen(c)),
            (Press::Text { text, .. }, Some(_)) if !repeated => self.type_in(text),
            (Press::Backspace, Some(_)) if self.comment.pop().is_none() => self.label = None,
            (Press::Enter, label) if !repeated && (label.is_some() || self.may_be_empty()) => {
                return Wish::Finish(self.annotation());
            }
            (Press::Escape, _) => (self.label, self.comment) = (None, String::new()),
            _ => {}
        }
        Wish::Nothing
    }

    /// What has been entered, when a label is chosen.
    pub fn annotation(&self) -> Option<Annotation> {
        Some(Annotation { label: self.label?, comment: self.comment.trim().to_owned(), perception_caused: None })
    }

    fn chosen(&self, digit: char) -> Option<Label> {
        let number = digit.to_digit(10)? as usize;
        self.choices().find(|(choice, _)| *choice == number).map(|(_, label)| label)
    }

    fn type_in(&mut self, text: &str) {
        let room = MAX_COMMENT.saturating_sub(self.comment.chars().count());
        self.comment.extend(text.chars().filter(|c| !c.is_control()).take(room));
    }
}

/// The kind of corner case with a number key: 1 for the first.
pub(super) fn case_of(digit: char) -> Option<Label> {
    Dialog::of_case(None).chosen(digit).filter(|label| label.is_case())
}
