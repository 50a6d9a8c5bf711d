//! What people say about cases. It belongs to the case, and stays when its file is moved, cut again or looked at again.

use std::fmt;
use std::str::FromStr;

use rusqlite::{Transaction, params};

/// Longest tag, characters.
const MOST_CHARACTERS: usize = 64;

/// What came of looking at a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ReviewState {
    /// It is what its label says, and may be used.
    Accepted,
    /// It may not.
    Rejected,
    /// Somebody else should look.
    Unclear,
}

impl ReviewState {
    /// Every one.
    pub const ALL: [Self; 3] = [Self::Accepted, Self::Rejected, Self::Unclear];

    /// As commands and JSON have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Accepted => "accepted",
            Self::Rejected => "rejected",
            Self::Unclear => "unclear",
        }
    }
}

impl FromStr for ReviewState {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|state| state.name() == text);
        found.ok_or_else(|| "expected accepted, rejected or unclear".into())
    }
}

/// Which reviews are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reviewed {
    /// Somebody has looked.
    Yes,
    /// Nobody has.
    No,
    /// Somebody said this.
    As(ReviewState),
}

impl FromStr for Reviewed {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "yes" => Ok(Self::Yes),
            "no" => Ok(Self::No),
            _ => text.parse().map(Self::As).map_err(|_| "expected yes, no, accepted, rejected or unclear".into()),
        }
    }
}

/// A word that people put on cases: 1 to 64 characters, without blanks and commas.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Tag(String);

impl Tag {
    /// Itself.
    pub fn name(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for Tag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl FromStr for Tag {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let is_plain = |c: char| !c.is_whitespace() && !c.is_control() && c != ',';
        let fits = (1..=MOST_CHARACTERS).contains(&text.chars().count()) && text.chars().all(is_plain);
        let expected =
            || format!("expected 1 to {MOST_CHARACTERS} characters without blanks and commas, as in night-walk");
        if fits { Ok(Self(text.to_owned())) } else { Err(expected()) }
    }
}

/// What is to be said of cases.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Change {
    /// What came of looking at them.
    pub review: Option<ReviewState>,
    /// Tags that they get.
    pub add: Vec<Tag>,
    /// Tags that they lose.
    pub remove: Vec<Tag>,
}

impl Change {
    /// Whether nothing is to be said.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Says it of a case.
    pub(super) fn make(&self, db: &Transaction<'_>, identity: &str) -> rusqlite::Result<()> {
        if let Some(state) = self.review {
            db.execute("INSERT OR REPLACE INTO reviews VALUES (?, ?)", params![identity, state.name()])?;
        }
        for tag in &self.add {
            db.execute("INSERT OR IGNORE INTO tags VALUES (?, ?)", params![identity, tag.name()])?;
        }
        for tag in &self.remove {
            db.execute("DELETE FROM tags WHERE identity = ? AND tag = ?", params![identity, tag.name()])?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_and_others_are_refused() {
        assert!(ReviewState::ALL.into_iter().all(|state| state.name().parse() == Ok(state)));
        assert_eq!(("no".parse(), "unclear".parse()), (Ok(Reviewed::No), Ok(Reviewed::As(ReviewState::Unclear))));
        assert!("maybe".parse::<Reviewed>().is_err() && "yes".parse::<ReviewState>().is_err());
        assert_eq!("nachts-über-rot".parse::<Tag>().map(|tag| tag.to_string()), Ok("nachts-über-rot".into()));
        assert!(["", "a b", "a,b", "a\n", &"a".repeat(65)].iter().all(|text| text.parse::<Tag>().is_err()));
    }
}
