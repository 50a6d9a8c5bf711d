//! Texts that are read, and texts that are refused.

use super::*;
use crate::story::script::{Action, Position};
use crate::story::{ELEMENTS, FIRST_STORY_ID, StoryError, Support};

fn refused(from: &str, to: &str) -> String {
    let whole = text(&begins("Other", -1, 100.0, 10.0), &event("e", &speed("step", 0.0, "time", 0.0), &after(1.0)));
    assert!(whole.contains(from), "{from}");
    Story::read(&whole.replacen(from, to, 1)).expect_err(to).to_string()
}

#[test]
fn what_is_not_supported_is_refused_by_line_and_name() {
    for (from, to, said) in [
        ("<SpeedAction>", "<SynchronizeAction/><SpeedAction>", "<SynchronizeAction> is not supported"),
        ("<TeleportAction>", "<Teleport>", "well-formed"),
        ("SimulationTimeCondition value", "TimeOfDayCondition value", "<TimeOfDayCondition> is not supported"),
        (
            "rule=\"greaterThan\"",
            "rule=\"more\"",
            "rule of <SimulationTimeCondition> is \"more\", expected greaterThan or",
        ),
        (
            "entityRef=\"Other\"",
            "entityRef=\"Nobody\"",
            "is \"Nobody\", expected an entity of the file: Ego, Other, Walker",
        ),
        ("dynamicsShape=\"step\"", "dynamicsShape=\"steep\"", "expected linear or cubic or sinusoidal or step"),
        ("value=\"10\"", "value=\"NaN\"", "value of <AbsoluteTargetSpeed> is \"NaN\", expected a number"),
        ("value=\"10\"", "value=\"$slow\"", "there is no parameter slow"),
        ("vehicleCategory=\"car\"", "vehicleCategory=\"tank\"", "expected car or van"),
        (
            "<Pedestrian name=\"child\" model=\"child\" mass=\"30\" pedestrianCategory=\"pedestrian\"/>",
            "<MiscObject name=\"tree\" mass=\"1\" miscObjectCategory=\"tree\"/>",
            "miscObjectCategory of <MiscObject> is \"tree\", expected obstacle or barrier or none",
        ),
        (
            "<Story name=\"story\">",
            "<Story name=\"story\"><Prologue/>",
            "<Prologue> is no element of OpenSCENARIO 1.0 to 1.2",
        ),
        ("<Storyboard>", "<Storyboard><Fog/>", "<Fog> is not supported"),
        ("revMajor=\"1\"", "revMajor=\"0\"", "it is OpenSCENARIO 0.9 or older, expected 1.0 to 1.2"),
        (
            "dynamicsShape=\"step\" value=\"0\" dynamicsDimension=\"time\"",
            "dynamicsShape=\"linear\" value=\"-1\" dynamicsDimension=\"time\"",
            "value of <SpeedActionDynamics> is \"-1\", expected a number from 0 on",
        ),
        (
            "dynamicsShape=\"step\" value=\"0\" dynamicsDimension=\"time\"",
            "dynamicsShape=\"linear\"",
            "<SpeedActionDynamics> has no dynamicsDimension",
        ),
        ("<Event name=\"e\"", "<Event maximumExecutionCount=\"0\" name=\"e\"", "expected 1 or more"),
        ("<OpenSCENARIO>", "<!DOCTYPE x [<!ENTITY a \"b\">]><OpenSCENARIO>", "well-formed"),
    ] {
        let refused = refused(from, to);
        assert!(refused.starts_with("line ") && refused.contains(said) && !refused.contains('\n'), "{refused}");
    }
    assert_eq!(
        Story::read("<OpenDRIVE/>"),
        Err(StoryError { line: 1, reason: "expected <OpenSCENARIO>, but it is <OpenDRIVE>".into() })
    );
}

#[test]
fn what_is_harmless_is_told() {
    let story = Story::read(&text(&begins("Other", -1, 100.0, 10.0), "")).expect("it is a story");
    let passed: Vec<&str> = story.passed_over().iter().map(|(_, tag)| tag.as_str()).collect();
    assert_eq!(passed, ["Axles", "BoundingBox", "Properties"]);
    assert_eq!(story.map_file(), "road.xodr");
}

