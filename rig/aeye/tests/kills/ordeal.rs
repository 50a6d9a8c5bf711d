//! A command that is killed, started again, killed again, and so on.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::contents::{assert_same, contents, finished, is_temporary};
use crate::draws::Draws;
use crate::program::{Start, start};

/// The table of a redrive tells of the last call alone: each call takes that of the one before away.
const OF_LAST_CALL: &str = "redrive.jsonl";

/// What came of it.
#[derive(Default)]
struct Tally {
    kills: u32,
    /// Starts that nothing was there for.
    fresh: u32,
    /// Kills that left a file or folder half-written.
    torn: u32,
}

/// Kills a command as often as it is to be. It runs in a folder of its own, beside what `prepare` writes; `look` sees
/// every start, and whether it began with nothing.
pub fn survive(
    command: &'static str,
    arguments: &str,
    prepare: impl FnOnce(&Path),
    mut look: impl FnMut(&Start, bool),
) {
    let (dir, mut draws) = (tempfile::tempdir().expect("a folder"), Draws::of(command));
    let root = dir.path();
    ["whole", "killed", "tmp"].iter().for_each(|name| fs::create_dir(root.join(name)).expect("writable"));
    prepare(root);
    let within = start(root, "whole", arguments, None).took;
    let (whole, folder) = (contents(&root.join("whole")), root.join("killed"));
    let (mut tally, mut known) = (Tally::default(), BTreeSet::new());
    let mut is_fresh = true;
    loop {
        let aim = (tally.kills < draws.kills()).then(|| draws.aim(within));
        let started = start(root, "killed", arguments, aim);
        let (now, context) = (contents(&folder), format!("{command}, {} kills, {aim:?}", tally.kills));
        look(&started, is_fresh);
        tally.fresh += u32::from(is_fresh);
        is_fresh = !started.was_killed;
        if started.was_killed {
            tally.kills += 1;
            tally.torn += u32::from(now.keys().any(|name| is_temporary(name)));
            let there = finished(&now, &whole);
            let lost: Vec<_> = known.difference(&there).filter(|name| !name.ends_with(OF_LAST_CALL)).collect();
            assert!(lost.is_empty(), "{context}: lost: {lost:?}");
            known = there;
            continue;
        }
        assert_same(&now, &whole, &context);
        if aim.is_none() {
            break;
        }
        fs::remove_dir_all(&folder).and_then(|()| fs::create_dir(&folder)).expect("writable");
        known.clear();
    }
    assert_eq!(contents(&root.join("tmp")).keys().collect::<Vec<_>>(), [""; 0], "{command}: left where nobody looks");
    let Tally { kills, fresh, torn } = tally;
    eprintln!("{command}: {kills} kills in {fresh} goes of {within:.1?}; {torn} left something half-written");
}
