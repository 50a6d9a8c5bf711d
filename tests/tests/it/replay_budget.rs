//! An hour of driving fits into 4 MB.

use replay::Recording;
use tests::recordings::{ALONE, record};
use tests::scenes::busy_city;

/// Most bytes an hour, with 100 to 150 actors (design: CARLA writes about 200 MB, poses only).
const BYTES_AN_HOUR: f64 = 4e6;

#[test]
fn an_hour_with_100_actors_fits_into_4_mb() {
    let city = busy_city();
    let bytes = record(&city, 7200, ALONE);
    let log = Recording::from_bytes(&bytes).expect("a recording").into_log();
    let empty = record(&city, 0, ALONE);
    let hours = log.last_tick() as f64 / (3600.0 * 60.0);
    let an_hour = (bytes.len() - empty.len()) as f64 / hours;
    assert!(log.last_tick() >= 1800, "the run ended after {} ticks", log.last_tick());
    assert!(an_hour <= BYTES_AN_HOUR, "{an_hour:.0} bytes an hour over {} ticks", log.last_tick());
}
