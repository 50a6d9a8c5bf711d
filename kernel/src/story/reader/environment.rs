//! The weather, in the units of the standard.

use core::f32::consts::PI;

use crate::ops;
use crate::story::error::StoryError;
use crate::story::script::Environment;

use super::document::Element;
use super::vary;

/// Wind of 100 %: a storm, Beaufort 10, m/s.
const STORM_MPS: f32 = 24.5;
/// Rain of 100 %, mm an hour.
const CLOUDBURST_MM_H: f32 = 50.0;
/// How far one sees in fog of 100 %, metres; from so far on there is none.
const DENSEST_FOG_M: f32 = 50.0;
const CLEAR_M: f32 = 10_000.0;
/// What a wet road takes of the grip: a factor of friction below 1 is that of a road so wet.
const WET_GRIP_LOSS: f32 = 0.25;
/// The sun of an hour, where nothing else is said: that of 50 degrees north at an equinox.
const LATITUDE_RAD: f32 = 50.0 / 180.0 * PI;

/// By the eighths of the sky that clouds cover, percent.
const OKTAS: &[(&str, f32)] = &[
    ("zeroOktas", 0.0),
    ("oneOktas", 12.5),
    ("twoOktas", 25.0),
    ("threeOktas", 37.5),
    ("fourOktas", 50.0),
    ("fiveOktas", 62.5),
    ("sixOktas", 75.0),
    ("sevenOktas", 87.5),
    ("eightOktas", 100.0),
    ("nineOktas", 100.0),
];
/// The same as 1.0 and 1.1 have it.
const CLOUDS: &[(&str, f32)] =
    &[("skyOff", 0.0), ("free", 0.0), ("cloudy", 50.0), ("overcast", 100.0), ("rainy", 100.0)];
/// How wet surfaces are, and water that stands on them, percent.
const WETNESS: &[(&str, [f32; 2])] = &[
    ("dry", [0.0, 0.0]),
    ("moist", [40.0, 0.0]),
    ("wetWithPuddles", [100.0, 40.0]),
    ("lowFlooded", [100.0, 70.0]),
    ("highFlooded", [100.0, 100.0]),
];

/// What an `<EnvironmentAction>` says.
pub fn read(action: Element<'_>) -> Result<Environment, StoryError> {
    let environment = action.need("Environment")?;
    vary::pass_parameters(environment)?;
    let mut found = Environment::default();
    if let Some(weather) = environment.child("Weather") {
        self::weather(weather, &mut found)?;
    }
    if let Some(road) = environment.child("RoadCondition") {
        let friction = road.amount("frictionScaleFactor")?;
        let wet_pct = ((1.0 - friction) / WET_GRIP_LOSS * 100.0).clamp(0.0, 100.0);
        let told = road.word_given("wetness", WETNESS)?;
        let properties = road.child("Properties");
        properties.into_iter().flat_map(|all| all.all("Property")).for_each(drop);
        found.water_pct = Some(told.unwrap_or([wet_pct, 0.0]));
    }
    if let Some(time) = environment.child("TimeOfDay") {
        time.given("animation")?;
        let hour = hour(&time.text("dateTime")?);
        let hour =
            hour.ok_or_else(|| time.wrong("dateTime of <TimeOfDay> is none: expected as 2026-05-01T14:30:00"))?;
        found.sun_deg = found.sun_deg.or(Some(sun_at(hour)));
    }
    Ok(found)
}

fn weather(weather: Element<'_>, found: &mut Environment) -> Result<(), StoryError> {
    let oktas = weather.word_given("fractionalCloudCover", OKTAS)?;
    found.cloudiness_pct = oktas.or(weather.word_given("cloudState", CLOUDS)?);
    if let Some(sun) = weather.child("Sun") {
        let degrees = |rad: f32| rad * 180.0 / PI;
        // However often it goes round.
        let azimuth_rad = libm::fmod(sun.number("azimuth")?, core::f64::consts::TAU) as f32;
        let elevation_rad = sun.float("elevation")?;
        // The standard counts clockwise from north.
        let azimuth_deg = degrees(ops::wrap_angle(PI / 2.0 - azimuth_rad));
        let azimuth_deg = if azimuth_deg < 0.0 { azimuth_deg + 360.0 } else { azimuth_deg };
        found.sun_deg = Some([degrees(elevation_rad).clamp(-90.0, 90.0), azimuth_deg]);
    }
    if let Some(fog) = weather.child("Fog") {
        let range_m = fog.amount("visualRange")?.max(DENSEST_FOG_M);
        if fog.child("BoundingBox").is_some() {
            return Err(fog.wrong("<BoundingBox> is not supported in <Fog>"));
        }
        found.fog_density_pct = Some(if range_m >= CLEAR_M { 0.0 } else { 100.0 * DENSEST_FOG_M / range_m });
    }
    if let Some(rain) = weather.child("Precipitation") {
        let falls = rain.word("precipitationType", &[("dry", 0.0), ("rain", 1.0)])?;
        let share = match rain.number_given("precipitationIntensity")? {
            Some(mm_h) => mm_h as f32 / CLOUDBURST_MM_H,
            // 1.0 has a share of its own.
            None => rain.amount("intensity")?,
        };
        found.precipitation_pct = Some((100.0 * falls * share).clamp(0.0, 100.0));
    }
    if let Some(wind) = weather.child("Wind") {
        wind.given("direction")?;
        found.wind_pct = Some((100.0 * wind.amount("speed")? / STORM_MPS).min(100.0));
    }
    Ok(())
}

/// The hour of a date and time, [0, 24).
fn hour(text: &str) -> Option<f32> {
    let (_, time) = text.split_once('T')?;
    let mut parts = time.split([':', '.', '+', '-', 'Z']);
    let mut next = |most: f32| parts.next()?.parse::<f32>().ok().filter(|part| (0.0..most).contains(part));
    Some(next(24.0)? + next(60.0)? / 60.0)
}

/// Height of the sun and direction to it at an hour, degrees.
fn sun_at(hour: f32) -> [f32; 2] {
    let turned_rad = (hour - 12.0) / 12.0 * PI;
    let (sin, cos) = (ops::sin(turned_rad), ops::cos(turned_rad));
    let up = ops::cos(LATITUDE_RAD) * cos;
    let [north, east] = [-ops::sin(LATITUDE_RAD) * cos, -sin];
    let degrees = |rad: f32| rad * 180.0 / PI;
    let azimuth_deg = degrees(ops::atan2(north, east));
    let across = ops::sqrt(north * north + east * east);
    [degrees(ops::atan2(up, across)), if azimuth_deg < 0.0 { azimuth_deg + 360.0 } else { azimuth_deg }]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_of_an_hour_goes_from_east_over_south_to_west() {
        let about = |hour: &str, expected: [f32; 2]| {
            let [altitude, azimuth] = sun_at(self::hour(hour).expect("a time"));
            let off = (altitude - expected[0]).abs().max((azimuth - expected[1]).abs());
            assert!(off < 0.1, "{hour}: {altitude}, {azimuth}");
        };
        about("2026-03-20T06:00:00", [0.0, 0.0]);
        about("2026-03-20T12:00:00.000+01:00", [40.0, 270.0]);
        about("2026-03-20T18:00:00Z", [0.0, 180.0]);
        assert!(sun_at(1.0)[0] < -30.0);
        assert!(["noon", "2026-01-01", "2026-01-01T25:00:00", "T-1:00"].iter().all(|text| hour(text).is_none()));
    }
}
