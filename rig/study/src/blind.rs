//! Blind drives: what their recordings hold and nobody is told unless it is to be revealed.

use replay::Provenance;

use crate::questionnaire;

/// The checkpoint was drawn, and nobody was told which it is.
pub(super) const BLIND: &str = "blind";
/// The checkpoints that it was drawn from.
pub(super) const CANDIDATES: &str = "blind_candidates";
/// What a blind drive does not tell unless it is revealed.
const HIDDEN: [&str; 5] = ["checkpoint", "checkpoint_digest", "external", "inference", CANDIDATES];

/// Whether nobody was told which checkpoint drove.
pub fn is_blind(provenance: &Provenance) -> bool {
    provenance.contains_key(BLIND)
}

/// What may be told of a drive: without what is blind, unless that is to be revealed, and without the
/// questionnaire, which has a place of its own.
pub fn tellable(provenance: &Provenance, reveal: bool) -> Provenance {
    let hides = is_blind(provenance) && !reveal;
    let is_hidden = |key: &str| questionnaire::is_answer(key) || (hides && HIDDEN.contains(&key));
    let told = provenance.iter().filter(|(key, _)| !is_hidden(key));
    told.map(|(key, value)| (key.clone(), value.clone())).collect()
}
