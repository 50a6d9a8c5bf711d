//! Files that are no maps.

use super::*;

const CROSS: &str = include_str!("../../../../tests/maps/cross_lights.xodr");

/// A straight road with one lane of `width`, and `extra` inside the road.
fn straight(length: &str, width: &str, extra: &str) -> String {
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
    assert!(refused(&walk).contains("driving"));
    assert!(refused(&straight("50", "0", "")).contains("driving"));
    assert!(refused(&straight("NaN", "3.5", "")).contains("expected"));
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
