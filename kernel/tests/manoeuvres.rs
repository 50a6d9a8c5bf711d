//! Vehicles change lanes, pass bicycles and whatever stands in their way, and flow as traffic does.
#![allow(clippy::disallowed_methods, reason = "tests may read files and the environment")]

#[path = "common/svg.rs"]
mod svg;

use std::f32::consts::PI;
use std::sync::Arc;

use glam::{Vec2, Vec3};
use kernel::events::EventKind;
use kernel::geometry::rectangles_overlap;
use kernel::map::bake;
use kernel::scene::ActorKind;
use kernel::time::{Tick, seconds};
use kernel::traffic::{Body, Manoeuvre, Obstacle, Surroundings, Traffic, TrafficCounts};
use kernel::weather::Conditions;
use kernel::{Controls, RoadNetwork};
use svg::{Area, Axis, Chart, agrees_with_plot, picture};

const LANE_M: f64 = 3.5;
const FAR: Vec3 = Vec3::new(1e5, 0.0, 0.0);

/// A road with so many lanes to the left (the other direction) and right, and its geometry.
fn road(left: i32, right: i32, length_m: f64, geometry: &str, link: &str) -> Arc<RoadNetwork> {
    let lane = |id: i32| {
        let next =
            if link.is_empty() { String::new() } else { format!("<predecessor id=\"{id}\"/><successor id=\"{id}\"/>") };
        format!(
            "<lane id=\"{id}\" type=\"driving\"><link>{next}</link>\
             <width sOffset=\"0\" a=\"{LANE_M}\" b=\"0\" c=\"0\" d=\"0\"/></lane>"
        )
    };
    let side = |name: &str, ids: Vec<i32>| {
        let lanes: String = ids.into_iter().map(lane).collect();
        if lanes.is_empty() { lanes } else { format!("<{name}>{lanes}</{name}>") }
    };
    let text = format!(
        "<?xml version=\"1.0\"?><OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>\
         <road id=\"0\" length=\"{length_m}\" junction=\"-1\">{link}<planView>\
         <geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"{length_m}\">{geometry}</geometry></planView>\
         <lanes><laneSection s=\"0\">{}<center><lane id=\"0\" type=\"none\"/></center>{}</laneSection></lanes>\
         </road></OpenDRIVE>",
        side("left", (1..=left).rev().collect()),
        side("right", (1..=right).map(|k| -k).collect()),
    );
    Arc::new(bake("road", &text).expect("it bakes"))
}

fn straight(left: i32, right: i32, length_m: f64) -> Arc<RoadNetwork> {
    road(left, right, length_m, "<line/>", "")
}

/// A ring on which traffic goes round for ever.
fn ring(lanes: i32, length_m: f64) -> Arc<RoadNetwork> {
    let link = "<link><predecessor elementType=\"road\" elementId=\"0\" contactPoint=\"end\"/>\
                <successor elementType=\"road\" elementId=\"0\" contactPoint=\"start\"/></link>";
    let geometry = format!("<arc curvature=\"{}\"/>", std::f64::consts::TAU / length_m);
    road(0, lanes, length_m, &geometry, link)
}

fn car_at(position: Vec3) -> Obstacle {
    Obstacle {
        id: 0,
        position,
        heading_rad: 0.0,
        velocity_mps: Vec3::ZERO,
        size_m: kernel::ego::SIZE_M,
        on_foot: false,
    }
}

fn drive(traffic: &mut Traffic, ego: Obstacle, ticks: Tick, mut each: impl FnMut(&Traffic, Tick)) {
    for tick in 1..=ticks {
        traffic.step(&Surroundings::calm(tick, ego));
        each(traffic, tick);
    }
}

/// From the middle of one to another in the axes of the first: ahead and to the left, metres.
fn seen_from(me: &Body, other: Vec3) -> Vec2 {
    let forward = (me.rotation * Vec3::X).truncate().normalize_or(Vec2::X);
    let to = (other - me.position).truncate();
    Vec2::new(to.dot(forward), forward.perp_dot(to))
}

