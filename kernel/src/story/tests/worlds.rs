//! Stories as a part of worlds: keyframes, forks, collisions, traffic.

use super::actions::follow;
use super::*;
use crate::actor::{ActorKind, FIRST_STORY_ID};
use crate::arbiter::{Outcome, Phase};
use crate::events::EventKind;
use crate::map::bundled;
use crate::state::State;
use crate::story::{BUNDLED, Stage};

fn busy() -> String {
    let lane = r#"<PrivateAction><LateralAction><LaneChangeAction>
<LaneChangeActionDynamics dynamicsShape="cubic" value="3" dynamicsDimension="time"/>
<LaneChangeTarget><AbsoluteTargetLane value="-2"/></LaneChangeTarget></LaneChangeAction></LateralAction></PrivateAction>"#;
    event("lane", lane, &after(11.0))
        + &event("fast", &speed("linear", 2.0, "rate", 20.0), &after(10.0)).replace("overwrite", "parallel")
        + &event("late", &speed("linear", 2.0, "rate", 2.0), &after(13.0).replace("delay=\"0\"", "delay=\"1\""))
}

#[test]
fn a_world_goes_on_from_a_keyframe_as_it_did() {
    let mut world = played(&busy());
    let mut keyframe = None;
    let mut hashes = Vec::new();
    for _ in 0..18 * 60 {
        let output = world.step(&TickInput::default());
        if let Some(made) = output.keyframe {
            (keyframe, hashes) = (Some(made), Vec::new());
        } else {
            hashes.push(output.hash);
        }
    }
    let keyframe = keyframe.expect("one is made every 12 s");
    let mut resumed = World::resume(world.scenario(), road(), &keyframe).expect("it is its own");
    let again: Vec<_> = hashes.iter().map(|_| resumed.step(&TickInput::default()).hash).collect();
    assert_eq!(again, hashes);
    let mut plain = scenario(&text(&(begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 100.0, 10.0)), ""));
    let said = World::fork(&plain, road(), &keyframe).err().expect("it has other events").to_string();
    assert!(said.contains("its story has other elements"), "{said}");
    plain.story = None;
    let said = World::fork(&plain, road(), &keyframe).err().expect("it has no story").to_string();
    assert!(said.contains("its run has a story, expected none"), "{said}");
}

#[test]
fn every_field_of_a_story_is_in_the_hash() {
    let mut world = played(&busy());
    go_on(&mut world, 11.5);
    let state = world.parts_of_story().expect("it has a story").clone();
    let mut named = Vec::new();
    state.name("", &mut named);
    for wanted in
        ["actors[1].spot.on.s_m", "actors[1].speed_by", "deeds[0].from", "events[1].at", "conditions[2].since"]
    {
        assert!(named.iter().any(|value| value.path.starts_with(wanted)), "{wanted}: {named:?}");
    }
}

#[test]
fn scenarios_with_stories_come_back_from_their_text() {
    let scenario = scenario(&text(&(begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 100.0, 10.0)), &busy()));
    let printed = scenario.to_toml();
    assert_eq!(Scenario::from_toml(&printed).as_ref(), Ok(&scenario));
    let broken = printed.replacen("AbsoluteTargetLane", "AbsoluteLane", 2);
    let error = Scenario::from_toml(&broken).expect_err("it is broken").to_string();
    assert!(error.starts_with("story, line ") && error.contains("<AbsoluteLane> is no element"), "{error}");
}

#[test]
fn who_is_hit_is_pushed_and_plays_no_more() {
    let init = begins("Ego", -1, 200.0, 0.0) + &begins("Other", -1, 150.0, 20.0);
    let mut world = world(&text(&init, ""));
    let mut collided = false;
    for _ in 0..600 {
        let output = world.step(&TickInput::default());
        collided |= output.events.iter().any(|e| e.kind == crate::events::EventKind::CollisionActor);
    }
    assert!(collided);
    let other = other(&world);
    assert!(other.position.x < 240.0 && other.speed_mps.abs() < 0.5, "{other:?}");
    // Everything of it comes back from a keyframe.
    let last = crate::Keyframe { tick: world.tick(), bytes: world.state_of_now() };
    World::resume(world.scenario(), road(), &last).expect("it is its own");
}

