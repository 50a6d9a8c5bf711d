//! Scenarios as text.

use crate::car::CarSetup;
use crate::story::Story;
use crate::traffic::TrafficCounts;

use super::fields::{EgoStart, MOST_KMH, MOST_OF_A_KIND, Rules, Scenario, ScenarioError};
use super::hazards::{print_hazards, read_hazards};
use super::reader::Section;
use super::weather::{self, read_weather};

/// What the key `map` names.
const MAP: &str = "the name of a bundled map or of a file .xodr";

impl Scenario {
    /// Parses TOML; unknown keys, and values of another kind or out of range, are refused by line and name. What the
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
    let mut root = Section::whole_text(text)?;
    let map = root.named("map", || MAP.into(), |name| Some(name.to_owned()))?;
    let map = map.ok_or_else(|| ScenarioError(format!("the key map is missing, expected {MAP}")))?;
    let seed = root.whole("seed", 0..=u64::MAX)?.unwrap_or_default();
    let mut scenario = Scenario::default_for(&map, seed);
    // What the text itself says of the weather goes before what its story does.
    read_story(&mut root, &mut scenario)?;
    read_traffic(&mut root, &mut scenario.traffic)?;
    read_hazards(&mut root, &mut scenario.hazards)?;
    read_weather(&mut root, &mut scenario)?;
    read_ego(&mut root, &mut scenario.ego)?;
    read_car(&mut root, &mut scenario.car)?;
    read_rules(&mut root, &mut scenario.rules)?;
    root.end()?;
    Ok(scenario)
}

fn read_traffic(root: &mut Section<'_>, to: &mut TrafficCounts) -> Result<(), ScenarioError> {
    root.section("traffic", "keys such as cars = 40", |section| {
        let count = 0..=MOST_OF_A_KIND;
        to.cars = section.whole("cars", count.clone())?.unwrap_or(to.cars);
        to.motorcycles = section.whole("motorcycles", count.clone())?.unwrap_or(to.motorcycles);
        to.bicycles = section.whole("bicycles", count.clone())?.unwrap_or(to.bicycles);
        to.pedestrians = section.whole("pedestrians", count)?.unwrap_or(to.pedestrians);
        section.number("jaywalks_per_min", 0.0..=60.0, &mut to.jaywalks_per_min)?;
        section.pair("speed_share", 0.5..=1.5, &mut to.drivers.speed_share)?;
        section.pair("headway_s", 0.5..=4.0, &mut to.drivers.headway_s)?;
        section.number("politeness", 0.0..=1.0, &mut to.drivers.politeness)
    })
}

fn read_ego(root: &mut Section<'_>, to: &mut EgoStart) -> Result<(), ScenarioError> {
    root.section("ego", "keys such as lane = 3", |section| {
        to.lane = section.whole("lane", 0..=u32::MAX)?;
        section.number("s_m", 0.0..=1e6, &mut to.s_m)
    })
}

fn read_car(root: &mut Section<'_>, to: &mut CarSetup) -> Result<(), ScenarioError> {
    root.section("car", "keys such as abs = true", |section| {
        section.switch("abs", &mut to.abs)?;
        section.switch("esc", &mut to.esc)
    })
}

fn read_rules(root: &mut Section<'_>, to: &mut Rules) -> Result<(), ScenarioError> {
    root.section("rules", "keys such as max_seconds = 600", |section| {
        let threshold = 0.01..=0.99;
        section.number("max_speed_kmh", 5.0..=MOST_KMH, &mut to.max_speed_kmh)?;
        to.max_seconds = section.whole("max_seconds", 4..=86_400)?.unwrap_or(to.max_seconds);
        section.number("brake_threshold", threshold.clone(), &mut to.brake_threshold)?;
        section.number("steer_threshold", threshold, &mut to.steer_threshold)?;
        section.number("least_intervention_kmh", 0.0..=130.0, &mut to.least_intervention_kmh)?;
        to.takeover_s = section.whole("takeover_s", 1..=60)?.unwrap_or(to.takeover_s);
        Ok(())
    })
}

/// What is wrong in a story is told by the story's own lines.
fn read_story(root: &mut Section<'_>, to: &mut Scenario) -> Result<(), ScenarioError> {
    let expected = || "a text in OpenSCENARIO XML".to_owned();
    let Some(text) = root.named("story", expected, |text| Some(text.to_owned()))? else { return Ok(()) };
    let story = Story::read(&text).map_err(|error| ScenarioError(format!("story, {error}")))?;
    to.play(story);
    Ok(())
}

