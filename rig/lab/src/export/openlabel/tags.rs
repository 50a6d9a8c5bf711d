//! Weather and light of a window in the ontology of scenario tags that comes with OpenLABEL 1.0.

use std::collections::BTreeSet;

use kernel::scene::Weather;

use super::document::{Data, Numbered, Ontology, Tag, Value};
use super::kinds::CLASSES;
use crate::cases::conditions::{self, Condition};

/// Key of the ontology.
pub const SCENARIO_TAGS: &str = "0";
const URI: &str = "https://openlabel.asam.net/V1-0-0/ontologies/openlabel_ontology_scenario_tags.ttl";
/// Tags of weather and light that may be here.
const WEATHER: [&str; 6] =
    ["DaySunElevation", "IlluminationCloudiness", "LowLightNight", "ParticulatesWater", "WeatherRain", "WeatherWind"];
const OKTAS_PER_PCT: f64 = 0.08;

/// The ontology, with every tag that may be here: one that is not does not hold.
pub fn ontologies() -> Numbered<Ontology> {
    let boundary_list = WEATHER.into_iter().chain(CLASSES).collect();
    [(0, Ontology { uri: URI, boundary_list, boundary_mode: "include" })].into()
}

/// What holds of a weather, and which classes of road users there are.
pub fn tags(weather: &Weather, classes: &BTreeSet<&'static str>) -> Numbered<Tag> {
    let tag = |r#type, tag_data| Tag { r#type, ontology_uid: SCENARIO_TAGS, tag_data };
    let number = |name, val| Data { num: vec![Value { name, val }], ..Data::default() };
    let oktas = OKTAS_PER_PCT * f64::from(weather.cloudiness_pct);
    let mut found = vec![
        tag("DaySunElevation", number("daySunElevationValue", weather.sun_altitude_deg.into())),
        tag("IlluminationCloudiness", number("illuminationCloudinessValue", oktas)),
    ];
    let conditions = conditions::bits(weather);
    let holds = |condition: Condition| conditions & condition as i64 != 0;
    let others = [
        ("LowLightNight", holds(Condition::Night)),
        ("ParticulatesWater", holds(Condition::Fog)),
        ("WeatherRain", holds(Condition::Rain)),
        ("WeatherWind", weather.wind_pct > 0.0),
    ];
    let others = others.into_iter().filter(|(_, holds)| *holds).map(|(name, _)| name);
    found.extend(others.chain(classes.iter().copied()).map(|name| tag(name, Data::default())));
    (0..).zip(found).collect()
}
