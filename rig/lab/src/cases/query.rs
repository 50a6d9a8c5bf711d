//! Which cases are asked for, and in which order.

use std::str::FromStr;

use base::words;
use kernel::scene::ActorKind;
use replay::Label;
use rusqlite::types::Value;

use super::conditions::WeatherChoice;
use super::review::{Reviewed, Tag};
use super::rows::Within;
use super::situation::{NEAR_COS, NEAR_M, NEAR_MPS, Situation};
use crate::redrive::Need;

/// What a parked car is called among those who were overlooked.
pub const PARKED_CAR: &str = "parked car";

/// Which cases are asked for. Of a list, one is enough; everything that is asked for must hold.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Query {
    /// Labels.
    pub label: Vec<Label>,
    /// Verdicts on the takeover.
    pub verdict: Vec<Need>,
    /// Names of maps.
    pub map: Vec<String>,
    /// Weather at the takeover.
    pub weather: Vec<WeatherChoice>,
    /// Levels of hazards, or `own`.
    pub hazards: Vec<String>,
    /// Names of checkpoints, or how their digests begin (8 digits or more).
    pub checkpoint: Vec<String>,
    /// Whether perception caused it.
    pub perception_caused: Vec<Caused>,
    /// Who was overlooked.
    pub overlooked: Vec<Overlooked>,
    /// Measured time to collision below this, seconds.
    pub ttc_below_s: Option<f64>,
    /// The same without the takeover.
    pub fork_ttc_below_s: Option<f64>,
    /// Reviews.
    pub reviewed: Vec<Reviewed>,
    /// Tags.
    pub tag: Vec<Tag>,
    /// One of each group of cases that are near each other, the first in order.
    pub unique: bool,
    /// The order.
    pub sort: Sort,
    /// The other way round.
    pub descending: bool,
    /// At most so many.
    pub limit: Option<u32>,
}

/// Whether perception caused a takeover.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Caused {
    /// True masks avoid it.
    Yes,
    /// They do not.
    No,
    /// Nobody tried.
    Unknown,
}

impl FromStr for Caused {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "yes" => Ok(Self::Yes),
            "no" => Ok(Self::No),
            "unknown" => Ok(Self::Unknown),
            _ => Err("expected yes, no or unknown".into()),
        }
    }
}

/// Somebody of a kind, of whom at least so many pixels were overlooked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Overlooked {
    /// Kinds of road users.
    pub kinds: Vec<&'static str>,
    /// Pixels in all frames of the window.
    pub pixels: u32,
}

impl FromStr for Overlooked {
    type Err = String;

    /// `KIND` or `KIND:PIXELS`.
    fn from_str(text: &str) -> Result<Self, String> {
        let (kind, pixels) = text.split_once(':').unwrap_or((text, "1"));
        let pixels =
            pixels.parse().map_err(|_| format!("{pixels:?} pixels; expected a whole number, as in walker:200"))?;
        let all = || ActorKind::ALL.iter().map(|kind| (words::road_user(*kind), kind.is_on_foot()));
        let all = all().chain([(PARKED_CAR, false)]);
        let is_meant = |name: &str, on_foot: bool| match kind {
            "any" => true,
            "walker" => on_foot,
            "vehicle" => !on_foot,
            _ => dashed(name) == kind,
        };
        let kinds: Vec<_> =
            all.clone().filter(|(name, on_foot)| is_meant(name, *on_foot)).map(|(name, _)| name).collect();
        if kinds.is_empty() {
            let names: Vec<_> = all.map(|(name, _)| dashed(name)).collect();
            return Err(format!("no road user {kind:?}; expected any, walker, vehicle, {}", names.join(", ")));
        }
        Ok(Self { kinds, pixels })
    }
}

/// A name of several words as one.
pub fn dashed(name: &str) -> String {
    name.replace(' ', "-").to_lowercase()
}

/// By what cases are sorted; those of which it is not known come last.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sort {
    /// By their files, as every command does.
    #[default]
    File,
    /// By the measured time to collision.
    Ttc,
    /// By that without the takeover.
    ForkTtc,
    /// By the speed at the takeover.
    Speed,
    /// By the most pixels that were overlooked of anybody.
    Overlooked,
    /// By the distance to the case that they are near to.
    Distance,
}

