//! OpenDRIVE files come from strangers: what no map holds is refused in a sentence that names it, before
//! it costs time or memory.
#![allow(clippy::disallowed_methods, reason = "tests may compute as they like")]

#[path = "../../tests/src/roads.rs"]
#[allow(dead_code, reason = "others use the rest")]
mod roads;

use kernel::map::{RoadNetwork, bake};
use roads::{Road, crossing, file, geometry, section, winding};

fn refusal(text: &str) -> String {
    let refusal = bake("strange", text).expect_err("it is refused").to_string();
    assert!(!refusal.contains('\n') && refusal.len() < 300, "one sentence: {refusal}");
    refusal
}

/// Refused, and the sentence says all of `says`.
fn refused(text: &str, says: &[&str]) {
    let refusal = refusal(text);
    assert!(says.iter().all(|said| refusal.contains(said)), "{says:?}: {refusal}");
}

fn baked(text: &str) -> RoadNetwork {
    let map = bake("large", text).expect("it bakes");
    assert!(map.lanes.iter().flat_map(|l| &l.points).all(|p| p.position.is_finite()));
    map
}

fn road() -> Road {
    Road::straight(7, [0.0; 3], 100.0)
}

#[test]
fn a_polynomial_of_1e308_is_refused() {
    for name in ["aU", "bU", "cU", "dU", "aV", "bV", "cV", "dV"] {
        let shape = format!("<paramPoly3 pRange=\"normalized\" {name}=\"1e308\"/>");
        let plan = geometry(0.0, [0.0; 3], 100.0, &shape);
        refused(&file(&[Road { plan, ..road() }]), &["road 7", name, "1e308"]);
    }
    let plan = geometry(0.0, [0.0; 3], 100.0, "<paramPoly3 aU=\"0\" bU=\"100\" cU=\"0\" dU=\"1e14\"/>");
    refused(&file(&[Road { plan, ..road() }]), &["road 7", "farther"]);
}

#[test]
fn a_road_whose_line_jumps_is_refused() {
    let plan = |x: f64| geometry(0.0, [0.0; 3], 50.0, "<line/>") + &geometry(50.0, [x, 0.0, 0.0], 50.0, "<line/>");
    refused(&file(&[Road { plan: plan(150_000.0), ..road() }]), &["road 7", "geometries that join", "14995"]);
    // Neatly made ones join; torn by metres they are drawn as they are.
    baked(&file(&[Road { plan: plan(50.0), ..road() }]));
    baked(&file(&[Road { plan: plan(60.0), ..road() }]));
}

