//! Traffic lights and weather of stories.

use super::*;
use crate::map::bundled;
use crate::map_data::LightGroupId;
use crate::signals::LightPhase;
use crate::weather::Weather;

/// A signal of the bundled city that is a traffic light.
const SIGNAL: &str = "75";

fn city() -> Arc<RoadNetwork> {
    bundled("city").expect("it is bundled")
}

/// A story in the city, with programmes of lights, what is so from the beginning, and what happens.
fn in_city(signals: &str, init: &str, events: &str) -> Scenario {
    let place = |name: &str, s_m: f32| begins(name, -1, s_m, 0.0);
    let text = text(&(init.to_owned() + &place("Ego", 40.0) + &place("Other", 80.0)), events)
        .replace(r#"<LogicFile filepath="road.xodr"/>"#, &format!(r#"<LogicFile filepath="city.xodr"/>{signals}"#));
    Scenario { map: "city".into(), ..scenario(&text) }
}

fn group() -> LightGroupId {
    city().lights_of(SIGNAL).next().expect("it is a light")
}

fn light(state: &str) -> String {
    format!(
        r#"<GlobalAction><InfrastructureAction><TrafficSignalAction><TrafficSignalStateAction name="{SIGNAL}" state="{state}"/>
</TrafficSignalAction></InfrastructureAction></GlobalAction>"#
    )
}

fn city_world(scenario: &Scenario) -> World {
    World::new(scenario, &city()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_light_shows_what_a_story_holds_it_at() {
    let red_later = event("e", &light("red"), &after(30.0));
    let mut world = city_world(&in_city("", &light("green"), &red_later));
    let without = city_world(&in_city("", "", ""));
    for second in 0..60 {
        let expected = if second <= 30 { LightPhase::Green } else { LightPhase::Red };
        assert_eq!(world.light(group()), expected, "after {second} s");
        assert_eq!(world.scene().lights[group() as usize], expected);
        let others = world.scene().lights.iter().zip(&without.scene().lights).filter(|(a, b)| a != b).count();
        assert!(second > 0 || others <= 1, "others are as they were");
        go_on(&mut world, 1.0 + 1e-3);
    }
}

#[test]
fn programmes_go_round_and_events_put_them_into_phases() {
    let phase = |name: &str, seconds: f32, state: &str| {
        format!(
            r#"<Phase name="{name}" duration="{seconds}"><TrafficSignalState trafficSignalId="{SIGNAL}" state="{state}"/></Phase>"#
        )
    };
    let signals = format!(
        r#"<TrafficSignals><TrafficSignalController name="c" delay="2">{}{}</TrafficSignalController></TrafficSignals>"#,
        phase("go", 5.0, "green"),
        phase("stop", 3.0, "on;off;off")
    );
    let stop = r#"<GlobalAction><InfrastructureAction><TrafficSignalAction><TrafficSignalControllerAction trafficSignalControllerRef="c" phase="stop"/>
</TrafficSignalAction></InfrastructureAction></GlobalAction>"#;
    let faster = event(
        "faster",
        &speed("step", 0.0, "time", 5.0),
        &cue(r#"<TrafficSignalControllerCondition trafficSignalControllerRef="c" phase="go"/>"#),
    );
    let events = faster + &event("e", stop, &after(12.0)).replace("overwrite", "parallel");
    let mut world = city_world(&in_city(&signals, "", &events));
    let mut seen = String::new();
    for second in 0..20 {
        seen.push(match world.light(group()) {
            LightPhase::Green => 'g',
            LightPhase::Yellow => 'y',
            LightPhase::Red => 'r',
        });
        if second == 1 {
            assert_eq!(other(&world).speed_mps, 0.0);
        }
        go_on(&mut world, 1.0 + 1e-3);
    }
    // Red until the delay is over; at 12 s the event begins a red phase anew.
    assert_eq!(seen, "rrgggggrrrgggrrrgggg");
    assert!(other(&world).speed_mps > 4.9, "green began it");
}

fn cue(condition: &str) -> String {
    format!(
        r#"<ConditionGroup><Condition name="" delay="0" conditionEdge="none"><ByValueCondition>{condition}</ByValueCondition></Condition></ConditionGroup>"#
    )
}

#[test]
fn a_light_begins_an_event() {
    let events = event(
        "faster",
        &speed("step", 0.0, "time", 5.0),
        &cue(&format!(r#"<TrafficSignalCondition name="{SIGNAL}" state="red"/>"#)),
    ) + &event("e", &light("red"), &after(3.0)).replace("overwrite", "parallel");
    let mut world = city_world(&in_city("", &light("green"), &events));
    go_on(&mut world, 2.9);
    assert_eq!(other(&world).speed_mps, 0.0);
    go_on(&mut world, 0.3);
    assert!(other(&world).speed_mps > 4.9);
}

#[test]
fn a_light_that_is_not_there_is_refused() {
    let scenario = in_city("", &light("green").replace("\"75\"", "\"nine\""), "");
    let error = World::new(&scenario, &city()).err().expect("it is not there").to_string();
    assert!(error.contains("there is no traffic light nine on the map"), "{error}");
}

#[test]
fn the_weather_is_that_of_the_story_and_of_the_scenario_over_it() {
    let environment = r#"<GlobalAction><EnvironmentAction><Environment name="night"><TimeOfDay animation="false" dateTime="2026-11-01T23:00:00"/>
<Weather fractionalCloudCover="sixOktas"><Fog visualRange="500"/><Precipitation precipitationType="rain" precipitationIntensity="25"/></Weather>
<RoadCondition frictionScaleFactor="1" wetness="wetWithPuddles"/></Environment></EnvironmentAction></GlobalAction>"#;
    let story = Story::read(&text(
        &(environment.to_owned() + &begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 1.0, 0.0)),
        "",
    ));
    let mut scenario = Scenario::default_for("road", 1);
    let before = scenario.weather;
    scenario.play(story.unwrap_or_else(|error| panic!("{error}")));
    let weather = scenario.weather;
    assert!((-40.0..-30.0).contains(&weather.sun_altitude_deg), "{weather:?}");
    let told = Weather {
        cloudiness_pct: 75.0,
        precipitation_pct: 50.0,
        wetness_pct: 100.0,
        puddles_pct: 40.0,
        fog_density_pct: 10.0,
        fog_distance_m: 0.0,
        sun_altitude_deg: weather.sun_altitude_deg,
        sun_azimuth_deg: weather.sun_azimuth_deg,
        ..before
    };
    assert_eq!(weather, told);
    // A scenario with the story says more, or something else.
    let printed = scenario.to_toml();
    assert_eq!(Scenario::from_toml(&printed).as_ref(), Ok(&scenario));
    let (head, _) = printed.split_once("[weather]").expect("it has one");
    let drier = Scenario::from_toml(&format!("{head}[weather]\nprecipitation_pct = 5\n")).expect("a scenario").weather;
    assert_eq!(drier, Weather { precipitation_pct: 5.0, ..told });
}

#[test]
fn weather_that_changes_later_is_that_of_the_last_event() {
    let weather = |what: &str| {
        let action =
            "<GlobalAction><EnvironmentAction><Environment name=\"later\"><Weather>WHAT</Weather></Environment>";
        action.replace("WHAT", what) + "</EnvironmentAction></GlobalAction>"
    };
    let rain = weather(r#"<Precipitation precipitationType="rain" precipitationIntensity="25"/>"#);
    let [fog, haze] = [250, 1000].map(|range_m| weather(&format!(r#"<Fog visualRange="{range_m}"/>"#)));
    // The later one stands first in the text.
    let events =
        event("haze", &haze, &after(13.0)) + &event("rain", &rain, &after(1.0)) + &event("fog", &fog, &after(2.0));
    let mut world = played(&events.replace("overwrite", "parallel"));
    let before = world.scene().weather;
    let friction = world.friction();
    go_on(&mut world, 0.9);
    assert_eq!(world.scene().weather, before);
    go_on(&mut world, 0.2);
    let wet = Weather { precipitation_pct: 50.0, ..before };
    assert_eq!(world.scene().weather, wet);
    assert!(world.friction() < friction, "{} {friction}", world.friction());
    go_on(&mut world, 1.0);
    assert_eq!(world.scene().weather, Weather { fog_density_pct: 20.0, fog_distance_m: 0.0, ..wet });
    let keyframe = loop {
        if let Some(made) = world.step(&TickInput::default()).keyframe {
            break made;
        }
    };
    let mut resumed = World::resume(world.scenario(), road(), &keyframe).expect("it is its own");
    assert_eq!(resumed.scene().weather, world.scene().weather);
    for world in [&mut world, &mut resumed] {
        go_on(world, 1.5);
        assert_eq!(world.scene().weather, Weather { fog_density_pct: 5.0, fog_distance_m: 0.0, ..wet });
    }
    assert_eq!(resumed.hash(), world.hash());
}
