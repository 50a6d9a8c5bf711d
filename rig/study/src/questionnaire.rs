//! The short questionnaire: experience, fatigue and stress, before and after, for each driver.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::RangeInclusive;
use std::path::Path;

use anyhow::anyhow;
use base::files::{self, most};
use base::toml_text;
use base::words::{self, SEATS};
use kernel::Seat;
use replay::Provenance;
use serde::Serialize;
use toml::{Table, Value};

/// The questions whose answers are whole numbers, with the range of these.
///
/// Fatigue is the Karolinska Sleepiness Scale (Åkerstedt and Gillberg 1990): 1 extremely alert, 9 very
/// sleepy. Stress is a numeric rating: 0 none, 10 the worst imaginable.
const NUMBERS: [(&str, RangeInclusive<i64>); 6] = [
    ("experience_years", 0..=80),
    ("simulator_hours", 0..=100_000),
    ("before.fatigue", 1..=9),
    ("before.stress", 0..=10),
    ("after.fatigue", 1..=9),
    ("after.stress", 0..=10),
];
/// A question that is answered by a whole number.
#[derive(Debug, PartialEq, Eq)]
pub struct Question {
    /// Its name, after the seat's.
    pub name: &'static str,
    /// In words.
    pub words: &'static str,
    /// Answers that it allows.
    pub range: RangeInclusive<i64>,
}

/// What is asked after a drive.
pub const AFTER: [Question; 2] = [
    Question {
        name: "after.fatigue",
        words: "How sleepy are you? 1 extremely alert, 3 alert, 5 neither, 7 sleepy, 9 very sleepy",
        range: 1..=9,
    },
    Question {
        name: "after.stress",
        words: "How stressed are you? 0 not at all, 10 the worst imaginable",
        range: 0..=10,
    },
];

/// The question that is answered in words.
const REMARK: &str = "remark";
/// Longest answer in words, characters.
const MAX_REMARK: usize = 1000;
/// What the names of answers begin with in provenance.
const PREFIX: &str = "questionnaire.";

/// An answer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum Answer {
    /// A whole number.
    Number(i64),
    /// Words.
    Text(String),
}

impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Text(text) => f.write_str(text),
        }
    }
}

/// Answers by driver and question, such as `semantic.before.fatigue`; nobody has to answer anything.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Questionnaire(BTreeMap<String, Answer>);

impl Questionnaire {
    /// Reads a file; what is wrong is said in a sentence that names file and key.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let text = files::read_text(path, most::TEXT)?;
        Self::from_toml(&text).map_err(|problem| anyhow!("{}: {problem}", path.display()))
    }

    /// Reads the text of a file.
    pub fn from_toml(text: &str) -> Result<Self, String> {
        Self::from_table(toml_text::read(text)?)
    }

    /// From what a file holds.
    pub fn from_table(table: Table) -> Result<Self, String> {
        let mut answers = BTreeMap::new();
        for (key, value) in flat("", table) {
            let answer = answer(&key, value)?;
            answers.insert(key, answer);
        }
        Ok(Self(answers))
    }

    /// As the tables of a file.
    pub fn to_table(&self) -> Table {
        let mut root = Table::new();
        for (key, answer) in &self.0 {
            let mut names: Vec<&str> = key.split('.').collect();
            let last = names.pop().unwrap_or_default();
            let value = match answer {
                Answer::Number(number) => Value::Integer(*number),
                Answer::Text(text) => Value::String(text.clone()),
            };
            insert(&mut root, &names, last, value);
        }
        root
    }

    /// As entries of a recording's provenance.
    pub fn provenance(&self) -> Provenance {
        self.0.iter().map(|(key, answer)| (format!("{PREFIX}{key}"), answer.to_string())).collect()
    }

    /// From the entries of a recording's provenance; those that no question explains are left out.
    pub fn of(provenance: &Provenance) -> Self {
        let entry = |(key, text): (&String, &String)| {
            let key = key.strip_prefix(PREFIX)?;
            let value = text.parse().map_or_else(|_| Value::String(text.clone()), Value::Integer);
            let value = if key.ends_with(REMARK) { Value::String(text.clone()) } else { value };
            Some((key.to_owned(), answer(key, value).ok()?))
        };
        Self(provenance.iter().filter_map(entry).collect())
    }

    /// Both questionnaires' answers; a question with two different answers is an error that names it.
    pub fn joined(mut self, other: Self) -> Result<Self, String> {
        for (key, answer) in other.0 {
            if let Some(before) = self.0.get(&key).filter(|before| **before != answer) {
                return Err(format!("{key} is {answer}; the recording has {before} already"));
            }
            self.0.insert(key, answer);
        }
        Ok(self)
    }

    /// Takes an answer of the driver in a seat.
    pub fn answer(&mut self, seat: Seat, question: &Question, number: i64) {
        self.0.insert(format!("{}.{}", words::seat(seat), question.name), Answer::Number(number));
    }

    /// Whether nobody answered anything.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Questions with their answers.
    pub fn answers(&self) -> impl Iterator<Item = (&str, &Answer)> {
        self.0.iter().map(|(key, answer)| (key.as_str(), answer))
    }
}

