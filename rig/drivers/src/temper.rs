//! Who the simulated people are: a population that is drawn by the run's seed.

use kernel::Seat;
use kernel::rng::{self, Stream};
use replay::Provenance;

/// Far from the numbers of those whose reaction times are drawn from the same stream.
const FIRST_ENTITY: u64 = 1 << 32;

/// What kind of driver somebody is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Temper {
    /// Half of all.
    #[default]
    Attentive,
    /// Brakes early and gently, turns slowly.
    Cautious,
    /// Brakes late and hard, turns fast.
    Sporty,
    /// Reacts late.
    Tired,
}

impl Temper {
    /// Everybody.
    pub const ALL: [Self; 4] = [Self::Attentive, Self::Cautious, Self::Sporty, Self::Tired];

    /// Who sits in a seat in the run of this seed.
    pub fn drawn(seed: u64, seat: Seat) -> Self {
        let share = rng::unit(seed, Stream::Driver, FIRST_ENTITY + seat as u64, 0);
        Self::ALL
            .into_iter()
            .zip([0.5, 0.7, 0.9])
            .find(|(_, end)| share < *end)
            .map_or(Self::Tired, |(temper, _)| temper)
    }

    /// As recordings and statistics call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Attentive => "attentive",
            Self::Cautious => "cautious",
            Self::Sporty => "sporty",
            Self::Tired => "tired",
        }
    }

    /// Where a recording says who sits in a seat.
    fn entry(seat: Seat) -> &'static str {
        match seat {
            Seat::Semantic => "semantic_temper",
            Seat::Safety => "safety_temper",
        }
    }

    /// What a recording says about those seats that bots have, in the run of a seed.
    pub fn entries(bots: impl IntoIterator<Item = Seat>, seed: u64) -> Provenance {
        let entry = |seat| (Self::entry(seat).to_owned(), Self::drawn(seed, seat).name().to_owned());
        bots.into_iter().map(entry).collect()
    }

    /// Which simulated driver sat in a seat by what a recording says; `None` where it does not.
    pub fn told(provenance: &Provenance, seat: Seat) -> Option<Self> {
        let name = provenance.get(Self::entry(seat))?;
        Self::ALL.into_iter().find(|temper| name == temper.name())
    }

    /// Reaction times are those of an attentive driver times this.
    pub fn reaction_factor(self) -> f32 {
        if self == Self::Tired { 1.5 } else { 1.0 }
    }

    /// What is comfortable, or near enough, is that of an attentive driver times this: braking, turning, threshold.
    pub fn vigour(self) -> f32 {
        match self {
            Self::Attentive | Self::Tired => 1.0,
            Self::Cautious => 0.85,
            Self::Sporty => 1.2,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everybody_is_drawn_as_often_as_said_and_in_each_seat_for_itself() {
        for seat in [Seat::Semantic, Seat::Safety] {
            let count = |temper| (0..4000).filter(|seed| Temper::drawn(*seed, seat) == temper).count();
            let shares = Temper::ALL.map(|temper| count(temper) as f32 / 4000.0);
            for (share, expected) in shares.into_iter().zip([0.5, 0.2, 0.2, 0.1]) {
                assert!((share - expected).abs() < 0.03, "{shares:?}");
            }
        }
        let both = |seed| (Temper::drawn(seed, Seat::Semantic), Temper::drawn(seed, Seat::Safety));
        let tired = (0..4000).filter(|seed| both(*seed) == (Temper::Tired, Temper::Tired)).count();
        assert!((20..70).contains(&tired), "{tired} of 4000");
    }

    #[test]
    fn a_recording_tells_who_sat_there() {
        let told = |name: &str| {
            let provenance = [(Temper::entry(Seat::Semantic).to_owned(), name.to_owned())].into();
            Temper::told(&provenance, Seat::Semantic)
        };
        assert_eq!(Temper::ALL.map(|temper| told(temper.name())), Temper::ALL.map(Some));
        assert_eq!((told("nobody"), Temper::told(&Provenance::new(), Seat::Safety)), (None, None));
        let bots = Temper::entries([Seat::Safety], 7);
        assert_eq!(Temper::told(&bots, Seat::Safety), Some(Temper::drawn(7, Seat::Safety)));
        assert_eq!(bots.len(), 1);
    }
}
