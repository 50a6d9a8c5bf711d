//! Bridges, tunnels, water, rails and things by the road, as any file tells of them.

use proptest::prelude::*;

use super::broken::straight;
use super::*;

fn baked(text: &str) -> RoadNetwork {
    let map = bake("structures", text).expect("a map");
    map.surfaces.iter().for_each(check_surface);
    map
}

fn of(map: &RoadNetwork, kind: PropKind) -> Vec<&Prop> {
    map.props.iter().filter(|p| p.kind == kind).collect()
}

/// A road of 200 m that rises `grade` along x, with these objects.
fn rising(grade: f64, objects: &str) -> String {
    let profile = format!(
        "</planView><elevationProfile><elevation s=\"0\" a=\"0\" b=\"{grade}\" c=\"0\" d=\"0\"/></elevationProfile>"
    );
    straight("200", "3.5", &format!("<objects>{objects}</objects>")).replace("</planView>", &profile)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// A bridge is as long as its file says, its deck below its lanes and its parapets beside them, and land below all of it.
    #[test]
    fn a_bridge_carries_its_lanes(s in 5f64..80.0, length in 10f64..100.0, grade in -0.1f64..0.1) {
        let bridge = format!("<bridge id=\"1\" s=\"{s}\" length=\"{length}\" type=\"concrete\"/>");
        let map = baked(&rising(grade, &bridge));
        let pieces = of(&map, PropKind::Bridge);
        let (decks, rest): (Vec<&Prop>, Vec<&Prop>) = pieces.into_iter().partition(|p| p.size.y > 3.5);
        let covered: f32 = decks.iter().map(|p| p.size.x - 0.1).sum();
        prop_assert!((covered - length as f32).abs() < 0.5, "{} of {} m", covered, length);
        let road_m = |p: &Prop| grade as f32 * p.position.x;
        prop_assert!(decks.iter().all(|p| (p.position.z + p.size.z - road_m(p) + 0.1).abs() < 0.01));
        prop_assert!(decks.iter().all(|p| (p.rise_m() - grade as f32 * p.size.x).abs() < 0.01));
        let (parapets, piers): (Vec<&Prop>, Vec<&Prop>) = rest.into_iter().partition(|p| p.size.y < 0.5);
        prop_assert_eq!(parapets.len(), 2 * decks.len());
        prop_assert!(parapets.iter().all(|p| !map.on_road(p.position) && p.position.z + p.size.z > road_m(p) + 0.9));
        let x = |p: &Prop| f64::from(p.position.x);
        prop_assert!(parapets.iter().chain(&piers).all(|p| x(p) > s - 2.0 && x(p) < s + length + 2.0));
        let land = map.surfaces.iter().find(|s| s.kind == SurfaceKind::Terrain).expect("land");
        let under = land.positions.iter().filter(|p| f64::from(p.x) > s && f64::from(p.x) < s + length && (p.y + 1.75).abs() < 3.0);
        let below = |p: &Vec3| p.z < grade as f32 * p.x - 1.2;
        prop_assert!(under.clone().all(below));
    }
}

#[test]
fn a_tunnel_has_two_walls_and_a_roof_over_its_lanes() {
    let map = baked(&rising(0.0, "<tunnel id=\"1\" s=\"50\" length=\"80\" type=\"standard\"/>"));
    let pieces = of(&map, PropKind::Tunnel);
    let (roof, walls): (Vec<&Prop>, Vec<&Prop>) = pieces.into_iter().partition(|p| p.position.z > 1.0);
    assert_eq!((roof.len(), walls.len()), (21, 42));
    assert!(roof.iter().all(|p| p.position.z > 5.0 && p.size.y > 3.5 && (49.0..131.0).contains(&p.position.x)));
    assert!(walls.iter().all(|p| !map.on_road(p.position) && p.position.z + p.size.z > 5.0));
}

