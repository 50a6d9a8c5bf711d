//! What those who play do.

use super::*;

pub fn position(x: f32, y: f32, h: &str, time: &str) -> String {
    format!(r#"<Vertex {time}><Position><WorldPosition x="{x}" y="{y}" z="0" {h}/></Position></Vertex>"#)
}

pub fn follow(timing: &str, corners: &str) -> String {
    format!(
        r#"<PrivateAction><RoutingAction><FollowTrajectoryAction>
<Trajectory name="line" closed="false"><Shape><Polyline>{corners}</Polyline></Shape></Trajectory>
<TimeReference>{timing}</TimeReference><TrajectoryFollowingMode followingMode="position"/>
</FollowTrajectoryAction></RoutingAction></PrivateAction>"#
    )
}

fn lane_change(target: &str, shape: &str, value: f32, dimension: &str) -> String {
    format!(
        r#"<PrivateAction><LateralAction><LaneChangeAction>
<LaneChangeActionDynamics dynamicsShape="{shape}" value="{value}" dynamicsDimension="{dimension}"/>
<LaneChangeTarget>{target}</LaneChangeTarget></LaneChangeAction></LateralAction></PrivateAction>"#
    )
}

#[test]
fn who_is_asked_for_nothing_keeps_lane_and_speed() {
    let mut world = played("");
    go_on(&mut world, 3.0);
    let other = other(&world);
    assert!((other.position.x - 130.0).abs() < 0.05 && (other.position.y + 1.75).abs() < 0.01, "{other:?}");
    assert!((other.speed_mps - 10.0).abs() < 0.02);
}

#[test]
fn speeds_change_as_their_shapes_say() {
    // (shape, value, dimension, share of the change half-way)
    for (shape, value, dimension, takes_s) in [
        ("linear", 4.0, "time", 4.0),
        ("sinusoidal", 4.0, "time", 4.0),
        ("cubic", 4.0, "time", 4.0),
        ("linear", 2.5, "rate", 4.0),
        ("step", 0.0, "time", 0.0),
    ] {
        let mut world = played(&event("e", &speed(shape, value, dimension, 20.0), &after(1.0)));
        go_on(&mut world, 1.0);
        assert!((other(&world).speed_mps - 10.0).abs() < 0.1, "{shape}");
        go_on(&mut world, takes_s / 2.0);
        let half_mps = if shape == "step" { 10.0 } else { 15.0 };
        assert!((other(&world).speed_mps - half_mps).abs() < 0.2, "{shape} {dimension}: {}", other(&world).speed_mps);
        go_on(&mut world, takes_s / 2.0 + 0.1);
        assert!((other(&world).speed_mps - 20.0).abs() < 0.02, "{shape} {dimension}: {}", other(&world).speed_mps);
    }
}

#[test]
fn a_parameter_and_an_expression_are_values() {
    let action = speed("step", 0.0, "time", 0.0)
        .replace(r#"<AbsoluteTargetSpeed value="0"/>"#, r#"<AbsoluteTargetSpeed value="${$fast / 2 + 3}"/>"#);
    let mut world = played(&event("e", &action, &after(0.0)));
    go_on(&mut world, 0.2);
    assert!((other(&world).speed_mps - 13.0).abs() < 0.02);
}

#[test]
fn lanes_are_changed_in_the_time_and_on_the_way_that_are_asked_for() {
    for (target, y) in [
        (r#"<RelativeTargetLane entityRef="Other" value="-1"/>"#, -5.25),
        (r#"<AbsoluteTargetLane value="-2"/>"#, -5.25),
        (r#"<RelativeTargetLane entityRef="Other" value="1"/>"#, 1.75),
        (r#"<RelativeTargetLane entityRef="Ego" value="2"/>"#, 1.75),
        (r#"<AbsoluteTargetLane value="2"/>"#, 5.25),
    ] {
        for (value, dimension) in [(2.0, "time"), (20.0, "distance")] {
            let mut world = played(&event("e", &lane_change(target, "sinusoidal", value, dimension), &after(1.0)));
            go_on(&mut world, 2.0);
            let half = other(&world);
            assert!((half.position.y - (y - 1.75) * 0.5).abs() < 0.15, "{target} {dimension}: {half:?}");
            go_on(&mut world, 1.2);
            let there = other(&world);
            assert!((there.position.y - y).abs() < 0.02 && there.speed_mps > 9.9, "{target} {dimension}: {there:?}");
            // On the other side of the road it goes on the way it faced.
            assert!((there.position.x - 132.0).abs() < 0.6, "{target}: {there:?}");
        }
    }
}

#[test]
fn who_moves_aside_comes_no_harder_than_is_asked_for() {
    let action = r#"<PrivateAction><LateralAction><LaneOffsetAction continuous="false">
<LaneOffsetActionDynamics dynamicsShape="sinusoidal" maxLateralAcc="1"/>
<LaneOffsetTarget><AbsoluteTargetLaneOffset value="1.2"/></LaneOffsetTarget></LaneOffsetAction></LateralAction></PrivateAction>"#;
    let mut world = played(&event("e", action, &after(0.0)));
    let (mut across, mut hardest_mps2) = (Vec::new(), 0.0_f32);
    for _ in 0..240 {
        go_on(&mut world, 1.1 / 60.0);
        across.push(other(&world).position.y);
    }
    for y in across.windows(13).step_by(6) {
        hardest_mps2 = hardest_mps2.max((y[12] - 2.0 * y[6] + y[0]).abs() / (0.1 * 0.1));
    }
    assert!((across[239] + 0.55).abs() < 0.01, "{}", across[239]);
    assert!((0.8..1.15).contains(&hardest_mps2), "{hardest_mps2}");
}

#[test]
fn a_line_is_followed_to_the_millimetre_in_time() {
    let corners: String = (0..=40)
        .map(|k| {
            let (t, s) = (k as f32 * 0.1, k as f32);
            position(100.0 + s, -1.75 + 0.05 * s, "h=\"0.3\"", &format!("time=\"{t}\""))
        })
        .collect();
    let timing = r#"<Timing domainAbsoluteRelative="absolute" scale="1" offset="0"/>"#;
    let mut world = played(&event("e", &follow(timing, &corners), &after(0.0)));
    for tick in 1..=240 {
        go_on(&mut world, 1.1 / 60.0);
        let (at, s) = (other(&world), tick as f32 / 6.0);
        let way = at.position.truncate() - glam::Vec2::new(100.0 + s, -1.75 + 0.05 * s);
        // Pictures and recordings of scenes know places to 2^-10 m.
        assert!(way.length() < 2e-3, "tick {tick}: {at:?}");
    }
    let faces = other(&world).rotation * glam::Vec3::X;
    assert!((faces.y - crate::ops::sin(0.3)).abs() < 0.01, "{faces}");
    // Then it goes on along its road.
    go_on(&mut world, 1.0);
    let then = other(&world);
    assert!((then.position.x - 150.0).abs() < 0.2 && then.speed_mps > 9.9, "{then:?}");
}

#[test]
fn without_times_a_line_is_followed_at_the_own_speed() {
    let corners = position(100.0, -1.75, "", "") + &position(120.0, -1.75, "", "") + &position(120.0, 20.0, "", "");
    let mut world = played(&event("e", &follow("<None/>", &corners), &after(0.0)));
    go_on(&mut world, 3.0);
    let at = other(&world);
    assert!((at.position.truncate() - glam::Vec2::new(120.0, 8.25)).length() < 0.3, "{at:?}");
    assert!((at.rotation * glam::Vec3::X).y > 0.99);
}

#[test]
fn who_is_deleted_is_gone_and_who_is_told_to_jump_is_there() {
    let gone = r#"<GlobalAction><EntityAction entityRef="Other"><DeleteEntityAction/></EntityAction></GlobalAction>"#;
    let mut world = played(&event("e", gone, &after(1.0)));
    go_on(&mut world, 2.0);
    assert_eq!(world.scene().actors.len(), 1);
    let jump = r#"<PrivateAction><TeleportAction><Position><RelativeLanePosition entityRef="Ego" dLane="1" ds="50"/></Position></TeleportAction></PrivateAction>"#;
    let mut world = played(&event("e", jump, &after(1.0)));
    go_on(&mut world, 1.05);
    let at = other(&world).position;
    assert!((at.x - 550.0).abs() < 1.0 && (at.y + 1.75).abs() < 0.01, "{at}");
}

#[test]
fn a_place_is_come_to() {
    let acquire = r#"<PrivateAction><RoutingAction><AcquirePositionAction><Position>
<LanePosition roadId="7" laneId="-2" s="140"/></Position></AcquirePositionAction></RoutingAction></PrivateAction>"#;
    let stop = r#"<ConditionGroup><Condition name="" delay="0" conditionEdge="none"><ByValueCondition>
<StoryboardElementStateCondition storyboardElementType="action" storyboardElementRef="of go" state="completeState"/>
</ByValueCondition></Condition></ConditionGroup>"#;
    let acquire = acquire.replace("laneId=\"-2\"", "laneId=\"-1\"");
    let events = event("go", &acquire, &after(0.0)) + &event("stop", &speed("step", 0.0, "time", 0.0), stop);
    let mut world = played(&events);
    go_on(&mut world, 6.0);
    let at = other(&world);
    assert!((at.position.x - 139.0).abs() < 0.7 && at.speed_mps == 0.0, "{at:?}");
}

#[test]
fn who_begins_turned_round_drives_against_traffic() {
    let init = begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 400.0, 10.0);
    let turned = r#"laneId="-1" s="400"><Orientation type="relative" h="3.14159265"/></LanePosition>"#;
    let mut world = world(&text(&init.replace(r#"laneId="-1" s="400"/>"#, turned), ""));
    go_on(&mut world, 2.0);
    let at = other(&world);
    assert!((at.position.x - 380.0).abs() < 0.1 && (at.rotation * glam::Vec3::X).x < -0.99, "{at:?}");
    assert!((at.speed_mps - 10.0).abs() < 0.02);
}

#[test]
fn where_the_road_ends_one_stands() {
    let init = begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 980.0, 10.0);
    let ended = when("Other", "none", r#"<EndOfRoadCondition duration="1"/>"#);
    let gone = r#"<GlobalAction><EntityAction entityRef="Other"><DeleteEntityAction/></EntityAction></GlobalAction>"#;
    let mut world = world(&text(&init, &event("e", gone, &ended)));
    go_on(&mut world, 2.5);
    assert!((other(&world).position.x - 1000.0).abs() < 0.2 && other(&world).speed_mps == 0.0);
    go_on(&mut world, 1.0);
    assert_eq!(world.scene().actors.len(), 1);
}

#[test]
fn a_line_beside_another_lies_where_that_is_when_it_begins() {
    let corner = |ds: f32, offset: f32, time: f32| {
        format!(
            r#"<Vertex time="{time}"><Position><RelativeLanePosition entityRef="Other" dLane="0" ds="{ds}" offset="{offset}"/></Position></Vertex>"#
        )
    };
    let corners = corner(0.0, 0.0, 0.0) + &corner(20.0, 1.0, 1.0) + &corner(60.0, -1.0, 3.0);
    let timing = r#"<Timing domainAbsoluteRelative="relative" scale="1" offset="0"/>"#;
    let mut world = played(&event("e", &follow(timing, &corners), &after(1.0)));
    go_on(&mut world, 2.0);
    let at = other(&world);
    assert!((at.position.truncate() - glam::Vec2::new(130.0, -0.75)).length() < 0.5, "{at:?}");
    go_on(&mut world, 1.0);
    assert!((other(&world).position.x - 150.0).abs() < 0.5, "{:?}", other(&world));
}

fn entry(speed_mps: f32, time: &str) -> String {
    format!(r#"<SpeedProfileEntry speed="{speed_mps}" {time}/>"#)
}

#[test]
fn a_profile_of_speeds_is_driven_entry_by_entry() {
    let entries = entry(14.0, r#"time="2""#) + &entry(14.0, r#"time="1""#) + &entry(6.0, "");
    let action = format!(
        r#"<PrivateAction><LongitudinalAction><SpeedProfileAction followingMode="follow">
<DynamicConstraints maxDeceleration="4"/>{entries}</SpeedProfileAction></LongitudinalAction></PrivateAction>"#
    );
    let mut world = played(&event("e", &action, &after(1.0)));
    go_on(&mut world, 1.0);
    for (seconds, expected_mps) in [(1.0, 12.0), (1.0, 14.0), (1.0, 14.0), (1.0, 10.0), (1.1, 6.0), (1.0, 6.0)] {
        go_on(&mut world, seconds);
        let speed_mps = other(&world).speed_mps;
        assert!((speed_mps - expected_mps).abs() < 0.15, "{speed_mps}, expected {expected_mps}");
    }
}

fn keeps(gap: &str) -> String {
    format!(
        r#"<PrivateAction><LongitudinalAction><LongitudinalDistanceAction entityRef="Ego" {gap} continuous="true">
<DynamicConstraints maxAcceleration="3" maxDeceleration="6"/></LongitudinalDistanceAction></LongitudinalAction></PrivateAction>"#
    )
}

#[test]
fn a_gap_is_kept_from_middle_to_middle_or_from_bumper_to_bumper() {
    // The ego car stands at 500 m; cars are 4.5 m long.
    for (gap, side, expected_m) in [
        (r#"distance="20" freespace="false""#, 100.0, -20.0),
        (r#"distance="20" freespace="true""#, 100.0, -24.5),
        (r#"distance="30" freespace="false" displacement="leadingReferencedEntity""#, 510.0, 30.0),
    ] {
        let init = begins("Ego", -1, 500.0, 0.0) + &begins("Other", -1, side, 10.0);
        let mut world = world(&text(&init, &event("e", &keeps(gap), &after(0.0))));
        go_on(&mut world, 60.0);
        let other = other(&world);
        let [own, ego] = [other.position.x, world.scene().ego.position.x + crate::ego::CENTRE_M.x];
        let length_m = crate::ego::SIZE_M.x * 0.5 + crate::actor::ActorKind::Car.size_m().x * 0.5 - 4.5;
        let free_m = if gap.contains("true") { length_m } else { 0.0 };
        assert!((own - ego - expected_m + free_m).abs() < 0.3, "{gap}: {}", own - ego);
        assert!(other.speed_mps.abs() < 0.05, "{other:?}");
    }
}

/// Arrives at 300 m of its lane when the ego car, which rolls, is at some place of its own.
fn meets(theirs_m: f32, last: &str) -> String {
    let place = |tag: &str, lane: i32, s_m: f32| {
        format!(r#"<{tag}><LanePosition roadId="7" laneId="{lane}" s="{s_m}"/></{tag}>"#)
    };
    let (theirs, own) = (place("TargetPositionMaster", -2, theirs_m), place("TargetPosition", -1, 300.0));
    format!(
        r#"<PrivateAction><SynchronizeAction masterEntityRef="Ego" targetToleranceMaster="1" targetTolerance="1">
{theirs}{own}{last}</SynchronizeAction></PrivateAction>"#
    )
}

#[test]
fn who_is_to_meet_the_ego_car_arrives_when_it_does() {
    for (begins_m, last, last_mps) in [
        (100.0, "", None),
        (180.0, r#"<FinalSpeed><AbsoluteSpeed value="12"/></FinalSpeed>"#, Some(12.0)),
        (220.0, r#"<FinalSpeed><RelativeSpeedToMaster speedTargetValueType="delta" value="-3"/></FinalSpeed>"#, None),
    ] {
        let init = begins("Ego", -2, 100.0, 15.0) + &begins("Other", -1, begins_m, 10.0);
        let mut world = world(&text(&init, &event("e", &meets(200.0, last), &after(0.0))));
        let place_m = |world: &World| world.scene().ego.position.x + crate::ego::CENTRE_M.x;
        while place_m(&world) < 199.0 {
            go_on(&mut world, 1.1 / 60.0);
            assert!(world.tick() < 3000, "the ego car rolls to its place");
        }
        let other = other(&world);
        // Within a tenth of a second: the ego car slows as it rolls.
        assert!((other.position.x - 300.0).abs() < 1.0 + 0.1 * other.speed_mps, "from {begins_m} m: {other:?}");
        if let Some(last_mps) = last_mps {
            assert!((other.speed_mps - last_mps).abs() < 0.6, "{other:?}");
        }
    }
}

#[test]
fn who_is_taken_from_the_end_of_its_road_goes_on_as_fast_as_before() {
    let back = r#"<PrivateAction><TeleportAction><Position><LanePosition roadId="7" laneId="-1" s="50"/></Position></TeleportAction></PrivateAction>"#;
    let at_end = when("Other", "none", r#"<EndOfRoadCondition duration="1"/>"#);
    let init = begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 980.0, 20.0);
    let mut world = world(&text(&init, &event("back", back, &at_end)));
    go_on(&mut world, 1.5);
    assert!(other(&world).speed_mps.abs() < 0.1 && other(&world).position.x > 999.0);
    go_on(&mut world, 2.0);
    let other = other(&world);
    assert!((other.speed_mps - 20.0).abs() < 0.1 && (60.0..90.0).contains(&other.position.x), "{other:?}");
}

#[test]
fn beyond_its_last_lane_a_road_counts_as_if_it_went_on() {
    let off = lane_change(r#"<RelativeTargetLane entityRef="Other" value="-4"/>"#, "sinusoidal", 2.0, "time");
    let gone = when("Other", "none", r#"<OffroadCondition duration="0.5"/>"#);
    let events = event("off", &off, &after(1.0))
        + &event("stop", &speed("step", 0.0, "time", 0.0), &gone).replace("overwrite", "parallel");
    let mut world = played(&events);
    go_on(&mut world, 2.2);
    assert!(other(&world).speed_mps > 9.0);
    go_on(&mut world, 1.5);
    let other = other(&world);
    // Lanes of 3.5 m: two of them on this side.
    assert!((other.position.y + 15.75).abs() < 0.1 && other.speed_mps < 0.1, "{other:?}");
}

#[test]
fn what_takes_time_at_the_beginning_takes_it() {
    let slowly = begins("Other", -1, 100.0, 12.0)
        .replace(r#"dynamicsShape="step" value="0""#, r#"dynamicsShape="linear" value="4""#);
    let mut world = world(&text(&(begins("Ego", -2, 500.0, 0.0) + &slowly), ""));
    for (seconds, expected_mps) in [(1.0, 3.0), (1.0, 6.0), (2.1, 12.0), (1.0, 12.0)] {
        go_on(&mut world, seconds);
        assert!((other(&world).speed_mps - expected_mps).abs() < 0.2, "{:?}", other(&world));
    }
}

#[test]
fn a_place_is_told_along_the_road_of_somebody() {
    for (lane, ds, dt, x, y) in [(-1, 30.0, -3.5, 530.0, -5.25), (2, 30.0, 3.5, 530.0, 8.75)] {
        let place = format!(r#"<RelativeRoadPosition entityRef="Ego" ds="{ds}" dt="{dt}"/>"#);
        let init = begins("Ego", lane, 500.0, 0.0)
            + &begins("Other", -1, 1.0, 0.0).replace(r#"<LanePosition roadId="7" laneId="-1" s="1"/>"#, &place);
        let other = other(&world(&text(&init, "")));
        assert!((other.position.truncate() - glam::Vec2::new(x, y)).length() < 0.05, "{lane}: {other:?}");
    }
}
