//! The plots of docs/world.md: dots are driven, lines computed.

use kernel::car::{Grip, NOMINAL_LOAD_N, Torque, Tyre, Wheel};
use kernel::rng::{Stream, below, bits, unit};

use super::braking::{Stops, stops};
use super::cornering::{LANES, lane_change, turned, yaw_gain};
use super::driving::{ROLLING, coasted_mps, rolled_mps};
use super::svg::{
    Area, Axis, BLACK, BLUE, Chart, END, GREEN, GREY, MIDDLE, ORANGE, RED, START, agrees_with_plot, picture,
};
use super::*;

const AREA: Area = Area { left: 60.0, top: 35.0, right: 600.0, bottom: 275.0 };

fn name(kind: SurfaceKind) -> &'static str {
    match kind {
        SurfaceKind::Road => "asphalt",
        SurfaceKind::RoadLine => "paint",
        SurfaceKind::Sidewalk => "slabs",
        SurfaceKind::Ground | SurfaceKind::Setts | SurfaceKind::Track | SurfaceKind::Rail => "setts",
        SurfaceKind::Gravel => "gravel",
        SurfaceKind::Terrain | SurfaceKind::Water => "grass",
    }
}

/// Full stops on every surface, dry and wet through.
fn stops_of(kmh: f64, area: Area, most_m: f64, ticks: &[f64]) -> Chart {
    use SurfaceKind as K;
    let label = format!("way of a full stop from {kmh} km/h, m (dots: driven, bars: computed)");
    let x = Axis { label: "", range: [0.0, 12.0], ticks: &[] };
    let mut chart = Chart::new(area, &x, &Axis { label: &label, range: [0.0, most_m], ticks });
    chart.text([area.left + 20.0, area.top + 10.0], START, BLUE, "● anti-lock brakes");
    chart.text([area.left + 20.0, area.top + 26.0], START, ORANGE, "■ locked wheels");
    for (k, kind) in [K::Road, K::Sidewalk, K::RoadLine, K::Setts, K::Gravel, K::Terrain].into_iter().enumerate() {
        chart.beside((2.0 * k as f64 + 1.0, 0.0), [0.0, 32.0], MIDDLE, BLACK, name(kind));
        for (wetness, word) in [(0.0, "dry"), (1.0, "wet")] {
            let at = 2.0 * k as f64 + 0.5 + wetness;
            let Stops { best, locked, abs, bare } = stops(kind, wetness, kmh);
            println!("{}, {word}, {kmh} km/h: {abs:.1}, {bare:.1} m; computed {best:.1}, {locked:.1} m", name(kind));
            chart.beside((at, 0.0), [0.0, 16.0], MIDDLE, GREY, word);
            chart.line(BLUE, " stroke-width=\"2\"", [(at - 0.3, best), (at + 0.3, best)]);
            chart.line(ORANGE, " stroke-width=\"2\"", [(at - 0.3, locked), (at + 0.3, locked)]);
            chart.dot(BLUE, (at, abs));
            chart.square(ORANGE, (at, bare));
        }
    }
    chart
}

#[test]
fn braking_distances() {
    let below = Area { top: 355.0, bottom: 595.0, ..AREA };
    let charts = [
        stops_of(50.0, AREA, 50.0, &[0.0, 10.0, 20.0, 30.0, 40.0, 50.0]),
        stops_of(100.0, below, 180.0, &[0.0, 50.0, 100.0, 150.0]),
    ];
    agrees_with_plot("braking", &picture([620, 640], &charts));
}

/// Friction in use of a wheel on a drum after a second at 20 m/s: along the wheel when it is held at a slip, across it
/// when it rolls at a slip angle.
fn on_a_drum(grip: &Grip, slip: f32, angle_rad: f32) -> f64 {
    let tyre = Tyre::new(NOMINAL_LOAD_N, grip);
    let hub_mps = glam::Vec2::new(kernel::ops::cos(angle_rad), kernel::ops::sin(angle_rad)) * 20.0;
    let least_radps = hub_mps.x / (0.32 * (1.0 + slip));
    let brake_nm = if slip > 0.0 { 1e5 } else { 0.0 };
    let torque = Torque { brake_nm, least_radps, most_radps: f32::MAX, drive_nm: 0.0 };
    let mut wheel = Wheel::rolling(hub_mps.x);
    let mut force_n = glam::Vec2::ZERO;
    for _ in 0..240 {
        force_n = wheel.turn(&tyre, hub_mps, &torque, 1.0 / 240.0).0;
    }
    f64::from(if slip > 0.0 { -force_n.x } else { -force_n.y } / NOMINAL_LOAD_N)
}

/// The brush model up to its peak, then a cubic to sliding at three times that slip.
fn curve([peak, sliding]: [f64; 2], slip: f64) -> f64 {
    let slips = slip * 22.0 / (3.0 * peak);
    if slips < 1.0 {
        return peak * (3.0 * slips - 3.0 * slips * slips + slips * slips * slips);
    }
    let way = ((slips - 1.0) / 2.0).min(1.0);
    peak - (peak - sliding) * way * way * (3.0 - 2.0 * way)
}