#[test]
fn a_bridge_over_a_road_has_piers_beside_it_only() {
    let lane = "<lane id=\"-1\" type=\"driving\"><width sOffset=\"0\" a=\"4\" b=\"0\" c=\"0\" d=\"0\"/></lane>";
    let road = |id: u32, at: &str, more: &str| {
        format!(
            "<road id=\"{id}\" length=\"200\" junction=\"-1\"><planView><geometry s=\"0\" {at} length=\"200\"><line/>\
             </geometry></planView>{more}<lanes><laneSection s=\"0\"><center><lane id=\"0\" type=\"none\"/></center>\
             <right>{lane}</right></laneSection></lanes>"
        )
    };
    let high = "<elevationProfile><elevation s=\"0\" a=\"7\" b=\"0\" c=\"0\" d=\"0\"/></elevationProfile>";
    let bridge = "<objects><bridge id=\"1\" s=\"20\" length=\"160\" type=\"steel\"/></objects></road>";
    let above = road(1, "x=\"0\" y=\"0\" hdg=\"0\"", high) + bridge;
    let below = road(2, "x=\"100\" y=\"-100\" hdg=\"1.570796326794897\"", "") + "</road>";
    let map = baked(&format!("<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>{above}{below}</OpenDRIVE>"));
    let piers: Vec<_> = of(&map, PropKind::Bridge).into_iter().filter(|p| p.size.z > 3.0).collect();
    assert!((3..9).contains(&piers.len()), "{}", piers.len());
    assert!(piers.iter().all(|p| !map.places().roads().is_near(p.position, 0.5)), "{piers:?}");
    let ground = map.ground(Vec3::new(102.0, -2.0, 0.5)).expect("the road below");
    assert!(ground.kind == SurfaceKind::Road && ground.height_m.abs() < 0.01);
}

#[test]
fn a_lake_is_flat_and_lies_in_the_land() {
    let corner = |u: f64, v: f64, dz: f64| format!("<cornerLocal u=\"{u}\" v=\"{v}\" z=\"{dz}\" height=\"0\"/>");
    // An L, whose inner corner is not water.
    let corners = [(0.0, 0.0), (40.0, 0.0), (40.0, 15.0), (15.0, 15.0), (15.0, 40.0), (0.0, 40.0)];
    let corners: String = corners.iter().map(|&(u, v)| corner(u, v, if u > 20.0 { -1.0 } else { -1.5 })).collect();
    let lake = format!(
        "<object id=\"1\" type=\"none\" name=\"water\" s=\"60\" t=\"10\" zOffset=\"0\" hdg=\"0\"><outlines>\
         <outline id=\"0\" closed=\"true\">{corners}</outline></outlines></object>"
    );
    let map = baked(&rising(0.0, &lake));
    let at = |x: f32, y: f32| map.ground(Vec3::new(x, y, 0.0)).expect("ground");
    for (x, y) in [(65.0, 15.0), (95.0, 20.0), (70.0, 45.0)] {
        let ground = at(x, y);
        assert_eq!((ground.kind, ground.height_m), (SurfaceKind::Water, -1.5), "{x} {y}");
    }
    assert!(at(90.0, 40.0).kind == SurfaceKind::Terrain && at(50.0, 20.0).kind == SurfaceKind::Terrain);
    assert!(!map.on_road(Vec3::new(65.0, 15.0, 0.0)));
}