#[test]
fn what_files_leave_out_or_write_otherwise_is_understood() {
    let whole = |init: &str, events: &str| text(&(begins("Ego", -2, 500.0, 0.0) + init), events);
    let strict = whole(&begins("Other", -1, 100.0, 10.0), &event("e", &speed("linear", 2.0, "rate", 4.0), &after(1.0)));
    let expected = Story::read(&strict).expect("it is a story").script().clone();
    for (from, to) in [
        ("dynamicsShape=\"step\" value=\"0\" dynamicsDimension=\"time\"", "dynamicsShape=\"step\""),
        (
            "dynamicsShape=\"step\" value=\"0\" dynamicsDimension=\"time\"",
            "dynamicsShape=\"step\" dynamicsDimension=\"time\"",
        ),
        ("value=\"2\" dynamicsDimension=\"rate\"", "value=\"-2\" dynamicsDimension=\"rate\""),
        (" conditionEdge=\"none\"", ""),
        ("selectTriggeringEntities=\"false\"", "selectTriggeringEntities=\"False\""),
        (
            "<Vehicle name=\"car\" vehicleCategory=\"car\"/>",
            "<Vehicle name=\"car\" vehicleCategory=\"car\"><ParameterDeclarations/></Vehicle>",
        ),
        (
            "<Vehicle name=\"car\" vehicleCategory=\"car\"/>",
            "<Vehicle name=\"car\" vehicleCategory=\"car\"><TrailerHitch dx=\"1\"/><Trailer><EntityRef entityRef=\"\"/></Trailer></Vehicle>",
        ),
        ("value=\"4\"", "value=\"${pow(2, 2) * sin(pi / 2)}\""),
        ("<Event name=\"e\"", "<Event name=\"e\" maximumExecutionCount=\"1\""),
    ] {
        assert!(strict.contains(from), "{from}");
        let script = Story::read(&strict.replace(from, to)).unwrap_or_else(|error| panic!("{to}: {error}"));
        let mut script = script.script().clone();
        // Only where it stands in the text may differ.
        script.cast.iter_mut().zip(&expected.cast).for_each(|(role, of)| role.at = of.at);
        script.init.iter_mut().zip(&expected.init).for_each(|((_, action), (_, of))| {
            if let (Action::Teleport(place), Action::Teleport(_)) = (&*action, of) {
                assert!(matches!(place, Position::Lane { .. } | Position::World { .. }));
                *action = of.clone();
            }
        });
        assert_eq!(script, expected, "{to}");
    }
}

#[test]
fn who_is_told_a_line_alone_begins_at_its_beginning() {
    let line =
        super::actions::follow("<None/>", &[100.0, 200.0].map(|x| super::actions::position(x, -1.75, "", "")).concat());
    let told = format!("<Private entityRef=\"Other\">{line}</Private>");
    let world = world(&text(&(begins("Ego", -2, 500.0, 0.0) + &told), ""));
    assert!((other(&world).position.x - 100.0).abs() < 0.01, "{:?}", other(&world).position);
}

#[test]
fn files_of_carla_count_to_the_right() {
    let plain = text(&(begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 100.0, 0.0)), "");
    let place = r#"<WorldPosition x="900" y="30" z="0" h="0"/>"#;
    let turned = plain.replace(place, r#"<WorldPosition x="900" y="-30" z="0" h="0.5"/>"#);
    let carla = turned.replace("description=\"\"", "description=\"CARLA:Something\"");
    assert_ne!(carla, turned);
    let walker =
        |text: &str| *world(text).scene().actors.iter().find(|a| a.id == FIRST_STORY_ID + 2).expect("it plays");
    let heading_rad = |text: &str| {
        let ahead = walker(text).rotation * glam::Vec3::X;
        crate::ops::atan2(ahead.y, ahead.x)
    };
    assert!((walker(&carla).position.y - 30.0).abs() < 0.01 && (walker(&turned).position.y + 30.0).abs() < 0.01);
    assert!((heading_rad(&carla) + 0.5).abs() < 0.01 && (heading_rad(&turned) - 0.5).abs() < 0.01);
}

