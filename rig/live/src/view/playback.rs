//! Where the viewer stands in a log, and how it goes on with time.

use kernel::time::{TICK_HZ, Tick};

/// Speeds that can be chosen, thousandths of real time.
pub const SPEEDS_PERMILLE: [u64; 7] = [100, 250, 500, 1000, 2000, 4000, 8000];
const REAL_TIME: usize = 3;
/// Parts that a tick is counted in.
const PARTS: u64 = 1_000_000;
/// While it plays, the screen is renewed at most this often, microseconds.
const SHORTEST_WAIT_US: u64 = 8_000;

const _: () = assert!(SPEEDS_PERMILLE[REAL_TIME] == 1000);

/// A position between the first and the last tick, and whether time moves it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Playback {
    first: Tick,
    last: Tick,
    /// Since tick 0, in [`PARTS`] of a tick.
    position: u64,
    speed: usize,
    is_playing: bool,
}

impl Playback {
    /// Stands still at the first tick.
    pub fn new(first: Tick, last: Tick) -> Self {
        Self { first, last, position: first * PARTS, speed: REAL_TIME, is_playing: false }
    }

    /// The tick that is to be seen.
    pub fn tick(&self) -> Tick {
        self.position / PARTS
    }

    /// Whether time moves the position.
    pub fn is_playing(&self) -> bool {
        self.is_playing
    }

    /// Thousandths of real time.
    pub fn speed_permille(&self) -> u64 {
        SPEEDS_PERMILLE[self.speed]
    }

    /// Starts or stops; at the end it starts from the beginning.
    pub fn toggle(&mut self) {
        self.is_playing = !self.is_playing && self.first < self.last;
        if self.is_playing && self.tick() >= self.last {
            self.position = self.first * PARTS;
        }
    }

    /// Goes to the beginning of a tick, or of the nearest that there is; it goes on playing if it did.
    pub fn seek(&mut self, tick: Tick) {
        self.position = tick.clamp(self.first, self.last) * PARTS;
    }

    /// Goes so many ticks on, or back, and stops there.
    pub fn step(&mut self, ticks: i64) {
        self.is_playing = false;
        self.seek(self.tick().saturating_add_signed(ticks));
    }

    /// Chooses the next higher or lower speed.
    pub fn change_speed(&mut self, up: bool) {
        self.speed = if up { (self.speed + 1).min(SPEEDS_PERMILLE.len() - 1) } else { self.speed.saturating_sub(1) };
    }

    /// Time has passed, microseconds. At the last tick it stops.
    pub fn advance(&mut self, elapsed_us: u64) {
        if !self.is_playing {
            return;
        }
        // Nobody notices hours between two looks; a product without bounds would.
        let elapsed_us = elapsed_us.min(3_600_000_000);
        self.position += elapsed_us * u64::from(TICK_HZ) * self.speed_permille() / 1000;
        if self.tick() >= self.last {
            self.seek(self.last);
            self.is_playing = false;
        }
    }

    /// Microseconds until there may be another tick to see; `None` while it stands still.
    pub fn wait_us(&self) -> Option<u64> {
        let missing = PARTS - self.position % PARTS;
        let wait_us = (missing * 1000).div_ceil(u64::from(TICK_HZ) * self.speed_permille());
        self.is_playing.then_some(wait_us.max(SHORTEST_WAIT_US))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn playing(last: Tick) -> Playback {
        let mut playback = Playback::new(0, last);
        playback.toggle();
        playback
    }

    #[test]
    fn a_second_is_sixty_ticks_times_the_speed() {
        for (i, permille) in SPEEDS_PERMILLE.into_iter().enumerate() {
            let mut playback = playing(1000);
            for _ in 0..REAL_TIME.abs_diff(i) {
                playback.change_speed(i > REAL_TIME);
            }
            playback.advance(1_000_000);
            assert_eq!(playback.tick(), 60 * permille / 1000, "{permille}");
        }
    }

    #[test]
    fn it_stops_at_the_end_and_starts_again_from_the_beginning() {
        let mut playback = playing(100);
        playback.advance(u64::MAX);
        assert_eq!((playback.tick(), playback.is_playing(), playback.wait_us()), (100, false, None));
        playback.toggle();
        assert_eq!((playback.tick(), playback.is_playing()), (0, true));
    }

    #[test]
    fn a_step_stops_and_stays_between_the_ends() {
        let mut playback = Playback::new(600, 700);
        playback.toggle();
        playback.advance(500_000);
        playback.step(-6);
        assert_eq!((playback.tick(), playback.is_playing()), (624, false));
        playback.step(-1000);
        assert_eq!(playback.tick(), 600);
        playback.step(i64::MAX);
        assert_eq!(playback.tick(), 700);
        playback.seek(Tick::MAX);
        assert_eq!(playback.tick(), 700);
    }

    #[test]
    fn a_log_of_one_tick_does_not_play() {
        let mut playback = Playback::new(5, 5);
        playback.toggle();
        assert!(!playback.is_playing());
    }

    proptest! {
        #[test]
        fn time_in_pieces_is_time_as_a_whole(pieces in prop::collection::vec(0u64..100_000, 1..50), ups in -3i32..=3) {
            let mut in_pieces = playing(1 << 30);
            for _ in 0..ups.abs() {
                in_pieces.change_speed(ups > 0);
            }
            let mut whole = in_pieces.clone();
            for piece in &pieces {
                in_pieces.advance(*piece);
            }
            whole.advance(pieces.iter().sum());
            // What is rounded away is less than a part for each piece.
            prop_assert!(whole.position - in_pieces.position <= pieces.len() as u64);
        }

        #[test]
        fn after_the_wait_there_is_another_tick(elapsed_us in 0u64..10_000_000, ups in -3i32..=3) {
            let mut playback = playing(1 << 30);
            for _ in 0..ups.abs() {
                playback.change_speed(ups > 0);
            }
            playback.advance(elapsed_us);
            let before = playback.tick();
            playback.advance(playback.wait_us().expect("it plays"));
            prop_assert!(playback.tick() > before);
        }
    }
}
