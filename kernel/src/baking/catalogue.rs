//! What signals and signs mean, by the catalogues of countries. What is not in here is for nobody.

use super::pace;
use crate::map_data::Turn;

/// What a signal or sign tells those whom it is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Meaning {
    /// A light that holds those who turn so.
    Light(&'static [Turn]),
    /// Halt, then give way.
    Stop,
    /// Give way.
    Yield,
    /// At the next junction others give way.
    Priority,
    /// Nobody drives faster, m/s.
    Limit(f32),
    /// Buses halt here.
    BusStop,
}

impl Meaning {
    /// Whether it is for those who turn so.
    pub fn holds(self, turn: Turn) -> bool {
        !matches!(self, Self::Light(turns) if !turns.contains(&turn))
    }
}

/// What a sign of the table is about.
#[derive(Clone, Copy)]
enum Sign {
    Stop,
    Yield,
    Priority,
    Limit,
    BusStop,
}

/// Signs by country (ISO 3166) and code: StVO and VzKat; Vägmärkesförordningen 2007:90; Arrêté du 24 novembre
/// 1967; TSRGD 2016; MUTCD 2009.
const SIGNS: [(&str, &str, Sign); 28] = [
    ("DE", "205", Sign::Yield),
    ("DE", "206", Sign::Stop),
    ("DE", "224", Sign::BusStop),
    ("DE", "274", Sign::Limit),
    ("DE", "274.1", Sign::Limit),
    ("DE", "301", Sign::Priority),
    ("DE", "306", Sign::Priority),
    ("FR", "AB2", Sign::Priority),
    ("FR", "AB3A", Sign::Yield),
    ("FR", "AB4", Sign::Stop),
    ("FR", "AB6", Sign::Priority),
    ("FR", "B14", Sign::Limit),
    ("FR", "C6", Sign::BusStop),
    ("GB", "601.1", Sign::Stop),
    ("GB", "602", Sign::Yield),
    ("GB", "670", Sign::Limit),
    ("GB", "975", Sign::BusStop),
    ("SE", "B1", Sign::Yield),
    ("SE", "B2", Sign::Stop),
    ("SE", "B4", Sign::Priority),
    ("SE", "C31", Sign::Limit),
    ("SE", "E22", Sign::BusStop),
    ("US", "R1-1", Sign::Stop),
    ("US", "R1-2", Sign::Yield),
    ("US", "R2-1", Sign::Limit),
    ("US", "R7-107", Sign::BusStop),
    // As some files write them.
    ("FR", "AB3", Sign::Yield),
    ("GB", "601", Sign::Stop),
];

/// Lights with arrows of the catalogue that OpenDRIVE comes with, type and subtype.
const ARROWS: [(&str, &str, &[Turn]); 7] = [
    ("1000010", "10", &[Turn::Left]),
    ("1000010", "20", &[Turn::Right]),
    ("1000011", "10", &[Turn::Left]),
    ("1000011", "20", &[Turn::Right]),
    ("1000011", "30", &[Turn::Straight]),
    ("1000011", "40", &[Turn::Straight, Turn::Left]),
    ("1000011", "50", &[Turn::Straight, Turn::Right]),
];

/// Lights of the same catalogue that are for people on foot or bicycles only.
const NOT_FOR_CARS: [&str; 3] = ["1000002", "1000007", "1000013"];

/// A mile an hour, m/s.
const MPH_MPS: f32 = 0.44704;

/// What a signal of the file means; `None` where it means nothing here.
pub(super) fn meaning(signal: &xodr::Signal) -> Option<Meaning> {
    read(signal).ok()
}

