//! What is told of a case or drive.

/// A named fact.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Fact {
    /// What it is about.
    pub name: &'static str,
    /// The fact, with its unit.
    pub value: String,
}