/// Times that another vehicle came past a bicycle, and the least distance between their sides then, metres.
fn passes_of_bicycles(network: &Arc<RoadNetwork>, counts: TrafficCounts, seed: u64, minutes: u32) -> (usize, f32) {
    let mut traffic = Traffic::spawn(&counts, seed, network.ways(), FAR);
    let (mut passes, mut least_m) = (0, f32::MAX);
    let mut before: Vec<Vec<f32>> = Vec::new();
    drive(&mut traffic, car_at(FAR), seconds(60 * minutes), |traffic, _| {
        let bodies = traffic.bodies();
        let bicycles = bodies.iter().filter(|b| b.kind.is_pedalled());
        let now: Vec<Vec<f32>> = bicycles
            .map(|bicycle| {
                let ahead = |other: &Body| {
                    let at = seen_from(bicycle, other.position);
                    let half = (other.kind.size_m() + bicycle.kind.size_m()).truncate() * 0.5;
                    let along = (other.rotation * Vec3::X).dot(bicycle.rotation * Vec3::X) > 0.5;
                    if along && !other.kind.is_pedalled() && at.x.abs() < half.x && at.y.abs() < 6.0 {
                        least_m = least_m.min(at.y.abs() - half.y);
                    }
                    if along && at.y.abs() < 6.0 { at.x } else { f32::NAN }
                };
                bodies.iter().map(ahead).collect()
            })
            .collect();
        for (was, is) in before.iter().zip(&now) {
            passes += was.iter().zip(is).filter(|(was, is)| **was < 0.0 && **is >= 0.0 && **is - **was < 1.0).count();
        }
        before = now;
    });
    (passes, least_m)
}

#[test]
fn bicycles_are_passed_with_room_beside_the_oncoming_lane() {
    let counts = TrafficCounts { cars: 8, motorcycles: 1, bicycles: 2, ..TrafficCounts::NONE };
    let (mut passes, mut least_m) = (0, f32::MAX);
    for seed in 1..=4 {
        let (count, near_m) = passes_of_bicycles(&straight(1, 1, 1500.0), counts, seed, 10);
        (passes, least_m) = (passes + count, least_m.min(near_m));
    }
    println!("{passes} passes, at least {least_m} m");
    assert!(passes >= 40, "{passes} passes in 40 minutes");
    assert!(least_m >= 1.5, "{least_m} m between a bicycle and who passed it");
}

#[test]
fn bicycles_are_passed_on_the_lane_beside() {
    let counts = TrafficCounts { cars: 10, motorcycles: 1, bicycles: 2, ..TrafficCounts::NONE };
    let (passes, least_m) = passes_of_bicycles(&straight(0, 2, 1500.0), counts, 1, 10);
    println!("{passes} passes, at least {least_m} m");
    assert!(passes >= 20 && least_m >= 1.5, "{passes} passes at {least_m} m");
}

/// By how much a lone car falls back behind the ego car, which drives at its speed beside and ahead of it, in five
/// seconds, metres.
fn falls_back_m(seed: u64, indicates: bool) -> f32 {
    let network = straight(0, 2, 1500.0);
    let mut traffic = Traffic::spawn(&TrafficCounts { cars: 1, ..TrafficCounts::NONE }, seed, network.ways(), FAR);
    let place = |traffic: &Traffic| traffic.bodies()[0].position;
    let mut tick = 0;
    let mut step = |traffic: &mut Traffic, ego, ego_flags| {
        tick += 1;
        traffic.step(&Surroundings { ego_flags, ..Surroundings::calm(tick, ego) });
    };
    while traffic.bodies()[0].velocity_mps.x < 8.0 || place(&traffic).x > 1000.0 {
        step(&mut traffic, car_at(FAR), 0);
    }
    let on_left = place(&traffic).y > -LANE_M as f32;
    let (aside_m, flag) = if on_left { (-LANE_M, Controls::INDICATE_LEFT) } else { (LANE_M, Controls::INDICATE_RIGHT) };
    let velocity_mps = Vec3::X * traffic.bodies()[0].velocity_mps.x;
    let mut ego = Obstacle { velocity_mps, ..car_at(place(&traffic) + Vec3::new(8.0, aside_m as f32, 0.0)) };
    for _ in 0..seconds(5) {
        step(&mut traffic, ego, if indicates { flag } else { 0 });
        ego.position += velocity_mps / 60.0;
    }
    ego.position.x - place(&traffic).x - 8.0
}

