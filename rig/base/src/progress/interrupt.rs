//! Ctrl-C and its like: who listens comes to an end in good order, all others end at once.

use std::process::exit;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::sync::{Arc, OnceLock};

use crate::say::say;

/// What shells add to the number of a signal that ended a process.
const ENDED_BY_SIGNAL: u8 = 128;

/// Raised by Ctrl-C; long work looks at it between its steps and can be resumed.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicBool>);

/// The flag of all who listen, if anybody does.
static SHARED: OnceLock<Interrupt> = OnceLock::new();
/// The exit code that the first signal asks for; 0 before.
static CODE: AtomicU8 = AtomicU8::new(0);

impl Interrupt {
    /// Listens from now on; everyone who listens shares the flag.
    pub fn listen() -> Self {
        SHARED.get_or_init(Self::default).clone()
    }

    /// Asks everyone who shares the flag to stop.
    pub fn raise(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the work is to end.
    pub fn is_raised(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// The exit code of this process if a signal has interrupted it: 128 and the signal's number.
pub fn interrupted() -> Option<u8> {
    Some(CODE.load(Ordering::Relaxed)).filter(|code| *code != 0)
}

/// Hears of every signal that asks the process to end, from now on. To be called before there are other threads.
pub fn watch_signals() -> anyhow::Result<()> {
    system::each_signal(heard)
}

/// The first signal asks whoever listens to end; where nobody does, and at the next, the process ends at once.
fn heard(number: u8) {
    let code = ENDED_BY_SIGNAL.saturating_add(number);
    let is_first = CODE.compare_exchange(0, code, Ordering::Relaxed, Ordering::Relaxed).is_ok();
    say("interrupted");
    match SHARED.get() {
        Some(interrupt) if is_first => interrupt.0.store(true, Ordering::Relaxed),
        _ => exit(code.into()),
    }
}

#[cfg(unix)]
mod system {
    use std::fs;
    use std::thread;

    use anyhow::Context;
    use nix::sys::signal::{SigSet, Signal};

    const ENDING: [Signal; 3] = [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP];

    /// Signals are blocked in this thread and those that it starts, and waited for in one of their own.
    pub fn each_signal(heard: fn(u8)) -> anyhow::Result<()> {
        let ignored = ignored();
        let set: SigSet = ENDING.into_iter().filter(|signal| ignored >> (*signal as u32 - 1) & 1 == 0).collect();
        set.thread_block().context("listening to signals")?;
        thread::spawn(move || {
            while let Ok(signal) = set.wait() {
                heard(signal as u8);
            }
        });
        Ok(())
    }

    /// A bit for each signal that whoever started the process wants ignored, as `nohup` does; none where the system
    /// does not tell.
    fn ignored() -> u64 {
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or_default()
    }
}

#[cfg(not(unix))]
mod system {
    use anyhow::Context;

    /// What Ctrl-C is called elsewhere.
    const INTERRUPT: u8 = 2;

    pub fn each_signal(heard: fn(u8)) -> anyhow::Result<()> {
        ctrlc::set_handler(move || heard(INTERRUPT)).context("listening to Ctrl-C")
    }
}
