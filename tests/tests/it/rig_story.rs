//! Stories in OpenSCENARIO XML are driven, recorded and verified as all else; a recording that is exported as one is
//! played back as it was.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use aeye::cli::Cli;
use aeye::exit;
use base::failure::sentence;
use base::scenario_file::ScenarioFile;
use clap::Parser;
use glam::Vec3;
use kernel::story::FIRST_STORY_ID;
use kernel::{TickInput, World};
use measures::footage::decisive_tick;
use replay::{Recording, Replayer};
use tests::recordings::{TAKEOVER, WITH_TAKEOVER, record};
use tests::scenes::busy_city;

/// Exit code and sentence of `aeye`.
fn aeye(arguments: &[&str]) -> (u8, String) {
    let cli = Cli::try_parse_from([&["aeye", "--json"], arguments].concat()).expect("a valid command line");
    let result = aeye::run(&cli);
    (exit::number(&result), result.err().map(|e| sentence(&e)).unwrap_or_default())
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a name in UTF-8")
}

/// The end of a recorded drive through the city as a story.
fn exported(folder: &Path) -> (PathBuf, PathBuf) {
    let (recording, out) = (folder.join("a.mcap"), folder.join("a.xosc"));
    fs::write(&recording, record(&busy_city(), TAKEOVER + 180, WITH_TAKEOVER)).unwrap();
    let (code, said) =
        aeye(&["export", text(&recording), "--last", "4s", "--format", "openscenario", "--out", text(&out)]);
    assert_eq!(code, 0, "{said}");
    (recording, out)
}

#[test]
fn an_exported_story_plays_everybody_as_they_were() {
    let dir = tempfile::tempdir().unwrap();
    let (recording, out) = exported(dir.path());
    let file = ScenarioFile::read(&out).unwrap();
    assert_eq!(file.map.network.name, "a", "the map beside the story");
    let cast = &file.scenario.story.as_ref().expect("a story").script().cast;
    let mut world = World::new(&file.scenario, &file.map.network).unwrap();

    let recording = Recording::open(&recording).unwrap();
    let mut replayer = Replayer::new(recording.log(), recording.network().unwrap()).unwrap();
    let (last, length) = (decisive_tick(recording.log()), 240);
    let from = last + 1 - length;
    let (mut compared, mut worst_m) = (0, 0.0_f32);
    for tick in from..=last {
        replayer.run_to(tick).unwrap();
        let scene = replayer.world().scene();
        let was: BTreeMap<u32, Vec3> = scene.actors.iter().map(|actor| (actor.id, actor.position)).collect();
        for actor in world.scene().actors {
            let name = &cast[(actor.id - FIRST_STORY_ID) as usize].name;
            let id: u32 = name.trim_start_matches(char::is_alphabetic).parse().expect("its number");
            if let Some(was) = was.get(&id) {
                worst_m = worst_m.max((actor.position - *was).length());
                compared += 1;
            }
        }
        world.step(&TickInput::default());
    }
    assert!(compared > 10_000, "{compared}");
    assert!(worst_m < 0.01, "{worst_m} m");
}

#[test]
fn a_story_is_refused_on_another_map_than_its_own() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let campaign =
        ["campaign", "--scenario", "cut_out", "--maps", "city", "--vary", "2", "--checkpoint", "truth", "--out"];
    let (code, said) = aeye(&[campaign.as_slice(), &[text(&out)]].concat());
    assert_eq!((code, said.as_str()), (2, "cut_out: plays on the roads of its own map; expected no --maps"));
    assert!(!out.exists());
}

#[test]
fn a_story_is_driven_recorded_and_verified() {
    let dir = tempfile::tempdir().unwrap();
    let (_, story) = exported(dir.path());
    let run = dir.path().join("run.mcap");
    let drive =
        ["drive", "--headless", "--scenario", text(&story), "--checkpoint", "truth", "--max-time", "5s", "--record"];
    let (code, said) = aeye(&[drive.as_slice(), &[text(&run)]].concat());
    assert_eq!(code, 0, "{said}");
    let (code, said) = aeye(&["verify", text(&run)]);
    assert_eq!(code, 0, "{said}");
    // Another story at the same place is not overwritten.
    fs::write(&story, "<OpenSCENARIO/>").unwrap();
    let again = ["export", text(&run), "--format", "openscenario", "--out", text(&story)];
    assert!(aeye(&again).1.contains("exists already and is no export of this"));
    let (code, said) =
        aeye(&["drive", "--headless", "--scenario", text(&story), "--max-time", "5s", "--record", "no.mcap"]);
    assert!(code != 0 && said.contains("a.xosc: line 1: <OpenSCENARIO> has no <RoadNetwork>"), "{code} {said}");
}

