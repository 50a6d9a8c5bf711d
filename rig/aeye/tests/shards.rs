//! A campaign in shards: whoever drives which of them when, and however often one is killed, together they are what
//! one process gives.

mod common;
#[path = "kills/street.rs"]
mod street;
#[path = "../../../tests/src/toy.rs"]
mod toy;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use base::output::OutputFolder;
use common::{aeye, run};
use serde_json::Value;

/// All are corner cases, whatever pictures look like: the network sees nothing but road.
const RUNS: u32 = 5;
const DRIVES: &str = "campaign --checkpoint road.onnx --maps street.xodr --pedestrians 160 --hazards raised --max-time 14s \
                      --seed 6";

/// A folder in which campaigns are driven.
struct Place(PathBuf);

impl Place {
    fn at(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Drives a campaign, or a shard of it, which goes well.
    fn drive(&self, tail: &str) -> String {
        let (code, out, said) = run(&mut aeye(&self.0, &format!("{DRIVES} --jobs 2 {tail}")));
        assert_eq!(code, Some(0), "{tail}: {said}");
        out
    }

    /// Drives all shards up to a goal.
    fn drive_shards(&self, goal: &str) {
        for shard in 1..=3 {
            self.drive(&format!("{goal} --shard {shard}/3 --out shards/{shard}"));
        }
    }

    /// Exit code of putting folders together, and what is said.
    fn collect(&self, folders: &str, out: &str) -> (Option<i32>, String) {
        let (code, _, said) = run(&mut aeye(&self.0, &format!("campaign --collect {folders} --out {out}")));
        assert!(code == Some(0) || !self.at(out).exists(), "{folders}: {out} is there: {said}");
        (code, said)
    }

    /// Expects a sentence that holds these words.
    fn refuses(&self, folders: &str, code: i32, words: &[&str]) {
        let (got, said) = self.collect(folders, "refused");
        assert!(got == Some(code) && words.iter().all(|word| said.contains(word)), "{folders}: {got:?}: {said}");
        assert_eq!(said.lines().filter(|line| line.starts_with("error: ")).count(), 1, "{said}");
    }

    /// A copy of a folder of files, of which `shard.json` holds one text instead of another.
    fn copy(&self, from: &str, to: &str, (text, instead): (&str, &str)) {
        fs::create_dir(self.at(to)).expect("writable");
        for (name, bytes) in contents(&self.at(from)) {
            fs::write(self.at(to).join(name), bytes).expect("writable");
        }
        let path = self.at(to).join("shard.json");
        let shard = fs::read_to_string(&path).expect("there");
        assert!(shard.contains(text), "{text}: {shard}");
        fs::write(path, shard.replacen(text, instead, 1)).expect("writable");
    }

    /// Lets the runs of a campaign wait for one that drives the same, as if it had been killed.
    fn let_wait(&self, whole: &str, campaign: &str) {
        let waiting = self.at(campaign).join(".waiting/road");
        fs::create_dir_all(&waiting).expect("writable");
        for (name, bytes) in contents(&self.at(whole)) {
            fs::write(waiting.join(name), bytes).expect("writable");
        }
    }

    /// Drives a shard and kills it between its first run and its last one; the first one stays as it is.
    fn drive_killed(&self, tail: &str, first: &str) {
        let mut child = aeye(&self.0, &format!("{DRIVES} --jobs 1 {tail}")).spawn().expect("the program starts");
        let path = self.at(first);
        while !path.exists() {
            assert!(child.try_wait().expect("a child").is_none(), "it still drives");
            std::thread::sleep(Duration::from_millis(10));
        }
        child.kill().expect("it can be killed");
        assert!(!child.wait().expect("it ends").success());
        let modified = || fs::metadata(&path).and_then(|about| about.modified()).expect("a file");
        let before = modified();
        self.drive(tail);
        assert_eq!(modified(), before, "it was driven again");
    }
}

/// The files of a folder that holds no others.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).expect("a readable folder").map(|entry| entry.expect("an entry"));
    let read = |path: PathBuf| fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    entries.map(|entry| (entry.file_name().to_string_lossy().into_owned(), read(entry.path()))).collect()
}

