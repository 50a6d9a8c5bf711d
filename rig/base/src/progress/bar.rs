//! A bar where stderr is a terminal; elsewhere a line now and then, as logs have it.

use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use crate::clock::Every;
use crate::say::say;

/// From one line of a log to the next, at least.
const LINE_EVERY: Duration = Duration::from_secs(30);

/// How far a piece of work is.
pub struct Bar {
    drawn: ProgressBar,
    log: Option<Log>,
}

/// Lines in the place of a drawing.
struct Log {
    what: String,
    due: Mutex<Every>,
    say: Box<dyn Fn(String) + Send + Sync>,
}

/// Begins to show how far a piece of work with so many steps is.
pub fn bar(what: &str, steps: u64) -> Bar {
    let style = ProgressStyle::with_template("{prefix:>12} [{bar:32}] {pos}/{len} {msg} ({per_sec}, {eta} left)");
    let drawn = ProgressBar::new(steps).with_prefix(what.to_owned());
    let drawn = match style {
        Ok(style) => drawn.with_style(style.progress_chars("=> ")),
        Err(_) => drawn,
    };
    let log = (!std::io::stderr().is_terminal()).then(|| Log::new(what, LINE_EVERY, say));
    Bar { drawn, log }
}

impl Bar {
    /// Shows nothing.
    pub fn hidden() -> Self {
        Self { drawn: ProgressBar::hidden(), log: None }
    }

    /// So many more steps are done.
    pub fn inc(&self, steps: u64) {
        self.drawn.inc(steps);
        self.tell();
    }

    /// So many steps are done.
    pub fn set_position(&self, steps: u64) {
        self.drawn.set_position(steps);
        self.tell();
    }

    /// So many steps there are.
    pub fn set_length(&self, steps: u64) {
        self.drawn.set_length(steps);
    }

    /// What else there is to say.
    pub fn set_message(&self, message: String) {
        self.drawn.set_message(message);
    }

    /// Does something that prints lines of its own.
    pub fn suspend<T>(&self, print: impl FnOnce() -> T) -> T {
        self.drawn.suspend(print)
    }

    /// The work is over.
    pub fn finish_and_clear(&self) {
        self.drawn.finish_and_clear();
    }

    fn tell(&self) {
        let Some(log) = self.log.as_ref().filter(|log| log.is_due()) else { return };
        let (done, of) = (self.drawn.position(), self.drawn.length().unwrap_or_default());
        let line = format!("{}: {done} of {of} {}", log.what, self.drawn.message());
        (log.say)(line.trim_end().to_owned());
    }
}

impl Log {
    fn new(what: &str, every: Duration, say: impl Fn(String) + Send + Sync + 'static) -> Self {
        Self { what: what.to_owned(), due: Mutex::new(Every::next(every)), say: Box::new(say) }
    }

    fn is_due(&self) -> bool {
        self.due.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).is_due()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;

    #[test]
    fn a_log_says_how_far_the_work_is_and_no_more_often_than_it_may() {
        let told = |every: Duration| {
            let (sender, lines) = channel();
            let bar = Bar { log: Some(Log::new("runs", every, move |line| drop(sender.send(line)))), ..Bar::hidden() };
            bar.set_length(3);
            bar.inc(1);
            bar.set_message("loss 0.5".into());
            bar.set_position(3);
            drop(bar);
            lines.iter().collect::<Vec<_>>()
        };
        assert_eq!(told(Duration::ZERO), ["runs: 1 of 3", "runs: 3 of 3 loss 0.5"]);
        assert!(told(LINE_EVERY).is_empty());
    }
}
