//! Files that are no maps.

use super::*;

const CROSS: &str = include_str!("../../../../tests/maps/cross_lights.xodr");

/// A straight road with one lane of `width`, and `extra` inside the road.
pub(super) fn straight(length: &str, width: &str, extra: &str) -> String {
    format!(
        "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/><road id=\"1\" length=\"{length}\" junction=\"-1\"><planView>\
         <geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"{length}\"><line/></geometry></planView><lanes>\
         <laneSection s=\"0\"><center><lane id=\"0\" type=\"none\"/></center><right><lane id=\"-1\" type=\"driving\">\
         <width sOffset=\"0\" a=\"{width}\" b=\"0\" c=\"0\" d=\"0\"/></lane></right></laneSection></lanes>{extra}\
         </road></OpenDRIVE>"
    )
}

fn refused(text: &str) -> String {
    bake("broken", text).expect_err("no map").to_string()
}

#[test]
fn a_file_cut_in_half_is_named_by_its_line() {
    let text = refused(&CROSS[..CROSS.len() / 2]);
    assert!(text.starts_with("line ") && text.contains("expected well-formed"), "{text}");
}

#[test]
fn texts_that_are_no_maps_are_refused_in_one_sentence() {
    for text in
        ["", "   ", "not xml", "<OpenDRIVE/>", "<html></html>", "\u{0}\u{1}\u{2}", "<OpenDRIVE><road/></OpenDRIVE>"]
    {
        let error = refused(text);
        assert!(error.contains("expected") && !error.contains('\n'), "{text:?}: {error}");
    }
}

#[test]
fn a_map_without_a_lane_to_drive_on_is_refused() {
    let walk = straight("50", "3.5", "").replace("driving", "sidewalk");
    let expected =
        "the whole file: expected a road with a length, a plan view, and a lane of type driving that has a width";
    for (text, but) in [
        (walk, "but the only road is none"),
        (straight("50", "0", ""), "but the only road is none"),
        (straight("50", "3.5", "").replace("<width", "<wide"), "but the only road is none"),
        (straight("50", "3.5", "").replace("planView", "plan"), "but the only road is none"),
        (straight("0", "3.5", "</road><road id=\"2\" length=\"5\">"), "but none of the 2 roads is one"),
        ("<OpenDRIVE/>".to_owned(), "but there is no road"),
    ] {
        assert_eq!(refused(&text), format!("{expected}, {but}"));
    }
    assert!(refused(&straight("NaN", "3.5", "")).contains("expected"));
}

#[test]
fn elements_nested_too_deep_are_named() {
    let deep = straight("50", "3.5", &format!("{}{}", "<userData>".repeat(300), "</userData>".repeat(300)));
    let expected = "the whole file: expected OpenDRIVE that can be read, but it has elements nested more than 256 deep";
    assert_eq!(refused(&deep), expected);
}

/// A road with this in its `<type>`, and with this in its lane.
fn limited(of_road: &str, of_lane: &str) -> String {
    let road = format!("<type s=\"0\" type=\"town\">{of_road}</type><planView>");
    let text = straight("50", "3.5", "").replace("<planView>", &road);
    text.replace("</lane></right>", &format!("{of_lane}</lane></right>"))
}