fn assert_same(one: &Path, another: &Path) {
    let (one, another) = (contents(one), contents(another));
    assert_eq!(one.keys().collect::<Vec<_>>(), another.keys().collect::<Vec<_>>());
    let differing: Vec<_> =
        one.iter().filter(|(name, bytes)| another[*name] != **bytes).map(|(name, _)| name).collect();
    assert!(differing.is_empty(), "{differing:?}");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn shards_together_are_what_one_process_gives() {
    let dir = tempfile::tempdir().expect("a folder");
    let place = Place(dir.path().to_owned());
    street::street(&place.at("street.xodr"));
    toy::all_road(&place.0);
    let whole = format!("--runs {RUNS}");
    place.drive(&format!("{whole} --out whole"));

    // A run takes from its number alone what it is, so the order of shards is nobody's matter.
    place.drive(&format!("{whole} --shard 3/3 --out shards/3"));
    place.drive_killed(&format!("{whole} --shard 2/3 --out shards/2"), "shards/2/road-0001.mcap");
    place.refuses("shards", 3, &["runs are missing: road 0, 3; expected all of --shard 1/3"]);
    place.refuses("shards/2 elsewhere", 3, &["elsewhere: holds no shard.json", "road 0, 2, 3; ", "--shard 1/3, 3/3"]);
    let claim = OutputFolder::open(&place.at("shards/1")).expect("free");
    let first = format!("{whole} --shard 1/3 --out shards/1");
    let (code, _, said) = run(&mut aeye(dir.path(), &format!("{DRIVES} {first}")));
    assert!(code == Some(75) && said.contains("another aeye is at work there"), "{said}");
    drop(claim);
    let said = place.drive(&first);
    assert!(said.starts_with("shard 1/3: 2 runs, "), "{said}");

    assert_eq!(place.collect("shards/3 shards/1 shards/2", "together").0, Some(0));
    assert_same(&place.at("whole"), &place.at("together"));
    fs::remove_file(place.at("together/campaign.json")).expect("it was there");
    assert_eq!(place.collect("shards", "together").0, Some(0), "it goes on where it was killed");
    assert_same(&place.at("whole"), &place.at("together"));

    mixtures_are_told(&place);
    goals_end_at_the_run_that_reaches_them(&place);
}

/// Shards of other campaigns, programs and machines.
fn mixtures_are_told(place: &Place) {
    let other = format!("--runs {RUNS} --shard 1/3 --out shards/1 --max-time 15s");
    let (code, _, said) = run(&mut aeye(&place.0, &format!("{} {other}", DRIVES.replace("--max-time 14s ", ""))));
    assert!(code == Some(1) && said.contains("shards/1/shard.json: run_seconds is 14 there, 15 here"), "{said}");
    let (code, _, said) = run(&mut aeye(&place.0, &format!("{DRIVES} --runs 1 --out new shards/1")));
    assert!(code == Some(2) && said.contains("shards/1: is given to a campaign; expected --collect"), "{said}");
    let other = format!("--runs {RUNS} --shard 1/2 --out shards/1");
    let (code, _, said) = run(&mut aeye(&place.0, &format!("{DRIVES} {other}")));
    assert!(code == Some(1) && said.contains("is of shard 1/3, this is 1/2"), "{said}");

    let (code, _, said) = run(&mut aeye(&place.0, &format!("{DRIVES} --runs {RUNS} --shard 1/3 --out whole")));
    assert!(code == Some(1) && said.contains("whole: holds a whole campaign"), "{said}");

    place.copy("shards/1", "plan", ("\"pedestrians\": 160", "\"pedestrians\": 50"));
    place.refuses("shards/2 shards/3 plan", 1, &["plan/shard.json: pedestrians is 50, in shards/2 it is 160"]);
    place.copy("shards/1", "build", ("\"sources\": \"", "\"sources\": \"0123456789ab"));
    place.refuses(
        "shards/2 shards/3 build",
        1,
        &["build/shard.json: was driven by", "sources 0123456789ab", "shards/2"],
    );

    place.copy("shards/1", "machine", ("\"cpu_features\": [", "\"cpu_features\": [\"abacus\", "));
    let (code, said) = place.collect("shards/2 machine shards/3", "mixed");
    assert!(code == Some(0) && said.contains("machines of 2 kinds drove") && said.contains("abacus"), "{said}");
    let figures: Value = serde_json::from_slice(&contents(&place.at("mixed"))["campaign.json"]).expect("JSON");
    assert_eq!(figures["machines"][1]["cpu_features"][0], "abacus");

    place.copy("shards/1", "twice", ("", ""));
    assert_eq!(place.collect("shards twice", "twofold").0, Some(0));
    assert_same(&place.at("whole"), &place.at("twofold"));
    let verdict = contents(&place.at("twice")).into_keys().find(|name| name.contains("counterfactual"));
    let verdict = place.at("twice").join(verdict.expect("a run with an intervention"));
    fs::write(&verdict, fs::read_to_string(&verdict).expect("there") + "\n").expect("writable");
    place.refuses("shards twice", 1, &["counterfactual.json: differs from shards/1/road-"]);
}

/// What is enough is known only when all shards have driven.
fn goals_end_at_the_run_that_reaches_them(place: &Place) {
    for (name, goal) in [("cases", "--cases 1"), ("km", "--km 0.11")] {
        place.let_wait("whole", name);
        place.drive(&format!("{goal} --out {name}"));
        place.drive_shards(&format!("{goal} --runs {RUNS}"));
        assert_eq!(place.collect("shards", &format!("{name}-together")).0, Some(0));
        assert_same(&place.at(name), &place.at(&format!("{name}-together")));
        let runs = contents(&place.at(name)).into_keys().filter(|file| file.starts_with("road-"));
        assert!(
            runs.filter(|file| file.matches('.').count() == 1).count() < RUNS as usize,
            "{name}: nothing is left out"
        );
    }
    place.drive_shards(&format!("--cases 50 --runs {RUNS}"));
    place.refuses("shards", 3, &["road: 5 runs came to 5 of 50 corner cases; ", "expected a greater --runs"]);
}
