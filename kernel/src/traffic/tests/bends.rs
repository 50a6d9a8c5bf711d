//! Two long vehicles let each other through where a street is too narrow for both.

use super::standing::with_vehicles;
use super::*;
use crate::actor::ActorKind;

/// Drives two buses for a minute, one before a bend and one before the same on its side, so far from it, metres. How long
/// somebody stood, ticks.
fn meet(network: &Arc<RoadNetwork>, [a, b]: [(u32, f32); 2], speeds_mps: [f32; 2]) -> u32 {
    let bus = |id, (lane, s_m), speed_mps| {
        let flags = if s_m < 6.0 { Vehicle::CROSSING } else { 0 };
        Vehicle { id, kind: ActorKind::Bus, lane, before: lane, s_m, speed_mps, flags, ..Vehicle::standing() }
    };
    let mut traffic = with_vehicles(network, vec![bus(1, a, speeds_mps[0]), bus(2, b, speeds_mps[1])]);
    let mut stood = 0;
    for tick in 1..=MINUTE {
        let conditions = Conditions::default();
        traffic.step(&Surroundings { conditions, ..Surroundings::calm(tick, nowhere()) });
        let vehicles = &traffic.state().vehicles;
        assert_eq!(overlaps(&traffic), [], "{a:?} and {b:?}, tick {tick}: {vehicles:?}");
        stood += u32::from(vehicles.iter().any(|v| v.speed_mps == 0.0));
        assert!(vehicles.iter().all(|v| v.stuck_s < 30), "{a:?} and {b:?}, tick {tick}: {vehicles:?}");
    }
    stood
}

#[test]
fn long_vehicles_let_each_other_through_narrow_bends() {
    for name in ["old_town", "suburb"] {
        let network = bundled(name).expect("it is bundled");
        let (mut met, mut stood) = (0, 0);
        for lane in 0..network.lanes.len() as u32 {
            for (bend_m, there) in network.ways().lanes[lane as usize].bends.iter().map(|bend| bend.begins()) {
                let (other, other_m) = there;
                for (mine_m, theirs_m) in [(14.0, 14.0), (14.0, 20.0), (25.0, 16.0), (9.0, 12.0)] {
                    let places = [(lane, bend_m - mine_m), (other, other_m - theirs_m)];
                    if places.iter().all(|(_, s_m)| *s_m > 0.0) {
                        met += 1;
                        stood += u32::from(meet(&network, places, [5.0; 2]) > 0);
                    }
                }
            }
        }
        assert!(met > 4 && stood > 0, "{name}: {met} met, {stood} times somebody stood");
    }
}

/// Who waits a little nearer to a bend than it should leaves less room: the other comes by slowly.
#[test]
fn who_waits_right_before_a_bend_lets_the_other_out() {
    for name in ["old_town", "suburb"] {
        let network = bundled(name).expect("it is bundled");
        for lane in 0..network.lanes.len() as u32 {
            for (bend_m, (other, other_m)) in network.ways().lanes[lane as usize].bends.iter().map(|bend| bend.begins())
            {
                for waits_m in [0.3, 0.75] {
                    meet(&network, [(lane, bend_m - waits_m), (other, other_m + 2.0)], [0.0, 5.0]);
                }
            }
        }
    }
}

/// A road of 100 m into a junction that leads straight on, and right behind it a narrow bend to the left, then 100 m more.
fn bend_behind_a_junction() -> Arc<RoadNetwork> {
    let lane = |id: i32| {
        format!(
            "<lane id=\"{id}\" type=\"driving\"><link><predecessor id=\"{id}\"/><successor id=\"{id}\"/></link>\
             <width sOffset=\"0\" a=\"2.85\" b=\"0\" c=\"0\" d=\"0\"/></lane>"
        )
    };
    let road = |id: u32, length_m: f64, junction: i32, link: &str, geometry: &str| {
        format!(
            "<road id=\"{id}\" length=\"{length_m}\" junction=\"{junction}\"><link>{link}</link><planView>{geometry}</planView>\
             <lanes><laneSection s=\"0\"><left>{}</left><center><lane id=\"0\" type=\"none\"/></center><right>{}</right>\
             </laneSection></lanes></road>",
            lane(1),
            lane(-1)
        )
    };
    let line = |s: f64, [x, y]: [f64; 2], heading: f64, length: f64| {
        format!("<geometry s=\"{s}\" x=\"{x}\" y=\"{y}\" hdg=\"{heading}\" length=\"{length}\"><line/></geometry>")
    };
    let (radius_m, quarter_m) = (12.0, 12.0 * std::f64::consts::FRAC_PI_2);
    let arc = format!(
        "<geometry s=\"0\" x=\"112\" y=\"0\" hdg=\"0\" length=\"{quarter_m}\"><arc curvature=\"{}\"/></geometry>",
        1.0 / radius_m
    );
    let beyond = line(quarter_m, [112.0 + radius_m, radius_m], std::f64::consts::FRAC_PI_2, 100.0);
    let joint = |end: &str, kind: &str, id: u32, at: &str| {
        let at = if at.is_empty() { String::new() } else { format!(" contactPoint=\"{at}\"") };
        format!("<{end} elementType=\"{kind}\" elementId=\"{id}\"{at}/>")
    };
    let connects = |id: u32, from: u32, at: &str, lane: i32| {
        format!(
            "<connection id=\"{id}\" incomingRoad=\"{from}\" connectingRoad=\"2\" contactPoint=\"{at}\">\
             <laneLink from=\"{lane}\" to=\"{lane}\"/></connection>"
        )
    };
    let text = format!(
        "<?xml version=\"1.0\"?><OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>{}{}{}\
         <junction id=\"9\" name=\"\">{}{}</junction></OpenDRIVE>",
        road(0, 100.0, -1, &joint("successor", "junction", 9, ""), &line(0.0, [0.0, 0.0], 0.0, 100.0)),
        road(
            2,
            12.0,
            9,
            &(joint("predecessor", "road", 0, "end") + &joint("successor", "road", 1, "start")),
            &line(0.0, [100.0, 0.0], 0.0, 12.0)
        ),
        road(1, quarter_m + 100.0, -1, &joint("predecessor", "junction", 9, ""), &(arc + &beyond)),
        connects(0, 0, "start", -1),
        connects(1, 1, "end", 1),
    );
    Arc::new(crate::map::bake("bend", &text).expect("it bakes"))
}

#[test]
fn who_could_not_wait_between_a_junction_and_a_bend_waits_before_the_junction() {
    let network = bend_behind_a_junction();
    let [out, back] = ["0/", "1/"].map(|road| {
        let leads_in = |lane: &crate::map::Lane| lane.name.starts_with(road) && !lane.successors.is_empty();
        network.lanes.iter().position(leads_in).expect("one leads to the junction") as u32
    });
    let ends_m = network.lanes[back as usize].length_m;
    let mut stood = 0;
    for out_m in [10.0, 30.0, 50.0, 70.0, 85.0] {
        for back_m in [8.0, 25.0, 45.0, 60.0, 75.0, ends_m - 8.0] {
            stood += u32::from(meet(&network, [(out, out_m), (back, back_m)], [6.0; 2]) > 60);
        }
    }
    assert!(stood > 5, "{stood}");
}

/// Where there is room for both nobody waits.
#[test]
fn wide_streets_have_no_bends_to_wait_at() {
    for name in ["city", "motorway"] {
        let network = bundled(name).expect("it is bundled");
        assert!(network.ways().lanes.iter().all(|lane| lane.bends.is_empty()), "{name}");
    }
}