impl Sort {
    /// Every one.
    pub const ALL: [Self; 6] = [Self::File, Self::Ttc, Self::ForkTtc, Self::Speed, Self::Overlooked, Self::Distance];

    /// As commands have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::File => "file",
            Self::Ttc => "ttc",
            Self::ForkTtc => "fork-ttc",
            Self::Speed => "speed",
            Self::Overlooked => "overlooked",
            Self::Distance => "distance",
        }
    }

    fn column(self) -> &'static str {
        match self {
            Self::File => "c.place",
            Self::Ttc => "m.min_ttc_s",
            Self::ForkTtc => "c.fork_min_ttc_s",
            Self::Speed => "c.speed_mps",
            Self::Overlooked => "m.overlooked_px",
            Self::Distance => "distance2",
        }
    }
}

impl FromStr for Sort {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|sort| sort.name() == text);
        found.ok_or_else(|| format!("expected one of {}", Self::ALL.map(Self::name).join(", ")))
    }
}

impl Query {
    /// Whether it asks for all cases.
    pub fn asks_for_all(&self) -> bool {
        let Self { sort, descending, .. } = *self;
        *self == Self { sort, descending, ..Self::default() }
    }
}

/// What else decides which cases are given.
#[derive(Clone, Debug, Default)]
pub struct Scope {
    /// Folders below which they lie; all, without any.
    pub within: Vec<Within>,
    /// Only cases whose places are in the table `wanted`.
    pub only_wanted: bool,
    /// Only those near this case, without the case of this identity itself.
    pub near: Option<(Situation, String)>,
    /// Checkpoints of blind drives may be asked for.
    pub reveal: bool,
}

impl Scope {
    /// A condition on the `place` of the files that are meant, and its values; empty, where all are.
    fn files(&self) -> (String, Vec<Value>) {
        let (below, values): (Vec<&str>, Vec<Vec<String>>) = self.within.iter().map(Within::condition).unzip();
        let mut conditions = Vec::new();
        if !below.is_empty() {
            conditions.push(format!("({})", below.join(" OR ")));
        }
        if self.only_wanted {
            conditions.push("place IN temp.wanted".to_owned());
        }
        (conditions.join(" AND "), values.into_iter().flatten().map(Value::from).collect())
    }
}

/// A query in the database's language: what stands after `FROM`, and its values.
#[derive(Clone, Debug, Default)]
pub struct Sql {
    conditions: Vec<String>,
    values: Vec<Value>,
    distance2: String,
    order: String,
}

