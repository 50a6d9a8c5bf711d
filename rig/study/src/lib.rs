//! What makes drives a study with people: who drives by pseudonym, what they answered, whether the
//! drive counts, which checkpoint drives without anybody knowing, and what is driven in which order.
//!
//! All of it is provenance in the recording's manifest; nothing of it steers a replay.

mod attached;
mod blind;
mod lineup;
pub mod protocol;
mod pseudonym;
pub mod questionnaire;

use std::path::PathBuf;

use drivers::checkpoint::CheckpointChoice;
use replay::Provenance;

pub use attached::{answers_of, attached, path_beside};
pub use blind::{is_blind, tellable};
pub use lineup::{Cast, Draw, Lineup};
pub use protocol::Protocol;
pub use pseudonym::Pseudonym;
pub use questionnaire::{Answer, Questionnaire};

/// Names of the operators' pseudonyms in provenance, semantic driver's first.
const NAMES: [&str; 2] = ["semantic_name", "safety_name"];
/// The drive is one for familiarisation.
const FAMILIARISATION: &str = "familiarisation";
/// Whether the operators had swapped seats since the session began, `true` or `false`.
pub const SWAPPED: &str = "seats_swapped";

/// How a drive is part of a study.
#[derive(Clone, Debug, Default)]
pub struct Study {
    /// Pseudonym of the semantic driver, for the recording.
    pub semantic_name: Option<Pseudonym>,
    /// Pseudonym of the safety driver, for the recording.
    pub safety_name: Option<Pseudonym>,
    /// File with the drivers' answers, for the recording.
    pub questionnaire: Option<PathBuf>,
    /// A drive to get used to the rig: it is marked and does not count, and no case is cut from it.
    pub familiarisation: bool,
    /// Two or more checkpoints, of which each run draws one by its seed without telling which.
    pub blind: Vec<CheckpointChoice>,
}

impl Study {
    /// What recordings say about it, the checkpoint aside. Reads the questionnaire's file.
    pub fn provenance(&self) -> anyhow::Result<Provenance> {
        let names = NAMES.into_iter().zip(self.names());
        let mut entries: Provenance = names.filter_map(|(key, name)| Some((key.into(), name?))).collect();
        if self.familiarisation {
            entries.insert(FAMILIARISATION.into(), "true".into());
        }
        if let Some(path) = &self.questionnaire {
            entries.extend(Questionnaire::read(path)?.provenance());
        }
        Ok(entries)
    }

    /// The checkpoints of which each run draws one: those of a blind session, or else this one.
    pub fn candidates(&self, otherwise: &CheckpointChoice) -> Vec<CheckpointChoice> {
        if self.blind.is_empty() { vec![otherwise.clone()] } else { self.blind.clone() }
    }

    /// The operators' pseudonyms, semantic driver's first.
    pub fn names(&self) -> [Option<String>; 2] {
        [&self.semantic_name, &self.safety_name].map(|name| name.as_ref().map(ToString::to_string))
    }
}

/// What recordings say after the operators have swapped seats: names and answers go with them.
pub fn swapped(provenance: &Provenance) -> Provenance {
    let [semantic, safety] = NAMES;
    let swap = |key: &String| match key.as_str() {
        key if key == semantic => safety.to_owned(),
        key if key == safety => semantic.to_owned(),
        key => questionnaire::of_other_seat(key).unwrap_or_else(|| key.to_owned()),
    };
    provenance.iter().map(|(key, value)| (swap(key), value.clone())).collect()
}

/// Whether the operators had swapped seats since their session began.
pub fn is_swapped(provenance: &Provenance) -> bool {
    provenance.get(SWAPPED).is_some_and(|swapped| swapped == "true")
}

/// Whether a drive was one to get used to the rig, which does not count.
pub fn is_familiarisation(provenance: &Provenance) -> bool {
    provenance.contains_key(FAMILIARISATION)
}

#[cfg(test)]
mod tests {
    use super::blind::{BLIND, CANDIDATES};
    use super::*;

    fn provenance(entries: &[(&str, &str)]) -> Provenance {
        entries.iter().map(|(key, value)| ((*key).into(), (*value).into())).collect()
    }

    #[test]
    fn a_blind_drive_tells_its_checkpoint_only_when_asked() {
        let open = provenance(&[("checkpoint", "early"), ("checkpoint_digest", "aa"), ("camera", "driver 256x128")]);
        assert_eq!(tellable(&open, false), open);
        let mut blind = open.clone();
        blind.extend(provenance(&[(BLIND, "one of 2 checkpoints"), (CANDIDATES, "early, full")]));
        let hidden = provenance(&[(BLIND, "one of 2 checkpoints"), ("camera", "driver 256x128")]);
        assert_eq!((tellable(&blind, false), tellable(&blind, true)), (hidden, blind));
    }

    #[test]
    fn names_and_answers_go_with_the_operators_to_their_new_seats() {
        let before = provenance(&[
            ("semantic_name", "P07"),
            ("questionnaire.safety.before.stress", "2"),
            ("questionnaire.semantic.remark", "semantic.remark"),
            (FAMILIARISATION, "true"),
        ]);
        let after = provenance(&[
            ("safety_name", "P07"),
            ("questionnaire.semantic.before.stress", "2"),
            ("questionnaire.safety.remark", "semantic.remark"),
            (FAMILIARISATION, "true"),
        ]);
        assert_eq!((swapped(&before), swapped(&after)), (after, before));
    }

    #[test]
    fn what_was_not_given_is_not_recorded() {
        assert_eq!(Study::default().provenance().expect("nothing to read"), Provenance::default());
        let name = |text: &str| Some(text.parse().expect("a pseudonym"));
        let args = Study { safety_name: name("P03"), familiarisation: true, ..Default::default() };
        let entries = args.provenance().expect("nothing to read");
        assert_eq!(entries, provenance(&[("safety_name", "P03"), (FAMILIARISATION, "true")]));
        assert!(is_familiarisation(&entries) && !is_blind(&entries));
    }
}