#[test]
fn about_every_second_opens_a_gap_for_the_ego_car_that_indicates() {
    let mut courteous = 0;
    for seed in 0..60 {
        let (silent_m, asked_m) = (falls_back_m(seed, false), falls_back_m(seed, true));
        assert!(asked_m >= silent_m - 0.01, "{silent_m} {asked_m}");
        courteous += u32::from(asked_m > silent_m + 3.0);
    }
    println!("{courteous} of 60 open a gap");
    // Half of them, or a little more where a new one is drawn within these seconds; of 60 with 99.9 %.
    assert!((18..=53).contains(&courteous), "{courteous} of 60");
}

/// For each vehicle the seconds from when it came near a car that stands in its lane until it was past, s.
fn waits_behind(network: &Arc<RoadNetwork>, stands: Vec3, cars: u16, seed: u64) -> Vec<u64> {
    let counts = TrafficCounts { cars, ..TrafficCounts::NONE };
    let mut traffic = Traffic::spawn(&counts, seed, network.ways(), stands);
    let mut since = vec![None; usize::from(cars)];
    let mut waits = Vec::new();
    drive(&mut traffic, car_at(stands), seconds(600), |traffic, tick| {
        for (body, since) in traffic.bodies().iter().zip(&mut since) {
            let at = body.position - stands;
            let eastward = (body.rotation * Vec3::X).x > 0.5;
            let near = eastward && (-40.0..8.0).contains(&at.x);
            *since = match *since {
                None if near => Some(tick),
                Some(then) if !near => {
                    waits.push((tick - then) / 60);
                    None
                }
                same => same,
            };
        }
    });
    waits.extend(since.into_iter().flatten().map(|then| seconds(600) / 60 - then / 60));
    waits
}

#[test]
fn a_car_that_stands_is_passed_within_a_minute_where_the_other_lane_is_free() {
    let stands = Vec3::new(700.0, -1.75, 0.0);
    for (name, network, cars) in
        [("oncoming lane", straight(1, 1, 1500.0), 6), ("lane beside", straight(0, 2, 1500.0), 12)]
    {
        let waits: Vec<u64> = (1..=4).flat_map(|seed| waits_behind(&network, stands, cars, seed)).collect();
        let longest = waits.iter().max().copied().unwrap_or(u64::MAX);
        println!("{name}: {} came by, the longest in {longest} s", waits.len());
        assert!(waits.len() > 40, "{name}: {} came by", waits.len());
        assert!(longest <= 60, "{name}: somebody waited {longest} s");
    }
}

/// Lets somebody come the other way, who was not to be seen, when the first one that swings out has only `gap_m` left to
/// the one that it passes, as long as a bus, which nobody may touch. Whether one has swung out.
fn swings_past_untouched(network: &Arc<RoadNetwork>, stands: Vec3, gap_m: f32, seed: u64) -> bool {
    const COMES: Vec3 = Vec3::new(-8.0, 0.0, 0.0);
    let counts = TrafficCounts { cars: 6, ..TrafficCounts::NONE };
    let mut traffic = Traffic::spawn(&counts, seed, network.ways(), stands);
    let size_m = ActorKind::Bus.size_m();
    let half = 0.5 * size_m.truncate();
    let mut coming: Option<Obstacle> = None;
    let mut ends = seconds(300);
    for tick in 1..=seconds(300) {
        if tick > ends {
            break;
        }
        if let Some(obstacle) = &mut coming {
            obstacle.position += COMES / 60.0;
        }
        let conditions = Conditions::default();
        let ego = Obstacle { size_m, ..car_at(stands) };
        traffic.step(&Surroundings { loose: coming.as_slice(), conditions, ..Surroundings::calm(tick, ego) });
        for (vehicle, body) in traffic.state().vehicles.iter().zip(traffic.bodies()) {
            let (way, their_half) = ((body.position - stands).truncate(), 0.5 * body.kind.size_m().truncate());
            let axis = (body.rotation * Vec3::X).truncate();
            assert!(!rectangles_overlap(half, way, axis, their_half), "{gap_m} m, seed {seed}: touched by {vehicle:?}");
            let to_tail_m = -way.x - half.x - their_half.x;
            if coming.is_none() && vehicle.manoeuvre == Manoeuvre::PassLeft && (0.0..gap_m).contains(&to_tail_m) {
                let position = stands + Vec3::new(45.0, -2.0 * stands.y, 0.0);
                ends = tick + seconds(20);
                coming = Some(Obstacle { id: 60_000, heading_rad: PI, velocity_mps: COMES, ..car_at(position) });
            }
        }
    }
    coming.is_some()
}

