//! Each feature on a small map of its own.

use super::*;

macro_rules! small {
    ($name:literal) => {{
        let map = bake($name, include_str!(concat!("../../../../tests/maps/", $name, ".xodr"))).unwrap();
        check_sound(&map);
        map
    }};
}

/// Lanes that lead into the junction, counter-clockwise by heading from west.
fn before_junction(map: &RoadNetwork) -> Vec<&Lane> {
    let leads = |l: &&Lane| {
        let next = l.successors.first().map(|&n| map.lanes[n as usize].junction.is_some());
        l.kind == LaneKind::Driving && l.junction.is_none() && next == Some(true)
    };
    map.lanes.iter().filter(leads).collect()
}

fn inside(map: &RoadNetwork) -> impl Iterator<Item = &Lane> {
    map.junctions[0].lanes.iter().map(|&l| &map.lanes[l as usize])
}

/// Whether `a` runs east or west where it starts.
fn is_level(a: &Lane) -> bool {
    crate::ops::cos(a.start().heading_rad).abs() > 0.7
}

#[test]
fn lanes_turn_as_they_are_named() {
    let map = small!("cross_lights");
    let count = |turn| inside(&map).filter(|l| l.turn == turn).count();
    assert_eq!((count(Turn::Left), count(Turn::Straight), count(Turn::Right)), (4, 4, 4));
    assert_eq!(map.junctions.len(), 1);
    assert!(map.junctions[0].center.length() < 2.0);
    for lane in before_junction(&map) {
        assert_eq!(lane.successors.len(), 3);
        assert!(lane.end().position.length() < lane.start().position.length(), "drives towards the middle");
        assert!((lane.speed_limit_mps - 50.0 / 3.6).abs() < 1e-4);
        assert!((lane.start().half_width_m - 1.75).abs() < 1e-3);
    }
}

#[test]
fn each_approach_has_its_light() {
    let map = small!("cross_lights");
    let groups: Vec<_> = before_junction(&map).iter().map(|l| l.stop.unwrap().kind).collect();
    assert_eq!(groups.len(), 4);
    for (k, kind) in groups.iter().enumerate() {
        assert!(matches!(kind, StopKind::Light(_)) && !groups[..k].contains(kind));
    }
    assert_eq!(map.junctions[0].light_groups.len(), 4);
    assert_eq!(map.light_heads.len(), 4);
    for head in &map.light_heads {
        let facing = direction(head.facing_rad);
        assert!(facing.dot(head.position.truncate()) > 0.0, "shines away from the junction");
        assert!(!map.on_road(head.position) && head.height_m > 2.0);
    }
}

#[test]
fn stop_lines_lie_before_the_zebra() {
    let map = small!("cross_lights");
    assert_eq!(map.crosswalks.len(), 4);
    for crosswalk in &map.crosswalks {
        assert_eq!(crosswalk.junction, Some(0));
        assert_eq!(crosswalk.lanes.len(), 2);
        assert!((crosswalk.ends[0].distance(crosswalk.ends[1]) - 8.0).abs() < 0.05, "from kerb to kerb");
        assert!((crosswalk.half_width_m - 2.0).abs() < 0.01);
        for &(lane, s) in &crosswalk.lanes {
            if let Some(stop) = map.lanes[lane as usize].stop {
                assert!(stop.s_m < s - crosswalk.half_width_m && stop.s_m > s - crosswalk.half_width_m - 3.0);
            }
        }
    }
}

#[test]
fn lights_referred_to_from_inside_the_junction_govern_the_lanes_before_it() {
    let map = small!("cross_references");
    assert!(before_junction(&map).iter().all(|l| matches!(l.stop.unwrap().kind, StopKind::Light(_))));
    assert_eq!((map.light_groups.len(), map.light_heads.len()), (4, 4));
    assert_eq!(map.crosswalks.len(), 4, "a junction with lights and sidewalks gets crossings");
    assert_eq!(walkable_parts(&map).len(), 1);
}

#[test]
fn signs_stop_the_minor_road() {
    for (map, kind) in [(small!("cross_stop"), StopKind::Stop), (small!("cross_yield"), StopKind::Yield)] {
        let signed = before_junction(&map).into_iter().filter(|l| !is_level(l));
        assert!(signed.clone().count() == 2 && signed.into_iter().all(|l| l.stop.unwrap().kind == kind));
        assert_eq!(map.props.iter().filter(|p| p.kind == PropKind::Sign).count(), 2);
        for minor in inside(&map).filter(|l| !is_level(l)) {
            let major = minor.conflicts.iter().filter(|c| is_level(&map.lanes[c.lane as usize]));
            assert!(major.clone().count() > 0 && major.into_iter().all(|c| c.other_first));
        }
    }
}

#[test]
fn without_signs_right_goes_before_left() {
    let map = small!("cross_none");
    for lane in inside(&map).filter(|l| l.turn == Turn::Straight) {
        for conflict in &lane.conflicts {
            let other = &map.lanes[conflict.lane as usize];
            let turn = crate::ops::wrap_angle(other.start().heading_rad - lane.start().heading_rad);
            if turn.abs() < 2.0 {
                assert_eq!(conflict.other_first, turn > 0.0, "{} meets {}", lane.name, other.name);
            } else {
                assert!(!conflict.other_first, "an oncoming left turn waits");
            }
        }
        assert!(lane.conflicts.len() >= 5);
    }
    assert!(before_junction(&map).iter().all(|l| l.stop.unwrap().kind == StopKind::Yield));
}

