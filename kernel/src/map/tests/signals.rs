//! Signal programmes, arrows, and the signs of several countries.

use super::*;

#[path = "../../../tests/common/programmes.rs"]
mod programmes;

pub(super) use programmes::check_programmes;

use crate::signals::{LightPhase, phase};

const LIGHTS: &str = include_str!("../../../../tests/maps/cross_lights.xodr");
const NONE: &str = include_str!("../../../../tests/maps/cross_none.xodr");

fn baked(text: &str) -> RoadNetwork {
    let map = bake("cross", text).unwrap();
    check_sound(&map);
    check_programmes(&map);
    map
}

/// A file with another signal for those who drive on a road of the crossroads towards its middle.
fn with_signal(text: &str, road: u32, kind: &str) -> String {
    let at = text.find(&format!("id=\"{road}\" junction=\"-1\"")).unwrap();
    let end = at + text[at..].find("</road>").unwrap();
    let signal = format!(
        "<signal id=\"9{road}\" s=\"6.5\" t=\"7.3\" zOffset=\"3.2\" orientation=\"-\" dynamic=\"no\" {kind}>\
         <validity fromLane=\"1\" toLane=\"1\"/></signal>"
    );
    match text[at..end].find("</signals>") {
        Some(k) => format!("{}{signal}{}", &text[..at + k], &text[at + k..]),
        None => format!("{}<signals>{signal}</signals>{}", &text[..end], &text[end..]),
    }
}

fn without_controllers(text: &str) -> String {
    text.replace("<controller ", "<userData ").replace("</controller>", "</userData>")
}

/// The lane that leads from a road of the crossroads to its middle.
fn lane_of(map: &RoadNetwork, road: u32) -> &Lane {
    map.lanes.iter().find(|l| l.kind == LaneKind::Driving && l.name == format!("{road}/1")).unwrap()
}

fn light_of(map: &RoadNetwork, road: u32) -> &LightGroup {
    let Some(StopKind::Light(group)) = lane_of(map, road).stop.map(|stop| stop.kind) else { panic!("a light") };
    &map.light_groups[group as usize]
}

fn starts(map: &RoadNetwork) -> Vec<u32> {
    map.junctions[0].light_groups.iter().map(|g| map.light_groups[*g as usize].green_from_ticks).collect()
}

/// The lane inside that turns so from a road.
fn turning(map: &RoadNetwork, road: u32, turn: Turn) -> (LaneId, &Lane) {
    let mut next = lane_of(map, road).successors.iter().map(|l| (*l, &map.lanes[*l as usize]));
    next.find(|(_, lane)| lane.turn == turn).unwrap()
}

#[test]
fn controllers_switch_in_their_sequence() {
    let map = baked(LIGHTS);
    let order: Vec<_> = [4, 1, 2, 3].map(|road| light_of(&map, road).green_from_ticks).into();
    assert!(order.windows(2).all(|pair| pair[0] < pair[1]) && order == starts(&map), "{order:?}");
    // 10 s green, 3 s yellow, then what a left turn takes to clear the way.
    let slot = map.junctions[0].cycle_ticks / 4;
    assert!((15 * 60..18 * 60).contains(&slot), "{slot} ticks");
    assert_eq!((map.light_groups[0].green_ticks, map.light_groups[0].yellow_ticks), (600, 180));
}

#[test]
fn controllers_of_the_same_sequence_switch_together() {
    let paired = LIGHTS.replace("sequence=\"2\"", "sequence=\"0\"").replace("sequence=\"3\"", "sequence=\"1\"");
    let map = baked(&paired);
    let [east, north, west, south] = [1, 2, 3, 4].map(|road| light_of(&map, road).green_from_ticks);
    assert!(east == west && north == south && north < east);
}

