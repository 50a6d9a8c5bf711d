//! Long work, which Ctrl-C ends and which lets Python's other threads go on.

use std::panic::resume_unwind;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use base::failure::Failed;
use base::json::json_line;
use base::progress::Interrupt;
use lab::share::ShareDone;
use pyo3::prelude::*;

use crate::errors::raise;
use crate::external::Raised;

/// How often it is asked whether Ctrl-C was pressed: only the interpreter's own thread is told.
const ASK_EVERY: Duration = Duration::from_millis(50);

/// Does work on a thread of its own. Ctrl-C raises its interrupt; when the work has come to its end, so does
/// `KeyboardInterrupt`.
pub fn work<T: Send>(py: Python<'_>, work: impl FnOnce(&Interrupt) -> anyhow::Result<T> + Send) -> PyResult<T> {
    let interrupt = Interrupt::default();
    thread::scope(|scope| {
        let (sender, mut done) = channel();
        let asked = interrupt.clone();
        let worker = scope.spawn(move || sender.send(work(&asked)));
        let mut stopped = None;
        loop {
            let (result, receiver) = py.detach(move || (done.recv_timeout(ASK_EVERY), done));
            done = receiver;
            match result {
                Ok(result) => return stopped.map_or_else(|| result.map_err(|error| raise(&error)), Err),
                Err(RecvTimeoutError::Timeout) => {
                    if let Err(error) = py.check_signals() {
                        interrupt.raise();
                        stopped = Some(error);
                    }
                }
                // Only a panic leaves without a result.
                Err(RecvTimeoutError::Disconnected) => match worker.join() {
                    Err(panic) => resume_unwind(panic),
                    Ok(_) => unreachable!("a worker that is done has sent its result"),
                },
            }
        }
    })
}

/// A line that `--json` prints as a dictionary.
pub fn parsed<'py>(py: Python<'py>, line: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (line,))
}

/// The same, whose rows under a key are a table.
pub fn tabled<'py>(py: Python<'py>, line: &str, rows: &str) -> PyResult<Bound<'py, PyAny>> {
    let parsed = parsed(py, line)?;
    let table = py.import("aeye._tables")?.call_method1("Table", (parsed.get_item(rows)?,))?;
    parsed.set_item(rows, table)?;
    Ok(parsed)
}

/// What a share of some work came to, as `--json` prints it.
pub fn shared<'py>(
    py: Python<'py>,
    raised: &Raised,
    share: impl FnOnce(&Interrupt) -> anyhow::Result<ShareDone> + Send,
) -> PyResult<Bound<'py, PyAny>> {
    let line = work(py, |interrupt| {
        let done = share(interrupt)?;
        Failed::check(&done.failed, done.done)?;
        json_line(&done)
    });
    parsed(py, &raised.or(line)?)
}