#[test]
fn tyre_curve() {
    let friction_axis = |label| Axis { label, range: [0.0, 1.1], ticks: &[0.0, 0.2, 0.4, 0.6, 0.8, 1.0] };
    let slip =
        Axis { label: "slip, sliding by rolling speed", range: [0.0, 0.5], ticks: &[0.0, 0.1, 0.2, 0.3, 0.4, 0.5] };
    let angle = Axis { label: "slip angle, degrees", range: [0.0, 25.0], ticks: &[0.0, 5.0, 10.0, 15.0, 20.0, 25.0] };
    let along = Area { right: 310.0, ..AREA };
    let across = Area { left: 380.0, right: 630.0, ..AREA };
    let mut along = Chart::new(along, &slip, &friction_axis("braking force by load"));
    let mut across = Chart::new(across, &angle, &friction_axis("side force by load"));
    let cases = [
        (BLUE, "asphalt", 0.38, friction(SurfaceKind::Road)),
        (RED, "wet asphalt", 0.18, wet_friction(SurfaceKind::Road)),
        (ORANGE, "gravel", 0.38, friction(SurfaceKind::Gravel)),
        (GREEN, "grass", 0.38, friction(SurfaceKind::Terrain)),
    ];
    for (colour, name, slip_of_name, figures) in cases {
        let grip = Grip { peak: figures[0] as f32, sliding: figures[1] as f32, rolling: 0.0 };
        along.line(colour, "", (0..=100).map(|k| f64::from(k) / 200.0).map(|slip| (slip, curve(figures, slip))));
        across.line(
            colour,
            "",
            (0..=100)
                .map(|k| f64::from(k) / 4.0)
                .map(|degrees| (degrees, curve(figures, libm::tan(degrees.to_radians())))),
        );
        for k in 1..=20 {
            let (slip, degrees) = (0.025 * f64::from(k), 1.25 * f64::from(k));
            let [held, rolling] =
                [on_a_drum(&grip, slip as f32, 0.0), on_a_drum(&grip, 0.0, degrees.to_radians() as f32)];
            along.cloud(colour, 6.0, [(slip, held)]);
            across.cloud(colour, 6.0, [(degrees, rolling)]);
            for (driven, computed) in
                [(held, curve(figures, slip)), (rolling, curve(figures, libm::tan(degrees.to_radians())))]
            {
                assert!((driven / computed - 1.0).abs() < 0.01, "{name}: {driven} instead of {computed}");
            }
        }
        let last = curve(figures, slip_of_name);
        let down = if name.contains("asphalt") { -8.0 } else { 16.0 };
        along.beside((slip_of_name, last), [6.0, down], START, colour, name);
        across.beside((libm::atan(slip_of_name).to_degrees(), last), [6.0, down], START, colour, name);
    }
    agrees_with_plot("tyre", &picture([650, 325], &[along, across]));
}

/// Forces of wheels by what their load allows, along and to the left, at moments of random drives.
fn moments(drives: u64) -> Vec<(f64, f64)> {
    let mut moments = Vec::new();
    for drive in 0..drives {
        let draw = |what: u64| unit(drive, Stream::Driver, what, 0);
        let kinds = GROUNDS;
        let kind = kinds[below(drive, Stream::Driver, 0, 0, kinds.len() as u32) as usize];
        let mut car = Drive::over(kind, 40.0 * draw(1), CarSetup { abs: draw(2) < 0.5, esc: draw(3) < 0.5 });
        for part in 1..=4 {
            let random = bits(drive, Stream::Driver, 4, part);
            let [steer, throttle, brake] = [0, 16, 32].map(|shift| (random >> shift) as u16);
            let coasts = random >> 62 == 0;
            let brake = if coasts { 0 } else { brake };
            let flags = (random >> 48) as u8 & (Controls::HAND_BRAKE | Controls::REVERSE);
            let ticks = 5 + below(drive, Stream::Driver, 5, part, 55);
            car.hold(Tick::from(ticks), |_| Controls { steer: steer as i16, throttle, brake, flags });
            let print = &car.physics.footprints()[part as usize % 4];
            if print.load_n > 0.0 {
                let by_limit = print.force_n / print.limit_n;
                assert!(by_limit.length() < 1.0001, "{by_limit} in drive {drive}");
                moments.push((f64::from(by_limit.x), f64::from(by_limit.y)));
            }
        }
    }
    moments
}

