//! When something happens.

use super::*;

/// The seconds after which `Other` stops because a trigger is met; at most 20.
fn stops_after(trigger: &str) -> f32 {
    let mut world = played(&event("e", &speed("step", 0.0, "time", 0.0), trigger));
    let stopped = (1..=1200).find(|_| {
        go_on(&mut world, 1.1 / 60.0);
        other(&world).speed_mps == 0.0
    });
    stopped.unwrap_or(1200) as f32 / 60.0
}

fn parameter(name: &str, value: &str, rule: &str) -> String {
    format!(
        r#"<ConditionGroup><Condition name="" delay="0" conditionEdge="rising"><ByValueCondition>
<ParameterCondition parameterRef="{name}" value="{value}" rule="{rule}"/></ByValueCondition></Condition></ConditionGroup>"#
    )
}

fn relative(kind: &str, rest: &str, value: f32, rule: &str) -> String {
    when("Other", "none", &format!(r#"<{kind} entityRef="Ego" value="{value}" rule="{rule}" {rest}/>"#))
}

#[test]
fn conditions_are_met_when_they_should_be() {
    let straight = r#"freespace="false" relativeDistanceType="cartesianDistance""#;
    let along = r#"freespace="true" relativeDistanceType="longitudinal""#;
    let lane = r#"<Position><LanePosition roadId="7" laneId="-1" s="150"/></Position>"#;
    for (trigger, expected_s) in [
        (after(5.0), 5.0),
        (after(5.0).replace("delay=\"0\"", "delay=\"2\""), 7.0),
        (when("Other", "none", r#"<TraveledDistanceCondition value="80"/>"#), 8.0),
        (
            when("Other", "none", &format!(r#"<ReachPositionCondition tolerance="5">{lane}</ReachPositionCondition>"#)),
            4.5,
        ),
        (
            when(
                "Other",
                "none",
                &format!(
                    r#"<DistanceCondition value="10" rule="lessThan" freespace="false">{lane}</DistanceCondition>"#
                ),
            ),
            4.0,
        ),
        (when("Ego", "none", r#"<StandStillCondition duration="3"/>"#), 3.0),
        // Of who plays nothing is known before.
        (when("Other", "rising", r#"<SpeedCondition value="5" rule="greaterThan"/>"#), 20.0),
        (when("Other", "risingOrFalling", r#"<SpeedCondition value="5" rule="greaterThan"/>"#), 20.0),
        (when("Other", "none", r#"<SpeedCondition value="5" rule="greaterThan"/>"#), 0.0),
        (when("Other", "rising", r#"<TraveledDistanceCondition value="80"/>"#), 8.0),
        (parameter("fast", "20", "equalTo"), 0.0),
        (parameter("$fast", "20.5", "lessThan"), 0.0),
        (parameter("fast", "20", "notEqualTo"), 20.0),
        (parameter("fast", "quick", "notEqualTo"), 0.0),
        // Files of ScenarioRunner name what a drive is judged by.
        (parameter("", "", "lessThan"), 20.0),
        (parameter("distance_success", "100", "lessThan"), 20.0),
        (when("Other", "falling", r#"<SpeedCondition value="5" rule="greaterThan"/>"#), 20.0),
        // 400 m apart at the beginning, 3.5 m beside each other; a car is 4.5 m long, and the ego car 4.18 m.
        (relative("RelativeDistanceCondition", straight, 300.0, "lessThan"), 10.0),
        (relative("RelativeDistanceCondition", along, 300.0, "lessThan"), 9.57),
        (relative("TimeHeadwayCondition", r#"freespace="false" alongRoute="true""#, 30.0, "lessThan"), 10.0),
        (relative("RelativeSpeedCondition", "", 5.0, "greaterThan"), 0.0),
        (
            when(
                "Other",
                "none",
                r#"<TimeToCollisionCondition value="30" rule="lessThan" freespace="false" alongRoute="true">
<TimeToCollisionConditionTarget><EntityRef entityRef="Ego"/></TimeToCollisionConditionTarget></TimeToCollisionCondition>"#,
            ),
            10.0,
        ),
        (when("Other", "none", r#"<CollisionCondition><EntityRef entityRef="Ego"/></CollisionCondition>"#), 20.0),
    ] {
        let stopped_s = stops_after(&trigger);
        assert!((stopped_s - expected_s).abs() < 0.06, "{trigger}: {stopped_s} s, expected {expected_s} s");
    }
}

#[test]
fn all_of_a_group_and_any_of_the_groups() {
    let both = (after(3.0) + &after(6.0)).replace("</ConditionGroup><ConditionGroup>", "");
    assert!((stops_after(&both) - 6.0).abs() < 0.05);
    assert!((stops_after(&(after(3.0) + &after(6.0))) - 3.0).abs() < 0.05);
}

#[test]
fn an_event_that_overrides_ends_the_other_and_is_told() {
    let faster = event("faster", &speed("linear", 10.0, "time", 20.0), &after(1.0));
    let stops = event("stops", &speed("step", 0.0, "time", 0.0), &after(3.0));
    let told = |kind: &str, name: &str, state: &str| {
        format!(
            r#"<ConditionGroup><Condition name="" delay="0" conditionEdge="none"><ByValueCondition>
<StoryboardElementStateCondition storyboardElementType="{kind}" storyboardElementRef="{name}" state="{state}"/>
</ByValueCondition></Condition></ConditionGroup>"#
        )
    };
    for (trigger, mps) in [
        (told("event", "faster", "stopTransition"), 7.0),
        (told("event", "faster", "endTransition"), 0.0),
        (told("event", "faster", "completeState"), 7.0),
        (told("action", "of faster", "stopTransition"), 7.0),
        (told("act", "act", "runningState"), 7.0),
    ] {
        let then = event("then", &speed("step", 0.0, "time", 7.0), &trigger).replace("overwrite", "parallel");
        let mut world = played(&(faster.clone() + &stops + &then));
        go_on(&mut world, 3.5);
        let is_act = trigger.contains("\"act\"");
        let expected_mps = if is_act { 0.0 } else { mps };
        assert!((other(&world).speed_mps - expected_mps).abs() < 0.05, "{trigger}: {}", other(&world).speed_mps);
    }
}

#[test]
fn an_event_happens_as_many_times_as_it_may() {
    let further = r#"<PrivateAction><TeleportAction><Position><RelativeObjectPosition entityRef="Other" dx="20" dy="0"/></Position></TeleportAction></PrivateAction>"#;
    for times in [1, 3] {
        let jumps = event("e", further, &when("Other", "none", r#"<SpeedCondition value="5" rule="greaterThan"/>"#));
        let jumps = jumps.replace("<Event ", &format!("<Event maximumExecutionCount=\"{times}\" "));
        let mut world = played(&jumps);
        go_on(&mut world, 2.0);
        let x = other(&world).position.x;
        assert!((x - (120.0 + 20.0 * times as f32)).abs() < 0.3, "{times}: {x}");
    }
}

#[test]
fn events_that_did_not_begin_are_told() {
    let slow = |name: &str, seconds: f32| event(name, &speed("step", 0.0, "time", 5.0), &after(seconds));
    let mut world = played(&(slow("soon", 1.0) + &slow("late", 3.0) + &slow("never", 1e6)));
    for (seconds, expected) in
        [(0.5, vec!["soon", "late", "never"]), (1.5, vec!["late", "never"]), (2.0, vec!["never"])]
    {
        go_on(&mut world, seconds);
        assert_eq!(world.waiting_events().collect::<Vec<_>>(), expected);
    }
    // Nor does what ends with its act begin.
    let text = text(&(begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 100.0, 10.0)), &slow("never", 9.0));
    let act = text.rfind("</Act>").expect("it has one");
    let stops = format!("<StopTrigger>{}</StopTrigger>", after(1.0));
    let mut world = self::world(&(text[..act].to_owned() + &stops + &text[act..]));
    go_on(&mut world, 2.0);
    assert_eq!(world.waiting_events().collect::<Vec<_>>(), ["never"]);
}
