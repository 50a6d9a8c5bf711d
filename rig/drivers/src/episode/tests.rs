//! An agent that copies a bot drives its run; company and the length of steps change nothing.

use kernel::time::seconds;
use render::{AdapterChoice, Renderer};
use replay::{Log, Recording};

use super::*;
use crate::vision::{Eye, Vision};

const SEED: u64 = 3;

fn city() -> (Map, Scenario) {
    let map = Map::find("city").expect("bundled");
    let mut scenario = map.scenario(SEED);
    scenario.rules.max_seconds = 5;
    (map, scenario)
}

/// The same run by two bots.
fn bots_drive() -> Log {
    let (map, scenario) = city();
    let vision = Vision::new(Renderer::new(&map.network, &AdapterChoice::default()).expect("a driver"), Eye::Truth);
    let (bytes, _) = simulate::drive(&scenario, &map, vision, Vec::new(), |_| true).expect("a drive");
    Recording::from_bytes(&bytes).expect("readable").into_log()
}

fn optics(map: &Map) -> Optics {
    Optics::new(Renderer::new(&map.network, &AdapterChoice::default()).expect("a driver"), Eye::Truth)
}

#[test]
fn an_agent_that_does_what_a_bot_does_drives_the_bots_run() {
    let expected = bots_drive();
    let (map, scenario) = city();
    let mut optics = optics(&map);
    for seat in [Seat::Semantic, Seat::Safety] {
        let manifest = manifest(&scenario, &map, seat, &Eye::Truth);
        let mut episode = Episode::new(&scenario, &map, seat, Some(&manifest), false).expect("fits");
        let mut facts = Facts::default();
        for input in &expected.inputs {
            let controls = if seat == Seat::Semantic { input.semantic } else { input.safety };
            facts.progress_m += episode.step(&mut optics, controls, 1).expect("a tick").progress_m;
            episode.mask(&mut optics).expect("looking twice changes nothing");
        }
        assert!(episode.is_over());
        let driven_m = episode.world().odometer_mm() as f32 / 1000.0;
        assert!(driven_m > 5.0 && (0.95..1.01).contains(&(facts.progress_m / driven_m)), "{facts:?} of {driven_m} m");
        let bytes = episode.finish().expect("readable").expect("it is recorded");
        let log = Recording::from_bytes(&bytes).expect("readable").into_log();
        assert_eq!((&log.inputs, &log.hashes, &log.masks), (&expected.inputs, &expected.hashes, &expected.masks));
        assert_eq!(log.manifest.provenance[if seat == Seat::Semantic { "semantic" } else { "safety" }], "agent");
    }
}

#[test]
fn the_length_of_steps_changes_nothing_that_the_controls_do_not() {
    let (map, scenario) = city();
    let mut optics = optics(&map);
    let mut drive = |ticks: Tick| {
        let mut episode = Episode::new(&scenario, &map, Seat::Semantic, None, true).expect("fits");
        let controls = Controls::from_fractions(0.05, 0.4, 0.0);
        let mut progress_m = 0.0;
        while episode.world().tick() < seconds(2) {
            progress_m += episode.step(&mut optics, controls, ticks).expect("a step").progress_m;
        }
        let image = episode.image(&mut optics, &Camera::driver(64, 32)).expect("drawn").into_owned();
        (episode.mask(&mut optics).expect("drawn").ids.to_vec(), image, episode.world().hash(), progress_m.round())
    };
    assert_eq!(drive(1), drive(12));
    assert_eq!(drive(4), drive(60));
}

/// Mask, HUD and figures.
type Seen = (Vec<u8>, Vec<f32>, Vec<f64>);

/// What is seen of each of some episodes after each step.
fn fleet_of(places: usize, jobs: usize) -> Vec<Vec<Seen>> {
    let plan = Plan { seat: Seat::Semantic, ticks: 6, masks: true, images: None, archive: None, jobs };
    let mut fleet = Fleet::new(plan, Eye::Truth, places);
    let (width, height) = fleet.eye().size();
    let blank: Seen = (vec![0; (width * height) as usize], vec![0.0; hud::NAMES.len()], vec![0.0; COLUMNS.len()]);
    let mut told = Vec::new();
    for step in 0..4 {
        let mut seen = vec![blank.clone(); places];
        let rows = seen.iter_mut().enumerate().map(|(place, (mask, hud, figures))| Row {
            place,
            mask: Some(mask),
            image: None,
            hud,
            figures,
        });
        let rows: Vec<Row<'_>> = rows.collect();
        if step == 0 {
            let start = |place: usize| {
                let map = Map::find(["city", "rural"][place % 2]).expect("bundled");
                Start { place, scenario: map.scenario(place as u64), map }
            };
            fleet.start((0..places).map(start).collect(), rows).expect("it starts");
        } else {
            let controls: Vec<_> = (0..places).map(|i| Controls::from_fractions(0.0, 0.1 * i as f32, 0.0)).collect();
            fleet.step(&controls, rows).expect("a step");
        }
        told.push(seen);
    }
    told
}

#[test]
fn episodes_are_the_same_alone_and_in_any_company() {
    let together = fleet_of(4, 3);
    assert_eq!(fleet_of(4, 1), together, "one device for all");
    let alone: Vec<_> = fleet_of(1, 1).into_iter().map(|mut step| step.remove(0)).collect();
    assert_eq!(alone, together.into_iter().map(|mut step| step.remove(0)).collect::<Vec<_>>());
}

#[test]
fn a_step_without_an_episode_is_refused() {
    let plan = Plan { seat: Seat::Safety, ticks: 6, masks: false, images: None, archive: None, jobs: 1 };
    let mut fleet = Fleet::new(plan, Eye::Truth, 1);
    let row = Row { place: 0, mask: None, image: None, hud: &mut [], figures: &mut [] };
    let said = fleet.step(&[Controls::default()], vec![row]).expect_err("nothing runs").to_string();
    assert_eq!(said, "the episode is over; expected a reset before the next step");
    assert!(fleet.draw(0, &Camera::chase(32, 16)).is_err());
    assert_eq!(fleet.finish(&[0]).expect("nothing to end"), [None]);
}
