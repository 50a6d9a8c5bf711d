//! What the simulation says is heard, and who plays it: neither waits for the other.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError, TryLockError};

use sound::{Heard, Mixer};

/// What is to be heard, shared by the simulation and a player.
#[derive(Debug, Default)]
pub struct Outlet {
    newest: Mutex<Option<Heard>>,
    is_muted: AtomicBool,
    is_lost: AtomicBool,
    late: AtomicU64,
}

impl Outlet {
    /// This is heard from now on. Cues of what nobody took in are not lost.
    pub fn put(&self, mut heard: Heard) {
        if self.is_lost() {
            return;
        }
        let mut newest = self.newest.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(missed) = newest.take() {
            heard.cues.splice(0..0, missed.cues);
        }
        *newest = Some(heard);
    }

    /// Plays nothing, or plays again.
    pub fn mute(&self, is_muted: bool) {
        self.is_muted.store(is_muted, Ordering::Relaxed);
    }

    /// Its device is gone; whether it was not before.
    pub fn lose(&self) -> bool {
        !self.is_lost.swap(true, Ordering::Relaxed)
    }

    /// Whether its device is gone.
    pub fn is_lost(&self) -> bool {
        self.is_lost.load(Ordering::Relaxed)
    }

    /// Samples came later than the device wanted them.
    pub fn is_late(&self) {
        self.late.fetch_add(1, Ordering::Relaxed);
    }

    /// How often they did.
    pub fn late_count(&self) -> u64 {
        self.late.load(Ordering::Relaxed)
    }

    /// What was put since it was asked for last. Nobody waits: what is just being put is taken the next time.
    fn take(&self) -> Option<Heard> {
        match self.newest.try_lock() {
            Ok(mut newest) => newest.take(),
            Err(TryLockError::Poisoned(newest)) => newest.into_inner().take(),
            Err(TryLockError::WouldBlock) => None,
        }
    }
}

/// Makes the samples of an outlet, on the thread that a device asks for them.
pub struct Player {
    outlet: Arc<Outlet>,
    mixer: Mixer,
}

impl Player {
    /// Plays what is put into an outlet.
    pub fn new(outlet: Arc<Outlet>, sample_hz: u32) -> Self {
        Self { outlet, mixer: Mixer::new(sample_hz) }
    }

    /// The next samples, left and right, for each of `frames`.
    pub fn play<F>(&mut self, frames: impl Iterator<Item = F>, mut fill: impl FnMut(F, [f32; 2])) {
        if let Some(heard) = self.outlet.take() {
            self.mixer.hear(&heard);
        }
        self.mixer.set_volume(if self.outlet.is_muted.load(Ordering::Relaxed) { 0.0 } else { 1.0 });
        for frame in frames {
            fill(frame, self.mixer.sample());
        }
    }

    /// What it plays.
    pub fn outlet(&self) -> Arc<Outlet> {
        self.outlet.clone()
    }
}

#[cfg(test)]
mod tests {
    use sound::{Cue, SAMPLE_HZ};

    use super::*;

    fn loudest(player: &mut Player, samples: usize) -> f32 {
        let mut loudest = 0.0_f32;
        player.play(0..samples, |_, [left, right]| loudest = loudest.max(left.abs()).max(right.abs()));
        loudest
    }

    #[test]
    fn cues_are_heard_once_however_late_they_are_taken() {
        let outlet = Arc::new(Outlet::default());
        let mut player = Player::new(outlet.clone(), SAMPLE_HZ);
        assert_eq!(loudest(&mut player, 4800), 0.0);
        outlet.put(Heard { cues: vec![Cue::Takeover], ..Heard::default() });
        outlet.put(Heard::default());
        assert!(loudest(&mut player, 9600) > 0.05);
        loudest(&mut player, 96_000);
        assert!(loudest(&mut player, 4800) < 1e-4);
    }

    #[test]
    fn who_is_muted_is_silent_and_goes_on_where_it_would_be() {
        let outlet = Arc::new(Outlet::default());
        let mut player = Player::new(outlet.clone(), SAMPLE_HZ);
        outlet.put(Heard { speed_mps: 14.0, ..Heard::default() });
        outlet.mute(true);
        loudest(&mut player, 48_000);
        assert_eq!(loudest(&mut player, 4800), 0.0);
        outlet.mute(false);
        assert!(loudest(&mut player, 9600) > 0.01);
    }

    #[test]
    fn what_nobody_plays_is_not_kept() {
        let outlet = Outlet::default();
        assert_eq!([outlet.lose(), outlet.lose()], [true, false], "it is said once");
        outlet.put(Heard { cues: vec![Cue::Ended], ..Heard::default() });
        assert_eq!(outlet.take(), None);
    }

    #[test]
    fn a_player_does_not_wait_for_who_puts() {
        let outlet = Arc::new(Outlet::default());
        let mut player = Player::new(outlet.clone(), SAMPLE_HZ);
        outlet.put(Heard { horn: true, ..Heard::default() });
        let held = outlet.newest.lock().unwrap();
        assert_eq!(loudest(&mut player, 4800), 0.0, "it plays on what it heard before");
        drop(held);
        assert!(loudest(&mut player, 4800) > 0.05);
    }
}
