//! A device that nobody hears: samples are made when one would want them.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use sound::SAMPLE_HZ;

use super::outlet::Player;

/// Samples that are wanted at once, and how many times that are buffered: what is later than these is heard as a gap.
const PERIOD: usize = 480;
const BUFFERED: u32 = 4;

/// Plays until it is dropped.
pub struct Null {
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Null {
    /// Begins to play.
    pub fn open(mut player: Player) -> Self {
        let is_over = Arc::new(AtomicBool::new(false));
        let asked = is_over.clone();
        let period = Duration::from_secs(1) * PERIOD as u32 / SAMPLE_HZ;
        let thread = thread::spawn(move || {
            let mut due = Instant::now() + BUFFERED * period;
            while !asked.load(Ordering::Relaxed) {
                player.play(0..PERIOD, |_, _| {});
                let now = Instant::now();
                if now > due {
                    player.outlet().is_late();
                    due = now;
                }
                due += period;
                thread::sleep((due - BUFFERED * period).saturating_duration_since(now));
            }
        });
        Self { is_over, thread: Some(thread) }
    }
}

impl Drop for Null {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            drop(thread.join());
        }
    }
}
