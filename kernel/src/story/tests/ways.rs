//! Where those who play go: routes, lines and turns, and what ends them.

use super::actions::{follow, position};
use super::*;
use crate::story::FIRST_STORY_ID;

pub fn acquire(lane: i32, s_m: f32) -> String {
    format!(
        r#"<PrivateAction><RoutingAction><AcquirePositionAction><Position>
<LanePosition roadId="7" laneId="{lane}" s="{s_m}"/></Position></AcquirePositionAction></RoutingAction></PrivateAction>"#
    )
}

pub fn lane_change(target: &str, seconds: f32) -> String {
    format!(
        r#"<PrivateAction><LateralAction><LaneChangeAction><LaneChangeActionDynamics dynamicsShape="linear" value="{seconds}"
dynamicsDimension="time"/><LaneChangeTarget>{target}</LaneChangeTarget></LaneChangeAction></LateralAction></PrivateAction>"#
    )
}

/// A condition of a state of an element.
pub fn told(kind: &str, name: &str, state: &str) -> String {
    format!(
        r#"<ConditionGroup><Condition name="" delay="0" conditionEdge="none"><ByValueCondition>
<StoryboardElementStateCondition storyboardElementType="{kind}" storyboardElementRef="{name}" state="{state}"/>
</ByValueCondition></Condition></ConditionGroup>"#
    )
}

pub const DELETE: &str =
    r#"<GlobalAction><EntityAction entityRef="Other"><DeleteEntityAction/></EntityAction></GlobalAction>"#;

/// Where somebody is as those who play see it.
pub fn place(world: &World) -> [f32; 2] {
    other(world).position.truncate().to_array()
}

#[test]
fn who_goes_to_a_place_on_another_lane_changes_to_it() {
    let stops = told("action", "of go", "completeState");
    let events =
        event("go", &acquire(-2, 200.0), &after(0.0)) + &event("stop", &speed("step", 0.0, "time", 0.0), &stops);
    let mut world = played(&events);
    let mut across = vec![place(&world)[1]];
    for _ in 0..12 * 60 {
        go_on(&mut world, 1.1 / 60.0);
        across.push(place(&world)[1]);
    }
    let [x, y] = place(&world);
    assert!((x - 199.0).abs() < 1.0 && (y + 5.25).abs() < 0.05 && other(&world).speed_mps == 0.0, "{x} {y}");
    assert!(across.windows(2).all(|y| (y[1] - y[0]).abs() < 0.03), "nobody jumps");
}

#[test]
fn who_is_put_across_its_lane_and_stands_stays_so() {
    let turned = begins("Other", -1, 100.0, 0.0).replace(
        r#"<LanePosition roadId="7" laneId="-1" s="100"/>"#,
        r#"<WorldPosition x="100" y="-1.75" z="0" h="1.2"/>"#,
    );
    let mut world = world(&text(&(begins("Ego", -2, 500.0, 0.0) + &turned), ""));
    go_on(&mut world, 1.0);
    let ahead = other(&world).rotation * glam::Vec3::X;
    assert!((ahead.y - crate::ops::sin(1.2)).abs() < 0.01, "{ahead}");
}