#[test]
fn a_lane_kilometres_wide_is_refused() {
    let wide = |record: &str| {
        let sections = section(0.0, "").replacen("a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"", record, 1);
        file(&[Road { sections, ..road() }])
    };
    refused(&wide("a=\"3.5\" b=\"0\" c=\"0\" d=\"5000\""), &["road 7, section 0, lane 1", "width", "200"]);
    refused(&wide("a=\"5000\" b=\"0\" c=\"0\" d=\"0\""), &["road 7, section 0, lane 1", "5000"]);
    // In the middle only: 3.5 m at both ends.
    refused(&wide("a=\"3.5\" b=\"1000\" c=\"-10\" d=\"0\""), &["road 7, section 0, lane 1", "width"]);
    // At the very end, where a lane has its last point; beyond, a record may say what it likes.
    let from = |s: u32| {
        wide(&format!("a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/><width sOffset=\"{s}\" a=\"5000\" b=\"0\" c=\"0\" d=\"0\""))
    };
    refused(&from(100), &["road 7, section 0, lane 1", "5000"]);
    baked(&from(101));
}

#[test]
fn a_mark_of_a_thousand_lines_is_refused() {
    let line = "<line length=\"0.1\" space=\"0.1\" tOffset=\"0\" sOffset=\"0\" width=\"0.1\"/>";
    let mark = |lines: usize| {
        format!(
            "<roadMark sOffset=\"0\" type=\"broken\"><type name=\"b\" width=\"0.1\">{}</type></roadMark>",
            line.repeat(lines)
        )
    };
    let with = |lines| file(&[Road { sections: section(0.0, &mark(lines)), ..road() }]);
    refused(&with(1_000), &["road 7, section 0, lane -1", "lines of a road mark"]);
    let dashes = baked(&with(4)).surfaces.iter().map(|s| s.triangles.len()).sum::<usize>();
    assert!(dashes < 10_000, "{dashes} triangles");
}

#[test]
fn more_dashes_than_a_map_has_are_refused() {
    let mark = "<roadMark sOffset=\"0\" type=\"broken\"><type name=\"b\" width=\"0.1\"><line length=\"1e-9\" \
                space=\"1e-9\" tOffset=\"0\" sOffset=\"0\"/></type></roadMark>";
    refused(&file(&[Road { sections: section(0.0, mark), ..road() }]), &["road 7, section 0, lane -1", "dashes"]);
}

#[test]
fn lengths_are_limited_road_by_road_and_together() {
    refused(&file(&[Road::straight(7, [0.0; 3], 100_001.0)]), &["road 7", "length of at most 100000 m"]);
    let unmarked = |id: usize| Road {
        sections: section(0.0, "").replace("type=\"broken\"", "type=\"solid\""),
        ..Road::straight(id, [0.0, 50.0 * id as f64, 0.0], 100_000.0)
    };
    refused(&file(&(0..11).map(unmarked).collect::<Vec<_>>()), &["road 10", "m of roads"]);
    let broken: Vec<_> = (0..10).map(|id| Road::straight(id, [0.0, 50.0 * id as f64, 0.0], 100_000.0)).collect();
    refused(&file(&broken), &["road 7, section 0, lane 0", "steps of computing"]);
    let plan = geometry(0.0, [0.0; 3], 1e7, "<spiral curvStart=\"0\" curvEnd=\"1e-7\"/>");
    refused(&file(&[Road { plan, ..road() }]), &["road 7", "m of geometry"]);
}

#[test]
fn sections_lanes_and_records_are_counted() {
    let sections: String = (0..10_000).map(|k| section(f64::from(k) * 0.01, "")).collect();
    refused(&file(&[Road { sections, ..road() }]), &["road 7", "sections", "10000"]);
    let lane = "<lane id=\"1\" type=\"driving\"><width sOffset=\"0\" a=\"3\"/></lane>".repeat(5_000);
    let sections = section(0.0, "").replacen("<left>", &format!("<left>{lane}"), 1);
    refused(&file(&[Road { sections, ..road() }]), &["road 7, section 0", "lanes of a section"]);
    let extra = format!("<elevationProfile>{}</elevationProfile>", "<elevation s=\"0\" a=\"0\"/>".repeat(20_000));
    refused(&file(&[Road { extra, ..road() }]), &["road 7", "<elevation>", "20000"]);
    let plan = geometry(0.0, [0.0; 3], 0.001, "<line/>").repeat(20_000);
    refused(&file(&[Road { plan, ..road() }]), &["road 7", "geometries"]);
}

#[test]
fn numbers_that_are_none_are_refused_where_they_count() {
    for number in ["nan", "inf", "-inf", "1e308", "-1e300"] {
        let text = file(&[road()]);
        for (name, given) in [("hdg", "hdg=\"0\""), ("x", "x=\"0\""), ("a", "a=\"3.5\""), ("s", "geometry s=\"0\"")] {
            let odd = text.replacen(given, &given.replace(given.split('"').nth(1).unwrap(), number), 1);
            refused(&odd, &["road 7", &format!("expected {name} of"), number]);
        }
    }
    let extra = "<elevationProfile><elevation s=\"0\" a=\"0\" b=\"0\" c=\"0\" d=\"1\"/></elevationProfile>".to_owned();
    refused(&file(&[Road { extra, ..road() }]), &["road 7", "height of at most"]);
}

#[test]
fn what_is_no_number_is_refused_by_road_and_attribute() {
    let text = file(&[road()]);
    let geometry = "<geometry s=\"0\"";
    assert!(text.contains(geometry) && text.contains("length=\"100\""), "{text}");
    for (number, says) in [("abc", "abc"), ("6e2,5", "6e2,5"), ("", "nothing")] {
        let geometry = text.replacen("<geometry s=\"0\"", &format!("<geometry s=\"{number}\""), 1);
        refused(&geometry, &["road 7", "s of <geometry> to be a number", says]);
        refused(&text.replacen("length=\"100\"", &format!("length=\"{number}\""), 1), &["road 7", "length", says]);
        let section = text.replacen("<laneSection s=\"0\"", &format!("<laneSection s=\"{number}\""), 1);
        refused(&section, &["road 7", "s of <laneSection> to be a number", says]);
    }
}

#[test]
fn roads_and_junctions_are_counted() {
    refused(&file(&(0..50_001).map(|id| Road::straight(id, [0.0; 3], 1.0)).collect::<Vec<_>>()), &["roads", "50001"]);
    let connection = "<connection id=\"0\" incomingRoad=\"7\" connectingRoad=\"7\" contactPoint=\"start\"/>";
    let junction = format!("<junction id=\"3\" name=\"\">{}</junction></OpenDRIVE>", connection.repeat(5_000));
    refused(&file(&[road()]).replace("</OpenDRIVE>", &junction), &["junction 3", "connections"]);
}

#[test]
fn objects_are_counted_as_often_as_they_are_repeated() {
    let repeated = |distance: f64, length: f64| {
        let repeat = format!("<repeat s=\"0\" length=\"100\" distance=\"{distance}\" tStart=\"9\" tEnd=\"9\"/>");
        let extra = format!(
            "<objects><object id=\"5\" type=\"tree\" s=\"0\" t=\"9\" length=\"{length}\" width=\"1\" height=\"3\">\
             {repeat}</object></objects>"
        );
        file(&[Road { extra, ..road() }])
    };
    baked(&repeated(5.0, 1.0));
    // However many they are, the sentence stays one.
    assert!(refusal(&repeated(1e-300, 1.0)).len() < 200);
    refused(&repeated(1e-6, 1.0), &["road 7, object 5", "objects"]);
    // Long ones one in the other are looked at every metre.
    refused(&repeated(0.002, 48.0), &["road 7, object 5", "m² below objects"]);
}

#[test]
fn elements_of_thousands_of_attributes_are_refused() {
    let attributes: String = (0..100_000).map(|k| format!(" a{k}=\"\"")).collect();
    let text = file(&[road()]).replacen("<road ", &format!("<road{attributes} "), 1);
    refused(&text, &["line 3", "attributes"]);
}

#[test]
fn a_map_as_large_as_a_country_is_refused() {
    refused(&file(&[road(), Road::straight(8, [5e6, 0.0, 0.0], 100.0)]), &["8/", "300000 m"]);
}

#[test]
fn lanes_inside_each_other_are_named_once() {
    let nested =
        "<lane id=\"-1\" type=\"driving\">".repeat(100) + "<width sOffset=\"1e308\" a=\"1\"/>" + &"</lane>".repeat(100);
    let sections = format!("<laneSection s=\"0\"><right>{nested}</right></laneSection>");
    refused(&file(&[Road { sections, ..road() }]), &["road 7, section 0, lane -1: expected sOffset"]);
}

#[test]
fn a_road_has_an_id_of_its_own_and_a_junction_not_too_many_roads() {
    let twins = [Road::straight(3, [0.0; 3], 100.0), Road::straight(3, [0.0, 50.0, 0.0], 100.0)];
    refused(&file(&twins), &["road 3", "another road has it"]);
    let inside: Vec<_> = (0..401).map(|id| Road::straight(id, [0.0, 20.0 * id as f64, 0.0], 24.0)).collect();
    let text = file(&inside).replace("junction=\"-1\"", "junction=\"5\"");
    refused(&text, &["road 400", "at most 400 roads inside a junction"]);
}

#[test]
fn lanes_on_one_heap_are_refused() {
    let heap: Vec<_> = (0..3_000).map(|id| Road::straight(id, [0.0; 3], 100.0)).collect();
    refused(&file(&heap), &["road 2999", "heap"]);
}

#[test]
fn large_maps_bake() {
    let long = baked(&winding(20, 1_000.0));
    assert_eq!(long.lanes.len(), 80);
    assert!(long.lanes.iter().filter(|l| l.successors.len() == 1).count() >= 76, "the roads are joined");
    let streets = baked(&crossing(20, 100.0));
    assert_eq!(streets.lanes.len(), 160);
}

#[test]
fn a_long_lane_is_baked_as_its_parts_are() {
    // Whoever asks about a place on a long lane gets what the whole lane says.
    let map = baked(&winding(1, 4_000.0));
    for lane in 0..map.lanes.len() as u32 {
        for p in map.lanes[lane as usize].points.iter().step_by(97) {
            let near = map.nearest_lane(p.position, map.lanes[lane as usize].kind, Some(p.heading_rad), 0.5);
            assert_eq!(near, Some(map.project(lane, p.position)));
        }
    }
}