#[test]
fn lanes_of_one_direction_are_neighbours() {
    let map = small!("cross_wide");
    for lane in map.lanes.iter().filter(|l| l.kind == LaneKind::Driving && l.junction.is_none()) {
        assert!(lane.left.is_some() != lane.right.is_some(), "two lanes a direction: {}", lane.name);
        for (beside, sign) in [(lane.left, 1.0), (lane.right, -1.0)] {
            if let Some(id) = beside {
                let at = lane.project(map.lanes[id as usize].at(20.0).position);
                assert!((at.1 * sign - 3.5).abs() < 0.05);
            }
        }
    }
}

#[test]
fn pavements_are_raised_and_have_kerbs() {
    let map = small!("cross_lights");
    let walk = map.lanes.iter().find(|l| l.kind == LaneKind::Sidewalk).unwrap();
    let ground = map.ground(walk.at(walk.length_m / 2.0).position).unwrap();
    assert_eq!(ground.kind, SurfaceKind::Sidewalk);
    assert!((0.12..=0.15).contains(&ground.height_m));
    let sidewalk = map.surfaces.iter().find(|s| s.kind == SurfaceKind::Sidewalk).unwrap();
    assert!(sidewalk.positions.iter().any(|p| p.z < 0.0), "kerbs reach below the road");
}

#[test]
fn paint_lies_on_asphalt_and_stripes_fill_crossings() {
    let map = small!("cross_lights");
    let paint = map.surfaces.iter().find(|s| s.kind == SurfaceKind::RoadLine).unwrap();
    assert!(paint.positions.iter().all(|p| p.z > 0.005 && p.z < 0.03));
    let on_zebra = |p: &&Vec3| map.crosswalks.iter().any(|c| ((c.ends[0] + c.ends[1]) / 2.0).distance(**p) < 5.0);
    assert!(paint.positions.iter().filter(on_zebra).count() >= 4 * 8 * 4);
}

#[test]
fn land_lies_below_hilly_roads() {
    let map = small!("cross_hill");
    let top = map.lanes.iter().flat_map(|l| &l.points).map(|p| p.position.z).fold(0.0, f32::max);
    assert!((top - 6.0).abs() < 0.01);
    check_ground(&map, &[SurfaceKind::Road]);
}

/// On every lane of the road one finds the road, which is of one of these kinds.
pub(super) fn check_ground(map: &RoadNetwork, paved: &[SurfaceKind]) {
    for lane in map.lanes.iter().filter(|l| l.kind == LaneKind::Driving) {
        for p in &lane.points {
            let ground = map.ground(p.position).unwrap_or_else(|| panic!("no ground at {}", p.position));
            assert!((ground.height_m - p.position.z).abs() < 0.05, "{} at {}: {ground:?}", lane.name, p.position);
            assert!(paved.contains(&ground.kind), "{} at {}: {ground:?}", lane.name, p.position);
        }
    }
}

#[test]
fn lanes_are_made_of_what_the_file_says_from_where_it_says_so() {
    let material =
        |s: u32, surface: &str| format!("<material sOffset=\"{s}\" surface=\"{surface}\" friction=\"0.5\"/>");
    let lane = |id: i32, kind: &str, materials: &str| {
        format!(
            "<lane id=\"{id}\" type=\"{kind}\"><width sOffset=\"0\" a=\"4\" b=\"0\" c=\"0\" d=\"0\"/>{materials}</lane>"
        )
    };
    let text = format!(
        "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/><road id=\"0\" length=\"200\" junction=\"-1\"><planView>\
         <geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"200\"><line/></geometry></planView><lanes>\
         <laneSection s=\"0\"><left>{}</left><center><lane id=\"0\" type=\"none\"/></center><right>{}{}{}</right>\
         </laneSection></lanes></road></OpenDRIVE>",
        lane(1, "driving", &(material(0, "Asphalt") + &material(130, "RoadSurface_Gravel"))),
        lane(-1, "driving", &(material(37, "gravel") + &material(80, "cobblestone") + &material(150, "4711"))),
        lane(-2, "shoulder", &material(50, "grass")),
        lane(-3, "sidewalk", &material(0, "gravel")),
    );
    let map = bake("track", &text).unwrap();
    check_sound(&map);
    let kind = |x: f32, y: f32| map.ground(Vec3::new(x, y, 0.0)).unwrap().kind;
    use SurfaceKind::{Gravel, Road, Setts, Sidewalk, Terrain};
    let cases: [(f32, &[(f32, SurfaceKind)]); 4] = [
        (2.0, &[(1.0, Road), (129.5, Road), (130.5, Gravel), (199.0, Gravel)]),
        (
            -2.0,
            &[(1.0, Road), (36.5, Road), (37.5, Gravel), (79.5, Gravel), (80.5, Setts), (149.5, Setts), (151.0, Road)],
        ),
        (-6.0, &[(49.5, Road), (50.5, Terrain)]),
        (-10.0, &[(1.0, Sidewalk), (199.0, Sidewalk)]),
    ];
    for (y, places) in cases {
        for &(x, expected) in places {
            assert_eq!(kind(x, y), expected, "{x} {y}");
        }
    }
}
