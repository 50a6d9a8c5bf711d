//! How a corner case came about: the drive up to it, and what is known of it.

use glam::Vec2;
use kernel::arbiter::Outcome;
use kernel::scene::Weather;
use kernel::time::{TICK_HZ, Tick};
use measures::footage::Footage;
use replay::{Log, Replayer};

use super::drive::Drive;
use super::fact::Fact;
use super::map;

/// Ticks from one point of the drawn route to the next.
const ROUTE_TICKS: Tick = TICK_HZ as Tick / 2;

/// What the page says about a case besides its pictures.
pub struct Story {
    /// What kind of corner case it is.
    pub label: String,
    /// What happened, in the words of whoever labelled it.
    pub comment: String,
    /// Everything else.
    pub facts: Vec<Fact>,
    /// The map with the route and the place.
    pub map_svg: String,
}

impl Story {
    /// That of a case and its drive.
    pub fn of(drive: &Drive, footage: &Footage) -> anyhow::Result<Self> {
        let (log, whole) = (&footage.log, drive.recording.log());
        let at = footage.scenes.last().map_or(log.last_tick(), |scene| scene.tick);
        let (route, odometer_mm) = route(whole, footage, at)?;
        let annotation = log.annotation.as_ref();
        let label = annotation.map_or("not labelled".into(), |a| a.label.to_string());
        let comment = annotation.map_or(String::new(), |a| a.comment.clone());
        let weather = footage.scenes.last().map_or_else(|| log.manifest.scenario.weather_at(at), |scene| scene.weather);
        let facts = [facts(log, at, &weather, odometer_mm), drive.facts()].concat();
        Ok(Self { label, comment, facts, map_svg: map::svg(&footage.network, &route) })
    }
}

/// Places of the ego car from the log's start to a tick, seen from above, and the way driven,
/// millimetres.
fn route(log: &Log, footage: &Footage, to: Tick) -> anyhow::Result<(Vec<Vec2>, Option<u64>)> {
    if log.manifest.kernel != kernel::identity() {
        return Ok((footage.scenes.iter().map(|scene| scene.ego.position.truncate()).collect(), None));
    }
    let mut replayer = Replayer::new(log, footage.network.clone())?;
    let mut route = Vec::new();
    let mut tick = log.first_tick();
    loop {
        replayer.seek(tick)?;
        route.push(replayer.world().scene().ego.position.truncate());
        if tick >= to {
            return Ok((route, Some(replayer.world().odometer_mm())));
        }
        tick = to.min(tick + ROUTE_TICKS);
    }
}

fn facts(log: &Log, at: Tick, weather: &Weather, odometer_mm: Option<u64>) -> Vec<Fact> {
    let scenario = &log.manifest.scenario;
    let mut facts = Vec::new();
    let mut add = |name, value: String| facts.push(Fact { name, value });
    if let Some(annotation) = &log.annotation {
        let cause = match annotation.perception_caused {
            Some(true) => "yes: with true masks no takeover is needed",
            Some(false) => "no: true masks need the takeover as well",
            None => "not known",
        };
        add("Caused by perception", cause.into());
    }
    add("Time in the run", format!("{:.1} s", at as f64 / f64::from(TICK_HZ)));
    if let Some(mm) = odometer_mm {
        add("Driven before", format!("{:.3} km", mm as f64 / 1e6));
    }
    match (&log.intervention, log.summary.as_ref().and_then(|s| s.outcome)) {
        (Some(taken), _) => {
            let by = [(taken.by_brake, "brake"), (taken.by_steering, "steering")];
            let by: Vec<&str> = by.iter().filter(|(on, _)| *on).map(|(_, name)| *name).collect();
            add("Taken over by", format!("{} at {} km/h", by.join(" and "), base::words::kmh(taken.speed_mps.into())));
        }
        (None, Some(Outcome::Missed)) => add("Taken over by", "nobody: it ended in a collision".into()),
        (None, _) => {}
    }
    if let Some(checkpoint) = log.manifest.provenance.get("checkpoint") {
        let blind = if study::is_blind(&log.manifest.provenance) { ", and the drivers did not know it" } else { "" };
        add("Driven through", format!("{checkpoint}{blind}"));
    }
    add("Map and seed", format!("{}, {}", scenario.map, scenario.seed));
    add("Weather", words(weather));
    facts
}

fn words(weather: &Weather) -> String {
    let mut words = format!(
        "sun {:.0}\u{b0} high, clouds {:.0} %, wind {:.0} %",
        weather.sun_altitude_deg, weather.cloudiness_pct, weather.wind_pct
    );
    let rare = [
        ("rain", weather.precipitation_pct),
        ("puddles", weather.puddles_pct),
        ("wetness", weather.wetness_pct),
        ("fog", weather.fog_density_pct),
    ];
    for (name, percent) in rare.into_iter().filter(|(_, percent)| *percent > 0.0) {
        words += &format!(", {name} {percent:.0} %");
    }
    words
}