#[test]
fn what_conflicts_is_not_green_together_whatever_the_controllers_say() {
    let at_once = (1..4).fold(LIGHTS.to_owned(), |t, k| t.replace(&format!("sequence=\"{k}\""), "sequence=\"0\""));
    let one =
        LIGHTS.replace("id=\"23\"", "id=\"20\"").replace("id=\"26\"", "id=\"20\"").replace("id=\"29\"", "id=\"20\"");
    for text in [at_once, one] {
        let map = baked(&text);
        assert_ne!(light_of(&map, 1).green_from_ticks, light_of(&map, 2).green_from_ticks);
    }
}

#[test]
fn without_controllers_opposing_approaches_are_green_together() {
    let map = baked(&without_controllers(LIGHTS));
    let [east, north, west, south] = [1, 2, 3, 4].map(|road| light_of(&map, road));
    assert!(east.green_from_ticks == west.green_from_ticks && north.green_from_ticks == south.green_from_ticks);
    assert_eq!(east.green_ticks, 15 * 60);
    let (left, straight) = (turning(&map, 1, Turn::Left).1, turning(&map, 3, Turn::Straight).0);
    assert!(left.conflicts.iter().any(|c| c.lane == straight && c.other_first), "a left turn gives way");
    // The slowest get over the longest crossing while the traffic on it waits.
    for light in &map.light_groups {
        let red = map.junctions[0].cycle_ticks - light.green_ticks - light.yellow_ticks;
        assert!(red as f32 / 60.0 > (8.0 + 2.0) / 0.8);
    }
}

#[test]
fn fast_roads_have_a_longer_yellow() {
    for (kmh, yellow_s) in [(30, 3), (50, 3), (70, 4), (100, 5)] {
        let map = baked(&LIGHTS.replace("max=\"50\"", &format!("max=\"{kmh}\"")));
        assert!(map.light_groups.iter().all(|light| light.yellow_ticks == yellow_s * 60), "{kmh} km/h");
    }
}

#[test]
fn what_controllers_refer_to_in_vain_is_passed_over() {
    let whole = baked(LIGHTS);
    let lost = LIGHTS.replace("signalId=\"22\"", "signalId=\"999\"");
    let none = LIGHTS.replace("<control signalId=\"22\" type=\"0\"/>", "");
    assert_eq!(baked(&lost).digest, baked(&none).digest);
    assert_eq!(baked(&lost).light_groups.len(), 4);
    let more = LIGHTS.replace("</junction>", "<controller id=\"77\" type=\"0\" sequence=\"0\"/></junction>");
    assert_eq!(baked(&more).digest, whole.digest);
    for sequence in ["x", "", "-1", "99999999999"] {
        baked(&LIGHTS.replace("sequence=\"1\"", &format!("sequence=\"{sequence}\"")));
    }
}

#[test]
fn too_many_controllers_are_refused() {
    let many = "<controller id=\"1\"><control signalId=\"19\"/></controller>".repeat(20_001);
    let error = bake("many", &LIGHTS.replace("<junction ", &format!("{many}<junction "))).expect_err("too many");
    assert!(error.to_string().contains("at most 20000 controllers"), "{error}");
}

#[test]
fn an_arrow_holds_its_turn_only_and_gives_it_the_way() {
    let arrow = "country=\"OpenDRIVE\" type=\"1000011\" subtype=\"10\"";
    for text in [LIGHTS.to_owned(), without_controllers(LIGHTS)] {
        let map = baked(&with_signal(&text, 1, arrow));
        assert_eq!(map.light_groups.len(), 5);
        let (left, lane) = turning(&map, 1, Turn::Left);
        let before = map.lanes[left as usize].predecessors[0];
        let own = lane.light.expect("an arrow of its own");
        assert_eq!(map.light_between(before, left), Some(own));
        for turn in [Turn::Straight, Turn::Right] {
            let (next, lane) = turning(&map, 1, turn);
            assert_eq!(lane.light, None);
            assert_ne!(map.light_between(before, next), Some(own));
        }
        // Nobody to whom it gives way has green: not even oncoming traffic.
        let goes = |group, tick| phase(&map, 3, group, tick).0 != LightPhase::Red;
        for conflict in &lane.conflicts {
            let from = map.lanes[conflict.lane as usize].predecessors[0];
            let theirs = map.light_between(from, conflict.lane).unwrap();
            let cycle = u64::from(map.junctions[0].cycle_ticks);
            assert!(!(0..cycle).any(|tick| goes(own, tick) && goes(theirs, tick)), "lane {}", conflict.lane);
        }
    }
}