/// What a signal of the file means, or why it means nothing here.
pub(super) fn read(signal: &xodr::Signal) -> Result<Meaning, &'static str> {
    if signal.invalidated {
        return Err("is struck out");
    }
    if let Some(turns) = light(signal) {
        return Ok(Meaning::Light(turns));
    }
    if NOT_FOR_CARS.contains(&signal.kind.as_str()) {
        return Err("holds no vehicles");
    }
    let known = sign(&signal.country, &signal.kind, &signal.subtype);
    let (country, sign) = known.ok_or("is in none of the catalogues")?;
    match sign {
        Sign::Stop => Ok(Meaning::Stop),
        Sign::Yield => Ok(Meaning::Yield),
        Sign::Priority => Ok(Meaning::Priority),
        Sign::BusStop => Ok(Meaning::BusStop),
        Sign::Limit => limit_mps(signal, country).map(Meaning::Limit).ok_or("shows no speed"),
    }
}

/// A signal in a note, as the file writes it.
pub(super) fn said(signal: &xodr::Signal) -> String {
    let told = |name: &str, text: &str| match text.trim() {
        "" => format!("no {name}"),
        text => format!("{name} {text}"),
    };
    let [kind, subtype] = [told("type", &signal.kind), told("subtype", &signal.subtype)];
    format!("{kind}, {subtype}, {}", told("country", &signal.country))
}

/// Whether a sign that a file writes so shows a speed limit.
pub(super) fn is_limit(country: &str, kind: &str, subtype: &str) -> bool {
    matches!(sign(country, kind, subtype), Some((_, Sign::Limit)))
}

/// The country of a sign, and what it is about.
fn sign(named: &str, kind: &str, subtype: &str) -> Option<(&'static str, Sign)> {
    let country = country(named)?;
    let told = SIGNS.iter().find(|(of, code, _)| *of == country && is_coded(kind, subtype, code))?;
    Some((country, told.2))
}

fn light(signal: &xodr::Signal) -> Option<&'static [Turn]> {
    let kind = signal.kind.as_str();
    let arrow = ARROWS.iter().find(|(of, subtype, _)| *of == kind && *subtype == signal.subtype);
    let is_light = kind == "1000001" || (signal.dynamic && kind.starts_with("10000") && !NOT_FOR_CARS.contains(&kind));
    arrow.map(|arrow| arrow.2).or(is_light.then_some(Turn::ALL))
}

/// The country whose catalogue a file means: the German one where it names none.
fn country(named: &str) -> Option<&'static str> {
    const NAMES: [(&str, &[&str]); 5] = [
        ("DE", &["", "-1", "NONE", "OPENDRIVE", "DE", "DEU", "GERMANY"]),
        ("FR", &["FR", "FRA", "FRANCE"]),
        ("GB", &["GB", "UK", "GBR"]),
        ("SE", &["SE", "SWE", "SWEDEN"]),
        ("US", &["US", "USA"]),
    ];
    let named = named.trim().to_ascii_uppercase();
    NAMES.iter().find(|(_, names)| names.contains(&named.as_str())).map(|(country, _)| *country)
}

/// Whether a signal has a code, which files write as its type, before a number that only says what the sign shows, or as
/// type and subtype.
fn is_coded(kind: &str, subtype: &str, code: &str) -> bool {
    let (kind, subtype) = (kind.trim(), subtype.trim());
    let before = kind.rsplit_once('-').map_or(kind, |(before, _)| before);
    let joined = ["", "-", "."].map(|with| format!("{kind}{with}{subtype}"));
    [kind, before].into_iter().chain(joined.iter().map(String::as_str)).any(|told| code.eq_ignore_ascii_case(told))
}

/// What a sign shows; `None` where it shows no number, or one of no speed.
fn limit_mps(signal: &xodr::Signal, country: &str) -> Option<f32> {
    use xodr::Unit as U;
    let one_mps = match signal.unit {
        Some(U::MetrePerSecond) => 1.0,
        Some(U::MilePerHour) => MPH_MPS,
        None if ["GB", "US"].contains(&country) => MPH_MPS,
        Some(U::KilometrePerHour) | None => 1.0 / 3.6,
        Some(_) => return None,
    };
    let shown = signal.value.filter(|value| *value > 0.0)?;
    Some(pace::within(shown as f32 * one_mps))
}
