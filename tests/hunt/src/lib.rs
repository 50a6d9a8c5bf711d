//! Looks for files that a parser cannot cope with. In a test run a number of cases is tried; with
//! `AEYE_FUZZ_MINUTES`, cases are tried until the time is over or [`MOST_CASES`] were.
//!
//! What is tried lies in a folder of its own ([`trying`]) and stays there when the program ends by it.

mod limits;

use std::cell::RefCell;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, TestCaseResult, TestError, TestRunner};
use tempfile::TempDir;

/// How many cases are enough, however much time is left.
pub const MOST_CASES: u32 = 1_000_000;
/// Cases between two looks at the clock.
const BATCH: u32 = 50;
/// Tries at making what was found smaller.
const SHRINK_TRIES: u32 = 2_000;

thread_local! {
    /// Where what is tried lies.
    static FOLDER: RefCell<Option<TempDir>> = const { RefCell::new(None) };
}

/// Tries `cases` cases, or as many as there is time for.
///
/// # Panics
/// On the smallest case found on which `test` fails or panics; says in which folder it lies.
pub fn hunt<S: Strategy>(name: &str, cases: u32, strategy: S, test: impl Fn(S::Value) -> TestCaseResult) {
    let Some(minutes) = minutes() else { return run(name, cases, &strategy, &test) };
    let (started, mut tried) = (Instant::now(), 0);
    limits::watch();
    while started.elapsed() < Duration::from_secs_f64(minutes * 60.0) && tried < MOST_CASES {
        run(name, BATCH, &strategy, &test);
        tried += BATCH;
    }
    let (seconds, megabytes) = (started.elapsed().as_secs(), limits::peak_kb() / 1000);
    println!("{name}: {tried} cases in {seconds} s, at most {megabytes} MB, nothing found");
}

/// Lays down what is tried next, instead of the last: files with their names, in the folder that it gives.
pub fn trying(files: &[(&str, &[u8])]) -> PathBuf {
    limits::begin();
    let folder = FOLDER.with_borrow_mut(|folder| {
        let folder = folder.get_or_insert_with(|| tempfile::tempdir().expect("a folder"));
        folder.path().join("damaged")
    });
    // The first time nothing is there.
    let _ = fs::remove_dir_all(&folder);
    for (name, bytes) in files {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().expect("it is in the folder")).expect("a folder");
        fs::write(path, bytes).expect("writable");
    }
    folder
}

fn run<S: Strategy>(name: &str, cases: u32, strategy: &S, test: &impl Fn(S::Value) -> TestCaseResult) {
    let config = Config { cases, failure_persistence: None, max_shrink_iters: SHRINK_TRIES, ..Config::default() };
    match TestRunner::new(config).run(strategy, test) {
        Ok(()) => {}
        Err(TestError::Abort(reason)) => panic!("{name}: {reason}"),
        Err(TestError::Fail(reason, smallest)) => {
            // What was tried last need not be the smallest that fails.
            let _ = catch_unwind(AssertUnwindSafe(|| test(smallest)));
            let folder = FOLDER.take().map(TempDir::keep).unwrap_or_default();
            panic!("{name}: {reason}; what was tried is in {}", folder.display());
        }
    }
}

fn minutes() -> Option<f64> {
    let text = std::env::var("AEYE_FUZZ_MINUTES").ok()?;
    Some(text.parse().expect("AEYE_FUZZ_MINUTES is a number"))
}
