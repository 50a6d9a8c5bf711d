//! Damaged models: whatever is changed in a folder of them, it is read or refused in one sentence that names it. Nothing
//! panics, ends the program or takes more memory than its limit. `tests/fuzz.sh` tries for longer.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::TestCaseResult;
use serde_json::{Value, json};

use super::load;
use super::tests::sketch::{car, packed, parts, textured};
use crate::failure::sentence;

const LIST: &str = "[[models]]\nfile = \"damaged.glb\"\nis = [\"car\", \"bench\"]\nwheels = [\"fl\"]\nsteered = [\"fl\"]\n\
                    rider = [\"fr\"]\nlegs = [\"rl\", \"rr\"]\nlacquer = [\"paint\"]\n";

/// Numbers at which things break.
const ODD: [f64; 18] = [
    0.0,
    1.0,
    -1.0,
    2.0,
    3.0,
    4.0,
    5.0,
    23.0,
    255.0,
    5121.0,
    5123.0,
    5126.0,
    65_536.0,
    2_147_483_648.0,
    4_294_967_295.0,
    1e18,
    1e30,
    -1e38,
];

/// A change of a value of the JSON.
#[derive(Clone, Debug)]
enum Fate {
    Number(Index),
    Gone,
    Text,
    /// What stands at another place.
    Other(Index),
}

fn fates() -> impl Strategy<Value = Vec<(Index, Fate)>> {
    let fate = prop_oneof![
        5 => any::<Index>().prop_map(Fate::Number),
        1 => Just(Fate::Gone),
        1 => Just(Fate::Text),
        2 => any::<Index>().prop_map(Fate::Other),
    ];
    vec((any::<Index>(), fate), 1..4)
}

/// Where values stand.
fn places(value: &Value, at: &str, all: &mut Vec<String>) {
    let mut inside = |key: &str, inner: &Value| {
        let at = format!("{at}/{key}");
        all.push(at.clone());
        places(inner, &at, all);
    };
    match value {
        Value::Object(map) => map.iter().for_each(|(key, inner)| inside(key, inner)),
        Value::Array(list) => list.iter().enumerate().for_each(|(i, inner)| inside(&i.to_string(), inner)),
        _ => {}
    }
}

fn change(root: &mut Value, (at, fate): &(Index, Fate)) {
    let mut all = Vec::new();
    places(root, "", &mut all);
    if all.is_empty() {
        return;
    }
    let value = match fate {
        Fate::Number(odd) => {
            let odd = *odd.get(&ODD);
            if odd.fract() == 0.0 && odd.abs() < 1e19 { json!(odd as i64) } else { json!(odd) }
        }
        Fate::Gone => Value::Null,
        Fate::Text => json!("../damaged"),
        Fate::Other(other) => root.pointer(other.get(&all[..]).as_str()).cloned().unwrap_or_default(),
    };
    if let Some(place) = root.pointer_mut(at.get(&all[..]).as_str()) {
        *place = value;
    }
}

fn check(file: &[u8]) -> TestCaseResult {
    let folder = hunt::trying(&[("models.toml", LIST.as_bytes()), ("damaged.glb", file)]);
    if let Err(error) = load(&folder) {
        let text = sentence(&error);
        prop_assert!(text.contains("damaged") && text.len() < 3_000, "{}", text);
    }
    Ok(())
}

#[test]
fn changed_values() {
    let valid = [parts(&car()), textured(1)];
    hunt::hunt("model", 150, (any::<Index>(), fates()), |(which, fates)| {
        let (mut root, bin) = which.get(&valid).clone();
        fates.iter().for_each(|fate| change(&mut root, fate));
        check(&packed(root.to_string().into_bytes(), bin))
    });
}

#[test]
fn changed_bytes() {
    let valid = [parts(&car()), textured(1)].map(|(root, bin)| packed(root.to_string().into_bytes(), bin));
    let bytes = vec((any::<Index>(), any::<u8>()), 0..8);
    hunt::hunt("model's bytes", 150, (any::<Index>(), bytes, any::<Index>()), |(which, bytes, end)| {
        let mut file = which.get(&valid).clone();
        bytes.iter().for_each(|(at, byte)| *at.get_mut(&mut file) = *byte);
        file.truncate(if bytes.is_empty() { end.index(file.len()) } else { file.len() });
        check(&file)
    });
}