#[test]
fn what_is_drawn_of_a_story_and_cannot_be_played_is_told_before_anything_is_driven() {
    let dir = tempfile::tempdir().unwrap();
    let (story, out) = (dir.path().join("s.xosc"), dir.path().join("out"));
    let bundled = kernel::story::BUNDLED.iter().find(|(name, _)| *name == "leader_brakes").expect("it is bundled").1;
    let ranged = |value: &str| {
        let range = r#"<ConstraintGroup><ValueConstraint rule="greaterOrEqual" value="-5"/><ValueConstraint rule="lessOrEqual" value="5"/></ConstraintGroup>"#;
        let name = format!(
            r#"<ParameterDeclaration name="drawn" parameterType="double" value="5">{range}</ParameterDeclaration>"#
        );
        let text = bundled.replacen("<ParameterDeclarations>", &format!("<ParameterDeclarations>{name}"), 1);
        let teleport = text.find("<LanePosition ").expect("somebody begins on a lane");
        let (before, after) = text.split_at(teleport);
        let s = after.find(" s=\"").expect("at some place") + 4;
        let end = s + after[s..].find('"').expect("its end");
        format!("{before}{}{value}{}", &after[..s], &after[end..])
    };
    for (value, said) in [
        ("${40 + 0 * sqrt($drawn * $drawn - 4)}", "it has no finite value"),
        ("${40 + (5 - $drawn) * 10000}", "has no lane -1 at s "),
    ] {
        fs::write(&story, ranged(value)).unwrap();
        let campaign =
            ["campaign", "--scenario", text(&story), "--vary", "8", "--checkpoint", "truth", "--out", text(&out)];
        let (code, sentence) = aeye(&campaign);
        assert!(code == 2 && sentence.contains("s.xosc: draw ") && sentence.contains(said), "{code} {sentence}");
        assert!(!out.exists());
    }
}

/// Who leaves the map and comes again is deleted and added, and does not glide.
#[test]
fn who_leaves_and_comes_again_does_so_in_an_exported_story() {
    let dir = tempfile::tempdir().unwrap();
    let path = |name: &str| dir.path().join(name);
    let all =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../kernel/stories/leader_brakes.xosc")).unwrap();
    let name = "Leader";
    let trigger = |after_s: f32| {
        format!(
            r#"<StartTrigger><ConditionGroup><Condition name="t" delay="0" conditionEdge="none"><ByValueCondition><SimulationTimeCondition value="{after_s}" rule="greaterThan"/></ByValueCondition></Condition></ConditionGroup></StartTrigger>"#
        )
    };
    let entity = |what: &str, after_s: f32| {
        format!(
            r#"<Event name="e{after_s}" priority="parallel"><Action name="a{after_s}"><GlobalAction><EntityAction entityRef="{name}">{what}</EntityAction></GlobalAction></Action>{}</Event>"#,
            trigger(after_s)
        )
    };
    let place = r#"<AddEntityAction><Position><RelativeLanePosition entityRef="Ego" dLane="0" ds="60"/></Position></AddEntityAction>"#;
    let events = entity("<DeleteEntityAction/>", 1.0) + &entity(place, 2.0);
    let end = all.find("</Maneuver>").expect("it has one");
    fs::write(path("s.xosc"), format!("{}{events}{}", &all[..end], &all[end..])).unwrap();
    let drive = ["drive", "--headless", "--checkpoint", "truth", "--max-time", "4s", "--record"];
    for (story, record) in [("s.xosc", "a.mcap"), ("b.xosc", "b.mcap")] {
        let (story, record) = (path(story), path(record));
        let (code, said) = aeye(&[drive.as_slice(), &[text(&record), "--scenario", text(&story)]].concat());
        assert_eq!(code, 0, "{said}");
        if record.ends_with("a.mcap") {
            let out = path("b.xosc");
            let (code, said) = aeye(&["export", text(&record), "--format", "openscenario", "--out", text(&out)]);
            assert_eq!(code, 0, "{said}");
        }
    }
    let others = |file: &str| -> Vec<Vec<Vec3>> {
        let recording = Recording::open(&path(file)).unwrap();
        let mut replayer = Replayer::new(recording.log(), recording.network().unwrap()).unwrap();
        let scenes = (0..200).map(|tick| {
            replayer.run_to(tick).unwrap();
            replayer.world().scene().actors.iter().map(|actor| actor.position).collect()
        });
        scenes.collect()
    };
    let (was, is) = (others("a.mcap"), others("b.mcap"));
    let least = was.iter().map(Vec::len).min();
    assert_eq!(was.iter().map(Vec::len).collect::<Vec<_>>(), is.iter().map(Vec::len).collect::<Vec<_>>());
    assert!(least < was.iter().map(Vec::len).max(), "somebody leaves");
    let apart = was.iter().flatten().zip(is.iter().flatten()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    assert!(apart < 0.01, "{apart} m");
}
