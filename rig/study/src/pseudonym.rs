//! What operators are called in recordings.

use std::fmt;
use std::str::FromStr;

/// Longest pseudonym, characters.
const MAX_LENGTH: usize = 32;

/// A name that says nothing about the person: letters and digits of ASCII, - and _, 1 to 32 of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pseudonym(String);

impl FromStr for Pseudonym {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        if (1..=MAX_LENGTH).contains(&text.len()) && text.chars().all(is_plain) {
            return Ok(Self(text.to_owned()));
        }
        Err(format!("expected a pseudonym of 1 to {MAX_LENGTH} letters, digits, - and _, as in P07"))
    }
}

impl fmt::Display for Pseudonym {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pseudonyms_are_plain_and_short() {
        for text in ["P07", "a", "team-2_B", &"x".repeat(32)] {
            assert_eq!(text.parse::<Pseudonym>().map(|p| p.to_string()), Ok(text.to_owned()));
        }
        for text in ["", "Ada Lovelace", "Jürgen", "P07\n", "a/b", "../x", &"x".repeat(33)] {
            let said = text.parse::<Pseudonym>().expect_err(text);
            assert!(said.contains("pseudonym of 1 to 32") && !said.contains('\n'), "{said}");
        }
    }
}
