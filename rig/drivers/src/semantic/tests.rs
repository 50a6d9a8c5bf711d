//! Closed loops on painted roads: no renderer, no world.

use std::collections::VecDeque;

use kernel::ego;
use kernel::map::Turn;
use kernel::signals::LightPhase;
use kernel::{Controls, ops};
use render::{Camera, SemanticTag};

use super::pedals::{DOWN_RAD_PER_MPS2, FULL_BRAKE_MPS2, FULL_THROTTLE_MPS2};
use super::*;
use crate::MaskView;
use crate::readout::Readout;

const WIDTH: usize = 256;
const HEIGHT: usize = 128;

/// A two-lane road bent to the left with this curvature; the car belongs in the right lane.
struct Road {
    curvature: f32,
}

/// Pose of the rear axle.
#[derive(Clone, Copy)]
struct Pose {
    x: f32,
    y: f32,
    heading: f32,
}

impl Road {
    /// Metres to the left of the middle of the right lane.
    fn offset_m(&self, x: f32, y: f32) -> f32 {
        let radius = 1.0 / self.curvature;
        if self.curvature == 0.0 { y } else { radius - radius.signum() * ops::hypot(x, y - radius) }
    }

    fn tag(&self, x: f32, y: f32) -> SemanticTag {
        match self.offset_m(x, y) {
            o if (o - 1.75).abs() < 0.08 => SemanticTag::RoadLine,
            o if (-1.75..5.25).contains(&o) => SemanticTag::Road,
            _ => SemanticTag::SideWalk,
        }
    }

    fn mask(&self, pose: Pose) -> Vec<u8> {
        self.mask_from(pose, 0.0)
    }

    /// The mask of a camera that looks down by an angle.
    fn mask_from(&self, pose: Pose, down_rad: f32) -> Vec<u8> {
        let mut ids = vec![SemanticTag::Sky as u8; WIDTH * HEIGHT];
        let camera = Camera::driver(WIDTH as u32, HEIGHT as u32);
        let focal = 0.5 * WIDTH as f32 / ops::tan(0.5 * camera.fov_x_rad);
        let horizon = 0.5 * HEIGHT as f32 - focal * down_rad;
        for row in (horizon - 0.5).ceil() as usize..HEIGHT {
            for column in 0..WIDTH {
                let ahead = focal * camera.position.z / (row as f32 + 0.5 - horizon).max(1e-3);
                let left = (0.5 * WIDTH as f32 - column as f32 - 0.5) * ahead / focal;
                let (x, y) = pose.place(camera.position.x + ahead, left);
                ids[row * WIDTH + column] = self.tag(x, y) as u8;
            }
        }
        ids
    }

    /// The arrow of the HUD: bearing of the lane 12 m ahead in steps of 5 degrees.
    fn bearing_deg(&self, pose: Pose) -> i16 {
        let middle = pose.place(ego::CENTRE_M.x, 0.0);
        let travelled = if self.curvature == 0.0 {
            middle.0
        } else {
            ops::atan2(middle.0 * self.curvature, 1.0 - middle.1 * self.curvature) / self.curvature
        };
        let (x, y, _) = Arc { curvature: self.curvature }.at(travelled + path::ARROW_M);
        let bearing = ops::wrap_angle(ops::atan2(y - middle.1, x - middle.0) - pose.heading).to_degrees();
        -(5.0 * (bearing / 5.0).round()) as i16
    }
}

impl Pose {
    fn place(&self, forward: f32, left: f32) -> (f32, f32) {
        let (sin, cos) = (ops::sin(self.heading), ops::cos(self.heading));
        (self.x + forward * cos - left * sin, self.y + forward * sin + left * cos)
    }

    fn drive(&mut self, controls: Controls, speed_mps: f32) {
        let wheel = -controls.steer_fraction() * ego::MAX_WHEEL_ANGLE_RAD;
        self.heading += speed_mps * TICK_S * ops::tan(wheel) / ego::WHEELBASE_M;
        (self.x, self.y) = self.place(speed_mps * TICK_S, 0.0);
    }
}