#[test]
fn who_has_swung_out_too_far_to_stop_stays_off_whom_it_passes() {
    let stands = Vec3::new(700.0, -1.75, 0.0);
    let network = straight(1, 1, 1500.0);
    for gap_m in [1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0] {
        let out = (1..=20).filter(|seed| swings_past_untouched(&network, stands, gap_m, *seed)).count();
        assert!(out >= 10, "{gap_m} m: {out} of 20 swing out");
    }
}

/// Flow of a ring with so many vehicles: (density a lane, vehicles/km; flow a lane, vehicles/h; mean speed, m/s).
fn flow(cars: u16, seed: u64) -> (f64, f64, f64) {
    const LENGTH_M: f64 = 2000.0;
    let network = ring(2, LENGTH_M);
    let mut traffic = Traffic::spawn(&TrafficCounts { cars, ..TrafficCounts::NONE }, seed, network.ways(), FAR);
    assert_eq!(traffic.missing().total(), 0, "{cars} have room");
    let mut driven_m = 0.0;
    let (settle, ticks) = (seconds(180), seconds(600));
    drive(&mut traffic, car_at(FAR), ticks, |traffic, tick| {
        if tick > settle {
            driven_m += traffic.state().vehicles.iter().map(|v| f64::from(v.speed_mps)).sum::<f64>() / 60.0;
        }
    });
    let hours = (ticks - settle) as f64 / seconds(3600) as f64;
    let density = f64::from(cars) / 2.0 / (LENGTH_M / 1000.0);
    (density, driven_m / hours / LENGTH_M / 2.0, driven_m / hours / 3600.0 / f64::from(cars))
}

/// A circular road whose lanes are given as OpenDRIVE.
fn closed_road(name: &str, length_m: f64, lanes: &str) -> Arc<RoadNetwork> {
    let text = format!(
        "<?xml version=\"1.0\"?><OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>\
         <road id=\"0\" length=\"{length_m}\" junction=\"-1\"><link>\
         <predecessor elementType=\"road\" elementId=\"0\" contactPoint=\"end\"/>\
         <successor elementType=\"road\" elementId=\"0\" contactPoint=\"start\"/></link><planView>\
         <geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"{length_m}\"><arc curvature=\"{}\"/></geometry></planView>\
         <lanes>{lanes}</lanes></road></OpenDRIVE>",
        std::f64::consts::TAU / length_m
    );
    Arc::new(bake(name, &text).expect("it bakes"))
}

/// A ring of two lanes, one of which ends after 1.4 km, over 100 m, and begins anew 400 m farther on.
fn narrowing_ring() -> Arc<RoadNetwork> {
    let lane = |id: i32, links: [bool; 2], a: f64, b: f64| {
        let link = |tag: &str, there: bool| if there { format!("<{tag} id=\"{id}\"/>") } else { String::new() };
        format!(
            "<lane id=\"{id}\" type=\"driving\"><link>{}{}</link>\
             <width sOffset=\"0\" a=\"{a}\" b=\"{b}\" c=\"0\" d=\"0\"/></lane>",
            link("predecessor", links[0]),
            link("successor", links[1])
        )
    };
    let through = || lane(-1, [true, true], LANE_M, 0.0);
    let section = |s: f64, second: String| {
        let center = "<center><lane id=\"0\" type=\"none\"/></center>";
        format!("<laneSection s=\"{s}\">{center}<right>{}{second}</right></laneSection>", through())
    };
    let sections = [
        section(0.0, lane(-2, [true, true], LANE_M, 0.0)),
        section(1400.0, lane(-2, [true, false], LANE_M, -LANE_M / 100.0)),
        section(1500.0, String::new()),
        section(1900.0, lane(-2, [false, true], 0.0, LANE_M / 100.0)),
    ];
    closed_road("narrowing", 2000.0, &sections.concat())
}

