//! Texts that are read, and texts that are refused.

use super::*;
use crate::story::{ELEMENTS, StoryError, Support};

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
        ("<Pedestrian name", "<MiscObject/><Pedestrian name", "<MiscObject> is not supported"),
        (
            "<Story name=\"story\">",
            "<Story name=\"story\"><Prologue/>",
            "<Prologue> is no element of OpenSCENARIO 1.0 to 1.2",
        ),
        ("<Storyboard>", "<Storyboard><Fog/>", "<Fog> is not supported"),
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
    assert_eq!(passed, ["FileHeader", "CatalogLocations", "Axles", "BoundingBox", "Properties"]);
    assert_eq!(story.map_file(), "road.xodr");
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
    let ranged = r#"<ParameterDeclaration name="fast" parameterType="double" value="20"><ConstraintGroup>
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
    let plain = Story::read(&plain).expect("it is a story");
    assert_eq!(plain.varied(3).as_ref(), Ok(&plain));
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
    assert!(bounded("5", "15").is_ok());
    for (low, high, said) in [
        ("NaN", "15", "a number"),
        ("5", "INF", "a number"),
        ("$fast", "9", "a number"),
        ("15", "5", "no number is from 15 to 5"),
    ] {
        let error = bounded(low, high).expect_err(said).to_string();
        assert!(error.contains(said) && error.starts_with("line "), "{error}");
    }
}

#[test]
fn hostile_texts_are_refused_soon() {
    let deep = format!("<OpenSCENARIO>{}", "<Storyboard>".repeat(300_000));
    let events = event("e", "", "").replace("<Action name=\"of e\"></Action>", "");
    let many = text(&begins("Other", -1, 100.0, 10.0), &events.repeat(60_000));
    let long = "x".repeat(17 << 20);
    for (text, said) in [(deep, ""), (many, "expected at most"), (long, "expected at most 16 MiB")] {
        let error = Story::read(&text).expect_err("it is no story").to_string();
        assert!(error.contains(said) && error.len() < 300, "{error}");
    }
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