fn hud(speed_mps: f32, bearing_deg: i16) -> Readout {
    let speed_kmh = (3.6 * speed_mps).round() as u16;
    let (light, light_m) = (None, 0);
    Readout { speed_kmh, limit_kmh: 50, light, light_m, turn: Turn::Straight, junction_m: Some(100), bearing_deg }
}

/// What an attentive driver does after a second in front of an unchanged screen.
fn controls(ids: &[u8], hud: Readout) -> Controls {
    let view = SemanticView { mask: MaskView { width: WIDTH, height: HEIGHT, ids }, hud };
    let mut bot = SemanticBot::default();
    (0..60).map(|_| bot.controls(&view)).last().expect("60 ticks")
}

/// Largest offset from the lane's middle in the last 10 of 15 s.
fn worst_offset_m(road: &Road, start_left_m: f32, speed_mps: f32) -> f32 {
    let mut pose = Pose { x: 0.0, y: start_left_m, heading: 0.0 };
    let mut bot = SemanticBot::default();
    let mut worst: f32 = 0.0;
    let mut ids = Vec::new();
    for tick in 0..900 {
        if tick % 6 == 0 {
            ids = road.mask(pose);
        }
        let mask = MaskView { width: WIDTH, height: HEIGHT, ids: &ids };
        let controls = bot.controls(&SemanticView { mask, hud: hud(speed_mps, road.bearing_deg(pose)) });
        pose.drive(controls, speed_mps);
        if tick >= 300 {
            worst = worst.max(road.offset_m(pose.x, pose.y).abs());
        }
    }
    worst
}

#[test]
fn it_keeps_its_lane_on_straights_and_bends() {
    for (curvature, speed_mps) in [(0.0, 13.0), (0.01, 12.0), (-0.01, 12.0), (0.03, 8.0), (-0.03, 8.0), (0.06, 5.5)] {
        let worst = worst_offset_m(&Road { curvature }, 0.6, speed_mps);
        assert!(worst < 0.5, "curvature {curvature}: {worst} m off the middle of the lane");
    }
    for curvature in [0.0, 0.002, -0.002] {
        let worst = worst_offset_m(&Road { curvature }, 0.6, 80.0 / 3.6);
        assert!(worst < 0.6, "curvature {curvature}: {worst} m off the middle of the lane at 80 km/h");
    }
}

#[test]
fn it_drives_on_a_free_road_and_stops_at_red() {
    let ids = Road { curvature: 0.0 }.mask(Pose { x: 0.0, y: 0.0, heading: 0.0 });
    let free = controls(&ids, hud(8.0, 0));
    assert!(free.throttle > 0 && free.brake == 0, "{free:?}");
    let red = Readout { light: Some(LightPhase::Red), light_m: 10, ..hud(8.0, 0) };
    let red = controls(&ids, red);
    assert!(red.brake > 10_000 && red.throttle == 0, "{red:?}");
}

#[test]
fn it_brakes_for_a_person_but_not_for_specks() {
    let road = Road { curvature: 0.0 };
    let free = road.mask(Pose { x: 0.0, y: 0.0, heading: 0.0 });
    let with_person = |columns: std::ops::Range<usize>, rows: std::ops::Range<usize>| {
        let mut ids = free.clone();
        for row in rows {
            ids[row * WIDTH + columns.start..row * WIDTH + columns.end].fill(SemanticTag::Pedestrian as u8);
        }
        controls(&ids, hud(8.0, 0))
    };
    // 12.8 m in front of the camera a person is 17 pixels high and 5 wide.
    assert!(with_person(126..131, 62..79).brake > 0);
    assert_eq!(with_person(126..131, 76..79).brake, 0, "too low for a person");
    assert_eq!(with_person(126..127, 62..79).brake, 0, "a single column");
    assert_eq!(with_person(190..195, 62..79).brake, 0, "on the far side");
}

