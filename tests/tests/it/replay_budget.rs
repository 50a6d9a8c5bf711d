//! An hour of driving fits into 4 MB.

use replay::Recording;
use tests::recordings::{ALONE, record};
use tests::scenes::{Scene, busy_city, country_road};

/// Most bytes an hour, with 100 to 150 actors (design: CARLA writes about 200 MB, poses only).
const BYTES_AN_HOUR: f64 = 4e6;

fn fits_into_4_mb(scene: &Scene) {
    let bytes = record(scene, 3600, ALONE);
    let ticks = Recording::from_bytes(&bytes).expect("a recording").log().last_tick();
    assert!(ticks >= 1800, "the run ended after {ticks} ticks");
    let start = record(scene, 0, ALONE).len();
    let an_hour = (bytes.len() - start) as f64 / ticks as f64 * 3600.0 * 60.0;
    assert!(an_hour <= BYTES_AN_HOUR, "{an_hour:.0} bytes an hour over {ticks} ticks");
}

#[test]
fn an_hour_in_the_city_fits_into_4_mb() {
    fits_into_4_mb(&busy_city());
}

#[test]
fn an_hour_in_the_country_fits_into_4_mb() {
    fits_into_4_mb(&country_road());
}