impl Sql {
    /// Says what is asked for.
    pub fn of(query: &Query, scope: &Scope) -> Self {
        let mut sql = Self { distance2: "NULL".into(), ..Self::default() };
        sql.scope(scope);
        sql.near(scope);
        sql.one_of("c.label", query.label.iter().map(|label| label.name()));
        sql.one_of("c.verdict", query.verdict.iter().map(|verdict| verdict.name()));
        sql.one_of("c.map", &query.map);
        sql.one_of("c.hazards", &query.hazards);
        sql.any(query.weather.iter().map(|choice| match choice {
            WeatherChoice::Preset(name) => ("c.weather = ?".into(), vec![text(*name)]),
            WeatherChoice::With(condition) => ("c.conditions & ? <> 0".into(), vec![Value::from(*condition as i64)]),
            WeatherChoice::Without(condition) => ("c.conditions & ? = 0".into(), vec![Value::from(*condition as i64)]),
        }));
        sql.checkpoints(&query.checkpoint, scope.reveal);
        sql.any(query.perception_caused.iter().map(|caused| {
            let value = match caused {
                Caused::Yes => "c.perception_caused = 1",
                Caused::No => "c.perception_caused = 0",
                Caused::Unknown => "c.perception_caused IS NULL",
            };
            (value.to_owned(), Vec::new())
        }));
        sql.any(query.overlooked.iter().map(|Overlooked { kinds, pixels }| {
            let marks = vec!["?"; kinds.len()].join(", ");
            let inner = format!("SELECT digest FROM overlooked WHERE kind IN ({marks}) AND pixels >= ?");
            let values = kinds.iter().map(|kind| text(*kind)).chain([Value::from(i64::from(*pixels))]);
            (format!("c.digest IN ({inner})"), values.collect())
        }));
        for (column, below) in [("m.min_ttc_s", query.ttc_below_s), ("c.fork_min_ttc_s", query.fork_ttc_below_s)] {
            sql.any(below.iter().map(|below| (format!("{column} < ?"), vec![Value::from(*below)])));
        }
        sql.any(query.reviewed.iter().map(|reviewed| match reviewed {
            Reviewed::Yes => ("c.identity IN (SELECT identity FROM reviews)".into(), Vec::new()),
            Reviewed::No => ("c.identity NOT IN (SELECT identity FROM reviews)".into(), Vec::new()),
            Reviewed::As(state) => {
                ("c.identity IN (SELECT identity FROM reviews WHERE state = ?)".into(), vec![text(state.name())])
            }
        }));
        sql.any(
            query
                .tag
                .iter()
                .map(|tag| ("c.identity IN (SELECT identity FROM tags WHERE tag = ?)".into(), vec![text(tag.name())])),
        );
        sql.order = order(query.sort, query.descending);
        sql
    }

    /// Of the files that are meant, the first of each case.
    fn scope(&mut self, scope: &Scope) {
        let (meant, values) = scope.files();
        if meant.is_empty() {
            return self.with("c.copy = 0", []);
        }
        let place_of = |table: &str| meant.replace("place", &format!("{table}.place"));
        self.with(&place_of("c"), values.clone());
        // By its number, which every index holds.
        let before = "SELECT 1 FROM cases own JOIN cases d ON d.identity = own.identity \
                      WHERE own.id = c.id AND d.place < c.place";
        self.with(&format!("(c.copy = 0 OR NOT EXISTS ({before} AND {}))", place_of("d")), values);
    }

    fn near(&mut self, scope: &Scope) {
        let Some((near, itself)) = &scope.near else { return };
        let Situation { map_digest, label, nearest, spot, speed_mps } = near;
        // Numbers, which need no escape; all of their digits.
        self.distance2 = format!(
            "((c.x_m - {x:?}) * (c.x_m - {x:?}) + (c.y_m - {y:?}) * (c.y_m - {y:?}))",
            x = spot.x_m,
            y = spot.y_m
        );
        self.with(
            "c.map_digest = ? AND c.x_m BETWEEN ? AND ?",
            [Value::from(map_digest.to_vec()), Value::from(spot.x_m - NEAR_M), Value::from(spot.x_m + NEAR_M)],
        );
        self.with(
            "c.label IS ? AND c.nearest IS ? AND c.id NOT IN (SELECT id FROM cases WHERE identity = ?)",
            [
                label.clone().map_or(Value::Null, Value::from),
                nearest.clone().map_or(Value::Null, Value::from),
                text(itself),
            ],
        );
        let distance2 = format!("{} <= ?", self.distance2);
        self.with(&distance2, [Value::from(NEAR_M * NEAR_M)]);
        self.with("abs(c.speed_mps - ?) <= ?", [Value::from(*speed_mps), Value::from(NEAR_MPS)]);
        self.with("c.ahead_x * ? + c.ahead_y * ? >= ?", [spot.ahead_x, spot.ahead_y, NEAR_COS].map(Value::from));
    }

    fn checkpoints(&mut self, checkpoints: &[String], reveal: bool) {
        if !checkpoints.is_empty() && !reveal {
            self.with("c.blind = 0", []);
        }
        self.any(checkpoints.iter().map(|name| match is_digest(name) {
            true => (
                "(c.checkpoint = ? OR substr(c.checkpoint_digest, 1, ?) = ?)".into(),
                vec![text(name), Value::from(name.len() as i64), text(name)],
            ),
            false => ("c.checkpoint = ?".into(), vec![text(name)]),
        }));
    }