/// The rear of a car that stands on a straight road, 1.8 m wide and 1.5 m high, in the picture of a camera that looks down
/// by an angle.
fn queue_ahead(gap_m: f32, down_rad: f32) -> Vec<u8> {
    rear_ahead(gap_m, [-0.9, 0.9], down_rad)
}

/// The same from one place to another, metres to the left.
fn rear_ahead(gap_m: f32, across_m: [f32; 2], down_rad: f32) -> Vec<u8> {
    let mut ids = Road { curvature: 0.0 }.mask_from(Pose { x: 0.0, y: 0.0, heading: 0.0 }, down_rad);
    let camera = Camera::driver(WIDTH as u32, HEIGHT as u32);
    let focal = 0.5 * WIDTH as f32 / ops::tan(0.5 * camera.fov_x_rad);
    let ahead_m = ego::FRONT_M + gap_m - camera.position.x;
    let row = |height_m: f32| 0.5 * HEIGHT as f32 + focal * ((camera.position.z - height_m) / ahead_m - down_rad);
    let column = |left_m: f32| (0.5 * WIDTH as f32 - focal * left_m / ahead_m).clamp(0.0, WIDTH as f32) as usize;
    let [right, left] = across_m.map(column);
    for row in row(1.5).round() as usize..(row(0.0).round() as usize).min(HEIGHT) {
        ids[row * WIDTH + left..row * WIDTH + right].fill(SemanticTag::Vehicles as u8);
    }
    ids
}

/// The bot behind a car on a straight road, tick by tick.
struct Behind {
    bot: SemanticBot,
    shown: VecDeque<Vec<u8>>,
    tick: u32,
    limit_kmh: u16,
    gap_m: f32,
    speed_mps: f32,
    mps2: f32,
}

impl Behind {
    fn new(gap_m: f32, speed_mps: f32, limit_kmh: u16) -> Self {
        let (bot, shown) = (SemanticBot::default(), VecDeque::new());
        Self { bot, shown, tick: 0, limit_kmh, gap_m, speed_mps, mps2: 0.0 }
    }

    fn step(&mut self, leader_mps: f32) {
        // What is on the screen is 6 to 11 ticks old. The nose of the car dips by some 0.6 degrees when it brakes with
        // 3 m/s^2, and all seems farther then.
        if self.tick.is_multiple_of(6) {
            let mut ids = queue_ahead(self.gap_m, -DOWN_RAD_PER_MPS2 * self.mps2);
            // No two pictures are the same on the move.
            ids[0] = (self.tick / 6 % 2) as u8;
            self.shown.push_back(ids);
            self.shown.drain(..self.shown.len().saturating_sub(2));
        }
        self.tick += 1;
        let mask = MaskView { width: WIDTH, height: HEIGHT, ids: &self.shown[0] };
        let hud = Readout { limit_kmh: self.limit_kmh, junction_m: None, ..hud(self.speed_mps, 0) };
        let controls = self.bot.controls(&SemanticView { mask, hud });
        let asked = FULL_THROTTLE_MPS2 * f32::from(controls.throttle) / f32::from(u16::MAX)
            - FULL_BRAKE_MPS2 * f32::from(controls.brake) / f32::from(u16::MAX);
        // Pedals and suspension take a moment.
        self.mps2 += (asked - self.mps2) * TICK_S / 0.2;
        self.speed_mps = (self.speed_mps + self.mps2 * TICK_S).max(0.0);
        self.gap_m += (leader_mps - self.speed_mps) * TICK_S;
    }
}

