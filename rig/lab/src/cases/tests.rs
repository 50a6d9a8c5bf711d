//! What a query gives is what a filter over all cases gives, in plain Rust and without a database.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use measures::criticality::{Extreme, Extremes};
use proptest::prelude::*;
use replay::Label;

use super::conditions::{Condition, WeatherChoice};
use super::facts::Facts;
use super::index::{Access, Index};
use super::line::{CaseLine, OverlookedLine, count, lines, want};
use super::look::Measured;
use super::query::{Caused, Overlooked, Query, Scope, Sort, Sql};
use super::review::{Change, ReviewState, Reviewed, Tag};
use super::rows::{Within, Writer, regroup};
use super::situation::{Situation, Spot};
use super::{measure, rows};
use crate::redrive::Need;

/// A case and all that is known of it.
#[derive(Clone, Debug)]
struct Case {
    file: u8,
    facts: Facts,
    measured: Option<Measured>,
    review: Option<ReviewState>,
    tags: BTreeSet<&'static str>,
}

const TAGS: [&str; 3] = ["night-walk", "odd", "to-learn"];
const MAPS: [&str; 3] = ["city", "rural", "ring"];
const KINDS: [&str; 3] = ["pedestrian", "child", "car"];

fn tag(name: &str) -> Tag {
    name.parse().expect("a tag")
}

fn pick<T: Clone + std::fmt::Debug + 'static>(values: &[T]) -> impl Strategy<Value = T> + use<T> {
    prop::sample::select(values.to_vec())
}

fn facts() -> impl Strategy<Value = Facts> {
    let said = (prop::option::of(pick(&Label::CASES)), prop::option::of(any::<bool>()));
    let checkpoint = (prop::option::of(pick(&["early", "full", "00ffaa1122"])), 0u64..3, any::<bool>());
    let world = (pick(&MAPS), prop::option::of(pick(&["WetNoon", "ClearNight"])), 0i64..16, pick(&["none", "own"]));
    let spot = (prop::option::weighted(0.9, (-30.0f64..30.0, -15.0f64..15.0)), 0.0f64..60.0, 4.0f64..12.0);
    let fork = prop::option::of((pick(&Need::WITHOUT_INTERVENTION), prop::option::of(0.0f64..4.0)));
    (said, checkpoint, world, spot, fork, 0u64..60, any::<u64>()).prop_map(
        |(
            (label, caused),
            (checkpoint, digest, blind),
            (map, weather, conditions, hazards),
            (at, deg, mps),
            fork,
            tick,
            seed,
        )| {
            let (ahead_y, ahead_x) = deg.to_radians().sin_cos();
            Facts {
                // A few of these are the same case.
                identity: format!("{tick:032x}-{tick}"),
                digest: *blake3::hash(&seed.to_le_bytes()).as_bytes(),
                label,
                comment: None,
                perception_caused: caused,
                checkpoint: checkpoint.map(str::to_owned),
                checkpoint_digest: Some(format!("00ffaa11{digest:056}")),
                blind,
                map: map.to_owned(),
                seed,
                kernel: "0.1.0".into(),
                hazards,
                weather,
                conditions,
                tick,
                nearest: None,
                map_digest: [7; 16],
                spot: at.map(|(x_m, y_m)| Spot { x_m, y_m, ahead_x, ahead_y }),
                speed_mps: mps,
                verdict: fork.map(|(verdict, _)| verdict),
                fork_min_ttc_s: fork.and_then(|(_, ttc)| ttc),
            }
        },
    )
}

fn measured() -> impl Strategy<Value = Measured> {
    let overlooked = prop::collection::btree_map(0u32..4, (pick(&KINDS), 1u32..9, 1u32..400), 0..3);
    (prop::option::of(0.0f64..4.0), overlooked).prop_map(|(ttc, overlooked)| {
        let line = |(number, (kind, frames, pixels)): (u32, (&str, u32, u32))| OverlookedLine {
            actor: format!("{kind} {number}"),
            kind: kind.to_owned(),
            frames,
            pixels,
        };
        let extreme = ttc.map(|value| Extreme { value, tick: 1, with: "car 1".into() });
        let extremes =
            Extremes { min_ttc_s: extreme, min_pret_s: None, max_required_deceleration_mps2: None, pet_s: None };
        let overlooked = overlooked.into_iter().map(line).collect();
        Measured { extremes: Some(extremes), hazard: None, overlooked }
    })
}

fn cases() -> impl Strategy<Value = Vec<Case>> {
    let tags = prop::collection::btree_set(pick(&TAGS), 0..3);
    let case = (facts(), prop::option::of(measured()), prop::option::of(pick(&ReviewState::ALL)), tags);
    prop::collection::btree_map(any::<u8>(), case, 0..30).prop_map(|all| {
        let case = |(file, (facts, measured, review, tags))| Case { file, facts, measured, review, tags };
        all.into_iter().map(case).collect()
    })
}