#[test]
fn two_lanes_with_1200_vehicles_an_hour_merge_into_one() {
    let network = narrowing_ring();
    let counts = TrafficCounts { cars: 80, ..TrafficCounts::NONE };
    for seed in 9001..9004 {
        let mut traffic = Traffic::spawn(&counts, seed, network.ways(), FAR);
        let (mut passed, mut slowest_s) = (0, 0);
        let mut before: Vec<f32> = Vec::new();
        let mut stands_s = vec![0; 80];
        let (settle, ticks) = (seconds(300), seconds(900));
        // Where there is one lane only, told by the angle around the middle of the ring.
        let radius_m = 2000.0 / std::f32::consts::TAU;
        let gate_rad = 1700.0 / radius_m;
        let along = |body: &Body| {
            let from = (body.position.truncate() - Vec2::new(0.0, radius_m)).perp();
            (from.y.atan2(from.x)).rem_euclid(std::f32::consts::TAU)
        };
        drive(&mut traffic, car_at(FAR), ticks, |traffic, tick| {
            let now: Vec<f32> = traffic.bodies().iter().map(along).collect();
            if tick > settle {
                passed += before.iter().zip(&now).filter(|(was, is)| **was < gate_rad && **is >= gate_rad).count();
            }
            before = now;
            if tick.is_multiple_of(60) {
                for (vehicle, stands_s) in traffic.state().vehicles.iter().zip(&mut stands_s) {
                    *stands_s = if vehicle.speed_mps < 0.1 { *stands_s + 1 } else { 0 };
                    slowest_s = slowest_s.max(*stands_s);
                }
            }
        });
        let per_hour = passed as f64 / ((ticks - settle) as f64 / seconds(3600) as f64);
        println!("seed {seed}: {per_hour:.0} vehicles/h through one lane, nobody stands longer than {slowest_s} s");
        assert!(per_hour >= 1200.0, "seed {seed}: {per_hour} vehicles/h");
        assert!(slowest_s <= 20, "seed {seed}: somebody stood {slowest_s} s");
    }
}

/// A ring of 1 km with a lane each way and one between them that belongs to either direction by turns: both lose it at one
/// place, over 50 m, and get it back at another.
fn two_plus_one_ring() -> Arc<RoadNetwork> {
    let lane = |id: i32, [before, after]: [Option<i32>; 2], a: f64, b: f64| {
        let link = |tag: &str, to: Option<i32>| to.map_or(String::new(), |to| format!("<{tag} id=\"{to}\"/>"));
        let links = link("predecessor", before) + &link("successor", after);
        let width = format!("<width sOffset=\"0\" a=\"{a}\" b=\"{b}\" c=\"0\" d=\"0\"/>");
        format!("<lane id=\"{id}\" type=\"driving\"><link>{links}</link>{width}</lane>")
    };
    let (whole, slope) = (LANE_M, LANE_M / 50.0);
    let section = |s: f64, left: String, right: String| {
        let center = "<center><lane id=\"0\" type=\"none\"/></center>";
        format!("<laneSection s=\"{s}\"><left>{left}</left>{center}<right>{right}</right></laneSection>")
    };
    let both = |side: i32, inner: [Option<i32>; 2], outer: [Option<i32>; 2], a: f64, b: f64| {
        let lanes = [lane(side, inner, a, b), lane(2 * side, outer, whole, 0.0)];
        if side > 0 { lanes[1].clone() + &lanes[0] } else { lanes.concat() }
    };
    let sections = [
        section(
            0.0,
            lane(1, [Some(2), Some(2)], whole, 0.0),
            both(-1, [Some(-1), Some(-1)], [Some(-2), Some(-2)], whole, 0.0),
        ),
        section(
            450.0,
            both(1, [None, Some(1)], [Some(1), Some(2)], 0.0, slope),
            both(-1, [Some(-1), None], [Some(-2), Some(-1)], whole, -slope),
        ),
        section(
            500.0,
            both(1, [Some(1), Some(1)], [Some(2), Some(2)], whole, 0.0),
            lane(-1, [Some(-2), Some(-2)], whole, 0.0),
        ),
        section(
            950.0,
            both(1, [Some(1), None], [Some(2), Some(1)], whole, -slope),
            both(-1, [None, Some(-1)], [Some(-1), Some(-2)], 0.0, slope),
        ),
    ];
    let offsets = [(0.0, whole, 0.0), (450.0, whole, -slope), (500.0, 0.0, 0.0), (950.0, 0.0, slope)];
    let offsets: String = offsets
        .iter()
        .map(|(s, a, b)| format!("<laneOffset s=\"{s}\" a=\"{a}\" b=\"{b}\" c=\"0\" d=\"0\"/>"))
        .collect();
    closed_road("two_plus_one_ring", 1000.0, &(offsets + &sections.concat()))
}