/// Every key, so that the text still says the same when a default changes.
fn print(scenario: &Scenario) -> String {
    let Scenario { map, seed, traffic, hazards, weather, later, ego, car, rules, story } = scenario;
    // Keys of the whole text stand before its sections.
    let story = story.as_ref().map_or(String::new(), |story| format!("story = {}\n", toml::Value::from(story.text())));
    let hazards = print_hazards(hazards);
    let map = toml::Value::from(map.as_str());
    let lane = ego.lane.map_or(String::new(), |lane| format!("lane = {lane}\n"));
    format!(
        "map = {map}\nseed = {seed}\n{story}\n\
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
    use crate::traffic::Population;
    use crate::weather::WeatherChange;

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
        for (from, to, said) in [
            (
                "sun_altitude_deg",
                "sun_altitude_rad",
                "line 5: unknown key weather.sun_altitude_rad, expected one of preset,",
            ),
            (
                "[ego]",
                "[wagon]",
                "line 7: unknown key wagon, expected one of map, seed, story, traffic, hazards, weather,",
            ),
            ("[ego]", "[rules]\nabs = true\n\n[ego]", "line 8: unknown key rules.abs, expected one of max_speed_kmh,"),
            ("= 30", "= 95", "line 5: weather.sun_altitude_deg is 95, expected a number from -90 to 90"),
            ("= 30", "= \"high\"", "line 5: weather.sun_altitude_deg is \"high\", expected a number from -90 to 90"),
            ("= 4.5", "= nan", "line 9: ego.s_m is nan, expected a number from 0 to 1000000"),
            ("lane = 2", "lane = 2.0", "line 8: ego.lane is 2.0, expected a whole number from 0 to 4294967295"),
            ("seed = 7", "seed = -7", "line 2: seed is -7, expected a whole number from 0 to 18446744073709551615"),
            ("seed = 7", "seed = 7e0", "line 2: seed is 7e0, expected a whole number from 0 to "),
            ("seed = 7", "seed = 7\nseed = 8", "line 3: duplicate key"),
            ("[ego]", "[ego", "line 7: "),
            (
                "map = \"field\"",
                "map = true",
                "line 1: map is true, expected the name of a bundled map or of a file .xodr",
            ),
            ("map = \"field\"", "", "the key map is missing, expected the name of a bundled map or of a file .xodr"),
            (
                "seed = 7",
                "hazards = \"none\"",
                "line 2: hazards is \"none\", expected a section [hazards] with level = \"none\" or \"natural\" or \"r",
            ),
            (
                "seed = 7",
                "traffic = 40",
                "line 2: traffic is 40, expected a section [traffic] with keys such as cars = 40",
            ),
            ("seed = 7", "traffic.cars = -1", "line 2: traffic.cars is -1, expected a whole number from 0 to 500"),
            ("seed = 7", "traffic.cars = 501", "line 2: traffic.cars is 501, expected a whole number from 0 to 500"),
            (
                "seed = 7",
                "traffic.cars = 70_000",
                "line 2: traffic.cars is 70_000, expected a whole number from 0 to 500",
            ),
            (
                "[ego]",
                "[traffic.cars]\n[ego]",
                "line 7: traffic.cars is a section, expected a whole number from 0 to 500",
            ),
            (
                "[ego]",
                "[weather.later]\nover_s = []\n[ego]",
                "line 8: weather.later.over_s is [], expected a number from 1 to",
            ),
            (
                "= 30",
                "= 30\nlater = 9",
                "line 6: weather.later is 9, expected a section [weather.later] with keys such as",
            ),
            ("= 30", "= 30\npreset = 9", "line 6: weather.preset is 9, expected one of ClearNoon, "),
            ("[ego]", "[hazards]\nlevel = 0\n[ego]", "line 8: hazards.level is 0, expected \"none\" or \"natural\" or"),
            ("[ego]", "[car]\nesc = \"off\"\n[ego]", "line 8: car.esc is \"off\", expected true or false"),
            (
                "[ego]",
                "[rules]\ntakeover_s = 0\n[ego]",
                "line 8: rules.takeover_s is 0, expected a whole number from 1 to 60",
            ),
            (
                "[ego]",
                "[rules]\nbrake_threshold = 1\n[ego]",
                "line 8: rules.brake_threshold is 1, expected a number from 0.01",
            ),
        ] {
            let refused = refused(from, to);
            assert!(refused.starts_with(said) && !refused.contains('\n'), "{refused:?} does not begin with {said:?}");
        }
    }

    #[test]
    fn two_numbers_are_refused_together() {
        for given in ["[2, 1]", "[1, nan]", "[1]", "[1, 2, 3]", "[1, \"2\"]", "1", "[0.4, 1]", "[1, 4.5]"] {
            let said = refused("[ego]", &format!("[traffic]\nheadway_s = {given}\n\n[ego]"));
            let expected = "expected a list of two numbers from 0.5 to 4, the lower one first";
            assert_eq!(said, format!("line 8: traffic.headway_s is {given}, {expected}"));
        }
    }

    #[test]
    fn every_key_says_what_it_expects_and_shows_the_beginning_of_what_is_long() {
        let mut scenario = Scenario::default_for("field", 7);
        (scenario.ego.lane, scenario.later) = (Some(1), Some(WeatherChange { to: scenario.weather, over_s: 60.0 }));
        let text = scenario.to_toml();
        let lines: Vec<&str> = text.lines().collect();
        let (mut section, mut keys) = (String::new(), 0);
        for (at, line) in lines.iter().enumerate() {
            if let Some(name) = line.strip_prefix('[') {
                section = name.replace(']', ".");
            }
            let Some((key, _)) = line.split_once(" = ") else { continue };
            let (wrong, shown) = match key {
                "map" => ("1979-05-27".to_owned(), "1979-05-27".to_owned()),
                _ => (format!("\"{}\"", "x".repeat(99)), format!("\"{}...", "x".repeat(39))),
            };
            let wrong = format!("{key} = {wrong}");
            let text = [&lines[..at], &[wrong.as_str()], &lines[at + 1..]].concat().join("\n");
            let said = Scenario::from_toml(&text).expect_err(&wrong).0;
            let named = format!("line {}: {section}{key} is {shown}, expected ", at + 1);
            assert!(said.starts_with(&named), "{said:?} does not begin with {named:?}");
            keys += 1;
        }
        assert!(keys > 45, "only {keys} keys");
    }
}