/// None of a list most of the time.
fn few<S: Strategy<Value: Clone>>(one: S) -> impl Strategy<Value = Vec<S::Value>> {
    prop_oneof![3 => Just(Vec::new()), 1 => prop::collection::vec(one, 1..3)]
}

fn query() -> impl Strategy<Value = Query> {
    let weather = prop_oneof![
        pick(&["WetNoon", "ClearNight"]).prop_map(WeatherChoice::Preset),
        pick(&Condition::ALL).prop_map(WeatherChoice::With),
        pick(&[Condition::Wet, Condition::Night]).prop_map(WeatherChoice::Without),
    ];
    let overlooked = (pick(&["any", "walker", "vehicle", "child"]), 1u32..400)
        .prop_map(|(who, pixels)| format!("{who}:{pixels}").parse::<Overlooked>().expect("somebody"));
    let reviewed = prop_oneof![Just(Reviewed::Yes), Just(Reviewed::No), pick(&ReviewState::ALL).prop_map(Reviewed::As)];
    let names = |all: &[&'static str]| few(pick(all).prop_map(str::to_owned));
    let checkpoints = names(&["early", "full", "00ffaa11", "00ffaa1122", "00ffaa12"]);
    let first =
        (few(pick(&Label::CASES)), few(pick(&Need::WITHOUT_INTERVENTION)), names(&MAPS), few(weather), checkpoints);
    let second = (
        few(pick(&[Caused::Yes, Caused::No, Caused::Unknown])),
        few(overlooked),
        prop::option::weighted(0.2, 0.0f64..4.0),
        prop::option::weighted(0.2, 0.0f64..4.0),
        few(reviewed),
        few(pick(&TAGS).prop_map(tag)),
        names(&["own"]),
    );
    let sorts = [Sort::File, Sort::Ttc, Sort::ForkTtc, Sort::Speed, Sort::Overlooked];
    let third = (any::<bool>(), pick(&sorts), any::<bool>(), prop::option::weighted(0.2, 1u32..9));
    (first, second, third).prop_map(
        |(
            (label, verdict, map, weather, checkpoint),
            (perception_caused, overlooked, ttc_below_s, fork_ttc_below_s, reviewed, tag, hazards),
            (unique, sort, descending, limit),
        )| Query {
            label,
            verdict,
            map,
            weather,
            hazards,
            checkpoint,
            perception_caused,
            overlooked,
            ttc_below_s,
            fork_ttc_below_s,
            reviewed,
            tag,
            unique,
            sort,
            descending,
            limit,
        },
    )
}

/// Half of the cases lie in a folder, half in another.
fn name(file: u8) -> String {
    format!("{}/{file:03}.case.mcap", if file < 128 { "a" } else { "b" })
}

fn file(line: &CaseLine) -> u8 {
    line.way[2..5].parse().expect("a number")
}

/// Which files a call is about.
#[derive(Clone, Debug)]
enum Meant {
    All,
    Folder(&'static str),
    Files(BTreeSet<u8>),
}

impl Meant {
    fn holds(&self, file: u8) -> bool {
        match self {
            Self::All => true,
            Self::Folder(folder) => name(file).starts_with(folder),
            Self::Files(files) => files.contains(&file),
        }
    }

    fn scope(&self, index: &Index, reveal: bool) -> Scope {
        let place = |file: &u8| base::library::order(Path::new(&name(*file)));
        if let Self::Files(files) = self {
            let places: Vec<String> = files.iter().map(place).collect();
            index.read(|db| want(db, places.iter().map(String::as_str))).expect("writable");
            return Scope { only_wanted: true, reveal, ..Scope::default() };
        }
        let within = match self {
            Self::Folder(folder) => Within::of(base::library::order_below(Path::new(folder))),
            _ => Within::Home,
        };
        Scope { within: vec![within], reveal, ..Scope::default() }
    }
}

fn meant() -> impl Strategy<Value = Meant> {
    prop_oneof![
        2 => Just(Meant::All),
        1 => pick(&["a", "b"]).prop_map(Meant::Folder),
        1 => prop::collection::btree_set(any::<u8>(), 100..200).prop_map(Meant::Files),
    ]
}

/// An index of these cases in a folder.
fn index(folder: &Path, cases: &[Case]) -> Index {
    let mut index = Index::open(&folder.join("cases.sqlite"), Access::Write).expect("made");
    let fill = |db: &rusqlite::Transaction<'_>| {
        let mut writer = Writer::new(db)?;
        for case in cases {
            let name = name(case.file);
            writer.case((&base::library::order(Path::new(&name)), &name, "1"), &case.facts)?;
            if let Some(measured) = &case.measured {
                measure::put(db, &case.facts.digest, "engine", measured)?;
            }
            let add = case.tags.iter().map(|name| tag(name)).collect();
            Change { review: case.review, add, remove: Vec::new() }.make(db, &case.facts.identity)?;
        }
        regroup(db)
    };
    index.write(fill).expect("filled");
    index
}

/// The first file of each case of those that are meant. What people said belongs to the case, whichever file it was said of.
fn merged(cases: &[Case], meant: &Meant) -> Vec<Case> {
    let mut said: BTreeMap<&str, (Option<ReviewState>, BTreeSet<&'static str>)> = BTreeMap::new();
    for case in cases {
        let (review, tags) = said.entry(&case.facts.identity).or_default();
        *review = case.review.or(*review);
        tags.extend(&case.tags);
    }
    let mut seen = BTreeSet::new();
    let meant = cases.iter().filter(|case| meant.holds(case.file));
    let firsts = meant.filter(|case| seen.insert(&case.facts.identity));
    let merge = |case: &Case| {
        let (review, tags) = said[case.facts.identity.as_str()].clone();
        Case { review, tags, ..case.clone() }
    };
    firsts.map(merge).collect()
}

fn ttc(case: &Case) -> Option<f64> {
    Some(case.measured.as_ref()?.extremes.as_ref()?.min_ttc_s.as_ref()?.value)
}

fn most_overlooked(case: &Case) -> Option<f64> {
    let overlooked = &case.measured.as_ref()?.overlooked;
    Some(overlooked.iter().map(|line| f64::from(line.pixels)).fold(0.0, f64::max))
}

/// Whether a case is asked for.
fn is_meant(query: &Query, reveal: bool, case: &Case) -> bool {
    let facts = &case.facts;
    fn any<T>(choices: &[T], holds: impl Fn(&T) -> bool) -> bool {
        choices.is_empty() || choices.iter().any(holds)
    }
    let below = |limit: Option<f64>, value: Option<f64>| limit.is_none_or(|limit| value.is_some_and(|it| it < limit));
    let weather = |choice: &WeatherChoice| match choice {
        WeatherChoice::Preset(name) => facts.weather == Some(*name),
        WeatherChoice::With(condition) => facts.conditions & *condition as i64 != 0,
        WeatherChoice::Without(condition) => facts.conditions & *condition as i64 == 0,
    };
    let checkpoint = |name: &String| {
        let digest = facts.checkpoint_digest.as_deref().unwrap_or_default();
        let is_told = reveal || !facts.blind;
        is_told
            && (facts.checkpoint.as_ref() == Some(name) || (name.starts_with("00ff") && digest.starts_with(&**name)))
    };
    let caused = |asked: &Caused| match asked {
        Caused::Yes => facts.perception_caused == Some(true),
        Caused::No => facts.perception_caused == Some(false),
        Caused::Unknown => facts.perception_caused.is_none(),
    };
    let overlooked = |asked: &Overlooked| {
        let lines = case.measured.iter().flat_map(|measured| &measured.overlooked);
        lines.into_iter().any(|line| asked.kinds.contains(&line.kind.as_str()) && line.pixels >= asked.pixels)
    };
    let reviewed = |asked: &Reviewed| match asked {
        Reviewed::Yes => case.review.is_some(),
        Reviewed::No => case.review.is_none(),
        Reviewed::As(state) => case.review == Some(*state),
    };
    any(&query.label, |label| facts.label == Some(*label))
        && any(&query.verdict, |verdict| facts.verdict == Some(*verdict))
        && any(&query.map, |map| facts.map == *map)
        && any(&query.weather, weather)
        && any(&query.hazards, |level| facts.hazards == level)
        && any(&query.checkpoint, checkpoint)
        && any(&query.perception_caused, caused)
        && any(&query.overlooked, overlooked)
        && below(query.ttc_below_s, ttc(case))
        && below(query.fork_ttc_below_s, facts.fork_min_ttc_s)
        && any(&query.reviewed, reviewed)
        && any(&query.tag, |tag| case.tags.contains(tag.name()))
}

/// For each case the number of the one that its group is named by, whichever files are meant.
fn groups(cases: &[Case]) -> BTreeMap<String, usize> {
    let all = merged(cases, &Meant::All);
    let situations: Vec<Option<Situation>> = all.iter().map(|case| case.facts.situation()).collect();
    let groups = super::situation::groups(situations.iter().map(Option::as_ref));
    all.into_iter().map(|case| case.facts.identity).zip(groups).collect()
}

/// Files of the cases that are asked for, in order.
fn expected(query: &Query, reveal: bool, meant: &Meant, cases: &[Case]) -> Vec<u8> {
    let groups = groups(cases);
    let all = merged(cases, meant);
    let mut meant: Vec<&Case> = all.iter().filter(|case| is_meant(query, reveal, case)).collect();
    let key = |case: &Case| match query.sort {
        Sort::Ttc => ttc(case),
        Sort::ForkTtc => case.facts.fork_min_ttc_s,
        Sort::Speed => Some(case.facts.speed_mps),
        Sort::Overlooked => most_overlooked(case),
        Sort::File | Sort::Distance => None,
    };
    let turned = |value: f64| if query.descending { -value } else { value };
    if query.sort == Sort::File && query.descending {
        meant.reverse();
    }
    // Stable: of equal ones the first file comes first.
    meant.sort_by(|a, b| match (key(a).map(turned), key(b).map(turned)) {
        (Some(a), Some(b)) => a.total_cmp(&b),
        (a, b) => a.is_none().cmp(&b.is_none()),
    });
    let mut seen = BTreeSet::new();
    meant.retain(|case| !query.unique || seen.insert(groups[&case.facts.identity]));
    meant.truncate(query.limit.map_or(usize::MAX, |limit| limit as usize));
    meant.into_iter().map(|case| case.file).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_query_gives_what_a_filter_over_all_cases_gives(
        cases in cases(),
        queries in prop::collection::vec(query(), 1..6),
        meant in meant(),
        reveal in any::<bool>(),
    ) {
        let dir = tempfile::tempdir().expect("a folder");
        let index = index(dir.path(), &cases);
        let scope = meant.scope(&index, reveal);
        for query in queries {
            let sql = Sql::of(&query, &scope);
            let found = index.read(|db| lines(db, &query, &sql, reveal)).expect("an answer");
            let files: Vec<u8> = found.iter().map(file).collect();
            prop_assert_eq!(&files, &expected(&query, reveal, &meant, &cases), "{:?} of {:?}", query, meant);
            prop_assert_eq!(index.read(|db| count(db, &query, &sql)).expect("a number"), files.len() as u64);
            prop_assert!(found.iter().all(|line| reveal || !line.blind || line.checkpoint.is_none()));
        }
    }

    #[test]
    fn those_near_a_case_are_those_that_are_compared_with_it(cases in cases(), near in facts()) {
        let dir = tempfile::tempdir().expect("a folder");
        let index = index(dir.path(), &cases);
        prop_assume!(near.spot.is_some());
        let situation = near.situation().expect("a place");
        let scope = Scope { near: Some((situation.clone(), near.identity.clone())), ..Scope::default() };
        let query = Query { sort: Sort::Distance, ..Query::default() };
        let found = index.read(|db| lines(db, &query, &Sql::of(&query, &scope), true)).expect("an answer");
        let files: BTreeSet<u8> = found.iter().map(file).collect();
        let others = merged(&cases, &Meant::All).into_iter().filter(|case| case.facts.identity != near.identity);
        let is_near = |case: &Case| case.facts.situation().is_some_and(|it| it.is_near(&situation));
        let expected: BTreeSet<u8> = others.filter(is_near).map(|case| case.file).collect();
        prop_assert_eq!(files, expected);
        prop_assert!(found.is_sorted_by(|a, b| a.distance_m <= b.distance_m));
    }

    #[test]
    fn what_is_written_is_read(cases in cases()) {
        let dir = tempfile::tempdir().expect("a folder");
        let index = index(dir.path(), &cases);
        let query = Query::default();
        let found = index.read(|db| lines(db, &query, &Sql::of(&query, &Scope::default()), true)).expect("an answer");
        let all = merged(&cases, &Meant::All);
        prop_assert_eq!(found.len(), all.len());
        for (line, Case { facts, review, tags, measured, .. }) in found.iter().zip(&all) {
            prop_assert_eq!((line.seed, line.tick, &line.id), (facts.seed, facts.tick, &facts.identity));
            prop_assert_eq!(&line.checkpoint, &facts.checkpoint);
            prop_assert_eq!(&line.map_digest, &format!("{:032x}", u128::from_le_bytes(facts.map_digest)));
            prop_assert_eq!(line.position_m, facts.spot.map(|spot| [spot.x_m, spot.y_m]));
            prop_assert_eq!(line.review.as_deref(), review.map(ReviewState::name));
            prop_assert!(line.tags.iter().eq(tags));
            let told: Option<BTreeSet<_>> = line.measured.as_ref().map(|it| it.overlooked.iter().map(actor).collect());
            let known = measured.as_ref().map(|it| it.overlooked.iter().map(actor).collect());
            prop_assert_eq!(told, known);
        }
        let known = index.read(|db| rows::known(db, &Within::Home)).expect("readable");
        prop_assert_eq!(known.len(), cases.len());
    }
}

fn actor(line: &OverlookedLine) -> (&str, u32) {
    (&line.actor, line.pixels)
}
