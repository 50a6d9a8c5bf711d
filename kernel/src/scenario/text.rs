//! Scenarios as text.

use serde::Deserialize;

use super::fields::{MOST_OF_A_KIND, Scenario, ScenarioError};
use super::hazards::{Hazards, print_hazards};
use super::reader::{Given, Reader};
use super::weather::{self, AtStart};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Text {
    map: String,
    #[serde(default)]
    seed: u64,
    #[serde(default)]
    traffic: Traffic,
    #[serde(default)]
    hazards: Hazards,
    #[serde(default)]
    weather: AtStart,
    #[serde(default)]
    ego: Ego,
    #[serde(default)]
    car: Car,
    #[serde(default)]
    rules: Rules,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Traffic {
    cars: Given<u16>,
    motorcycles: Given<u16>,
    bicycles: Given<u16>,
    pedestrians: Given<u16>,
    jaywalks_per_min: Given<f32>,
    speed_share: Given<[f32; 2]>,
    headway_s: Given<[f32; 2]>,
    politeness: Given<f32>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Ego {
    lane: Given<u32>,
    s_m: Given<f32>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Car {
    abs: Option<bool>,
    esc: Option<bool>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Rules {
    max_speed_kmh: Given<f32>,
    max_seconds: Given<u32>,
    brake_threshold: Given<f32>,
    steer_threshold: Given<f32>,
    least_intervention_kmh: Given<f32>,
    takeover_s: Given<u32>,
}

impl Scenario {
    /// Parses TOML; unknown keys and values out of range are refused by name and line. What the
    /// text leaves out is as in [`Scenario::default_for`] its map and seed. Whether the map exists
    /// is for the caller to check, who knows where maps come from.
    pub fn from_toml(text: &str) -> Result<Self, ScenarioError> {
        parse(text)
    }

    /// The text that [`Scenario::from_toml`] reads back as this scenario.
    pub fn to_toml(&self) -> String {
        print(self)
    }
}

fn parse(text: &str) -> Result<Scenario, ScenarioError> {
    let reader = Reader { text };
    let given: Text = toml::from_str(text).map_err(|error| {
        let line = reader.line(error.span().map_or(0, |span| span.start));
        ScenarioError(format!("line {line}: {}", error.message().replace('\n', " ")))
    })?;
    let mut scenario = Scenario::default_for(&given.map, given.seed);
    traffic(&reader, given.traffic, &mut scenario)?;
    given.hazards.read(&reader, &mut scenario.hazards)?;
    weather::take(&reader, given.weather, &mut scenario)?;
    rules(&reader, given.rules, &mut scenario)?;
    if let Some(lane) = given.ego.lane {
        scenario.ego.lane = Some(*lane.get_ref());
    }
    let helpers = &mut scenario.car;
    helpers.abs = given.car.abs.unwrap_or(helpers.abs);
    helpers.esc = given.car.esc.unwrap_or(helpers.esc);
    reader.take("ego.s_m", given.ego.s_m, 0.0..=1e6, &mut scenario.ego.s_m)?;
    Ok(scenario)
}

fn traffic(reader: &Reader<'_>, given: Traffic, scenario: &mut Scenario) -> Result<(), ScenarioError> {
    let to = &mut scenario.traffic;
    let count = 0..=MOST_OF_A_KIND;
    reader.take("traffic.cars", given.cars, count.clone(), &mut to.cars)?;
    reader.take("traffic.motorcycles", given.motorcycles, count.clone(), &mut to.motorcycles)?;
    reader.take("traffic.bicycles", given.bicycles, count.clone(), &mut to.bicycles)?;
    reader.take("traffic.pedestrians", given.pedestrians, count, &mut to.pedestrians)?;
    reader.take("traffic.jaywalks_per_min", given.jaywalks_per_min, 0.0..=60.0, &mut to.jaywalks_per_min)?;
    let drivers = &mut to.drivers;
    reader.take_range("traffic.speed_share", given.speed_share, 0.5..=1.5, &mut drivers.speed_share)?;
    reader.take_range("traffic.headway_s", given.headway_s, 0.5..=4.0, &mut drivers.headway_s)?;
    reader.take("traffic.politeness", given.politeness, 0.0..=1.0, &mut drivers.politeness)
}

fn rules(reader: &Reader<'_>, given: Rules, scenario: &mut Scenario) -> Result<(), ScenarioError> {
    let to = &mut scenario.rules;
    let threshold = 0.01..=0.99;
    reader.take("rules.max_speed_kmh", given.max_speed_kmh, 5.0..=130.0, &mut to.max_speed_kmh)?;
    reader.take("rules.max_seconds", given.max_seconds, 4..=86_400, &mut to.max_seconds)?;
    reader.take("rules.brake_threshold", given.brake_threshold, threshold.clone(), &mut to.brake_threshold)?;
    reader.take("rules.steer_threshold", given.steer_threshold, threshold, &mut to.steer_threshold)?;
    let least = given.least_intervention_kmh;
    reader.take("rules.least_intervention_kmh", least, 0.0..=130.0, &mut to.least_intervention_kmh)?;
    reader.take("rules.takeover_s", given.takeover_s, 1..=60, &mut to.takeover_s)
}

/// Every key, so that the text still says the same when a default changes.
fn print(scenario: &Scenario) -> String {
    let Scenario { map, seed, traffic, hazards, weather, later, ego, car, rules } = scenario;
    let hazards = print_hazards(hazards);
    let map = toml::Value::from(map.as_str());
    let lane = ego.lane.map_or(String::new(), |lane| format!("lane = {lane}\n"));
    format!(
        "map = {map}\nseed = {seed}\n\n\
         [traffic]\ncars = {}\nmotorcycles = {}\nbicycles = {}\npedestrians = {}\njaywalks_per_min = {:?}\n\
         speed_share = {:?}\nheadway_s = {:?}\npoliteness = {:?}\n\n\
         {hazards}\n\
         {}\n\
         [ego]\n{lane}s_m = {:?}\n\n\
         [car]\nabs = {}\nesc = {}\n\n\
         [rules]\nmax_speed_kmh = {:?}\nmax_seconds = {}\nbrake_threshold = {:?}\nsteer_threshold = {:?}\n\
         least_intervention_kmh = {:?}\ntakeover_s = {}\n",
        traffic.cars,
        traffic.motorcycles,
        traffic.bicycles,
        traffic.pedestrians,
        traffic.jaywalks_per_min,
        traffic.drivers.speed_share,
        traffic.drivers.headway_s,
        traffic.drivers.politeness,
        weather::print(weather, later.as_ref()),
        ego.s_m,
        car.abs,
        car.esc,
        rules.max_speed_kmh,
        rules.max_seconds,
        rules.brake_threshold,
        rules.steer_threshold,
        rules.least_intervention_kmh,
        rules.takeover_s,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::car::CarSetup;
    use crate::traffic::Population;

    /// A map that is not bundled, so that no map has to be baked.
    const TEXT: &str = "map = \"field\"\nseed = 7\n\n[weather]\nsun_altitude_deg = 30\n\n[ego]\nlane = 2\ns_m = 4.5\n";

    fn refused(from: &str, to: &str) -> String {
        assert!(TEXT.contains(from));
        Scenario::from_toml(&TEXT.replace(from, to)).expect_err("this text is no scenario").0
    }

    #[test]
    fn what_is_left_out_is_the_default() {
        let scenario = Scenario::from_toml(TEXT).expect("a valid text");
        let mut expected = Scenario::default_for("field", 7);
        expected.weather.sun_altitude_deg = 30.0;
        (expected.ego.lane, expected.ego.s_m) = (Some(2), 4.5);
        assert_eq!(scenario, expected);
        let bare = Scenario::from_toml(&format!("{TEXT}\n[car]\nesc = false\n")).expect("a valid text");
        assert_eq!(bare.car, CarSetup { abs: true, esc: false });
    }

    #[test]
    fn a_text_comes_back() {
        for seed in [0, 1, 7, u64::MAX / 2, u64::MAX] {
            let mut scenario = Scenario::default_for("a \"map\" of its own", seed);
            scenario.car.abs = seed % 2 == 0;
            scenario.traffic.drivers = Population { speed_share: [0.7, 0.7], headway_s: [0.9, 2.5], politeness: 0.1 };
            (scenario.rules.least_intervention_kmh, scenario.rules.takeover_s) = (7.5, 1 + (seed % 60) as u32);
            assert_eq!(Scenario::from_toml(&scenario.to_toml()), Ok(scenario));
        }
    }

    #[test]
    fn mistakes_are_named_by_line_and_key() {
        let unit = refused("sun_altitude_deg", "sun_altitude_rad");
        assert!(unit.starts_with("line 5: unknown field `sun_altitude_rad`, expected"), "{unit}");
        let range = refused("= 30", "= 95");
        assert_eq!(range, "line 5: weather.sun_altitude_deg is 95, expected at least -90 and at most 90");
        let takeover = refused("[ego]", "[rules]\ntakeover_s = 0\n\n[ego]");
        assert_eq!(takeover, "line 8: rules.takeover_s is 0, expected at least 1 and at most 60");
        let least = refused("[ego]", "[rules]\nleast_intervention_kmh = -1\n\n[ego]");
        assert_eq!(least, "line 8: rules.least_intervention_kmh is -1, expected at least 0 and at most 130");
        let order = refused("[ego]", "[traffic]\nheadway_s = [2, 1]\n\n[ego]");
        let each = "expected the lower one first, each at least 0.5 and at most 4";
        assert_eq!(order, format!("line 8: traffic.headway_s is [2, 1], {each}"));
        let far = refused("[ego]", "[traffic]\nheadway_s = [1, nan]\n\n[ego]");
        assert_eq!(far, format!("line 8: traffic.headway_s is [1, NaN], {each}"));
        let kind = refused("= 30", "= \"high\"");
        assert!(kind.starts_with("line 5: ") && !kind.contains('\n'), "{kind}");
        let number = refused("= 4.5", "= nan");
        assert!(number.starts_with("line 9: ego.s_m is NaN"), "{number}");
        let syntax = refused("[ego]", "[ego");
        assert!(syntax.starts_with("line 7: "), "{syntax}");
        let section = refused("[ego]", "[wagon]");
        assert!(section.contains("unknown field `wagon`"), "{section}");
        let missing = refused("map = \"field\"\n", "");
        assert!(missing.contains("missing field `map`"), "{missing}");
    }
}