#[test]
fn a_line_may_be_driven_backwards() {
    let corner = |s: f32, time: &str| {
        format!(
            r#"<Vertex {time}><Position><RoadPosition roadId="7" s="{s}" t="-1.75"><Orientation type="absolute" h="3.14159265"/>
</RoadPosition></Position></Vertex>"#
        )
    };
    let corners = corner(100.0, r#"time="0""#) + &corner(130.0, r#"time="3""#);
    let timing = r#"<Timing domainAbsoluteRelative="relative" scale="1" offset="0"/>"#;
    let mut world = played(&event("e", &follow(timing, &corners), &after(0.0)));
    for (seconds, x) in [(1.0, 110.0), (1.0, 120.0), (2.0, 140.0)] {
        go_on(&mut world, seconds);
        let at = other(&world);
        assert!((at.position.x - x).abs() < 0.5 && (at.rotation * glam::Vec3::X).x < -0.99, "{at:?}");
        assert!((at.speed_mps + 10.0).abs() < 0.1, "{at:?}");
    }
}

#[test]
fn a_speed_that_is_reached_on_a_way_takes_as_long_as_that() {
    // From 10 m/s to a stand on 40 m, and from there to 10 m/s on 50 m.
    let stops = event("stop", &speed("linear", 40.0, "distance", 0.0), &after(1.0));
    let goes = event("go", &speed("linear", 50.0, "distance", 10.0), &told("event", "stop", "completeState"));
    let mut world = played(&(stops + &goes));
    go_on(&mut world, 1.0);
    let from = place(&world)[0];
    go_on(&mut world, 4.0);
    assert!((other(&world).speed_mps - 5.0).abs() < 0.1, "{:?}", other(&world));
    go_on(&mut world, 4.05);
    assert!((place(&world)[0] - from - 40.0).abs() < 0.3, "{:?}", other(&world));
    go_on(&mut world, 10.0);
    assert!((other(&world).speed_mps - 10.0).abs() < 0.1, "{:?}", other(&world));
    assert!((place(&world)[0] - from - 90.0).abs() < 0.6, "{:?}", other(&world));
}

#[test]
fn what_begins_ends_the_line_that_decides_the_same() {
    let corners = position(100.0, -1.75, "", r#"time="0""#) + &position(300.0, -1.75, "", r#"time="20""#);
    let timing = r#"<Timing domainAbsoluteRelative="relative" scale="1" offset="0"/>"#;
    let line = || event("line", &follow(timing, &corners), &after(0.0));
    let aside = lane_change(r#"<AbsoluteTargetLane value="-2"/>"#, 2.0);
    for (action, mps, y) in [(speed("step", 4.0, "time", 4.0), 4.0, -1.75), (aside, 10.0, -5.25)] {
        let then = event("then", &action, &after(2.0)).replace("overwrite", "parallel");
        let mut world = played(&(line() + &then));
        go_on(&mut world, 5.0);
        assert!((other(&world).speed_mps - mps).abs() < 0.05, "{:?}", other(&world));
        assert!((place(&world)[1] - y).abs() < 0.05, "{:?}", other(&world));
    }
}

#[test]
fn an_event_that_was_overridden_does_not_come_again() {
    let faster = event("faster", &speed("linear", 20.0, "time", 20.0), &after(1.0));
    let faster = faster.replace("<Event ", "<Event maximumExecutionCount=\"2\" ");
    let mut world = played(&(faster + &event("stop", &speed("step", 0.0, "time", 0.0), &after(3.0))));
    go_on(&mut world, 6.0);
    assert_eq!(other(&world).speed_mps, 0.0);
}

#[test]
fn a_rising_edge_has_to_rise_for_each_time() {
    let further = r#"<PrivateAction><TeleportAction><Position><RelativeObjectPosition entityRef="Other" dx="20" dy="0"/></Position></TeleportAction></PrivateAction>"#;
    let jumps = event("e", further, &when("Other", "rising", r#"<TraveledDistanceCondition value="5"/>"#));
    let mut world = played(&jumps.replace("<Event ", "<Event maximumExecutionCount=\"9\" "));
    go_on(&mut world, 2.0);
    assert!((place(&world)[0] - 140.0).abs() < 0.5, "{:?}", place(&world));
}

#[test]
fn a_start_is_seen_though_it_is_over_at_once() {
    let jump = r#"<PrivateAction><TeleportAction><Position><LanePosition roadId="7" laneId="-1" s="300"/></Position></TeleportAction></PrivateAction>"#;
    for kind in ["event", "action", "maneuver"] {
        let name = if kind == "maneuver" {
            "manoeuvre"
        } else if kind == "action" {
            "of jump"
        } else {
            "jump"
        };
        let stop = event("stop", &speed("step", 0.0, "time", 0.0), &told(kind, name, "startTransition"));
        let mut world = played(&(event("jump", jump, &after(1.0)) + &stop));
        go_on(&mut world, 2.0);
        assert_eq!(other(&world).speed_mps, 0.0, "{kind}");
    }
}

#[test]
fn who_is_taken_elsewhere_did_not_drive_there() {
    let jump = r#"<PrivateAction><TeleportAction><Position><LanePosition roadId="7" laneId="-1" s="600"/></Position></TeleportAction></PrivateAction>"#;
    let far = when("Other", "none", r#"<TraveledDistanceCondition value="100"/>"#);
    let mut world =
        played(&(event("jump", jump, &after(1.0)) + &event("stop", &speed("step", 0.0, "time", 0.0), &far)));
    let mut fastest_mps = 0.0_f32;
    for _ in 0..5 * 60 {
        go_on(&mut world, 1.1 / 60.0);
        fastest_mps = fastest_mps.max(other(&world).speed_mps);
    }
    assert!(fastest_mps < 10.1 && place(&world)[0] > 630.0, "{fastest_mps} {:?}", place(&world));
}

#[test]
fn what_somebody_does_ends_when_it_is_deleted() {
    let slow = event("slow", &speed("linear", 30.0, "time", 20.0), &after(0.0));
    let gone = event("gone", DELETE, &after(1.0)).replace("overwrite", "parallel");
    let too = DELETE.replace("Other", "Walker");
    let then = event("then", &too, &told("event", "slow", "completeState")).replace("overwrite", "parallel");
    let mut world = played(&(slow + &gone + &then));
    go_on(&mut world, 2.0);
    assert!(world.scene().actors.is_empty(), "{:?}", world.scene().actors);
}

#[test]
fn a_lane_that_is_not_beside_somebody_is_not_changed_to() {
    let aside = lane_change(r#"<AbsoluteTargetLane value="-9"/>"#, 2.0);
    let mut world = played(&event("e", &aside, &after(1.0)));
    go_on(&mut world, 4.0);
    assert!((place(&world)[1] + 1.75).abs() < 0.01 && place(&world)[0] > 139.0, "{:?}", place(&world));
}

#[test]
fn manoeuvres_have_parameters_of_their_own() {
    let declared = |mps: f32| {
        format!(
            r#"<ParameterDeclarations><ParameterDeclaration name="v" parameterType="double" value="{mps}"/></ParameterDeclarations>"#
        )
    };
    let own = |name: &str, seconds: f32| {
        event(
            name,
            &speed("step", 0.0, "time", 0.0).replace(r#"Speed value="0""#, r#"Speed value="$v""#),
            &after(seconds),
        )
    };
    let text =
        text(&(begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 100.0, 10.0)), &(declared(5.0) + &own("a", 1.0)));
    let second =
        format!("</Maneuver><Maneuver name=\"second\">{}{}</Maneuver></ManeuverGroup>", declared(15.0), own("b", 3.0));
    let mut world = world(&text.replace("</Maneuver></ManeuverGroup>", &second));
    go_on(&mut world, 2.0);
    assert_eq!(other(&world).speed_mps, 5.0);
    go_on(&mut world, 2.0);
    assert_eq!(other(&world).speed_mps, 15.0);
}

#[test]
fn what_conditions_refer_to_is_there() {
    let events = |path: &str| event("e", &speed("step", 0.0, "time", 0.0), &told("event", path, "completeState"));
    let init = begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 100.0, 10.0);
    assert!(Story::read(&text(&init, &events("group::manoeuvre::e"))).is_ok());
    for path in ["f", "other::e", "e::e"] {
        let error = Story::read(&text(&init, &events(path))).expect_err(path).to_string();
        assert!(error.starts_with("line ") && error.ends_with(&format!("there is no event {path:?}")), "{error}");
    }
}

/// A route over lane 1 on the right and then the one beside it.
pub const ROUTE: &str = r#"<Route name="way" closed="false">
<Waypoint routeStrategy="shortest"><Position><LanePosition roadId="7" laneId="-1" s="50"/></Position></Waypoint>
<Waypoint routeStrategy="shortest"><Position><LanePosition roadId="7" laneId="-2" s="400"/></Position></Waypoint></Route>"#;

#[test]
fn places_of_a_route_that_were_passed_are_left_out() {
    let assigned = format!(
        "<PrivateAction><RoutingAction><AssignRouteAction>{ROUTE}</AssignRouteAction></RoutingAction></PrivateAction>"
    );
    let mut world = played(&event("e", &assigned, &after(0.0)));
    go_on(&mut world, 10.0);
    assert!((place(&world)[1] + 5.25).abs() < 0.05, "{:?}", place(&world));
}

#[test]
fn places_on_routes_are_so_far_along_them() {
    for (within, expected) in [
        (r#"<FromLaneCoordinates pathS="70" laneId="-2" laneOffset="0.5"/>"#, [120.0, -4.75]),
        (r#"<FromLaneCoordinates pathS="70" laneId="1"/>"#, [120.0, 1.75]),
        (r#"<FromRoadCoordinates pathS="10" t="-2"/>"#, [60.0, -2.0]),
        (r#"<FromRoadCoordinates pathS="10" t="2"/>"#, [60.0, 2.0]),
    ] {
        let on_route = format!(
            "<RoutePosition><RouteRef>{ROUTE}</RouteRef><InRoutePosition>{within}</InRoutePosition></RoutePosition>"
        );
        let other = begins("Other", -1, 1.0, 0.0).replace(r#"<LanePosition roadId="7" laneId="-1" s="1"/>"#, &on_route);
        let at = place(&world(&text(&(begins("Ego", -2, 500.0, 0.0) + &other), "")));
        assert!((at[0] - expected[0]).abs() < 0.05 && (at[1] - expected[1]).abs() < 0.05, "{within}: {at:?}");
    }
}

#[test]
fn who_is_added_is_there_from_then_on() {
    let add = r#"<GlobalAction><EntityAction entityRef="Other"><AddEntityAction><Position>
<LanePosition roadId="7" laneId="-1" s="100"/></Position></AddEntityAction></EntityAction></GlobalAction>"#;
    let events = event("come", add, &after(1.0))
        + &event("drive", &speed("step", 0.0, "time", 10.0), &after(2.0))
        + &event("go", DELETE, &after(3.0))
        + &event("again", add, &after(4.0));
    let mut world = world(&text(&begins("Ego", -2, 500.0, 0.0), &events));
    let others = |world: &World| world.scene().actors.iter().filter(|a| a.id == FIRST_STORY_ID + 1).count();
    for (until_s, there) in [(0.9, 0), (1.9, 1), (2.9, 1), (3.9, 0), (4.9, 1)] {
        while world.tick() < (until_s * 60.0) as Tick {
            world.step(&TickInput::default());
        }
        assert_eq!(others(&world), there, "{until_s}");
    }
    // Whoever comes again begins anew.
    assert_eq!((place(&world)[0], other(&world).speed_mps), (100.0, 0.0));
}

#[test]
fn who_walks_across_a_lane_goes_straight_on() {
    let walker = r#"<Private entityRef="Walker"><PrivateAction><LongitudinalAction><SpeedAction>
<SpeedActionDynamics dynamicsShape="step"/><SpeedActionTarget><AbsoluteTargetSpeed value="1"/></SpeedActionTarget>
</SpeedAction></LongitudinalAction></PrivateAction></Private>"#;
    let text = text(&(begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 900.0, 0.0) + walker), "");
    let place = r#"<WorldPosition x="900" y="30" z="0" h="0"/>"#;
    let mut world = world(&text.replace(place, r#"<WorldPosition x="120" y="-9" z="0" h="1.5708"/>"#));
    go_on(&mut world, 12.0);
    let walker = *world.scene().actors.iter().find(|a| a.id == FIRST_STORY_ID + 2).expect("it plays");
    let [x, y] = walker.position.truncate().to_array();
    assert!((x - 120.0).abs() < 0.1 && (y - 3.0).abs() < 0.2, "{x} {y}");
}

#[test]
fn somebody_moves_to_a_distance_across_from_another() {
    let abreast = |rest: &str| {
        format!(
            r#"<PrivateAction><LateralAction><LateralDistanceAction entityRef="Ego" continuous="false" {rest}/></LateralAction></PrivateAction>"#
        )
    };
    // The ego car is in the middle of its lane, 1.79 m wide; a car is 1.85 m wide.
    for (rest, expected_m) in [
        (r#"distance="2" freespace="false""#, -3.25),
        (r#"distance="2" freespace="true" displacement="any""#, -1.43),
        (r#"distance="4" freespace="false" displacement="leftToReferencedEntity""#, -1.25),
        (r#"distance="1" freespace="false" displacement="rightToReferencedEntity""#, -6.25),
        (r#"freespace="true""#, -1.75),
    ] {
        let mut world = played(&event("e", &abreast(rest), &after(0.0)));
        go_on(&mut world, 15.0);
        assert!((place(&world)[1] - expected_m).abs() < 0.06, "{rest}: {:?}", place(&world));
    }
}
