//! Corner cases that nobody had to see.

use std::fs;
use std::path::Path;

use base::maps::Map;
use drivers::Driver;
use drivers::expert::Expert;
use drivers::session::{Session, SessionState};
use drivers::simulate::manifest;
use drivers::vision::Eye;
use kernel::{Controls, TickInput, World};
use replay::{Annotation, Case, Label, Recording};

/// The tick at which the safety driver brakes, soon after it may.
const TAKEOVER: u64 = 200;

/// A corner case in the country: for no reason, the safety driver brakes.
pub fn case(path: &Path, seed: u64) {
    let map = Map::find("rural").expect("bundled");
    let scenario = map.scenario(seed);
    let world = World::new(&scenario, &map.network).expect("a world");
    let mut session = Session::new(world, &manifest(&scenario, &map, &Eye::Truth), Vec::new()).expect("a recording");
    let mut state = SessionState::Driving;
    while state == SessionState::Driving {
        let braking = f32::from(u8::from(session.world().tick() >= TAKEOVER));
        let semantic = Expert.controls(session.world());
        let input = TickInput { semantic, safety: Controls::from_fractions(0.0, 0.0, braking) };
        state = session.tick(&input).expect("a tick").0;
    }
    session.annotate(Annotation { label: Label::Walker, comment: String::new(), perception_caused: None });
    let recording = Recording::from_bytes(&session.finish().expect("its end")).expect("whole");
    let window = Case::window(recording.log()).expect("an intervention");
    let case = Case::cut(&recording, &map.network, window).expect("a case");
    fs::write(path, case.encode().expect("a file")).expect("writable");
}
