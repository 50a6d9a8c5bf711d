//! A story as a text.

use crate::actor::ActorKind;
use crate::state::{DecodeError, NamedValue, Reader, State};

use super::error::StoryError;
use super::reader;
use super::script::{Action, Role, Script, SpeedTarget};

/// A text in OpenSCENARIO XML that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Story {
    text: String,
    read: reader::Read,
}

impl Story {
    /// Reads a text: one file, without catalogs.
    ///
    /// # Errors
    /// When it is no OpenSCENARIO XML, or has elements that are not supported, by element and line.
    pub fn read(text: &str) -> Result<Self, StoryError> {
        Ok(Self { text: text.to_owned(), read: reader::read(text)? })
    }

    /// The folders of the catalogs to which a text refers, as that calls them.
    pub fn catalog_folders(text: &str) -> Vec<String> {
        reader::folders(text)
    }

    /// A text with the entries of catalogs in place of the references to them, each on the line of the reference; of each
    /// catalog its file and its text. Who plays may be told by an entry that is not there: what it is is guessed by the name.
    ///
    /// # Errors
    /// When a catalog is none, or an entry of another kind is not there, by line.
    pub fn with_catalogs(text: &str, catalogs: &[(String, String)]) -> Result<String, StoryError> {
        reader::put_in(text, catalogs)
    }

    /// A refusal of what the text has so many bytes from its beginning.
    pub(super) fn refusal(&self, at: usize, reason: String) -> StoryError {
        let line = self.text.as_bytes()[..at.min(self.text.len())].iter().filter(|byte| **byte == b'\n').count() + 1;
        StoryError::at(line as u32, reason)
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The same with values drawn by a seed for those of its parameters that have ranges (`<ConstraintGroup>`).
    ///
    /// # Errors
    /// When it cannot be played with these values.
    pub fn varied(&self, seed: u64) -> Result<Self, StoryError> {
        reader::varied(&self.text, seed).map_or_else(|| Ok(self.clone()), |text| Self::read(&text))
    }

    /// Names and values of those of its parameters that have ranges.
    pub fn drawn(&self) -> Vec<(String, f64)> {
        reader::drawn(&self.text)
    }

    /// Whether some of its parameters have ranges.
    ///
    /// # Errors
    /// When it cannot be played with all of them at one end or the other.
    pub fn varies(&self) -> Result<bool, StoryError> {
        let [low, high] = [0.0, 1.0].map(|share| reader::with_shares(&self.text, |_| share));
        for text in low.iter().chain(&high) {
            Self::read(text)?;
        }
        Ok(low.is_some())
    }

    /// How many things it would have the ego car do that its drivers decide instead; the way that it takes they know.
    pub fn left_to_drivers(&self) -> usize {
        let mut all = self.script().ego_actions();
        if all.any(|action| *action == Action::HandOver) {
            return 0;
        }
        let known = |action: &&Action| matches!(action, Action::Route(_) | Action::Acquire(_));
        self.script().ego_actions().filter(|action| !known(action)).count()
    }

    /// Names of those whose catalog is not there, and what they were taken for.
    pub fn guessed(&self) -> impl Iterator<Item = (&str, ActorKind)> {
        let kind = |role: &Role| role.kind.unwrap_or(ActorKind::Car);
        self.script().cast.iter().filter(|role| role.guessed).map(move |role| (role.name.as_str(), kind(role)))
    }

    /// The fastest that it would have the ego car go from the beginning, m/s.
    pub fn ego_mps(&self) -> f32 {
        let ego = self.script().ego();
        let told = self.script().init.iter().filter_map(|(role, action)| match action {
            Action::Speed(_, SpeedTarget::Absolute(mps)) if *role == ego => Some(*mps),
            _ => None,
        });
        told.fold(0.0, f32::max)
    }

    /// What it says.
    pub fn script(&self) -> &Script {
        &self.read.script
    }

    /// The file of its map, as the text calls it.
    pub fn map_file(&self) -> &str {
        &self.read.map
    }

    /// Elements that were passed over since they change nothing, each once, with the line of the first one.
    pub fn passed_over(&self) -> &[(u32, String)] {
        &self.read.passed
    }
}

/// Its bytes are those of its text.
impl State for Story {
    fn write(&self, out: &mut Vec<u8>) {
        self.text.write(out);
    }

    fn read(r: &mut Reader<'_>) -> Result<Self, DecodeError> {
        let text = String::read(r)?;
        Story::read(&text).map_err(|_| r.error("a story in OpenSCENARIO XML"))
    }

    fn name(&self, path: &str, out: &mut Vec<NamedValue>) {
        self.text.name(path, out);
    }
}
