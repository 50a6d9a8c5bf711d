//! Who has the road to himself drives as fast as the model of free driving says, computed here independently.

use std::sync::Arc;

use super::{MINUTE, nowhere};
use crate::map::{RoadNetwork, bake};
use crate::time::Tick;
use crate::traffic::traits::driver;
use crate::traffic::{Population, Surroundings, Traffic, TrafficCounts};

const LENGTH_M: f64 = 4000.0;
const LIMIT_KMH: f64 = 100.0;

/// A one-way ring of one lane with a limit.
fn ring() -> Arc<RoadNetwork> {
    let text = format!(
        "<?xml version=\"1.0\"?><OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>\
         <road id=\"0\" length=\"{LENGTH_M}\" junction=\"-1\"><link>\
         <predecessor elementType=\"road\" elementId=\"0\" contactPoint=\"end\"/>\
         <successor elementType=\"road\" elementId=\"0\" contactPoint=\"start\"/></link>\
         <type s=\"0\" type=\"rural\"><speed max=\"{LIMIT_KMH}\" unit=\"km/h\"/></type><planView>\
         <geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"{LENGTH_M}\"><arc curvature=\"{}\"/></geometry></planView>\
         <lanes><laneSection s=\"0\"><center><lane id=\"0\" type=\"none\"/></center><right><lane id=\"-1\" \
         type=\"driving\"><link><predecessor id=\"-1\"/><successor id=\"-1\"/></link>\
         <width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane></right></laneSection></lanes></road>\
         </OpenDRIVE>",
        std::f64::consts::TAU / LENGTH_M
    );
    Arc::new(bake("ring", &text).expect("it bakes"))
}

/// Metres that free driving of the intelligent driver model covers from a speed on, in f64 at a tenth of a tick.
fn expected_m(from_mps: f32, wanted_mps: f32, accel_mps2: f32, ticks: Tick) -> f64 {
    let (mut v, wanted, accel) = (f64::from(from_mps), f64::from(wanted_mps), f64::from(accel_mps2));
    let (mut at_m, dt) = (0.0, 1.0 / 600.0);
    for _ in 0..ticks * 10 {
        let squared = (v / wanted) * (v / wanted);
        v += accel * (1.0 - squared * squared) * dt;
        at_m += v * dt;
    }
    at_m
}

#[test]
fn a_free_road_is_driven_as_the_model_says() {
    let network = ring();
    let kinds = [(1, 0, 0), (0, 1, 0), (0, 0, 1)];
    for (seed, (cars, motorcycles, bicycles)) in (9001..9021).flat_map(|seed| kinds.map(|kind| (seed, kind))) {
        let drivers = Population::USUAL;
        let counts = TrafficCounts { cars, motorcycles, bicycles, pedestrians: 0, jaywalks_per_min: 0.0, drivers };
        let mut traffic = Traffic::spawn(&counts, seed, network.ways(), nowhere().position);
        let Some(&start) = traffic.state().vehicles.first() else { panic!("one finds room") };
        let person = driver(&drivers, seed, start.id, start.kind);
        let limit_mps = (LIMIT_KMH / 3.6) as f32 * person.limit_share;
        let ticks = 3 * MINUTE;
        let mut driven_m = 0.0;
        for tick in 1..=ticks {
            traffic.step(&Surroundings::calm(tick, nowhere()));
            driven_m += f64::from(traffic.state().vehicles[0].speed_mps) / 60.0;
        }
        let expected_m = expected_m(start.speed_mps, limit_mps.min(person.top_mps), person.accel_mps2, ticks);
        let ratio = driven_m / expected_m;
        assert!((0.9..=1.1).contains(&ratio), "seed {seed}, {:?}: {ratio} of what the model says", start.kind);
    }
}