/// Whether an entry of provenance is an answer.
pub fn is_answer(key: &str) -> bool {
    key.starts_with(PREFIX)
}

/// The name in provenance of the other driver's answer to the same question; `None` of no answer.
pub fn of_other_seat(key: &str) -> Option<String> {
    let (seat, question) = key.strip_prefix(PREFIX)?.split_once('.')?;
    let [semantic, safety] = SEATS;
    let other = if seat == semantic { safety } else { semantic };
    Some(format!("{PREFIX}{other}.{question}"))
}

/// The values of nested tables by their whole names.
fn flat(above: &str, table: Table) -> Vec<(String, Value)> {
    let named = |key: String| if above.is_empty() { key } else { format!("{above}.{key}") };
    let values = table.into_iter().flat_map(|(key, value)| match value {
        Value::Table(table) => flat(&named(key), table),
        value => vec![(named(key), value)],
    });
    values.collect()
}

fn insert(table: &mut Table, above: &[&str], key: &str, value: Value) {
    let Some((first, rest)) = above.split_first() else {
        table.insert(key.into(), value);
        return;
    };
    let below = table.entry(*first).or_insert_with(|| Value::Table(Table::new()));
    if let Value::Table(below) = below {
        insert(below, rest, key, value);
    }
}

/// An answer if it is one that its question allows.
fn answer(key: &str, value: Value) -> Result<Answer, String> {
    let question = key.split_once('.').filter(|(seat, _)| SEATS.contains(seat)).map(|(_, question)| question);
    let range = question.and_then(|q| NUMBERS.into_iter().find(|(name, _)| *name == q)).map(|(_, range)| range);
    match (range, value) {
        (Some(range), Value::Integer(number)) if range.contains(&number) => Ok(Answer::Number(number)),
        (Some(range), value) => {
            Err(format!("{key} is {value}, expected a whole number from {} to {}", range.start(), range.end()))
        }
        (None, Value::String(text)) if question == Some(REMARK) && text.chars().count() <= MAX_REMARK => {
            Ok(Answer::Text(text))
        }
        (None, _) if question == Some(REMARK) => Err(format!("{key}: expected text of up to {MAX_REMARK} characters")),
        (None, _) => Err(format!("unknown key {key}, expected {}", known())),
    }
}