#[test]
fn without_another_light_those_whom_no_arrow_holds_give_way() {
    let arrow = |subtype: u32| format!("type=\"1000011\" subtype=\"{subtype}\"");
    let left = with_signal(NONE, 1, &arrow(10));
    let map = baked(&left);
    assert_eq!(lane_of(&map, 1).stop.unwrap().kind, StopKind::Yield);
    assert!(turning(&map, 1, Turn::Left).1.light.is_some() && turning(&map, 1, Turn::Right).1.light.is_none());
    // Two arrows that hold all have the line between them; the other keeps its own.
    let map = baked(&left.replacen("<signal id=\"91\"", &format!("<signal id=\"1\" s=\"6\" t=\"5\" orientation=\"-\" {}><validity fromLane=\"1\" toLane=\"1\"/></signal><signal id=\"91\"", arrow(50)), 1));
    assert!(matches!(lane_of(&map, 1).stop.unwrap().kind, StopKind::Light(_)));
    let own = [Turn::Left, Turn::Straight, Turn::Right].map(|turn| turning(&map, 1, turn).1.light.is_some());
    assert_eq!(own, [true, false, false]);
}

#[test]
fn a_light_referred_to_from_far_inside_holds_those_before_the_junction() {
    let references = include_str!("../../../../tests/maps/cross_references.xodr");
    let lane = "<lane id=\"-1\" type=\"driving\"><link><predecessor id=\"-1\"/><successor id=\"-1\"/></link>\
        <width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane>";
    let far = format!(
        "<laneSection s=\"12\"><center><lane id=\"0\" type=\"none\"/></center><right>{lane}</right></laneSection>"
    );
    // Of every straight way through the junction.
    let halves = references.split_inclusive("</road>").map(|road| {
        if road.contains("<road length=\"24\"") {
            road.replace("</laneSection></lanes>", &format!("</laneSection>{far}</lanes>"))
                .replace("s=\"0\" t=\"0\" orientation=\"+\"", "s=\"13\" t=\"0\" orientation=\"+\"")
        } else {
            road.to_owned()
        }
    });
    let text: String = halves.collect();
    assert!(text.contains("s=\"13\"") && text.contains("laneSection s=\"12\""));
    let map = baked(&text);
    for lane in map.lanes.iter().filter(|l| l.kind == LaneKind::Driving) {
        let enters =
            lane.junction.is_none() && lane.successors.iter().any(|n| map.lanes[*n as usize].junction.is_some());
        let lit = lane.stop.is_some_and(|stop| matches!(stop.kind, StopKind::Light(_)));
        assert_eq!(lit, enters, "lane {}", lane.name);
    }
}

#[test]
fn lights_of_people_on_foot_hold_nobody_else() {
    let map =
        baked(&with_signal(NONE, 1, "type=\"1000002\" subtype=\"-1\"").replace("dynamic=\"no\"", "dynamic=\"yes\""));
    assert!(map.light_groups.is_empty());
}

