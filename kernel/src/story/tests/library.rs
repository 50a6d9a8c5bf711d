//! The stories that come with A-Eye.

use std::path::Path;

use super::*;
use crate::map::bundled;
use crate::story::BUNDLED;

#[test]
fn bundled_stories_play_with_all_values_of_their_parameters() {
    for (name, text) in BUNDLED {
        let story = Story::read(text).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(story.varies(), Ok(true), "{name}");
        let map = Path::new(story.map_file()).file_stem().and_then(|stem| stem.to_str()).expect("a name").to_owned();
        let network = bundled(&map).unwrap_or_else(|| panic!("{name}: {map}"));
        for seed in [1, 2, 3] {
            let mut scenario = Scenario { traffic: TrafficCounts::NONE, ..Scenario::default_for(&map, seed) };
            scenario.play(story.varied(seed).unwrap_or_else(|error| panic!("{name}: {error}")));
            let mut world = World::new(&scenario, &network).unwrap_or_else(|error| panic!("{name}: {error}"));
            go_on(&mut world, 1.0);
        }
    }
}