/// What can be asked, for people to read.
fn known() -> String {
    let names: Vec<&str> = NUMBERS.iter().map(|(name, _)| *name).chain([REMARK]).collect();
    format!("semantic or safety with one of {}", names.join(", "))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const WHOLE: &str = r#"
        [semantic]
        experience_years = 8
        simulator_hours = 3
        remark = "wears glasses"
        before = { fatigue = 3, stress = 2 }
        after = { fatigue = 4, stress = 5 }
        [safety]
        experience_years = 31
        before.fatigue = 2
    "#;

    #[test]
    fn answers_are_read_and_none_is_needed() {
        let read = Questionnaire::from_toml(WHOLE).expect("valid");
        let words: Vec<String> = read.answers().map(|(key, answer)| format!("{key} {answer}")).collect();
        assert_eq!(
            words,
            [
                "safety.before.fatigue 2",
                "safety.experience_years 31",
                "semantic.after.fatigue 4",
                "semantic.after.stress 5",
                "semantic.before.fatigue 3",
                "semantic.before.stress 2",
                "semantic.experience_years 8",
                "semantic.remark wears glasses",
                "semantic.simulator_hours 3",
            ]
        );
        assert!(Questionnaire::from_toml("").expect("valid").is_empty());
    }

    #[test]
    fn what_is_wrong_is_named() {
        let said = |text: &str| Questionnaire::from_toml(text).expect_err(text);
        for (text, words) in [
            ("[semantic.before]\nfatigue = 10", "semantic.before.fatigue is 10, expected a whole number from 1 to 9"),
            ("[safety.after]\nstress = -1", "safety.after.stress is -1, expected a whole number from 0 to 10"),
            ("[safety.after]\nstress = 2.5", "safety.after.stress is 2.5"),
            ("[safety.after]\nstress = \"low\"", "safety.after.stress is \"low\""),
            ("[safety]\nage = 40", "unknown key safety.age, expected semantic or safety with one of experience_years"),
            ("[passenger.before]\nstress = 2", "unknown key passenger.before.stress"),
            ("[safety.during]\nstress = 2", "unknown key safety.during.stress"),
            ("fatigue = 2", "unknown key fatigue"),
            ("[safety]\nbefore = 3", "unknown key safety.before,"),
            ("[safety]\nremark = 3", "safety.remark: expected text"),
            ("[safety]\n[safety]", "line 2: "),
            ("[safety]\n\nx =", "line 3: "),
        ] {
            let sentence = said(text);
            assert!(sentence.starts_with(words) && !sentence.contains('\n'), "{sentence:?}, not {words:?}");
        }
    }

    #[test]
    fn what_is_asked_after_a_drive_is_what_files_can_answer() {
        for question in &AFTER {
            let (_, range) = NUMBERS.into_iter().find(|(name, _)| *name == question.name).expect("a known question");
            assert_eq!(range, question.range);
            let mut asked = Questionnaire::default();
            asked.answer(Seat::Safety, question, *range.start());
            assert_eq!(Questionnaire::from_table(asked.to_table()), Ok(asked));
        }
    }

    #[test]
    fn a_question_has_one_answer() {
        let read = |text: &str| Questionnaire::from_toml(text).expect("valid");
        let before = read("[safety.before]\nstress = 2");
        let joined = before.clone().joined(read("[safety.after]\nstress = 5\n[safety.before]\nstress = 2"));
        assert_eq!(joined, Ok(read("[safety]\nafter.stress = 5\nbefore.stress = 2")));
        let said = before.joined(read("[safety.before]\nstress = 3")).expect_err("two answers");
        assert_eq!(said, "safety.before.stress is 3; the recording has 2 already");
    }

    proptest! {
        #[test]
        fn answers_come_back_from_provenance_and_from_text(
            numbers in prop::collection::btree_map((0usize..2, 0usize..6), any::<u16>(), 0..12),
            remark in prop::option::of("[ -~äß\"\\\\]{0,30}|[0-9]{1,3}"),
        ) {
            let number = |((seat, question), raw): ((usize, usize), u16)| {
                let (name, range) = NUMBERS[question].clone();
                let span = range.end() - range.start() + 1;
                (format!("{}.{name}", SEATS[seat]), Answer::Number(range.start() + i64::from(raw) % span))
            };
            let mut answers: BTreeMap<String, Answer> = numbers.into_iter().map(number).collect();
            answers.extend(remark.map(|text| ("safety.remark".into(), Answer::Text(text))));
            let questionnaire = Questionnaire(answers);
            prop_assert_eq!(&Questionnaire::of(&questionnaire.provenance()), &questionnaire);
            let text = toml::to_string(&questionnaire.to_table()).expect("TOML");
            prop_assert_eq!(Questionnaire::from_toml(&text), Ok(questionnaire));
        }
    }
}