#[test]
fn signs_of_several_countries_are_understood() {
    let stop = ["DE 206", "SE B2", "FR AB4", "GB 601.1", "UK 601 1", "US R1-1", "OpenDRIVE 206", " 206"];
    let give_way = ["DE 205", "SE B1", "SE B 1", "FR AB3a", "FR AB3 a", "GB 602", "UK 602", "USA R1-2", "-1 205"];
    let unknown = ["DE 206.5", "SE 206", "US B2", "XX 206", "GB 205", "DE 999"];
    let signed = |code: &str| {
        let mut parts = code.split(' ');
        let [country, kind, subtype] = [(); 3].map(|()| parts.next().unwrap_or("-1"));
        let named = format!("country=\"{country}\" type=\"{kind}\" subtype=\"{subtype}\"");
        baked(&with_signal(&with_signal(NONE, 2, &named), 4, &named))
    };
    let minor = |map: &RoadNetwork| [2, 4].map(|road| lane_of(map, road).stop.unwrap().kind);
    let first = |map: &RoadNetwork| turning(map, 1, Turn::Straight).1.conflicts.iter().all(|c| !c.other_first);
    for code in stop {
        let map = signed(code);
        assert!(minor(&map) == [StopKind::Stop; 2] && first(&map), "{code}");
    }
    for code in give_way {
        let map = signed(code);
        assert!(minor(&map) == [StopKind::Yield; 2] && first(&map), "{code}");
        assert_eq!(map.props.iter().filter(|p| p.variant == SIGN_YIELD && p.kind == PropKind::Sign).count(), 2);
    }
    for code in unknown {
        let map = signed(code);
        assert!(minor(&map) == [StopKind::Yield; 2] && !first(&map), "{code} means nothing");
        assert!(map.props.iter().all(|p| p.kind != PropKind::Sign), "{code}");
    }
}

#[test]
fn who_drives_on_a_priority_road_goes_first() {
    for code in
        ["type=\"306\"", "country=\"DE\" type=\"301\"", "country=\"SE\" type=\"B4\"", "country=\"FR\" type=\"AB6\""]
    {
        let map = baked(&with_signal(&with_signal(NONE, 1, code), 3, code));
        for road in [1, 3] {
            for turn in [Turn::Straight, Turn::Right] {
                let (_, lane) = turning(&map, road, turn);
                assert!(lane.conflicts.iter().all(|c| !c.other_first), "{code}: {}", lane.name);
            }
            let (_, left) = turning(&map, road, Turn::Left);
            let oncoming = turning(&map, 4 - road, Turn::Straight).0;
            for conflict in &left.conflicts {
                let from = &map.lanes[map.lanes[conflict.lane as usize].predecessors[0] as usize];
                let minor = from.name.starts_with('2') || from.name.starts_with('4');
                assert!(!(minor && conflict.other_first), "{code}");
            }
            assert!(left.conflicts.iter().any(|c| c.lane == oncoming && c.other_first), "{code}: oncoming goes first");
        }
        for road in [2, 4] {
            assert_eq!(lane_of(&map, road).stop.unwrap().kind, StopKind::Yield, "{code}: waits at a line");
        }
    }
}

/// A straight road of three sections with this in its `<type>`, a sign so far along it.
fn signed_road(speed: &str, sign: &str, s_m: u32) -> RoadNetwork {
    signed_road_of("town", speed, sign, s_m)
}

/// The same of a type.
fn signed_road_of(kind: &str, speed: &str, sign: &str, s_m: u32) -> RoadNetwork {
    let lane = "<center><lane id=\"0\" type=\"none\"/></center><right><lane id=\"-1\" type=\"driving\"><link>\
        <predecessor id=\"-1\"/><successor id=\"-1\"/></link><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane></right>";
    let sections = [0, 100, 200].map(|s| format!("<laneSection s=\"{s}\">{lane}</laneSection>")).concat();
    let signal = format!("<signal id=\"1\" s=\"{s_m}\" t=\"-3.8\" orientation=\"+\" dynamic=\"no\" {sign}/>");
    let text = format!(
        "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/><road id=\"1\" length=\"300\" junction=\"-1\"><type s=\"0\" \
         type=\"{kind}\">{speed}</type><planView><geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"300\"><line/></geometry>\
         </planView><lanes>{sections}</lanes><signals>{signal}</signals></road></OpenDRIVE>"
    );
    bake("signed", &text).unwrap()
}

