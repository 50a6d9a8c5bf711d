//! What one case may take: the program ends by one that takes more, and what was tried stays.

use std::fs;
use std::sync::Once;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

/// Of all threads together.
const MOST_CPU_S: f64 = 5.0;
/// Above what the program held when it began: a network may hold 1 GiB of values and half of that of weights.
const MOST_KB: u64 = 2_000_000;
/// Clock ticks of Linux in a second, as `/proc` counts them.
const CLOCK_HZ: f64 = 100.0;
/// Exit code of a program that took too much.
const TOO_MUCH: i32 = 70;

/// CPU time when the present case began, clock ticks.
static BEGUN: AtomicU64 = AtomicU64::new(0);

/// A case begins.
pub fn begin() {
    BEGUN.store(cpu_ticks(), Ordering::Relaxed);
}

/// Looks at the present case from now on.
pub fn watch() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let most_kb = peak_kb() + MOST_KB;
        begin();
        thread::spawn(move || {
            loop {
                thread::sleep(Duration::from_millis(20));
                let used_s = cpu_ticks().saturating_sub(BEGUN.load(Ordering::Relaxed)) as f64 / CLOCK_HZ;
                if used_s > MOST_CPU_S || peak_kb() > most_kb {
                    eprintln!("a case took {used_s} s and {} kB; expected {MOST_CPU_S} s and {most_kb} kB", peak_kb());
                    std::process::exit(TOO_MUCH);
                }
            }
        });
    });
}

/// CPU time of this program; 0 where nothing says it.
fn cpu_ticks() -> u64 {
    let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The name, in brackets, may hold spaces.
    let numbers = stat.rsplit(')').next().unwrap_or_default();
    numbers.split_whitespace().skip(11).take(2).filter_map(|n| n.parse::<u64>().ok()).sum()
}

/// Greatest memory of this program so far; 0 where nothing says it.
pub fn peak_kb() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(0)
}