#[test]
fn rails_lie_on_the_bed_of_their_lane_and_on_the_road_that_crosses() {
    let lane = |kind: &str| {
        format!("<lane id=\"-1\" type=\"{kind}\"><width sOffset=\"0\" a=\"3\" b=\"0\" c=\"0\" d=\"0\"/></lane>")
    };
    let text = straight("200", "3.5", "").replace("</OpenDRIVE>", "");
    let text = format!(
        "{text}<road id=\"2\" length=\"100\" junction=\"-1\"><planView><geometry s=\"0\" x=\"100\" y=\"-50\" \
         hdg=\"1.570796326794897\" length=\"100\"><line/></geometry></planView><lanes><laneSection s=\"0\"><center>\
         <lane id=\"0\" type=\"none\"/></center><right>{}</right></laneSection></lanes></road></OpenDRIVE>",
        lane("rail")
    );
    let map = baked(&text);
    let kind = |x: f32, y: f32| map.ground(Vec3::new(x, y, 0.0)).expect("ground").kind;
    assert_eq!(
        (kind(101.5, -20.0), kind(101.5, -1.7), kind(50.0, -1.7)),
        (SurfaceKind::Track, SurfaceKind::Road, SurfaceKind::Road)
    );
    let rails = map.surfaces.iter().find(|s| s.kind == SurfaceKind::Rail).expect("rails");
    assert!(rails.positions.iter().all(|p| (0.0..0.05).contains(&p.z) && ((p.x - 101.5).abs() - 0.75).abs() < 0.1));
}

#[test]
fn things_are_told_by_their_names() {
    let object = |k: usize, (kind, name): (&str, &str)| {
        format!(
            "<object id=\"{k}\" type=\"{kind}\" name=\"{name}\" s=\"{}\" t=\"-9\" zOffset=\"0\" hdg=\"0\" length=\"1\" \
             width=\"1\" height=\"1\"/>",
            10 * (k + 1)
        )
    };
    use PropKind::{Furniture, GuardRail, Lamp, Movable, Sundry, Tree, Wall};
    let told = [
        (("none", "rubbishBin_3"), Movable),
        (("obstacle", "TrafficCone"), Movable),
        (("barrier", "barricade"), Movable),
        (("barrier", "guardRail"), GuardRail),
        (("obstacle", "cabinet"), Furniture),
        (("obstacle", "marketStall"), Sundry),
        (("-1", "PostBox"), Sundry),
        (("pole", "post"), Furniture),
        (("none", "cityWall"), Wall),
        (("none", "streetLamp"), Lamp),
        (("none", "street bench"), Furniture),
        (("none", "street tree 7"), Tree),
    ];
    let objects: String = told.iter().enumerate().map(|(k, (what, _))| object(k, *what)).collect();
    let map = baked(&rising(0.0, &objects));
    for (k, (what, kind)) in told.into_iter().enumerate() {
        let x = 10.0 * (k + 1) as f32;
        let found: Vec<_> = map.props.iter().filter(|p| (p.position.x - x).abs() < 0.1).map(|p| p.kind).collect();
        assert!(found.contains(&kind), "{what:?}: {found:?}");
    }
    let bench = map.props.iter().find(|p| (p.position.x - 110.0).abs() < 0.1 && p.kind == Furniture).unwrap();
    assert_eq!(bench.furniture(), Some(FurnitureKind::Bench));
    let sign = baked(&rising(0.0, &object(0, ("none", "street sign"))));
    assert!(sign.props.iter().all(|p| p.position.truncate().distance(glam::Vec2::new(10.0, -9.0)) > 0.1));
}

