//! Statistics come from recordings alone: what counts, what does not, and what is refused.

use std::fs;
use std::path::{Path, PathBuf};

use measures::statistics::{Choice, Library, of_recordings};
use replay::{Case, Recording};
use tests::recordings::{ALONE, TAKEOVER, WITH_TAKEOVER, record};
use tests::scenes::busy_city;

/// A recording of the city with these entries of its provenance.
fn recording(with_takeover: bool, entries: &[(&str, &str)]) -> Recording {
    let controls = if with_takeover { WITH_TAKEOVER } else { ALONE };
    let mut log = Recording::from_bytes(&record(&busy_city(), TAKEOVER + 60, controls)).unwrap().into_log();
    log.manifest.provenance.extend(entries.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())));
    Recording::from_bytes(&log.encode().unwrap()).unwrap()
}

fn write(folder: &Path, name: &str, recording: &Recording) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, recording.log().encode().unwrap()).unwrap();
    path
}

fn refused(paths: &[PathBuf], reference: Option<&str>) -> String {
    of_recordings(paths, Choice { reference, ..Choice::default() }, |_, _| true).expect_err("refused").to_string()
}

#[test]
fn every_ride_counts_once_for_its_checkpoint() {
    let dir = tempfile::tempdir().unwrap();
    let old = [("checkpoint", "old"), ("checkpoint_digest", "aa")];
    let new = [("checkpoint", "new"), ("checkpoint_digest", "bb")];
    let practice = [old[0], old[1], ("familiarisation", "true")];
    let ridden = recording(true, &old);
    write(dir.path(), "0.mcap", &ridden);
    write(dir.path(), "1.mcap", &recording(false, &old));
    write(dir.path(), "2.mcap", &recording(false, &new));
    write(dir.path(), "3.mcap", &recording(true, &practice));
    let case = Case::cut(&ridden, &ridden.network().unwrap(), Case::window(ridden.log()).unwrap()).unwrap();
    let case_path = dir.path().join("0.case.mcap");
    fs::write(&case_path, case.encode().unwrap()).unwrap();

    let of = of_recordings(&[dir.path().to_owned()], Choice::default(), |_, _| true).unwrap().checkpoints;
    let counts: Vec<_> = of.iter().map(|c| (c.checkpoint.as_str(), c.statistics.rides, c.statistics.cases)).collect();
    assert_eq!(counts, [("old", 2, 1), ("new", 1, 0)]);
    let (old, new) = (&of[0], &of[1]);
    let km = ridden.log().odometer_mm() as f64 / 1e6;
    assert!(km > 0.0 && (old.statistics.legs.km_mean.unwrap() - km).abs() < 1e-12);
    assert!(old.statistics.legs.censored_km > 0.0 && old.against_reference.is_none());
    assert_eq!(new.against_reference.as_ref().unwrap().ratio, Some(0.0));

    assert!(refused(&[case_path], None).contains("a corner case"));
    let fork = write(
        dir.path(),
        "a.fork.mcap",
        &recording(false, &[("checkpoint", "old"), ("fork", "without the intervention")]),
    );
    assert!(refused(std::slice::from_ref(&fork), None).contains("a fork of aeye redrive"));
    fs::remove_file(fork).unwrap();
    let (again, copy) = (dir.path().join("0.mcap"), dir.path().join("below/copy.mcap"));
    fs::create_dir(dir.path().join("below")).unwrap();
    fs::copy(&again, &copy).unwrap();
    let both = of_recordings(&[again, dir.path().to_owned()], Choice::default(), |_, _| true).unwrap();
    assert_eq!(both.checkpoints[0].statistics.rides, 2, "a file that is given twice counts once, and so does a copy");
    assert!(
        both.failed.iter().all(|failure| failure.error.contains("holds the same recording as"))
            && both.failed.len() == 1
    );
    fs::remove_file(copy).unwrap();
    assert!(refused(&[dir.path().to_owned()], Some("newest")).contains("expected one of old, new"));
    assert!(refused(&[dir.path().join("3.mcap")], None).contains("no recording counts"));
    let empty = tempfile::tempdir().unwrap();
    assert!(refused(&[empty.path().to_owned()], None).contains("holds no recording"));
}

#[test]
fn blind_drives_are_one_until_they_are_revealed() {
    let dir = tempfile::tempdir().unwrap();
    for (file, name) in [("a.mcap", "old"), ("b.mcap", "new")] {
        let entries = [("checkpoint", name), ("checkpoint_digest", name), ("blind", "one of 2 checkpoints")];
        write(dir.path(), file, &recording(false, &entries));
    }
    let names = |reveal| {
        let of = of_recordings(&[dir.path().to_owned()], Choice { reveal, ..Choice::default() }, |_, _| true)
            .unwrap()
            .checkpoints;
        of.into_iter().map(|c| c.checkpoint).collect::<Vec<_>>()
    };
    assert_eq!((names(false), names(true)), (vec!["blind".to_owned()], vec!["old".into(), "new".into()]));
}

#[test]
fn behind_cases_stand_the_rides_of_their_folders_by_checkpoint() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    ["runs/below", "calm", "elsewhere"].iter().for_each(|name| fs::create_dir_all(at(name)).unwrap());
    let (old, new) = ([("checkpoint", "old")], [("checkpoint", "new")]);
    let ridden = recording(true, &old);
    write(dir.path(), "runs/a.mcap", &ridden);
    let calm = write(dir.path(), "calm/b.mcap", &recording(false, &old));
    write(dir.path(), "runs/below/c.mcap", &recording(false, &new));
    write(dir.path(), "runs/a.fork.mcap", &recording(false, &[old[0], ("fork", "without the intervention")]));
    let case = Case::cut(&ridden, &ridden.network().unwrap(), Case::window(ridden.log()).unwrap()).unwrap();
    for name in ["runs/a.case.mcap", "elsewhere/a.case.mcap"] {
        fs::write(at(name), case.encode().unwrap()).unwrap();
    }
    let of = |places: &[PathBuf]| {
        let Library { cases, rides, failed } = Library::of(places);
        assert_eq!(failed, []);
        (cases.len(), rides.into_iter().map(|group| (group.checkpoint, group.rides.len())).collect::<Vec<_>>())
    };
    let (old, new) = (|rides| ("old".to_owned(), rides), ("new".to_owned(), 1));
    assert_eq!(of(&[at("runs")]), (1, vec![old(1), new.clone()]), "anywhere below a folder");
    assert_eq!(of(&[at("calm"), at("runs")]), (1, vec![old(2), new]), "a folder without a case was driven, too");
    assert_eq!(of(&[at("runs/a.case.mcap")]), (1, vec![old(1)]), "beside a file, and nowhere else");
    assert_eq!(of(&[at("elsewhere/a.case.mcap"), calm]), (1, vec![old(1)]), "a recording stands for itself");
    assert_eq!(of(&[at("elsewhere")]), (1, vec![]));
}