fn limits_kmh(map: &RoadNetwork) -> Vec<f32> {
    map.lanes.iter().map(|lane| (lane.speed_limit_mps * 36.0).round() / 10.0).collect()
}

#[test]
fn limits_are_told_in_several_units() {
    for (speed, kmh) in [
        ("<speed max=\"30\" unit=\"mph\"/>", 48.3),
        ("<speed max=\"30\" unit=\"km/h\"/>", 30.0),
        ("<speed max=\"10\" unit=\"m/s\"/>", 36.0),
        ("<speed max=\"10\"/>", 36.0),
        ("", 50.0),
        ("<speed max=\"undefined\"/>", 50.0),
        ("<speed/>", 50.0),
        ("<speed max=\"no limit\"/>", 130.0),
        ("<speed max=\"200\" unit=\"km/h\"/>", 130.0),
        ("<speed max=\"6\" unit=\"km/h\"/>", 6.0),
        ("<speed max=\"1\" unit=\"km/h\"/>", 5.0),
    ] {
        assert_eq!(limits_kmh(&signed_road(speed, "type=\"999\"", 10)), [kmh; 3], "{speed}");
    }
    for (sign, kmh) in [
        ("country=\"DE\" type=\"274\" subtype=\"30\" value=\"30\" unit=\"km/h\"", 30.0),
        ("country=\"DE\" type=\"274-30\" value=\"30\"", 30.0),
        ("type=\"274\" value=\"20\" unit=\"m/s\"", 72.0),
        ("country=\"SE\" type=\"C31\" value=\"70\"", 70.0),
        ("country=\"FR\" type=\"B14\" value=\"80\" unit=\"km/h\"", 80.0),
        ("country=\"UK\" type=\"670\" value=\"20\"", 32.2),
        ("country=\"US\" type=\"R2-1\" value=\"25\" unit=\"mph\"", 40.2),
        ("country=\"US\" type=\"R2-1\" value=\"40\" unit=\"km/h\"", 40.0),
        ("type=\"274\" value=\"1\"", 5.0),
        ("type=\"274\" value=\"140\"", 130.0),
        // Neither is a limit.
        ("type=\"274\" value=\"-1\"", 60.0),
        ("type=\"274\" value=\"0\"", 60.0),
        ("type=\"274\" value=\"30\" unit=\"t\"", 60.0),
        ("type=\"274\" value=\"30\" invalidated=\"true\"", 60.0),
    ] {
        let map = signed_road("<speed max=\"60\" unit=\"km/h\"/>", sign, 10);
        assert_eq!(limits_kmh(&map), [kmh; 3], "{sign}");
    }
}

#[test]
fn where_no_limit_is_told_the_type_of_the_road_tells_it() {
    for (kind, kmh) in [
        ("motorway", 130.0),
        ("rural", 100.0),
        ("townExpressway", 80.0),
        ("town", 50.0),
        ("townArterial", 50.0),
        ("unknown", 50.0),
        ("lowSpeed", 30.0),
        ("bicycle", 30.0),
        ("pedestrian", 7.0),
        ("townPlayStreet", 7.0),
    ] {
        for speed in ["", "<speed max=\"undefined\"/>"] {
            assert_eq!(limits_kmh(&signed_road_of(kind, speed, "type=\"999\"", 10)), [kmh; 3], "{kind}");
        }
        assert_eq!(limits_kmh(&signed_road_of(kind, "<speed max=\"no limit\"/>", "type=\"999\"", 10)), [130.0; 3]);
    }
}

#[test]
fn a_limit_holds_from_its_sign_on() {
    let sign = "type=\"274\" value=\"30\"";
    let at = |s_m| limits_kmh(&signed_road("<speed max=\"60\" unit=\"km/h\"/>", sign, s_m));
    assert_eq!(at(30), [30.0, 30.0, 30.0]);
    assert_eq!(at(80), [60.0, 30.0, 30.0]);
    assert_eq!(at(120), [60.0, 30.0, 30.0]);
    assert_eq!(at(270), [60.0; 3]);
}
