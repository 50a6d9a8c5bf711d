//! Changes of files: numbers, texts and lines of a text, bytes of any file.

use std::ops::Range;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;

/// What is put into files: numbers at which things break, and signs that mean something.
const ODD: [&str; 36] = [
    "0",
    "-0",
    "-1",
    "1",
    "0.5",
    "1e-300",
    "1e308",
    "1e999",
    "nan",
    "-inf",
    "255",
    "65536",
    "60000",
    "2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551615",
    "340282366920938463463374607431768211455",
    "true",
    "null",
    "\"../../x\"",
    "\"\"",
    "../../x",
    "/dev/zero",
    "[",
    "]",
    "{",
    "}",
    "\"",
    "\\",
    "\n",
    "=",
    "\0",
    "\u{202e}\u{1b}[2J",
];
/// Longest a file grows by repetition, bytes.
const MOST_BYTES: usize = 200_000;

/// A change of a file, and where; the indexes are of what the file holds at that time.
#[derive(Clone, Debug)]
pub enum Change {
    /// Something odd instead of a number.
    Number(Index, Index),
    /// Something odd instead of what stands between quotation marks.
    Text(Index, Index),
    /// A line so many times instead of once; none at 0.
    Line(Index, usize),
    /// A line in the place of another.
    Move(Index, Index),
    /// Something odd, or a byte, instead of some bytes.
    Bytes(Index, usize, Result<Index, u8>),
    /// The file ends here.
    Cut(Index),
}

/// None to six changes.
pub fn changes() -> impl Strategy<Value = Vec<Change>> {
    let at = any::<Index>;
    let with = prop_oneof![at().prop_map(Ok), any::<u8>().prop_map(Err)];
    let times = prop_oneof![4 => 0..3usize, 1 => 3..2_000usize];
    let one = prop_oneof![
        8 => (at(), at()).prop_map(|(at, odd)| Change::Number(at, odd)),
        4 => (at(), at()).prop_map(|(at, odd)| Change::Text(at, odd)),
        4 => (at(), times).prop_map(|(at, times)| Change::Line(at, times)),
        2 => (at(), at()).prop_map(|(at, from)| Change::Move(at, from)),
        4 => (at(), 0..20usize, with).prop_map(|(at, gone, with)| Change::Bytes(at, gone, with)),
        1 => at().prop_map(Change::Cut),
    ];
    vec(one, 0..7)
}

/// The file with some changes.
pub fn changed(valid: &[u8], changes: &[Change]) -> Vec<u8> {
    changes.iter().fold(valid.to_vec(), |bytes, change| change.of(&bytes))
}

impl Change {
    fn of(&self, bytes: &[u8]) -> Vec<u8> {
        let odd = |index: &Index| index.get(&ODD).as_bytes();
        match self {
            Self::Number(at, with) => pick(&numbers(bytes), at).map(|range| spliced(bytes, range, odd(with))),
            Self::Text(at, with) => pick(&texts(bytes), at).map(|range| spliced(bytes, range, odd(with))),
            Self::Line(at, times) => pick(&lines(bytes), at).map(|line| {
                let most = MOST_BYTES / line.len();
                spliced(bytes, line.clone(), &bytes[line].repeat(*times.min(&most)))
            }),
            Self::Move(at, from) => {
                let lines = lines(bytes);
                pick(&lines, at).zip(pick(&lines, from)).map(|(to, from)| spliced(bytes, to, &bytes[from]))
            }
            Self::Bytes(at, gone, with) => {
                let from = at.index(bytes.len() + 1);
                let to = (from + gone).min(bytes.len());
                let with = with.as_ref().map_or_else(|byte| std::slice::from_ref(byte), odd);
                Some(spliced(bytes, from..to, with))
            }
            Self::Cut(at) => Some(bytes[..at.index(bytes.len() + 1)].to_vec()),
        }
        .unwrap_or_else(|| bytes.to_vec())
    }
}

fn pick(places: &[Range<usize>], at: &Index) -> Option<Range<usize>> {
    (!places.is_empty()).then(|| at.get(places).clone())
}

fn spliced(bytes: &[u8], range: Range<usize>, with: &[u8]) -> Vec<u8> {
    [&bytes[..range.start], with, &bytes[range.end..]].concat()
}

/// Runs of what numbers are written with, where one begins.
fn numbers(bytes: &[u8]) -> Vec<Range<usize>> {
    let is_of_number = |byte: &u8| byte.is_ascii_digit() || b".-+e".contains(byte);
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let length = bytes[at..].iter().take_while(|byte| is_of_number(byte)).count();
        if length > 0 && bytes[at..at + length].iter().any(u8::is_ascii_digit) {
            found.push(at..at + length);
        }
        at += length.max(1);
    }
    found
}

/// What stands between quotation marks, these included.
fn texts(bytes: &[u8]) -> Vec<Range<usize>> {
    let marks: Vec<usize> = bytes.iter().enumerate().filter(|(_, byte)| **byte == b'"').map(|(at, _)| at).collect();
    marks.chunks_exact(2).map(|pair| pair[0]..pair[1] + 1).collect()
}

/// Lines with their ends.
fn lines(bytes: &[u8]) -> Vec<Range<usize>> {
    let mut from = 0;
    bytes
        .split_inclusive(|byte| *byte == b'\n')
        .map(|line| {
            from += line.len();
            from - line.len()..from
        })
        .collect()
}

#[test]
fn every_change_changes_what_it_says() {
    let text = b"a = 12\nb = \"some\"\nc = 3\n";
    assert_eq!([numbers(text).len(), texts(text).len(), lines(text).len()], [2, 1, 3]);
    proptest!(|(at in any::<Index>(), odd in any::<Index>())| {
        for change in [Change::Number(at, odd), Change::Text(at, odd), Change::Line(at, 2), Change::Line(at, 0)] {
            prop_assert!(change.of(text) != text, "{:?}", change);
        }
    });
}