#[test]
fn places_that_are_not_on_the_map_are_refused() {
    let init = begins("Ego", -2, 500.0, 0.0);
    for (place, said) in [
        (r#"<LanePosition roadId="8" laneId="-1" s="1"/>"#, "there is no road 8 on the map"),
        (r#"<LanePosition roadId="7" laneId="-3" s="1"/>"#, "road 7 has no lane -3 at s 1"),
        (r#"<LanePosition roadId="7" laneId="-1" s="1001"/>"#, "road 7 has no lane -1 at s 1001"),
        (r#"<RoadPosition roadId="7" s="-5" t="0"/>"#, "road 7 has no place at s -5"),
        (r#"<RelativeObjectPosition entityRef="Other" dx="1" dy="1"/>"#, "nothing says where Other begins"),
    ] {
        let other = begins("Other", -1, 1.0, 0.0).replace(r#"<LanePosition roadId="7" laneId="-1" s="1"/>"#, place);
        let error = World::new(&scenario(&text(&(init.clone() + &other), "")), road()).err().expect(place).to_string();
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn parameters_with_ranges_are_drawn_by_seed() {
    let declared = r#"<ParameterDeclaration name="fast" parameterType="double" value="20"/>"#;
    let ranged = r#"<ParameterDeclaration name="fast" parameterType="double" value="10"><ConstraintGroup>
<ValueConstraint rule="greaterOrEqual" value="5"/><ValueConstraint rule="lessOrEqual" value="15"/></ConstraintGroup></ParameterDeclaration>"#;
    let plain = text(&begins("Other", -1, 100.0, 10.0), "");
    let story = Story::read(&plain.replace(declared, ranged)).expect("it is a story");
    let fast = |story: &Story| -> f32 {
        let rest = story.text().split("name=\"fast\"").nth(1).expect("it is declared");
        rest.split('"').nth(3).expect("its value").parse().expect("a number")
    };
    let drawn: Vec<f32> = (0..50).map(|seed| fast(&story.varied(seed).expect("it plays"))).collect();
    assert!(drawn.iter().all(|value| (5.0..=15.0).contains(value)), "{drawn:?}");
    let spread = drawn.iter().fold((f32::MAX, 0.0_f32), |(l, h), v| (l.min(*v), h.max(*v)));
    assert!(spread.0 < 6.0 && spread.1 > 14.0, "{spread:?}");
    assert_eq!(story.varied(7), story.varied(7));
    let varied = story.varied(7).expect("it plays").drawn();
    assert!(matches!(&varied[..], [(name, value)] if name == "fast" && *value as f32 == drawn[7]), "{varied:?}");
    let plain = Story::read(&plain).expect("it is a story");
    assert_eq!(plain.varied(3).as_ref(), Ok(&plain));
}

#[test]
fn what_a_scenario_says_otherwise_than_its_story_is_not_drawn() {
    let declared = r#"<ParameterDeclaration name="fast" parameterType="double" value="20"/>"#;
    let ranged = r#"<ParameterDeclaration name="fast" parameterType="double" value="22"><ConstraintGroup>
<ValueConstraint rule="greaterOrEqual" value="16"/><ValueConstraint rule="lessOrEqual" value="24"/></ConstraintGroup></ParameterDeclaration>"#;
    let weather = r#"<GlobalAction><EnvironmentAction><Environment name="e"><Weather cloudState="free">
<Precipitation precipitationType="rain" precipitationIntensity="$fast"/></Weather></Environment></EnvironmentAction></GlobalAction>"#;
    let ego = begins("Ego", -2, 500.0, 0.0).replace(r#"Speed value="0""#, r#"Speed value="$fast""#);
    let text = text(&(weather.to_owned() + &ego + &begins("Other", -1, 100.0, 10.0)), "").replace(declared, ranged);
    let told = scenario(&text);
    let mut played = Scenario::default_for("road", 1);
    played.play((**told.story.as_ref().expect("it has one")).clone());
    assert!((played.rules.max_speed_kmh - 79.2).abs() < 0.01, "{:?}", played.rules);
    let drawn = |scenario: &Scenario, seed: u64| {
        let mut scenario = scenario.clone();
        scenario.vary(seed).expect("it plays");
        (scenario.rules.max_speed_kmh, scenario.weather.precipitation_pct)
    };
    let mut speeds: Vec<u32> = (0..20).map(|seed| drawn(&played, seed).0 as u32).collect();
    speeds.sort_unstable();
    assert!(speeds[0] < 65 && speeds[19] > 79, "{speeds:?}");
    assert_ne!(drawn(&played, 1).1, played.weather.precipitation_pct);
    let mut said = played.clone();
    (said.rules.max_speed_kmh, said.weather.precipitation_pct) = (60.0, 7.0);
    assert!((0..20).all(|seed| drawn(&said, seed) == (60.0, 7.0)));
}

#[test]
fn whole_numbers_are_drawn_within_their_range() {
    let declared = r#"<ParameterDeclaration name="fast" parameterType="double" value="20"/>"#;
    let ranged = |low: &str, high: &str| {
        format!(
            r#"<ParameterDeclaration name="fast" parameterType="integer" value="1"><ConstraintGroup>
<ValueConstraint rule="greaterOrEqual" value="{low}"/><ValueConstraint rule="lessOrEqual" value="{high}"/></ConstraintGroup></ParameterDeclaration>"#
        )
    };
    let plain = text(&begins("Other", -1, 100.0, 10.0), "");
    let story = Story::read(&plain.replace(declared, &ranged("-1.6", "1.6"))).expect("it is a story");
    let mut drawn: Vec<f64> = (0..50).map(|seed| story.varied(seed).expect("it plays").drawn()[0].1).collect();
    drawn.sort_by(f64::total_cmp);
    drawn.dedup();
    assert_eq!(drawn, [-1.0, 0.0, 1.0]);
    let error = Story::read(&plain.replace(declared, &ranged("0.2", "0.8"))).expect_err("none is between").to_string();
    assert!(error.contains("no number is from 1 to 0"), "{error}");
}

#[test]
fn entries_of_catalogs_come_to_no_more_than_a_text_may_have() {
    let declared: String = (0..12_000).map(|k| format!(r#"<ParameterDeclaration name="p{k}" value="1"/>"#)).collect();
    let catalog = format!(
        r#"<OpenSCENARIO><Catalog name="V"><Vehicle name="v"><ParameterDeclarations>{declared}</ParameterDeclarations></Vehicle>
<Route name="r"><CatalogReference catalogName="V" entryName="r"/></Route></Catalog></OpenSCENARIO>"#
    );
    let catalogs = [("v.xosc".to_owned(), catalog)];
    let plain = text(&begins("Other", -1, 100.0, 10.0), "");
    let with = |entry: &str, times: usize| {
        let references = format!("\n<CatalogReference catalogName=\"V\" entryName=\"{entry}\"/>").repeat(times);
        Story::with_catalogs(&plain.replace("</Entities>", &format!("{references}</Entities>")), &catalogs)
    };
    assert!(with("v", 1).is_ok());
    let error = with("v", 50_000).expect_err("it is too much").to_string();
    assert!(error.contains("expected at most 16 MiB with the entries of its catalogs"), "{error}");
    let line = plain[..plain.find("</Entities>").expect("it has some")].lines().count() + 2;
    let error = with("r", 1).expect_err("it has no end").to_string();
    assert!(error.starts_with(&format!("line {line}: ")) && error.contains("\"r\" the last of them"), "{error}");
}

#[test]
fn the_sun_may_have_gone_round_often() {
    for turns in [0.0, 1.0, -3.0, 1.5e8] {
        let azimuth = 1.0 + turns * core::f64::consts::TAU;
        let sun = format!(
            r#"<GlobalAction><EnvironmentAction><Environment name="e"><Weather><Sun elevation="0.5" azimuth="{azimuth}"/></Weather>
</Environment></EnvironmentAction></GlobalAction>"#
        );
        let story = Story::read(&text(&(sun + &begins("Other", -1, 100.0, 10.0)), "")).expect("it is a story");
        let [_, azimuth_deg] = story.script().environment.sun_deg.expect("it is told");
        assert!((azimuth_deg - 32.704).abs() < 0.01, "{turns}: {azimuth_deg}");
    }
}

#[test]
fn what_changes_something_is_not_said_to_be_passed_over() {
    let door = r#"<PrivateAction><AppearanceAction><AnimationAction loop="false"><AnimationType><ComponentAnimation>
<VehicleComponent vehicleComponentType="doorFrontLeft"/></ComponentAnimation></AnimationType><AnimationState state="1"/>
</AnimationAction></AppearanceAction></PrivateAction>"#;
    let lights = r#"<PrivateAction><AppearanceAction><LightStateAction/></AppearanceAction></PrivateAction>"#;
    let passed = |action: &str| {
        let text = text(&begins("Other", -1, 100.0, 10.0), &event("e", action, &after(1.0)));
        let story = Story::read(&text).unwrap_or_else(|error| panic!("{error}"));
        story.passed_over().iter().any(|(_, tag)| tag == "AppearanceAction")
    };
    assert!(passed(lights) && !passed(door));
}

#[test]
fn bounds_that_are_no_numbers_or_leave_none_are_refused() {
    let plain = text(&begins("Other", -1, 100.0, 10.0), "");
    let declared = r#"<ParameterDeclaration name="fast" parameterType="double" value="20"/>"#;
    assert!(plain.contains(declared));
    let bounded = |low: &str, high: &str| {
        let bounds = format!(
            r#"<ConstraintGroup><ValueConstraint rule="greaterOrEqual" value="{low}"/>
<ValueConstraint rule="lessOrEqual" value="{high}"/></ConstraintGroup>"#
        );
        Story::read(&plain.replace(declared, &declared.replace("/>", &format!(">{bounds}</ParameterDeclaration>"))))
    };
    assert!(bounded("5", "25").is_ok());
    // No range to draw from, which only a campaign asks for.
    assert!(bounded("$fast", "9").is_ok_and(|story| story.drawn().is_empty()));
    for (low, high, said) in [
        ("NaN", "15", "a number"),
        ("5", "INF", "a number"),
        ("5", "15", "expected one from 5 to 15"),
        ("15", "5", "no number is from 15 to 5"),
    ] {
        let error = bounded(low, high).expect_err(said).to_string();
        assert!(error.contains(said) && error.starts_with("line "), "{error}");
    }
}

#[test]
fn hostile_texts_are_refused_soon() {
    let init = begins("Other", -1, 100.0, 10.0);
    let deep = format!("<OpenSCENARIO>{}", "<Storyboard>".repeat(300_000));
    let events = event("e", "", "").replace("<Action name=\"of e\"></Action>", "");
    let attributes: String = (0..1_000_000).map(|k| format!(" a{k}=\"\"")).collect();
    let spaces: String = (0..60_000).map(|k| format!("<a xmlns:n{k}=\"u{k}\">")).collect();
    let groups = r#"<ManeuverGroup name="g" maximumExecutionCount="1"><Actors selectTriggeringEntities="false"/></ManeuverGroup>"#;
    let far = begins("Other", -1, 100.0, 10.0).replace(
        r#"<LanePosition roadId="7" laneId="-1" s="100"/>"#,
        r#"<RelativeLanePosition entityRef="Ego" dLane="0" ds="1e9"/>"#,
    );
    let twice = text(&init, "").replace(
        r#"<EntityRef entityRef="Other"/></Actors>"#,
        r#"<EntityRef entityRef="Other"/><EntityRef entityRef="Other"/></Actors>"#,
    );
    let long = format!(r#"value="{}""#, "x".repeat(5000));
    let named = text(&init, "").replace(r#"value="20""#, &long).replace("name=\"act\"", "name=\"$fast\"");
    let corner = r#"<Vertex><Position><RelativeObjectPosition entityRef="Ego" dx="10" dy="0"/></Position></Vertex>"#
        .repeat(10_000);
    let line = format!(r#"<Private entityRef="Other">{}</Private>"#, super::actions::follow("<None/>", &corner));
    let waits = event("e", "<UserDefinedAction/>", &super::ways::told("maneuver", "manoeuvre", "completeState"));
    let waits = waits.replace("<Action ", "<!--").replace("</Action>", "-->").repeat(1000);
    for (text, said) in [
        (deep, "expected at most 100 elements in each other"),
        (text(&init, &events.repeat(60_000)), "expected at most 10000 acts"),
        (text(&init, "").replace("</Act>", &format!("{}</Act>", groups.repeat(20_000))), "expected at most 10000 acts"),
        (format!("<OpenSCENARIO{attributes}/>"), "expected at most 64 attributes of an element"),
        (spaces, "expected at most 32 declarations of namespaces"),
        ("x".repeat(17 << 20), "expected at most 16 MiB"),
        (text(&far, ""), "ds of <RelativeLanePosition> is \"1000000000\", expected metres"),
        (twice, "<Actors> names \"Other\" twice"),
        (named, "expected a parameter of at most 4096 bytes, but it has 5000"),
        (text(&(init.clone() + &line), ""), "expected at most 10000 acts"),
        (text(&init, &waits), "expected conditions that refer to at most 100000 elements and parts of them"),
    ] {
        let error = Story::read(&text).expect_err(said).to_string();
        assert!(error.starts_with("line ") && error.contains(said) && error.len() < 500, "{said}: {error}");
    }
}

#[test]
fn tags_are_counted_as_the_parser_sees_them() {
    let plain = text(&begins("Other", -1, 100.0, 10.0), "");
    let noted = format!("<!-- {} > -->", "<a b='\"'".repeat(200));
    let noted = plain.replace("<CatalogLocations/>", &format!("{noted}<CatalogLocations/>"));
    assert!(Story::read(&noted).is_ok());
    let quoted = plain.replace("description=\"\"", "description='a > b \"c\" /'");
    assert!(quoted != plain && Story::read(&quoted).is_ok());
}

#[test]
fn who_begins_where_nobody_can_be_is_refused() {
    let refusal = |init: String| {
        let scenario = scenario(&text(&init, ""));
        World::new(&scenario, road()).err().expect("it cannot begin").to_string()
    };
    let ego = begins("Ego", -2, 500.0, 0.0);
    let far = |x: &str| {
        begins("Other", -1, 100.0, 0.0)
            .replace(r#"<LanePosition roadId="7" laneId="-1" s="100"/>"#, &format!(r#"<WorldPosition x="{x}" y="0"/>"#))
    };
    for (init, said) in [
        (ego.clone() + &far("1e9"), "expected one within 1000000 m"),
        (ego.clone() + &begins("Other", -2, 501.0, 0.0), "Other and Ego begin in each other"),
        (ego.clone() + &begins("Other", -9, 501.0, 0.0), "line 16: road 7 has no lane -9 at s 501"),
        (ego, "line 8: nothing says where Other begins, expected a teleport in <Init>"),
    ] {
        let refusal = refusal(init);
        assert!(refusal.contains(said), "{refusal}");
    }
    // As fast as its kind can be, and not faster.
    let mut fast = played(&event("e", &speed("step", 0.0, "time", -1e9), &after(0.0)));
    go_on(&mut fast, 1.0);
    assert!(other(&fast).speed_mps.abs() < 1000.0);
}

#[test]
fn every_element_that_counts_as_read_is_read() {
    let all = include_str!("../../../tests/stories/all.xosc");
    Story::read(all).unwrap_or_else(|error| panic!("{error}"));
    let read = |row: &&(&str, Support, &str)| matches!(row.1, Support::Yes | Support::Partly);
    let unread: Vec<&str> =
        ELEMENTS.iter().filter(read).map(|row| row.0).filter(|tag| !all.contains(&format!("<{tag}"))).collect();
    assert_eq!(unread, Vec::<&str>::new());
}

#[test]
fn stories_have_parameters_of_their_own_and_entities_of_catalogs_are_guessed() {
    let whole = text(&begins("Other", -1, 100.0, 10.0), "");
    let own = r#"<Story name="story"><ParameterDeclarations><ParameterDeclaration name="$owner" parameterType="string" value="Other"/></ParameterDeclarations>"#;
    let whole = whole
        .replace(r#"<Story name="story">"#, own)
        .replace(r#"<EntityRef entityRef="Other"/></Actors>"#, r#"<EntityRef entityRef="$owner"/></Actors>"#);
    let listed = r#"<ScenarioObject name="Other"><CatalogReference catalogName="c" entryName="bus_yellow"/>"#;
    let whole = whole.replace(r#"<ScenarioObject name="Other"><Vehicle name="car" vehicleCategory="car"/>"#, listed);
    let story = Story::read(&whole).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(story.script().cast[1].kind, Some(crate::actor::ActorKind::Bus));
    assert_eq!(story.script().acts[0].groups[0].actors, [1]);
}