#[test]
fn friction_circle() {
    let axis = |label| Axis { label, range: [-1.1, 1.1], ticks: &[-1.0, -0.5, 0.0, 0.5, 1.0] };
    let area = Area { left: 60.0, top: 35.0, right: 400.0, bottom: 375.0 };
    let mut chart = Chart::new(
        area,
        &axis("force to the right, by what the load allows"),
        &axis("force forwards, by what the load allows"),
    );
    let around = (0..=90).map(|k| (f64::from(k) * 4.0).to_radians()).map(|a| (libm::cos(a), libm::sin(a)));
    chart.line(GREY, "", around);
    let points = moments(500);
    println!("{} moments", points.len());
    chart.cloud(BLUE, 2.5, points.iter().map(|(forwards, left)| (-left, *forwards)));
    agrees_with_plot("friction-circle", &picture([420, 425], &[chart]));
}

#[test]
fn yaw_gains() {
    let x = Axis { label: "sideways acceleration, g", range: [0.0, 0.7], ticks: &[0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6] };
    let y = Axis {
        label: "yaw rate by angle of the front wheels, 1/s (dots: driven, lines: single-track model)",
        range: [0.0, 10.0],
        ticks: &[0.0, 2.0, 4.0, 6.0, 8.0, 10.0],
    };
    let mut chart = Chart::new(AREA, &x, &y);
    for (colour, speed) in [(BLUE, 7.0), (GREEN, 14.0), (ORANGE, 21.0), (RED, 28.0)] {
        let mut expected = Vec::new();
        for k in 1..=12 {
            let (driven, yaw, gain) = turned(speed, 0.05 * f64::from(k));
            let place = (driven * yaw / G, gain);
            expected.push((place.0, yaw_gain(driven)));
            chart.cloud(colour, 6.0, [place]);
        }
        let last = expected[expected.len() - 1];
        chart.line(colour, "", expected);
        chart.beside(last, [8.0, 4.0], START, colour, &format!("{speed} m/s"));
    }
    agrees_with_plot("yaw-gain", &picture([620, 325], &[chart]));
}

#[test]
fn coasting() {
    let x = Axis { label: "time, s", range: [0.0, 40.0], ticks: &[0.0, 10.0, 20.0, 30.0, 40.0] };
    let y = Axis {
        label: "speed without a pedal, km/h (dots: driven, lines: drag and rolling resistance of so much)",
        range: [0.0, 100.0],
        ticks: &[0.0, 20.0, 40.0, 60.0, 80.0, 100.0],
    };
    let mut chart = Chart::new(AREA, &x, &y);
    for ((kind, rolling, seconds_long), (colour, at)) in
        ROLLING.into_iter().zip([(BLUE, 16), (ORANGE, 34), (GREEN, 20)])
    {
        let speeds = coasted_mps(kind, seconds_long);
        let computed = (0..=seconds_long).map(|s| (s as f64, 3.6 * rolled_mps(rolling, speeds[0], s as f64)));
        chart.line(colour, "", computed);
        chart.cloud(colour, 6.0, speeds.iter().enumerate().step_by(2).map(|(s, speed)| (s as f64, 3.6 * speed)));
        let words = format!("{}, {rolling}", name(kind));
        let (anchor, beside) = if kind == SurfaceKind::Road { (START, [4.0, -10.0]) } else { (END, [-4.0, 18.0]) };
        chart.beside((at as f64, 3.6 * speeds[at]), beside, anchor, colour, &words);
    }
    agrees_with_plot("coasting", &picture([620, 325], &[chart]));
}

#[test]
fn lane_change_of_iso_3888_2() {
    let change = lane_change(50.0 / 3.6, HELPED);
    let label = format!("to the left, m; 50 km/h at the entry, stability control, {:.2} m of room left", -change.out_m);
    let x = Axis { label: "along the lanes, m", range: [-5.0, 67.0], ticks: &[0.0, 12.0, 25.5, 36.5, 49.0, 61.0] };
    let y = Axis { label: &label, range: [-4.0, 6.0], ticks: &[-4.0, -2.0, 0.0, 2.0, 4.0, 6.0] };
    let mut chart = Chart::new(Area { bottom: 185.0, ..AREA }, &x, &y);
    let place = |corner: Vec3| (f64::from(corner.x), f64::from(corner.y));
    let seen = |corners: &&[Vec3; 4]| corners.iter().all(|corner| corner.x >= -5.0);
    let boxes: Vec<_> = change.boxes.iter().filter(seen).collect();
    for corners in boxes.iter().step_by(12) {
        let mut outline = corners.map(place).to_vec();
        outline.push(outline[0]);
        chart.line("#bbb", "", outline);
    }
    let middles = boxes.iter().step_by(3).map(|corners| place(corners.iter().sum::<Vec3>() / 4.0));
    chart.line(BLUE, " stroke-width=\"2\"", middles);
    for ([from, to], sides) in LANES {
        for k in 0..=4 {
            let along = f64::from(from + (to - from) * k as f32 / 4.0);
            chart.cloud(ORANGE, 6.0, sides.map(|side| (along, f64::from(side))));
        }
    }
    agrees_with_plot("lane-change", &picture([620, 235], &[chart]));
}
