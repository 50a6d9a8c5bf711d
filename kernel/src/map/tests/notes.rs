//! What is not understood of a file is told, each thing by whoever passes over it.

use super::broken::straight;
use super::*;

/// What is told of a kind of thing: what, why, how many, and where the first one is.
fn told(kind: Passed, text: &str) -> Vec<(String, &'static str, usize, String)> {
    let groups = bake_with_notes("told", text).expect("a map").passed_over;
    let of_kind = groups.into_iter().filter(|group| group.kind == kind);
    of_kind.map(|group| (group.what, group.why, group.count, group.first)).collect()
}

/// A road of 200 m with this in it.
fn road(extra: &str) -> String {
    straight("200", "3.5", extra)
}

fn expect(kind: Passed, text: &str, expected: &[(&str, &'static str, usize, &str)]) {
    let mut told = told(kind, text);
    let mut expected: Vec<_> = expected.iter().map(|(a, b, n, c)| (a.to_string(), *b, *n, c.to_string())).collect();
    told.sort();
    expected.sort();
    assert_eq!(told, expected);
}

#[test]
fn a_plain_road_leaves_nothing_over() {
    assert_eq!(bake_with_notes("plain", &road("")).expect("a map").passed_over, []);
}

#[test]
fn notes_change_nothing_of_the_map() {
    for name in BUNDLED {
        let text = bundled_text(name).expect("bundled");
        let Baked { map, told, .. } = bake_with_notes(name, text).expect("a map");
        assert_eq!(map.digest, bundled(name).expect("bundled").digest);
        assert_eq!((told.lane_types.len(), told.controls.len()), (map.lanes.len(), map.junctions.len()));
        assert!(told.sides[0] + told.sides[1] > 0 && told.named_props <= map.props.len(), "{name}");
        assert!(told.marks.len() > 10 && told.roads > told.roads_inside, "{name}");
    }
}

#[test]
fn signals_that_mean_nothing_are_told_by_type_and_country() {
    let signal = |s: u32, more: &str| format!("<signal id=\"{s}\" s=\"{s}\" t=\"-3\" orientation=\"+\" {more}/>");
    let signals = [
        signal(20, "type=\"283\" subtype=\"30\" country=\"DE\""),
        signal(10, "type=\"283\" subtype=\"30\" country=\"DE\""),
        signal(30, "type=\"R99\" country=\"XX\""),
        signal(40, "type=\"274\" value=\"-1\" country=\"DE\""),
        signal(50, "type=\"206\" country=\"DE\""),
        signal(5, "type=\"224\" country=\"DE\""),
        signal(60, "type=\"1000002\" dynamic=\"yes\" country=\"OpenDRIVE\""),
        signal(70, "type=\"205\" country=\"DE\" invalidated=\"true\""),
        // Understood: a limit of a lane that is driven on.
        signal(80, "type=\"274\" value=\"30\" country=\"DE\""),
    ];
    let expected = [
        ("type 283, subtype 30, country DE", "is in none of the catalogues", 2, "road 1, s 20.0 m"),
        ("type R99, no subtype, country XX", "is in none of the catalogues", 1, "road 1, s 30.0 m"),
        ("type 274, no subtype, country DE", "shows no speed", 1, "road 1, s 40.0 m"),
        ("type 206, no subtype, country DE", "is for no lane before a junction", 1, "road 1, s 50.0 m"),
        ("type 224, no subtype, country DE", "no bus can halt there", 1, "road 1, s 5.0 m"),
        ("type 1000002, no subtype, country OpenDRIVE", "holds no vehicles", 1, "road 1, s 60.0 m"),
        ("type 205, no subtype, country DE", "is struck out", 1, "road 1, s 70.0 m"),
    ];
    expect(Passed::Signal, &road(&format!("<signals>{}</signals>", signals.concat())), &expected);
}

#[test]
fn objects_that_stand_for_nothing_or_nowhere_are_told() {
    let object = |s: u32, more: &str| format!("<object id=\"{s}\" s=\"{s}\" t=\"-9\" zOffset=\"0\" hdg=\"0\" {more}/>");
    let size = "length=\"4\" width=\"4\" height=\"5\"";
    let objects = [
        object(10, &format!("type=\"gantry\" {size}")),
        object(20, &format!("type=\"gantry\" {size}")),
        object(30, &format!("type=\"-1\" name=\"Pothole_01\" {size}")),
        object(40, &format!("type=\"-1\" name=\"Pothole_02\" {size}")),
        object(50, "type=\"tree\""),
        object(60, "type=\"crosswalk\""),
        object(70, &format!("type=\"building\" {size}")).replace("t=\"-9\"", "t=\"-1.75\""),
        object(80, &format!("type=\"tree\" {size}")),
    ];
    let expected = [
        ("type gantry", "stands for nothing here", 2, "road 1, s 10.0 m"),
        ("type unknown, name Pothole", "stands for nothing here", 2, "road 1, s 30.0 m"),
        ("type tree", "has no footprint, or no height", 1, "road 1, s 50.0 m"),
        ("type crosswalk", "has no area", 1, "road 1, s 60.0 m"),
        ("type building", "would stand on a driving lane", 1, "road 1, s 70.0 m"),
    ];
    expect(Passed::Object, &road(&format!("<objects>{}</objects>", objects.concat())), &expected);
}

#[test]
fn lanes_that_lose_something_are_told() {
    let lane = |id: i32, kind: &str| format!("<lane id=\"{id}\" type=\"{kind}\"><width sOffset=\"0\" a=\"2\"/></lane>");
    let further = [lane(-2, "bus"), lane(-3, "tram"), lane(-4, "hover"), lane(-5, "sidewalk")].concat();
    let text = road("").replace("</right>", &format!("{further}</right>"));
    let expected = [
        ("type bus", "everybody drives there", 1, "road 1, section 0, lane -2"),
        ("type tram", "nothing runs there", 1, "road 1, section 0, lane -3"),
        ("type unknown", "nobody uses it", 1, "road 1, section 0, lane -4"),
    ];
    expect(Passed::Lane, &text, &expected);
}

#[test]
fn marks_and_surfaces_that_look_otherwise_are_told() {
    let marks = "<roadMark sOffset=\"0\" type=\"botts dots\"/><roadMark sOffset=\"50\" type=\"solid\" color=\"yellow\"/>\
                 <roadMark sOffset=\"90\" type=\"curb\"/><roadMark sOffset=\"120\" type=\"broken\" color=\"white\"/>\
                 <material sOffset=\"0\" surface=\"moon dust\"/><material sOffset=\"60\" surface=\"gravel\"/>";
    let text = road("").replace("</lane></right>", &format!("{marks}</lane></right>"));
    let painted = [
        ("type botts-dots", "is not painted", 1, "road 1, s 0.0 m"),
        ("colour yellow", "is painted white", 1, "road 1, s 50.0 m"),
    ];
    expect(Passed::RoadMark, &text, &painted);
    let made = [("material moon dust", "counts as asphalt", 1, "road 1, section 0, lane -1")];
    expect(Passed::Surface, &text, &made);
    let marks = bake_with_notes("marks", &text).expect("a map").told.marks;
    let seen: Vec<_> = marks.iter().map(|mark| (mark.colour.as_str(), mark.dash_m.is_some())).collect();
    assert_eq!(seen, [("yellow", false), ("white", true)]);
    assert!(marks[0].points.iter().all(|p| (p.y + 3.5).abs() < 0.1 && (50.0..=90.0).contains(&p.x)), "{marks:?}");
}

#[test]
fn elements_without_a_place_in_a_map_are_told() {
    let text = road(
        "<objects><bridge id=\"7\" s=\"5\" length=\"9\" type=\"steel\"/><tunnel id=\"8\" s=\"50\" length=\"9\"/>\
                     <station id=\"9\"/></objects><railroad/><userData code=\"a\"/><surface><CRG file=\"a.crg\"/></surface>",
    );
    let expected = ["<station> in <objects>", "<railroad> in <road>", "<userData> in <road>"];
    let expected: Vec<_> =
        expected.into_iter().chain(["<surface> in <road>"]).map(|what| (what, "is not read", 1, "road 1")).collect();
    expect(Passed::Element, &text, &expected);
}

#[test]
fn references_to_what_is_not_there_are_told() {
    let link = "<link><predecessor elementType=\"road\" elementId=\"9\" contactPoint=\"end\"/>\
                <successor elementType=\"junction\" elementId=\"8\"/></link><planView>";
    let junction = "<junction id=\"3\"><connection id=\"0\" incomingRoad=\"1\" connectingRoad=\"4\" contactPoint=\"start\">\
                    <laneLink from=\"-7\" to=\"-1\"/></connection></junction></OpenDRIVE>";
    let signals = "<signals><signalReference id=\"77\" s=\"5\" t=\"0\" orientation=\"+\"/></signals>";
    let text = road(signals).replace("<planView>", link).replace("</OpenDRIVE>", junction);
    let told = told(Passed::Reference, &text);
    let said: Vec<String> =
        told.iter().map(|(what, why, count, first)| format!("{what}: {why} x{count}, {first}")).collect();
    for expected in [
        "<predecessor> to road 9: there is no such road x1, road 1",
        "<successor> to junction 8: there is no such junction x1, road 1",
        "<connection> to road 4: there is no such road x1, junction 3, connection 0",
        "<laneLink> to lane -7 of road 1: there is no such lane x1, junction 3, connection 0",
    ] {
        assert!(said.contains(&expected.to_owned()), "{expected} is not among {said:#?}");
    }
    assert!(said.iter().any(|line| line.starts_with("signal link dropped: ") && line.contains("\"77\"")), "{said:#?}");
}

#[test]
fn what_the_parser_says_is_told() {
    let text = road("").replace("length=\"200\" junction", "length=\"199\" junction");
    let told = told(Passed::Warning, &text);
    assert_eq!((told.len(), told[0].0.as_str(), told[0].2), (1, "road length mismatch", 1), "{told:?}");
    assert!(told[0].3.contains("road \"1\""), "{told:?}");
}

#[test]
fn junctions_are_told_by_what_controls_them() {
    for (text, control) in [
        (include_str!("../../../../tests/maps/cross_lights.xodr"), Control::Lights),
        (include_str!("../../../../tests/maps/cross_stop.xodr"), Control::Stop),
        (include_str!("../../../../tests/maps/cross_yield.xodr"), Control::Yield),
        (include_str!("../../../../tests/maps/cross_none.xodr"), Control::Right),
    ] {
        assert_eq!(bake_with_notes("cross", text).expect("a map").told.controls, [control]);
    }
}

#[test]
fn traffic_on_the_left_is_told() {
    let right = bake_with_notes("right", &road("")).expect("a map").told;
    assert_eq!(right.sides, [1, 0]);
    let left = road("").replace("junction=\"-1\"", "junction=\"-1\" rule=\"LHT\"");
    assert_eq!(bake_with_notes("left", &left).expect("a map").told.sides, [0, 1]);
}