#[test]
fn the_ego_car_begins_as_fast_as_the_story_says() {
    let init = begins("Ego", -1, 200.0, 15.0) + &begins("Other", -2, 150.0, 0.0);
    let world = world(&text(&init, ""));
    assert!((world.scene().ego.speed_mps - 15.0).abs() < 0.01);
    assert!((world.scene().ego.position.y + 1.75).abs() < 0.01);
}

#[test]
fn the_file_drives_the_ego_car_until_it_hands_it_over() {
    let ego = |events: &str| {
        let init = begins("Ego", -2, 300.0, 10.0) + &begins("Other", -1, 100.0, 0.0);
        text(&init, events)
            .replace(r#"<EntityRef entityRef="Other"/></Actors>"#, r#"<EntityRef entityRef="Ego"/></Actors>"#)
    };
    let activate = r#"<PrivateAction><ControllerAction><ActivateControllerAction longitudinal="true" lateral="true"/></ControllerAction></PrivateAction>"#;
    let faster = event("faster", &speed("linear", 2.0, "time", 15.0), &after(1.0));
    let hand_over = event("hand over", activate, &after(5.0)).replace("overwrite", "parallel");
    let mut world = world(&ego(&(faster.clone() + &hand_over)));
    let place = |world: &World| world.scene().ego.position.x + crate::ego::CENTRE_M.x;
    // 10 m, then 25 m in 2 s, then 2 s at 15 m/s.
    for (seconds, expected_m, expected_mps) in [(1.0, 310.0, 10.0), (2.0, 335.0, 15.0), (2.0, 365.0, 15.0)] {
        (0..(seconds * 60.0) as u32).for_each(|_| drop(world.step(&TickInput::default())));
        let ego = world.scene().ego;
        assert!((place(&world) - expected_m).abs() < 0.3, "{ego:?}");
        assert!((ego.speed_mps - expected_mps).abs() < 0.3 && ego.position.z.abs() < 0.05, "{ego:?}");
    }
    // Whoever brakes then brakes.
    let brake = crate::controls::Controls { brake: u16::MAX, ..Default::default() };
    let input = TickInput { semantic: brake, safety: brake };
    (0..240).for_each(|_| drop(world.step(&input)));
    assert!(world.scene().ego.speed_mps < 12.0, "{:?}", world.scene().ego);
    // Without a hand-over the drivers have it from the beginning.
    let mut alone = self::world(&ego(&faster));
    go_on(&mut alone, 3.0);
    assert!(alone.scene().ego.speed_mps < 10.0);
}

#[test]
fn a_door_opens_is_seen_is_hit_and_shuts() {
    let door = |state: u32| {
        format!(
            r#"<PrivateAction><AppearanceAction><AnimationAction loop="false" animationDuration="1"><AnimationType><ComponentAnimation>
<VehicleComponent vehicleComponentType="doorFrontLeft"/></ComponentAnimation></AnimationType><AnimationState state="{state}"/>
</AnimationAction></AppearanceAction></PrivateAction>"#
        )
    };
    let shut = event("shut", &door(0), &after(6.0)).replace("overwrite", "parallel");
    let events = event("open", &door(1), &after(1.0)) + &shut;
    let begins_at = |mps: f32| {
        begins("Ego", -1, 100.0, mps)
            + &begins("Other", -2, 120.0, 0.0).replace("s=\"120\"", "s=\"120\" offset=\"0.7\"")
    };
    let doors = |world: &World| -> Vec<ActorScene> {
        world.scene().actors.iter().filter(|a| a.kind == crate::scene::ActorKind::Door).copied().collect()
    };
    let mut world = world(&text(&begins_at(0.0), &events));
    go_on(&mut world, 0.9);
    assert_eq!(doors(&world), []);
    go_on(&mut world, 2.0);
    let [open] = doors(&world)[..] else { panic!("{:?}", doors(&world)) };
    // It stands out into the lane on the left of the car, whose side is at -4.55 + 0.9 m.
    assert!((-3.7..-2.6).contains(&open.position.y) && (119.0..122.0).contains(&open.position.x), "{open:?}");
    go_on(&mut world, 5.0);
    assert_eq!(doors(&world), []);
    // Who drives by too near hits it.
    let near = begins_at(10.0).replacen("s=\"100\"", "s=\"100\" offset=\"-0.6\"", 1);
    let mut world = self::world(&text(&near, &events));
    let hit = (0..240).any(|_| {
        let events = world.step(&TickInput::default()).events;
        events.iter().any(|e| {
            e.kind == crate::events::EventKind::CollisionActor && e.actor == crate::scene::FIRST_STORY_DOOR_ID + 1
        })
    });
    assert!(hit);
}

#[test]
fn traffic_drives_behind_who_plays_and_does_not_touch_it() {
    let init = begins("Ego", 2, 500.0, 0.0) + &begins("Other", -2, 300.0, 3.0);
    let mut scenario = scenario(&text(&init, ""));
    scenario.traffic = TrafficCounts { cars: 12, ..TrafficCounts::NONE };
    let mut world = World::new(&scenario, road()).expect("it fits");
    for _ in 0..60 {
        go_on(&mut world, 1.0);
        let scene = world.scene();
        let me = other(&world);
        for actor in scene.actors.iter().filter(|actor| actor.id != me.id) {
            let way = (actor.position - me.position).abs();
            assert!(way.x > 4.5 || way.y > 1.85, "{actor:?} is in {me:?}");
        }
    }
}

#[test]
fn drivers_know_the_way_that_a_line_tells() {
    let (_, told) = BUNDLED.into_iter().find(|(name, _)| *name == "cyclist_at_the_right_turn").expect("it is bundled");
    let (before, rest) = told.split_once("<RoutingAction><AssignRouteAction>").expect("its ego car has a route");
    let (_, after) = rest.split_once("</AssignRouteAction></RoutingAction>").expect("it ends");
    let corners: String = [("5", -2, 20), ("5", -2, 60), ("5", -2, 59), ("13", 1, 50), ("13", 1, 60)]
        .map(|(road, lane, s)| {
            format!(r#"<Vertex><Position><LanePosition roadId="{road}" laneId="{lane}" s="{s}"/></Position></Vertex>"#)
        })
        .concat();
    let line = follow("<None/>", &corners).replace("<PrivateAction>", "").replace("</PrivateAction>", "");
    let network = bundled("city").expect("it is bundled");
    let way = |text: &str| {
        let stage = Stage::new(&Story::read(text).expect("it is a story"), &network).expect("it is on the map");
        let (lane, _) = stage.ego_road(&network).expect("it begins on a road");
        stage.ego_way(&network, lane)
    };
    let routed = way(told);
    assert!(!routed.is_empty() && way(&format!("{before}{line}{after}")) == routed, "{routed:?}");
}

#[test]
fn a_run_ends_when_its_story_is_stopped() {
    let stop = format!("<StopTrigger>{}</StopTrigger></Storyboard>", after(5.0));
    let text = text(&(begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 100.0, 10.0)), "");
    let mut world = world(&text.replace("<StopTrigger/></Storyboard>", &stop));
    go_on(&mut world, 4.9);
    assert_ne!(world.arbiter().phase, Phase::Done);
    go_on(&mut world, 0.2);
    assert_eq!((world.arbiter().phase, world.arbiter().outcome), (Phase::Done, Some(Outcome::Censored)));
}

#[test]
fn a_thing_in_the_way_stands_there_until_it_is_run_into() {
    let thing =
        "<MiscObject name=\"bin\" mass=\"30\" miscObjectCategory=\"obstacle\"><BoundingBox/><Properties/></MiscObject>";
    let walker = r#"<Pedestrian name="child" model="child" mass="30" pedestrianCategory="pedestrian"/>"#;
    let text = text(&(begins("Ego", -1, 100.0, 12.0) + &begins("Other", -1, 300.0, 0.0)), "").replace(walker, thing);
    let place = r#"<WorldPosition x="900" y="30" z="0" h="0"/>"#;
    let mut world = world(&text.replace(place, r#"<LanePosition roadId="7" laneId="-1" s="120"/>"#));
    let bin = |world: &World| *world.scene().actors.iter().find(|a| a.id == FIRST_STORY_ID + 2).expect("it is there");
    let stood = bin(&world);
    assert_eq!(stood.kind, ActorKind::Obstacle);
    let mut hit = false;
    for _ in 0..4 * 60 {
        hit |= world.step(&TickInput::default()).events.iter().any(|event| event.kind == EventKind::CollisionActor);
        assert!(hit || bin(&world).position == stood.position);
    }
    assert!(hit && bin(&world).position.x > stood.position.x + 0.5, "{:?}", bin(&world));
}