#[test]
fn furniture_is_what_its_name_says_and_else_what_its_size_does() {
    use FurnitureKind as F;
    /// Type, name and size of an object, metres.
    type Named = (&'static str, &'static str, [f64; 3]);
    let told: [(Named, F); 23] = [
        (("obstacle", "bench", [1.6, 0.6, 0.9]), F::Bench),
        (("obstacle", "StreetBench_2", [1.0, 1.0, 1.0]), F::Bench),
        (("none", "rubbishBin_3", [1.6, 0.6, 0.9]), F::Bin),
        (("obstacle", "trash can", [0.3, 0.3, 1.0]), F::Bin),
        (("none", "switch cabinet", [1.6, 0.6, 0.9]), F::Cabinet),
        (("pole", "Bollard", [0.2, 0.2, 0.9]), F::Post),
        (("pole", "", [0.4, 0.4, 0.5]), F::Post),
        (("obstacle", "crossingPost", [1.0, 1.0, 1.0]), F::Post),
        (("obstacle", "fire_hydrant", [0.3, 0.3, 0.9]), F::Hydrant),
        (("-1", "PostBox", [0.5, 0.5, 1.3]), F::Mailbox),
        (("obstacle", "mail box", [0.5, 0.5, 1.3]), F::Mailbox),
        (("none", "busShelter", [3.6, 1.4, 2.5]), F::Shelter),
        (("none", "bus_stop", [3.6, 1.4, 2.5]), F::Shelter),
        (("none", "dumpster", [1.8, 1.2, 1.3]), F::Dumpster),
        (("obstacle", "planter", [1.6, 0.6, 0.9]), F::Planter),
        (("obstacle", "bike-rack", [1.6, 0.6, 0.9]), F::BicycleStand),
        (("obstacle", "TrafficCone", [0.4, 0.4, 0.7]), F::Cone),
        (("obstacle", "marketStall", [3.0, 2.0, 2.3]), F::Stall),
        (("obstacle", "thing", [1.7, 0.5, 0.8]), F::Bench),
        (("obstacle", "thing", [0.8, 0.4, 1.2]), F::Cabinet),
        (("obstacle", "thing", [0.2, 0.2, 1.0]), F::Post),
        (("obstacle", "thing", [3.0, 3.0, 1.0]), F::Other),
        (("none", "statue", [1.0, 1.0, 2.0]), F::Other),
    ];
    let object = |(k, ((kind, name, [x, y, z]), _)): (usize, &(Named, F))| {
        format!(
            "<object id=\"{k}\" type=\"{kind}\" name=\"{name}\" s=\"{}\" t=\"-9\" zOffset=\"0\" hdg=\"0\" length=\"{x}\" \
             width=\"{y}\" height=\"{z}\"/>",
            8 * (k + 1)
        )
    };
    let map = baked(&rising(0.0, &told.iter().enumerate().map(object).collect::<String>()));
    for (k, (what, kind)) in told.into_iter().enumerate() {
        let near = |p: &&Prop| (p.position.x - 8.0 * (k + 1) as f32).abs() < 0.1 && (p.position.y + 9.0).abs() < 0.1;
        let found: Vec<_> = map.props.iter().filter(near).map(Prop::furniture).collect();
        assert_eq!(found, [Some(kind)], "{what:?}");
    }
}

#[test]
fn the_benches_that_dress_a_street_look_at_it() {
    let map = bundled("city").unwrap();
    let furniture = of(&map, PropKind::Furniture);
    assert!(furniture.len() > 10);
    for bench in furniture {
        assert_eq!(bench.furniture(), Some(FurnitureKind::Bench));
        let street = map.places().roads().nearest(bench.position, LaneKind::Sidewalk, None, 10.0).expect("a sidewalk");
        let there = map.lane_point(street.lane, street.s_m).position;
        let back = direction(bench.heading_rad).perp();
        assert!(back.dot((there - bench.position).truncate()) < 0.0, "{bench:?}");
    }
}

#[test]
fn bridges_without_number_or_end_are_refused_or_left_out() {
    let many: String =
        (0..30_000).map(|k| format!("<bridge id=\"{k}\" s=\"0\" length=\"1e6\" type=\"steel\"/>")).collect();
    let refused = bake("many", &rising(0.0, &many)).expect_err("too many").to_string();
    assert!(refused.contains("expected at most"), "{refused}");
    let odd = "<bridge id=\"1\" s=\"900\" length=\"5\"/><tunnel id=\"2\" s=\"20\" length=\"0\"/><bridge id=\"3\" s=\"NaN\" length=\"9\"/>";
    if let Ok(map) = bake("odd", &rising(0.0, odd)) {
        assert!(map.props.iter().all(|p| !matches!(p.kind, PropKind::Bridge | PropKind::Tunnel)));
    }
}
