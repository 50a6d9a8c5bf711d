//! What comes between: who is taken elsewhere, handed over, deleted, or on the wrong side.

use super::actions::{follow, position};
use super::ways::{DELETE, ROUTE, acquire, lane_change, place, told};
use super::*;
use crate::story::FIRST_STORY_ID;

const ADD: &str = r#"<GlobalAction><EntityAction entityRef="Other"><AddEntityAction><Position>
<LanePosition roadId="7" laneId="-1" s="100"/></Position></AddEntityAction></EntityAction></GlobalAction>"#;

fn teleport(place: &str) -> String {
    format!("<PrivateAction><TeleportAction><Position>{place}</Position></TeleportAction></PrivateAction>")
}

fn on_lane(lane: i32, s_m: f32) -> String {
    teleport(&format!(r#"<LanePosition roadId="7" laneId="{lane}" s="{s_m}"/>"#))
}

fn stops(trigger: &str) -> String {
    event("stop", &speed("step", 0.0, "time", 0.0), trigger).replace("overwrite", "parallel")
}

/// The fastest that `Other` was in so many seconds, m/s.
fn fastest_mps(world: &mut World, seconds: f32) -> f32 {
    let mut fastest_mps = 0.0_f32;
    for _ in 0..(seconds * 60.0) as u32 {
        world.step(&TickInput::default());
        fastest_mps = fastest_mps.max(other(world).speed_mps.abs());
    }
    fastest_mps
}

#[test]
fn who_begins_with_a_line_is_taken_to_it() {
    // From lane -1 to a line on lane -2, far ahead.
    let corners = position(600.0, -5.25, "", "") + &position(800.0, -5.25, "", "");
    let events = event("line", &follow("<None/>", &corners), &after(1.0));
    let mut world = played(&events);
    assert!(fastest_mps(&mut world, 2.0) < 10.1);
    let [x, y] = place(&world);
    assert!((x - 610.0).abs() < 0.3 && (y + 5.25).abs() < 0.01, "{x} {y}");
}

#[test]
fn who_is_taken_elsewhere_leaves_its_line_and_its_way_across() {
    let corners = position(100.0, -1.75, "", "") + &position(900.0, -1.75, "", "");
    let line = follow("<None/>", &corners);
    let aside = lane_change(r#"<AbsoluteTargetLane value="-2"/>"#, 4.0);
    for action in [line, aside, acquire(-2, 300.0)] {
        let jump = event("jump", &on_lane(-1, 600.0), &after(2.0)).replace("overwrite", "parallel");
        let then = stops(&told("action", "of goes", "stopTransition"));
        let mut world = played(&(event("goes", &action, &after(0.5)) + &jump + &then));
        assert!(fastest_mps(&mut world, 3.0) < 10.1, "{action}");
        let [x, y] = place(&world);
        assert!((x - 600.0).abs() < 1.0 && (y + 1.75).abs() < 0.01, "{action}: {x} {y}");
    }
}

#[test]
fn who_was_stopped_at_the_end_of_its_road_stands_where_it_is_taken() {
    let ends = begins("Other", -1, 980.0, 10.0);
    let events = event("jump", &on_lane(-1, 300.0), &after(6.0));
    for (before, mps) in [(String::new(), 10.0), (stops(&after(4.0)), 0.0)] {
        let mut world = world(&text(&(begins("Ego", -2, 500.0, 0.0) + &ends), &(before + &events)));
        go_on(&mut world, 7.0);
        assert!((other(&world).speed_mps - mps).abs() < 0.01, "{:?}", other(&world));
    }
}

#[test]
fn who_shall_be_behind_falls_back_and_who_shall_be_ahead_overtakes() {
    let gap = |side: &str| {
        format!(
            r#"<PrivateAction><LongitudinalAction><LongitudinalDistanceAction entityRef="Walker" distance="20" freespace="false"
continuous="false" displacement="{side}"/></LongitudinalAction></PrivateAction>"#
        )
    };
    let walks = r#"<Private entityRef="Walker"><PrivateAction><LongitudinalAction><SpeedAction><SpeedActionDynamics dynamicsShape="step"/>
<SpeedActionTarget><AbsoluteTargetSpeed value="8"/></SpeedActionTarget></SpeedAction></LongitudinalAction></PrivateAction></Private>"#;
    for (side, from_m, ahead_m) in [
        ("trailingReferencedEntity", 150.0, -20.0),
        ("leadingReferencedEntity", 50.0, 20.0),
        ("trailingReferencedEntity", 50.0, -20.0),
        ("any", 150.0, 20.0),
    ] {
        let init = begins("Ego", -2, 5.0, 0.0) + &begins("Other", -1, from_m, 8.0) + walks;
        let text = text(&init, &event("keeps", &gap(side), &after(0.5)));
        let mut world = world(&text.replace(r#"x="900" y="30""#, r#"x="100" y="30""#));
        go_on(&mut world, 40.0);
        let walker = *world.scene().actors.iter().find(|a| a.id == FIRST_STORY_ID + 2).expect("it plays");
        let gap_m = place(&world)[0] - walker.position.x;
        assert!((gap_m - ahead_m).abs() < 0.3, "{side} from {from_m}: {gap_m}");
    }
}

#[test]
fn what_the_ego_car_does_ends_when_it_is_handed_over() {
    let activate = r#"<PrivateAction><ControllerAction><ActivateControllerAction longitudinal="true" lateral="true"/></ControllerAction></PrivateAction>"#;
    let events = event("faster", &speed("linear", 2.0, "time", 15.0), &after(1.0))
        + &event("hand over", activate, &after(2.0)).replace("overwrite", "parallel");
    let watcher = stops(&told("action", "of faster", "stopTransition"));
    let second = format!(
        r#"<ManeuverGroup name="watches" maximumExecutionCount="1"><Actors selectTriggeringEntities="false"><EntityRef entityRef="Other"/></Actors>
<Maneuver name="watch">{watcher}</Maneuver></ManeuverGroup><StartTrigger>"#
    );
    let text = text(&(begins("Ego", -2, 100.0, 10.0) + &begins("Other", -1, 300.0, 10.0)), &events)
        .replace(r#"<EntityRef entityRef="Other"/></Actors>"#, r#"<EntityRef entityRef="Ego"/></Actors>"#);
    let act = text.rfind("<StartTrigger>").expect("of the act");
    let mut world = world(&(text[..act].to_owned() + &text[act..].replacen("<StartTrigger>", &second, 1)));
    go_on(&mut world, 1.9);
    assert!((other(&world).speed_mps - 10.0).abs() < 0.01);
    go_on(&mut world, 0.5);
    assert_eq!(other(&world).speed_mps, 0.0);
}

#[test]
fn who_is_added_again_has_not_stood_before() {
    let events = stops(&after(0.0))
        + &event("go", DELETE, &after(2.0))
        + &event("again", ADD, &after(3.0))
        + &event(
            "move",
            &speed("step", 0.0, "time", 5.0),
            &when("Other", "none", r#"<StandStillCondition duration="1"/>"#),
        );
    let mut world = played(&events.replace("overwrite", "parallel"));
    // The first second of standing was before.
    let moved = |world: &World| world.scene().actors.iter().any(|a| a.id == FIRST_STORY_ID + 1 && a.speed_mps > 4.0);
    go_on(&mut world, 1.5);
    assert!(moved(&world));
    let events = event("go", DELETE, &after(0.9))
        + &event("again", ADD, &after(1.5))
        + &event(
            "move",
            &speed("step", 0.0, "time", 5.0),
            &when("Other", "none", r#"<StandStillCondition duration="1"/>"#),
        );
    let mut world = self::world(&text(
        &(begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 100.0, 0.0)),
        &events.replace("overwrite", "parallel"),
    ));
    go_on(&mut world, 2.3);
    assert!(!moved(&world));
    go_on(&mut world, 0.4);
    assert!(moved(&world));
}

#[test]
fn the_ego_car_is_neither_added_nor_deleted() {
    let of_ego = |action: &str| action.replace(r#"entityRef="Other""#, r#"entityRef="Ego""#);
    let placed = begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 100.0, 10.0);
    let near = r#"<RelativeDistanceCondition entityRef="Ego" freespace="false" relativeDistanceType="longitudinal" value="390" rule="lessThan"/>"#;
    let events = event("go", &of_ego(DELETE), &after(0.1)) + &stops(&when("Other", "none", near));
    for init in [placed.clone(), of_ego(DELETE) + &placed] {
        let mut world = world(&text(&init, &events));
        go_on(&mut world, 2.0);
        assert_eq!(other(&world).speed_mps, 0.0, "the ego car is still there");
    }
    let nowhere = text(&begins("Other", -1, 100.0, 10.0), &event("come", &of_ego(ADD), &after(1.0)));
    let error = World::new(&scenario(&nowhere), road()).err().expect("it begins nowhere").to_string();
    assert!(error.contains("nothing says where Ego begins"), "{error}");
}

#[test]
fn an_action_of_two_is_over_when_both_have_done_it() {
    // `Walker` needs longer for its way than `Other`.
    let goes = event("goes", &acquire(-1, 300.0), &after(0.0));
    let told_of = |state: &str| event("told", &speed("step", 0.0, "time", 3.0), &told("action", "of goes", state));
    let walks = r#"<Private entityRef="Walker"><PrivateAction><LongitudinalAction><SpeedAction><SpeedActionDynamics dynamicsShape="step"/>
<SpeedActionTarget><AbsoluteTargetSpeed value="8"/></SpeedActionTarget></SpeedAction></LongitudinalAction></PrivateAction></Private>"#;
    for (state, from_s, to_s) in
        [("completeState", 24.0, 26.0), ("endTransition", 24.0, 26.0), ("startTransition", 0.0, 0.1)]
    {
        let events = goes.clone() + &told_of(state).replace("overwrite", "parallel");
        let text = text(&(begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 100.0, 10.0) + walks), &events)
            .replace(
                r#"<EntityRef entityRef="Other"/></Actors>"#,
                r#"<EntityRef entityRef="Other"/><EntityRef entityRef="Walker"/></Actors>"#,
            )
            .replace(
                r#"<WorldPosition x="900" y="30" z="0" h="0"/>"#,
                r#"<LanePosition roadId="7" laneId="-1" s="100"/>"#,
            )
            .replace(
                r#"laneId="-1" s="100"/></Position></TeleportAction></PrivateAction>
<PrivateAction><LongitudinalAction>"#,
                r#"laneId="-1" s="110"/></Position></TeleportAction></PrivateAction>
<PrivateAction><LongitudinalAction>"#,
            );
        let mut world = world(&text);
        let slow = (1..=1800).find(|_| {
            go_on(&mut world, 1.1 / 60.0);
            (other(&world).speed_mps - 3.0).abs() < 0.01
        });
        let slow_s = slow.map(|ticks| ticks as f32 / 60.0);
        assert!(slow_s.is_some_and(|s| (from_s..=to_s).contains(&s)), "{state}: {slow_s:?}");
    }
}

#[test]
fn a_manoeuvre_runs_as_long_as_its_group() {
    let then = stops(&told("maneuver", "manoeuvre", "runningState"));
    let mut world = played(&then);
    go_on(&mut world, 0.5);
    assert_eq!(other(&world).speed_mps, 0.0);
}

#[test]
fn elements_are_found_by_their_full_names() {
    let stop = stops(&told("event", "story::act::group::manoeuvre::first", "completeState"));
    let mut world = played(&(event("first", &speed("step", 0.0, "time", 5.0), &after(1.0)) + &stop));
    go_on(&mut world, 2.0);
    assert_eq!(other(&world).speed_mps, 0.0);
}

#[test]
fn who_is_put_to_two_places_is_at_the_last() {
    let init = begins("Ego", -2, 500.0, 0.0)
        + &begins("Other", -1, 100.0, 10.0)
        + &format!(r#"<Private entityRef="Other">{}</Private>"#, on_lane(-2, 200.0));
    assert_eq!(place(&world(&text(&init, ""))), [200.0, -5.25]);
}

#[test]
fn routes_that_go_over_to_the_lane_beside_keep_their_turns() {
    use crate::story::lanes;
    use crate::story::spot::OnLane;
    let city = crate::map::bundled("city").expect("it is bundled");
    let mut tried = 0;
    for (lane, here) in (0..).zip(&city.lanes) {
        for beside in [here.left, here.right].into_iter().flatten() {
            let length_m = city.lanes[beside as usize].length_m;
            for turn in city.ways().onward(beside).iter().filter(|turn| turn.at_m == 0.0) {
                let from = OnLane { lane, s_m: 0.5 * here.length_m, offset_m: 0.0, against: false };
                let to = OnLane { lane: turn.lane, s_m: 1.0, ..from };
                let way_m = lanes::ahead_m(&city, from, to, &[beside, turn.lane], 1000.0).expect("it is ahead");
                assert!((way_m - 0.5 * length_m).abs() < 0.1 * length_m + 2.0, "{lane} {beside}: {way_m} {length_m}");
                let there = lanes::along(&city, from, way_m, vec![beside, turn.lane]);
                assert!(there.lane == turn.lane && (there.s_m - 1.0).abs() < 0.1, "{lane} {beside}: {there:?}");
                tried += 1;
            }
        }
    }
    assert!(tried > 10, "{tried}");
}

#[test]
fn ways_on_routes_are_bounded() {
    let place = |path_s: &str| {
        let within = format!(r#"<FromLaneCoordinates pathS="{path_s}" laneId="-2" laneOffset="0.5"/>"#);
        let on_route = format!(
            "<RoutePosition><RouteRef>{ROUTE}</RouteRef><InRoutePosition>{within}</InRoutePosition></RoutePosition>"
        );
        begins("Other", -1, 1.0, 0.0).replace(r#"<LanePosition roadId="7" laneId="-1" s="1"/>"#, &on_route)
    };
    for path_s in ["INF", "1e8", "-1"] {
        let error =
            Story::read(&text(&(begins("Ego", -2, 500.0, 0.0) + &place(path_s)), "")).expect_err(path_s).to_string();
        assert!(error.contains("pathS of <FromLaneCoordinates> is") && error.starts_with("line "), "{error}");
    }
    // Of CARLA's files offsets are to the right.
    let carla = text(&(begins("Ego", -2, 500.0, 0.0) + &place("70")), "");
    let carla = carla.replace("description=\"\"", "description=\"CARLA:Something\"");
    assert_eq!(super::ways::place(&world(&carla)), [120.0, -5.75]);
}
