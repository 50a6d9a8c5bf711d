//! Changes to an XML text of the kind that broken exporters and hostile authors make.

use std::ops::Range;

use proptest::prelude::*;
use proptest::sample::Index;

/// Numbers at the edges of what a reader expects.
const NUMBERS: [&str; 19] = [
    "0",
    "-0",
    "-1",
    "1",
    "1e308",
    "-1e308",
    "nan",
    "inf",
    "-inf",
    "1e-300",
    "1e9",
    "1e15",
    "99999999999999999999",
    "0.001",
    "1e-9",
    "100000",
    "5000",
    "x",
    "",
];

/// A change, and where: the index is of an element or an attribute of the text at that time.
#[derive(Clone, Debug)]
pub enum Mutation {
    /// Another number in an attribute.
    Number(Index, &'static str),
    /// A number times a power of ten.
    Scale(Index, i32),
    /// The value of another attribute of the same name.
    Swap(Index, Index),
    /// No such attribute.
    Forget(Index),
    /// No such element.
    Delete(Index),
    /// An element so many times more.
    Repeat(Index, usize),
    /// An element inside itself.
    Nest(Index, usize),
    /// An element in the place of another.
    Move(Index, Index),
    /// The text ends here.
    Cut(Index),
}

/// One to six changes.
pub fn mutations() -> impl Strategy<Value = Vec<Mutation>> {
    let at = any::<Index>;
    let number = prop::sample::select(NUMBERS.to_vec());
    let one = prop_oneof![
        8 => (at(), number).prop_map(|(at, n)| Mutation::Number(at, n)),
        4 => (at(), -12..13).prop_map(|(at, n)| Mutation::Scale(at, n)),
        3 => (at(), at()).prop_map(|(at, from)| Mutation::Swap(at, from)),
        2 => at().prop_map(Mutation::Forget),
        2 => at().prop_map(Mutation::Delete),
        2 => (at(), prop_oneof![4 => 1..4usize, 1 => 4..3_000usize]).prop_map(|(at, n)| Mutation::Repeat(at, n)),
        1 => (at(), prop_oneof![4 => 1..4usize, 1 => 4..400usize]).prop_map(|(at, n)| Mutation::Nest(at, n)),
        2 => (at(), at()).prop_map(|(at, from)| Mutation::Move(at, from)),
        1 => at().prop_map(Mutation::Cut),
    ];
    prop::collection::vec(one, 1..7)
}

/// The text with some changes.
pub fn mutated(text: &str, mutations: &[Mutation]) -> String {
    mutations.iter().fold(text.to_owned(), |text, mutation| mutation.of(&text).unwrap_or(text))
}

impl Mutation {
    /// The text with this change; none where there is nothing to change.
    fn of(&self, text: &str) -> Option<String> {
        match self {
            Self::Number(at, number) => Some(replaced(text, attribute(text, at)?.value, number)),
            Self::Scale(at, power) => {
                let value = attribute(text, at)?.value;
                let number: f64 = text[value.clone()].parse().ok()?;
                Some(replaced(text, value, &(number * 10f64.powi(*power)).to_string()))
            }
            Self::Swap(at, from) => {
                let to = attribute(text, at)?;
                let alike: Vec<_> =
                    attributes(text).filter(|a| text[a.name.clone()] == text[to.name.clone()]).collect();
                Some(replaced(text, to.value, &text[alike[from.index(alike.len())].value.clone()]))
            }
            Self::Forget(at) => {
                let attribute = attribute(text, at)?;
                Some(replaced(text, attribute.name.start..attribute.value.end + 1, ""))
            }
            Self::Delete(at) => Some(replaced(text, element(text, at)?, "")),
            Self::Repeat(at, times) => {
                let element = element(text, at)?;
                let times = (*times).min(400_000 / element.len());
                Some(replaced(text, element.end..element.end, &text[element.clone()].repeat(times)))
            }
            Self::Nest(at, times) => {
                let element = element(text, at)?;
                let (inner, close) = (&text[element.clone()], inside(&text[element.clone()])?);
                let nested = (0..(*times).min(100_000 / inner.len() + 1))
                    .fold(inner.to_owned(), |nested, _| format!("{}{nested}{}", &inner[..close], &inner[close..]));
                Some(replaced(text, element, &nested))
            }
            Self::Move(at, from) => Some(replaced(text, element(text, at)?, &text[element(text, from)?])),
            Self::Cut(at) => Some(text[..text.floor_char_boundary(at.index(text.len().max(1)))].to_owned()),
        }
    }
}

fn replaced(text: &str, range: Range<usize>, with: &str) -> String {
    format!("{}{with}{}", &text[..range.start], &text[range.end..])
}

struct Attribute {
    name: Range<usize>,
    value: Range<usize>,
}

fn attribute(text: &str, at: &Index) -> Option<Attribute> {
    let count = attributes(text).count();
    attributes(text).nth(at.index(count.max(1)))
}

/// Everything like `name="value"`.
fn attributes(text: &str) -> impl Iterator<Item = Attribute> {
    text.match_indices("=\"").filter_map(|(equals, _)| {
        let start = text[..equals].rfind([' ', '\n', '<'])? + 1;
        let value = equals + 2;
        Some(Attribute { name: start..equals, value: value..value + text[value..].find('"')? })
    })
}

/// From the `<` of an element to behind its end; never the whole document.
fn element(text: &str, at: &Index) -> Option<Range<usize>> {
    let starts: Vec<usize> = text
        .match_indices('<')
        .map(|(i, _)| i)
        .filter(|i| {
            text[i + 1..].starts_with(|c: char| c.is_ascii_alphabetic()) && !text[i + 1..].starts_with("OpenDRIVE")
        })
        .collect();
    let start = *starts.get(at.index(starts.len().max(1)))?;
    let mut depth = 0;
    for (i, _) in text[start..].match_indices('<') {
        let tag = &text[start + i..];
        let end = tag.find('>')?;
        match tag.as_bytes()[1] {
            b'!' | b'?' => continue,
            b'/' => depth -= 1,
            _ if tag.as_bytes()[end - 1] == b'/' => {}
            _ => depth += 1,
        }
        if depth <= 0 {
            return Some(start..start + i + end + 1);
        }
    }
    None
}

/// Where the first child of an element would stand; none in an element without an end tag.
fn inside(element: &str) -> Option<usize> {
    let end = element.find('>')?;
    (!element[..end].ends_with('/')).then_some(end + 1)
}