#[test]
fn it_draws_up_to_a_queue_without_being_about_to_hit_it() {
    for (start_mps, limit_kmh) in [(6.0, 50), (10.0, 50), (50.0 / 3.6, 50), (70.0 / 3.6, 70)] {
        let (mut car, mut hardest) = (Behind::new(150.0, start_mps, limit_kmh), 0.0_f32);
        for _ in 0..1800 {
            car.step(0.0);
            hardest = hardest.min(car.mps2);
            let (t_s, braking) = (2.0_f32, car.mps2.min(-1e-3));
            let t_s = t_s.min(-car.speed_mps / braking);
            let driven_m = car.speed_mps * t_s + 0.5 * braking * t_s * t_s;
            let Behind { gap_m, speed_mps, mps2, .. } = car;
            assert!(speed_mps < 0.5 || driven_m < gap_m, "{start_mps}: {speed_mps} m/s, {mps2}, {gap_m} m before it");
        }
        let Behind { gap_m, speed_mps, .. } = car;
        assert!(speed_mps < 0.1 && (1.0..6.0).contains(&gap_m), "{start_mps}: {speed_mps} m/s, {gap_m} m before it");
        // Rows of the picture are metres apart at first sight, so it brakes harder than is comfortable, but not fully.
        assert!(hardest > -0.6 * FULL_BRAKE_MPS2, "{start_mps}: {hardest} m/s^2");
    }
}

/// The leader drives for a minute and then brakes hard; from 10 s on the gap is said in seconds.
#[test]
fn it_keeps_pace_with_who_drives_ahead_and_stands_behind_them_when_they_brake() {
    for (leader_mps, limit_kmh, braking_mps2) in [(8.0, 50, 6.0), (12.0, 50, 6.0), (18.0, 80, 5.0)] {
        let mut car = Behind::new(40.0, leader_mps, limit_kmh);
        let (mut slowest, mut gaps_s) = (f32::INFINITY, Vec::new());
        for tick in 0..3600 {
            car.step(leader_mps);
            if tick >= 600 {
                slowest = slowest.min(car.speed_mps);
                gaps_s.push(car.gap_m / leader_mps);
            }
        }
        let gap_s = gaps_s.iter().sum::<f32>() / gaps_s.len() as f32;
        assert!(slowest > 0.75 * leader_mps, "{leader_mps}: {slowest} m/s behind it");
        assert!((1.2..5.0).contains(&gap_s), "{leader_mps}: {gap_s} s behind it");
        let (mut speed_mps, mut nearest_m) = (leader_mps, f32::INFINITY);
        for _ in 0..900 {
            speed_mps = (speed_mps - braking_mps2 * TICK_S).max(0.0);
            car.step(speed_mps);
            nearest_m = nearest_m.min(car.gap_m);
        }
        assert!(car.speed_mps < 0.1 && nearest_m > 1.0, "{leader_mps}: {nearest_m} m behind it");
    }
}

/// The way past a car that stands ahead on the right closes while it is driven.
#[test]
fn it_stops_at_once_when_the_way_past_closes() {
    let mut bot = SemanticBot::of_temper(Temper::Tired);
    let mut drive = |ids: &[u8], speed_mps: f32, ticks: usize| {
        let mask = MaskView { width: WIDTH, height: HEIGHT, ids };
        (0..ticks).map(|_| bot.controls(&SemanticView { mask, hud: hud(speed_mps, 0) })).collect::<Vec<_>>()
    };
    let beside = rear_ahead(3.0, [-3.0, -0.4], 0.0);
    assert!(drive(&beside, 0.0, 1780).iter().all(|controls| controls.throttle == 0));
    assert!(drive(&beside, 0.0, 120).iter().any(|controls| controls.throttle > 0), "it takes the way past");
    // Longer than its foot stays over the brake.
    drive(&beside, 0.8, 150);
    let closes = drive(&rear_ahead(0.5, [-6.0, 6.0], 0.0), 0.8, 12);
    assert!(closes[6..].iter().all(|controls| controls.throttle == 0 && controls.brake > 0), "{closes:?}");
}

/// Before it stands, the room of what was in the way seems to be there still; a picture in which nothing moves frees it.
#[test]
fn it_drives_on_when_what_it_waited_for_is_gone_though_nothing_moves_any_more() {
    let road = Road { curvature: 0.0 };
    let free = road.mask(Pose { x: 0.0, y: 0.0, heading: 0.0 });
    let blocked = queue_ahead(2.0, 0.0);
    let mut bot = SemanticBot::default();
    let mut throttle = |ids: &[u8], ticks: usize| {
        let view = SemanticView { mask: MaskView { width: WIDTH, height: HEIGHT, ids }, hud: hud(0.0, 0) };
        (0..ticks).map(|_| bot.controls(&view).throttle).max().expect("ticks")
    };
    assert_eq!(throttle(&blocked, 300), 0, "it stands before a car");
    assert!(throttle(&free, 120) > 0, "one picture of the free road, shown for 2 s");
}