#[test]
fn who_leaves_a_lane_that_ends_stays_off_the_oncoming_one() {
    let network = two_plus_one_ring();
    let counts = TrafficCounts { cars: 40, ..TrafficCounts::NONE };
    let mut farthest_m = f32::MIN;
    for seed in 9001..9007 {
        let mut traffic = Traffic::spawn(&counts, seed, network.ways(), FAR);
        drive(&mut traffic, car_at(FAR), seconds(600), |traffic, tick| {
            let dissolved = traffic.told().iter().filter(|(kind, _)| *kind == EventKind::Dissolved).count();
            assert_eq!(dissolved, 0, "seed {seed}, tick {tick}");
            for vehicle in &traffic.state().vehicles {
                let lane = &network.lanes[vehicle.lane as usize];
                let ends = lane.successors.is_empty() && lane.left.is_none() && lane.right.is_some();
                if ends && vehicle.manoeuvre == Manoeuvre::Keep {
                    let over_m = vehicle.offset_m + 0.5 * vehicle.kind.size_m().y - lane.at(vehicle.s_m).half_width_m;
                    farthest_m = farthest_m.max(over_m);
                }
            }
        });
    }
    println!("at most {farthest_m:.2} m over the border to the oncoming lane");
    assert!((-1.0..0.05).contains(&farthest_m), "{farthest_m} m over the border");
}

/// Flow over density as a picture.
fn plot(diagram: &[(f64, f64, f64)]) -> String {
    let density =
        Axis { label: "density, vehicles a km and lane", range: [0.0, 90.0], ticks: &[0.0, 20.0, 40.0, 60.0, 80.0] };
    let flow = Axis {
        label: "flow, vehicles an hour and lane (mean speed in km/h at the points)",
        range: [0.0, 2000.0],
        ticks: &[0.0, 500.0, 1000.0, 1500.0, 2000.0],
    };
    let mut chart = Chart::new(Area { left: 60.0, top: 35.0, right: 600.0, bottom: 275.0 }, &density, &flow);
    for &(density, flow, speed) in diagram {
        chart.dot(svg::BLUE, (density, flow));
        chart.beside((density, flow), [7.0, -6.0], svg::START, svg::BLACK, &format!("{:.0}", speed * 3.6));
    }
    picture([620, 325], &[chart])
}

#[test]
fn the_flow_of_a_lane_has_its_maximum_where_measured_ones_do() {
    let diagram: Vec<_> = [20, 60, 80, 100, 120, 140, 180, 240, 320].map(|cars| flow(cars, 1)).into();
    for (density, flow, speed) in &diagram {
        println!("{density:5.1} vehicles/km: {flow:6.0} vehicles/h at {:5.1} km/h", speed * 3.6);
    }
    agrees_with_plot("flow", &plot(&diagram));
    let most = diagram.iter().map(|point| point.1).fold(0.0, f64::max);
    assert!((1500.0..=2200.0).contains(&most), "at most {most} vehicles/h and lane");
    let (first, last) = (diagram[0], diagram[diagram.len() - 1]);
    assert!(last.1 < 0.9 * most, "dense traffic flows less");
    assert!(first.2 > last.2 * 2.0, "and slower");
}
