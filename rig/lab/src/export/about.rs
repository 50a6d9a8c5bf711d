//! What an export was made from.

use std::collections::BTreeMap;

use drivers::vision::Eye;
use kernel::RoadNetwork;
use measures::footage::Window;
use replay::Recording;

use super::options::Options;
use crate::cameras::Named;
use crate::looks::Size;

/// Everything that the pictures and messages of a window follow from, by names.
pub fn about(
    recording: &Recording,
    window: &Window,
    (args, size): (&Options, Size),
    (eyes, others): (&[Eye], &[Named]),
) -> BTreeMap<String, String> {
    let eyes: Vec<String> = eyes.iter().map(|eye| format!("{} {}", eye.name(), eye.digest())).collect();
    let entries = [
        ("source", blake3::Hash::from_bytes(recording.digest()).to_hex().to_string()),
        ("ticks", format!("{} to {}", window.ticks.start(), window.ticks.end())),
        ("fps", args.fps.to_string()),
        ("size", format!("{}x{}", size.0, size.1)),
        ("quality", args.imaging.to_string()),
        ("checkpoints", eyes.join(", ")),
        ("adapter", drivers::vision::adapter()),
        ("program", env!("CARGO_PKG_VERSION").to_owned()),
    ];
    let others: Vec<String> = others.iter().map(|Named { name, camera }| format!("{name} {camera:?}")).collect();
    let cameras = (!others.is_empty()).then(|| ("cameras", others.join(", ")));
    entries.into_iter().chain(cameras).map(|(name, value)| (name.to_owned(), value)).collect()
}

/// What to add to coordinates to have those of the map's file, where they differ: metres to the east and to the north.
pub fn origin(network: &RoadNetwork) -> Option<(String, String)> {
    let [east_m, north_m] = network.origin_m;
    ([east_m, north_m] != [0.0; 2]).then(|| ("origin_m".to_owned(), format!("{east_m} {north_m}")))
}
