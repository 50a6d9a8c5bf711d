//! Maps far from the origin of their file, as in the coordinates of a national grid.

use super::broken::straight;
use super::*;

const CITY: &str = include_str!("../../../maps/city.xodr");

/// As in UTM, at Munich.
const MUNICH_M: [f64; 2] = [691_000.0, 5_334_000.0];

/// A file with everything that it places itself so far east and north.
fn moved(text: &str, [east_m, north_m]: [f64; 2]) -> String {
    ["<geometry", "<positionInertial"].iter().fold(text.to_owned(), |text, opening| {
        let mut elements = text.split(opening);
        let before = elements.next().unwrap().to_owned();
        elements.fold(before, |done, element| {
            let (tag, rest) = element.split_once('>').unwrap();
            format!("{done}{opening}{}>{rest}", shifted(&shifted(tag, "x", east_m), "y", north_m))
        })
    })
}

fn shifted(tag: &str, name: &str, by_m: f64) -> String {
    let (before, rest) = tag.split_once(&format!(" {name}=\"")).unwrap();
    let (value, after) = rest.split_once('"').unwrap();
    format!("{before} {name}=\"{}\"{after}", value.parse::<f64>().unwrap() + by_m)
}

fn baked(text: &str) -> RoadNetwork {
    let map = bake("far", text).unwrap();
    check_sound(&map);
    map
}

/// Both hold the same but for the last bit of rounding.
fn check_same(one: &RoadNetwork, other: &RoadNetwork) {
    let near = |a: Vec3, b: Vec3| assert!((a - b).abs().max_element() <= 1.0 / 1024.0, "{a} is not {b}");
    assert_eq!(one.lanes.len(), other.lanes.len());
    for (a, b) in one.lanes.iter().zip(&other.lanes) {
        assert_eq!(
            (&a.name, &a.successors, a.junction, a.points.len()),
            (&b.name, &b.successors, b.junction, b.points.len())
        );
        a.points.iter().zip(&b.points).for_each(|(p, q)| near(p.position, q.position));
    }
    assert_eq!((one.props.len(), one.walk_nodes.len()), (other.props.len(), other.walk_nodes.len()));
    one.walk_nodes.iter().zip(&other.walk_nodes).for_each(|(a, b)| near(a.position, b.position));
}

#[test]
fn a_town_in_utm_is_the_same_town() {
    let (here, there) = (bake("city", CITY).unwrap(), baked(&moved(CITY, MUNICH_M)));
    assert_eq!((here.origin_m, there.origin_m), ([0.0; 2], MUNICH_M));
    check_same(&here, &there);
    assert!(here.digest != there.digest, "where a map lies is part of what it is");
}

#[test]
fn the_origin_is_a_whole_number_of_kilometres() {
    let road = straight("100", "3.5", "");
    for (by_m, origin_m) in [
        ([9_900.0, 0.0], [0.0; 2]),
        ([0.0, -9_900.0], [0.0; 2]),
        ([12_400.0, 300.0], [12_000.0, 0.0]),
        ([-12_600.0, -300.0], [-13_000.0, 0.0]),
        // The number of a zone before the easting.
        ([32_691_600.0, 5_334_400.0], [32_692_000.0, 5_334_000.0]),
    ] {
        let map = baked(&moved(&road, by_m));
        assert_eq!(map.origin_m, origin_m);
        assert!(map.origin_m.iter().all(|m| m.is_sign_positive() || *m < 0.0), "no negative zero");
        let start = map.lanes[0].start().position;
        let expected = [0, 1].map(|k| (by_m[k] - origin_m[k]) as f32);
        assert!((start.truncate() - glam::Vec2::from(expected)).abs().max_element() < 2.0, "{start} at {by_m:?}");
    }
}

#[test]
fn a_sign_with_a_place_of_its_own_comes_along() {
    let sign = "<signals><signal id=\"1\" s=\"20\" t=\"-6\" orientation=\"+\" dynamic=\"no\" type=\"206\">\
                <positionInertial x=\"30\" y=\"-7\" z=\"1\" hdg=\"0\"/></signal></signals>";
    let text = straight("100", "3.5", sign);
    let signs = |map: &RoadNetwork| {
        let signs = map.props.iter().filter(|p| p.kind == PropKind::Sign);
        signs.map(|p| p.position).collect::<Vec<_>>()
    };
    let here = signs(&baked(&text));
    assert_eq!(here.len(), 1);
    assert_eq!(signs(&baked(&moved(&text, MUNICH_M))), here);
    // However its numbers are written.
    let odd = moved(&text, MUNICH_M).replace("x=\"691030\" y=\"5333993\"", "y = '5333993'\n  x='+6.9103e5'");
    assert!(odd.contains("+6.9103e5"));
    assert_eq!(signs(&baked(&odd)), here);
}

#[test]
fn roads_without_lanes_do_not_pull_the_origin_away() {
    let bare = "</road><road id=\"2\" length=\"9\" junction=\"-1\"><planView><geometry s=\"0\" x=\"0\" y=\"0\" \
                hdg=\"0\" length=\"9\"><line/></geometry></planView><lanes><laneSection s=\"0\"><center>\
                <lane id=\"0\" type=\"none\"/></center></laneSection></lanes>";
    let far = moved(&straight("100", "3.5", ""), MUNICH_M);
    assert_eq!(baked(&far.replace("</road>", &format!("{bare}</road>"))).origin_m, MUNICH_M);
}

#[test]
fn lanes_too_far_from_the_middle_are_refused() {
    // The other road counts though its lane has no width, and is no lane at last.
    let far = moved(&straight("100", "3.5", ""), MUNICH_M);
    let narrow = straight("100", "0", "").replace("road id=\"1\"", "road id=\"2\"");
    let road = &narrow[narrow.find("<road").unwrap()..narrow.find("</OpenDRIVE>").unwrap()];
    let error = bake("far", &far.replace("</OpenDRIVE>", &format!("{road}</OpenDRIVE>"))).expect_err("refused");
    assert!(error.to_string().starts_with("the whole file: expected lanes within 300000 m of the middle"), "{error}");
}

#[test]
fn the_digest_tells_an_origin_only_where_there_is_one() {
    let map = |origin_m| MapData { origin_m, ..MapData::default() }.content_digest();
    assert_eq!(map([0.0; 2]), MapData::default().content_digest());
    assert!(map([1_000.0, 0.0]) != map([0.0; 2]) && map([1_000.0, 0.0]) != map([0.0, 1_000.0]));
}
