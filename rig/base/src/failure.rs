//! What can go wrong with a command, beyond what libraries say.

use std::fmt;
use std::io::{self, ErrorKind};
use std::path::Path;

use serde::Serialize;

/// The command line asks for something that does not exist or contradicts itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Usage(pub String);

impl std::fmt::Display for Usage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

/// Another process has what is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InUse(pub String);

impl fmt::Display for InUse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for InUse {}

/// Whether the same command may go well later on: another process is at work, or the system has no room now.
pub fn may_pass(error: &anyhow::Error) -> bool {
    let passes = |kind| {
        matches!(
            kind,
            ErrorKind::StorageFull
                | ErrorKind::QuotaExceeded
                | ErrorKind::OutOfMemory
                | ErrorKind::TimedOut
                | ErrorKind::StaleNetworkFileHandle
        )
    };
    error.is::<InUse>() || error.chain().any(|e| e.downcast_ref::<io::Error>().is_some_and(|e| passes(e.kind())))
}

/// A file among many that a command could not work on, while it went on with the rest.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Failure {
    /// The file or folder.
    pub file: String,
    /// Why, in a sentence that names it.
    pub error: String,
    /// Whether its replay is not the run that was recorded.
    #[serde(skip)]
    pub is_divergence: bool,
}

impl Failure {
    /// That of a file.
    pub fn new(path: &Path, error: &anyhow::Error) -> Self {
        let (file, mut text) = (path.display().to_string(), sentence(error));
        let name = one_line(&file);
        if !text.contains(&name) {
            text = format!("{name}: {text}");
        }
        Self { file, error: text, is_divergence: is_divergence(error) }
    }

    /// That of a file whose replay is not the run that was recorded.
    pub fn diverged(path: &Path) -> Self {
        let file = path.display().to_string();
        Self { error: format!("{file}: its replay is not the run that was recorded"), file, is_divergence: true }
    }
}

/// What a command over many files ends with when some of them, or all, could not be worked on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failed {
    failures: Vec<Failure>,
    /// Files that went well.
    rest: usize,
}

impl Failed {
    /// Of a command for which nothing is left.
    pub fn new(failures: Vec<Failure>) -> Self {
        Self { failures, rest: 0 }
    }

    /// An error if there are failures; so many files went well.
    pub fn check(failures: &[Failure], rest: usize) -> anyhow::Result<()> {
        if failures.is_empty() { Ok(()) } else { Err(Self { failures: failures.to_vec(), rest }.into()) }
    }

    /// What is said of each of several files before the error itself.
    pub fn sentences(&self) -> impl Iterator<Item = &str> {
        let several = self.rest + self.failures.len() > 1;
        self.failures.iter().filter(move |_| several).map(|failure| failure.error.as_str())
    }
}

impl fmt::Display for Failed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.rest, self.failures.as_slice()) {
            (0, []) => f.write_str("no file is left"),
            (0, [only]) => f.write_str(&only.error),
            (rest, failures) => write!(f, "{} of {} files failed", failures.len(), rest + failures.len()),
        }
    }
}

impl std::error::Error for Failed {}

/// Whether an error says that a replay is not the run that was recorded, and nothing worse; of several files
/// each must say so.
pub fn is_divergence(error: &anyhow::Error) -> bool {
    if let Some(failed) = error.downcast_ref::<Failed>() {
        return failed.failures.iter().all(|failure| failure.is_divergence);
    }
    let diverged = |error: &replay::Error| matches!(error, replay::Error::Diverged(_));
    error.chain().any(|e| e.downcast_ref::<replay::Error>().is_some_and(diverged))
}

/// An error with its causes as one line; what the text tells already of a cause is left out.
pub fn sentence(error: &anyhow::Error) -> String {
    let mut text = error.to_string();
    for cause in error.chain().skip(1).map(ToString::to_string) {
        if !text.contains(&cause) {
            let news = beyond(&text, &cause);
            text = format!("{text}: {news}");
        }
    }
    one_line(&text)
}

fn one_line(text: &str) -> String {
    text.lines().map(str::trim).collect::<Vec<_>>().join(" ")
}

/// What a cause says after the names that a text has said before it: of `a: damaged` after `a`, `damaged`.
fn beyond<'a>(text: &str, cause: &'a str) -> &'a str {
    let has_said = |name: &str| text.split(": ").any(|said| said == name);
    match cause.split_once(": ") {
        Some((name, rest)) if has_said(name) => beyond(text, rest),
        _ => cause,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::Context;

    #[test]
    fn one_file_says_why_and_several_say_how_many() {
        let failure = |file: &str| Failure::new(Path::new(file), &anyhow::anyhow!("no room"));
        let one = Failed::new(vec![failure("a.mcap")]);
        assert_eq!((one.to_string().as_str(), one.sentences().count()), ("a.mcap: no room", 0));
        let error = Failed::check(&[failure("a.mcap")], 2).expect_err("one failed");
        let failed = error.downcast_ref::<Failed>().expect("of files");
        assert_eq!(failed.to_string(), "1 of 3 files failed");
        assert_eq!(failed.sentences().collect::<Vec<_>>(), ["a.mcap: no room"]);
        assert!(!is_divergence(&error) && Failed::check(&[], 2).is_ok());
    }

    #[test]
    fn what_may_pass_is_told_from_what_will_not() {
        let io = |kind: ErrorKind| anyhow::Error::from(io::Error::from(kind)).context("a.mcap");
        assert!(may_pass(&io(ErrorKind::StorageFull)) && may_pass(&io(ErrorKind::QuotaExceeded)));
        assert!(may_pass(&InUse("a: another aeye is at work there".into()).into()));
        assert!(!may_pass(&io(ErrorKind::NotFound)) && !may_pass(&Usage("no such map".into()).into()));
    }

    #[test]
    fn a_failure_names_its_file_once_whatever_it_is_called() {
        for name in ["a.mcap", "a  b.mcap", "a\nb.mcap", "a: b.mcap"] {
            let failure = Failure::new(Path::new(name), &anyhow::anyhow!("{name}: no room"));
            assert_eq!(failure.error, format!("{}: no room", name.replace('\n', " ")));
        }
    }

    #[test]
    fn a_sentence_says_each_cause_once() {
        let cause: anyhow::Error = anyhow::anyhow!("no\n room");
        let error = Err::<(), _>(cause).context("b: no\n room").context("a").expect_err("one");
        assert_eq!(sentence(&error), "a: b: no room");
        let damaged = anyhow::anyhow!("a/x.mcap: damaged: chunk 3");
        assert_eq!(sentence(&damaged.context("a/x.mcap")), "a/x.mcap: damaged: chunk 3");
        let other = anyhow::anyhow!("a/x.mcap: damaged");
        assert_eq!(sentence(&other.context("b").context("a/x.mcap")), "a/x.mcap: b: damaged");
    }
}