    fn with(&mut self, condition: &str, values: impl IntoIterator<Item = Value>) {
        self.conditions.push(condition.to_owned());
        self.values.extend(values);
    }

    /// One of these conditions holds; any case will do where there are none.
    fn any(&mut self, choices: impl Iterator<Item = (String, Vec<Value>)>) {
        let (conditions, values): (Vec<String>, Vec<Vec<Value>>) = choices.unzip();
        if !conditions.is_empty() {
            self.with(&format!("({})", conditions.join(" OR ")), values.into_iter().flatten());
        }
    }

    fn one_of<T: AsRef<str>>(&mut self, column: &str, names: impl IntoIterator<Item = T>) {
        let values: Vec<Value> = names.into_iter().map(|name| text(name.as_ref())).collect();
        if !values.is_empty() {
            let marks = vec!["?"; values.len()].join(", ");
            self.with(&format!("{column} IN ({marks})"), values);
        }
    }

    /// The query for these columns of `c`, the case, and `m`, what was measured of it, in order; for the first so many.
    pub fn select(&self, columns: &str, limit: Option<u32>) -> String {
        let from = self.from(&[columns, &self.order]);
        let limit = limit.map_or(String::new(), |limit| format!(" LIMIT {limit}"));
        format!("SELECT {columns}, {} AS distance2 {from} ORDER BY {}{limit}", self.distance2, self.order)
    }

    /// The query for how many there are.
    pub fn count(&self) -> String {
        format!("SELECT COUNT(*) {}", self.from(&[]))
    }

    /// The query for the group of each, in any order.
    pub fn groups(&self) -> String {
        format!("SELECT c.situation {}", self.from(&[]))
    }

    /// What was measured is looked up only where it is asked for, by a condition or by these.
    fn from(&self, asked: &[&str]) -> String {
        let conditions = self.conditions.join(" AND ");
        let is_measured = asked.iter().any(|text| text.contains("m.")) || conditions.contains("m.");
        let join = if is_measured { "LEFT JOIN measured m ON m.digest = c.digest " } else { "" };
        format!("FROM cases c {join}WHERE {conditions}")
    }

    /// Its values.
    pub fn values(&self) -> &[Value] {
        &self.values
    }
}

/// Whether a text may be how a digest begins.
pub fn is_digest(text: &str) -> bool {
    text.len() >= 8 && text.bytes().all(|byte| byte.is_ascii_hexdigit())
}

fn order(sort: Sort, descending: bool) -> String {
    let (column, way) = (sort.column(), if descending { "DESC" } else { "ASC" });
    match sort {
        Sort::File => format!("{column} {way}"),
        _ => format!("{column} {way} NULLS LAST, c.place"),
    }
}

fn text(text: impl Into<String>) -> Value {
    Value::Text(text.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_was_overlooked_is_a_kind_or_several_and_a_number() {
        let of = |text: &str| text.parse::<Overlooked>();
        let walkers = of("walker:200").expect("a kind");
        assert_eq!((walkers.kinds.len(), walkers.pixels), (4, 200));
        assert_eq!(of("cargo-bike").expect("a kind"), Overlooked { kinds: vec!["cargo bike"], pixels: 1 });
        assert_eq!(of("suv").expect("a kind").kinds, ["SUV"]);
        assert_eq!(of("any").expect("all").kinds.len(), ActorKind::ALL.len() + 1);
        assert!(of("dog").unwrap_err().contains("expected any, walker, vehicle, car, ") && of("car:x").is_err());
    }

    #[test]
    fn words_are_read() {
        assert!(Sort::ALL.iter().all(|sort| sort.name().parse() == Ok(*sort)));
        assert_eq!("unknown".parse(), Ok(Caused::Unknown));
        assert!(is_digest("00ffAA11") && !is_digest("early123") && !is_digest("00ff"));
        assert!(Query { sort: Sort::Ttc, ..Query::default() }.asks_for_all());
        assert!(!Query { unique: true, ..Query::default() }.asks_for_all());
    }
}