#[test]
fn a_figure_is_as_far_as_its_lowest_foot() {
    let mut ids = Road { curvature: 0.0 }.mask(Pose { x: 0.0, y: 0.0, heading: 0.0 });
    // Trunk, one leg to the left, and the other, which stands, to the right.
    for (columns, rows) in [(126..130, 60..70), (124..127, 70..75), (129..132, 70..79)] {
        for row in rows {
            ids[row * WIDTH + columns.start..row * WIDTH + columns.end].fill(SemanticTag::Pedestrian as u8);
        }
    }
    let sight = Sight::new(MaskView { width: WIDTH, height: HEIGHT, ids: &ids }, 0.0);
    let (_, foot_m) = sight.rows_between(0.0, 60.0).find(|(row, _)| *row == 78).expect("in view");
    let contacts = sight.contacts();
    assert_eq!(contacts.len(), 8, "a contact for every column: {contacts:?}");
    assert!(contacts.iter().all(|c| c.is_person && (c.x_m - foot_m).abs() < 0.5), "{foot_m} m: {contacts:?}");
}

#[test]
fn a_bend_ahead_is_no_farther_than_it_is_along_the_route() {
    for curvature in [0.04, -0.08, 0.11] {
        let road = Road { curvature };
        let pose = Pose { x: 0.0, y: 0.0, heading: 0.0 };
        let middle = pose.place(ego::CENTRE_M.x, 0.0);
        let (x, y) = path::arrow_point(road.bearing_deg(pose));
        let along = Arc { curvature }.project(x, y).0 - Arc { curvature }.project(middle.0, middle.1).0;
        // Half a step of the arrow is 0.52 m at this distance.
        assert!((along - path::ARROW_M).abs() < 0.53, "curvature {curvature}: {along} m");
    }
}

/// The right kerb is at column 210 of the lowest row.
#[test]
fn who_is_cut_by_the_lower_edge_stands_where_the_ground_beside_him_is() {
    let free = Road { curvature: 0.0 }.mask(Pose { x: 0.0, y: 0.0, heading: 0.0 });
    let on_road = |columns: std::ops::Range<usize>| {
        let mut ids = free.clone();
        for row in 40..HEIGHT {
            ids[row * WIDTH + columns.start..row * WIDTH + columns.end].fill(SemanticTag::Pedestrian as u8);
        }
        let contacts = Sight::new(MaskView { width: WIDTH, height: HEIGHT, ids: &ids }, 0.0).contacts();
        assert!(contacts.len() >= columns.len() && contacts.iter().all(|contact| contact.is_cut));
        contacts[0].on_road
    };
    assert_eq!([150..160, 205..215, 218..228].map(on_road), [true, false, false]);
}

#[test]
fn a_rider_is_where_his_wheels_are() {
    let mut ids = Road { curvature: 0.0 }.mask(Pose { x: 0.0, y: 0.0, heading: 0.0 });
    for (tag, columns, rows) in [(SemanticTag::Vehicles, 128..130, 70..79), (SemanticTag::Pedestrian, 127..131, 60..72)]
    {
        for row in rows {
            ids[row * WIDTH + columns.start..row * WIDTH + columns.end].fill(tag as u8);
        }
    }
    let sight = Sight::new(MaskView { width: WIDTH, height: HEIGHT, ids: &ids }, 0.0);
    let (_, wheels_m) = sight.rows_between(0.0, 60.0).find(|(row, _)| *row == 78).expect("in view");
    let contacts = sight.contacts();
    assert!(
        contacts.len() >= 4 && contacts.iter().all(|c| !c.is_person && (c.x_m - wheels_m).abs() < 0.5),
        "{wheels_m} m: {contacts:?}"
    );
}