#[test]
fn a_limit_that_is_none_is_refused_where_it_stands() {
    let or_words = "expected max of <speed> to be a number above 0, no limit or undefined";
    for max in ["none", "-1", "-0.5", "50 km/h", "unlimited", "No limit", "fünfzig", "1,5"] {
        let speed = format!("<speed sOffset=\"0\" max=\"{max}\"/>");
        assert_eq!(refused(&limited(&speed, "")), format!("road 1: {or_words}, but it is {max}"));
        assert_eq!(refused(&limited("", &speed)), format!("road 1, section 0, lane -1: {or_words}, but it is {max}"));
    }
    let odd = "<speed sOffset=\"0\" max=\"50\" unit=\"kmh\"/>";
    assert_eq!(
        refused(&limited(odd, "")),
        "road 1: expected unit of <speed> to be one of m/s, km/h, mph, but it is kmh"
    );
    let zero = "<speed sOffset=\"0\" max=\"0\"/>";
    let expected = "road 1, section 0, lane -1: expected a speed limit above 0 where one drives";
    for text in [limited(zero, ""), limited("<speed max=\"9\"/>", zero)] {
        assert!(refused(&text).starts_with(expected), "{}", refused(&text));
    }
    let pavement =
        limited("", "</lane><lane id=\"-2\" type=\"sidewalk\"><width sOffset=\"0\" a=\"2\"/><speed max=\"0\"/>");
    assert!(bake("pavement", &pavement).is_ok(), "nobody drives there");
    for word in ["no limit", "undefined", ""] {
        let map = bake("words", &limited("", &format!("<speed sOffset=\"0\" max=\"{word}\"/>"))).unwrap();
        assert_eq!(map.lanes[0].speed_limit_mps, 50.0 / 3.6, "a lane that says {word} is as its road's type");
    }
}

#[test]
fn a_sign_that_shows_no_speed_is_refused() {
    let signed = |value: &str, kind: &str| {
        let sign = format!("<signals><signal id=\"5\" s=\"9\" t=\"-4\" type=\"{kind}\" value=\"{value}\"/></signals>");
        straight("50", "3.5", &sign)
    };
    for value in ["thirty", "-30", "1000", "1e300", "30 km/h"] {
        let reason = format!("expected value of this speed limit to be from 0 to below 1000, but it is {value}");
        assert_eq!(refused(&signed(value, "274")), format!("road 1, signal 5: {reason}"));
        assert!(bake("other", &signed(value, "206")).is_ok(), "{value} on a sign that shows none");
    }
    for value in ["", "0", "-1", "-1.0000000000000000e+00", "30", "999"] {
        assert!(bake("signed", &signed(value, "274")).is_ok(), "{value}");
    }
}

#[test]
fn odd_numbers_do_not_panic() {
    for number in ["NaN", "-1", "0", "1e-9", "1e9", "1e38", "inf", "x", ""] {
        let _ = bake("odd", &straight(number, "3.5", ""));
        let _ = bake("odd", &straight("50", number, ""));
        let crosswalk = format!(
            "<objects><object id=\"1\" type=\"crosswalk\" s=\"{number}\" t=\"{number}\" length=\"{number}\" \
             width=\"{number}\" height=\"{number}\" hdg=\"{number}\" zOffset=\"{number}\"/></objects>"
        );
        let _ = bake("odd", &straight("50", "3.5", &crosswalk));
    }
}

#[test]
fn a_map_with_any_stretch_missing_bakes_or_is_refused() {
    let step = CROSS.len() / 60;
    for k in 0..60 {
        let (from, to) = (k * step, k * step + step / 2);
        let (from, to) = (floor_boundary(from), floor_boundary(to));
        if let Err(error) = bake("holes", &format!("{}{}", &CROSS[..from], &CROSS[to..])) {
            assert!(!error.to_string().contains('\n'), "{error}");
        }
    }
}

#[test]
fn elements_left_out_one_by_one_do_not_panic() {
    for tag in ["<signal ", "<object ", "<laneLink ", "<connection ", "<link>", "<width ", "<geometry ", "<control "] {
        let renamed = CROSS.replace(tag, &tag.replace('<', "<x"));
        let closed = renamed.replace(&tag.replace('<', "</").trim().to_owned(), tag.replace('<', "</x").trim());
        if let Ok(map) = bake("without", &closed) {
            check_sound(&map);
        }
    }
}

fn floor_boundary(at: usize) -> usize {
    (0..=at).rev().find(|&i| CROSS.is_char_boundary(i)).unwrap_or(0)
}
