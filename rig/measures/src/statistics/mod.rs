//! How often corner cases happen: statistics of rides, simulated or with people, from recordings alone.

mod behind;
mod compare;
mod groups;
mod legs;
mod ride;
mod sampling;
mod set_aside;
mod text;

use std::collections::BTreeMap;

use replay::Label;
use serde::Serialize;

pub use behind::Library;
pub use compare::Comparison;
pub use groups::{CheckpointStatistics, Choice, Group, StatisticsOfAll, of_recordings};
pub use legs::Legs;
pub use ride::Ride;
pub use sampling::Sampling;
pub use set_aside::SetAside;
pub use text::table;

use crate::stats;

/// Seed of the draws of rides.
const BOOTSTRAP_SEED: u64 = 1;
/// What cases without a label count as.
const UNLABELLED: &str = "unlabelled";

/// What rides came to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Statistics {
    /// What decided how much was driven, on which the exact intervals rest.
    pub sampling: Sampling,
    /// Number of rides.
    pub rides: usize,
    /// Kilometres driven.
    pub km: f64,
    /// Minutes of the simulated world.
    pub minutes: f64,
    /// Corner cases: interventions, and collisions that nobody prevented.
    pub cases: u64,
    /// Corner cases by label.
    pub cases_by_label: BTreeMap<&'static str, u64>,
    /// Corner cases that true masks avoid.
    pub perception_caused: u64,
    /// Corner cases a kilometre: the likeliest rate, however the drives ended. Where they ended with the last of N
    /// cases its mean is N / (N - 1) times the true one.
    pub cases_per_km: f64,
    /// 95 % interval of that rate, exact for `sampling`; legs that did not end count as exposure.
    pub cases_per_km_95: (f64, f64),
    /// 95 % interval of that rate by drawing rides again; absent for a single ride,
    /// or without cases.
    pub cases_per_km_95_of_rides: Option<(f64, f64)>,
    /// Corner cases a minute.
    pub cases_per_min: f64,
    /// 95 % interval of that rate, exact for `sampling`.
    pub cases_per_min_95: (f64, f64),
    /// How the rides are spread over the population of simulated drivers, by semantic driver; people are left out.
    pub by_semantic_temper: BTreeMap<&'static str, Share>,
    /// By safety driver.
    pub by_safety_temper: BTreeMap<&'static str, Share>,
    /// Kilometres and minutes between corner cases, as the paper prints them.
    pub legs: Legs,
}

/// What the rides of one kind of driver came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Share {
    /// Number of rides.
    pub rides: usize,
    /// Kilometres driven.
    pub km: f64,
    /// Corner cases.
    pub cases: u64,
}

impl Share {
    /// By the temper of who sits in the first or second seat.
    fn by_temper(rides: &[Ride], seat: usize) -> BTreeMap<&'static str, Self> {
        let mut shares = BTreeMap::<_, Self>::new();
        for ride in rides {
            if let Some(temper) = ride.tempers[seat] {
                let share = shares.entry(temper.name()).or_default();
                share.rides += 1;
                share.km += ride.km;
                share.cases += u64::from(ride.is_case);
            }
        }
        shares
    }
}

impl Statistics {
    /// Of rides in the order in which they were driven.
    pub fn of(rides: &[Ride], sampling: Sampling) -> Self {
        let km: f64 = rides.iter().map(|r| r.km).sum();
        let cases = rides.iter().filter(|r| r.is_case);
        let number = cases.clone().count() as u64;
        let mut by_label = BTreeMap::new();
        for case in cases.clone() {
            *by_label.entry(case.label.map_or(UNLABELLED, Label::name)).or_insert(0) += 1;
        }
        let (low, high) = sampling.interval(number);
        let minutes: f64 = rides.iter().map(|r| r.minutes).sum();
        let per = |n: f64, exposure: f64| if exposure > 0.0 { n / exposure } else { 0.0 };
        let clusters: Vec<(u64, f64)> = rides.iter().map(|r| (r.is_case.into(), r.km)).collect();
        Self {
            sampling,
            rides: rides.len(),
            km,
            minutes,
            cases: number,
            cases_by_label: by_label,
            perception_caused: cases.filter(|r| r.perception_caused == Some(true)).count() as u64,
            cases_per_km: per(number as f64, km),
            cases_per_km_95: (per(low, km), per(high, km)),
            cases_per_km_95_of_rides: stats::rate_interval(&clusters, BOOTSTRAP_SEED),
            cases_per_min: per(number as f64, minutes),
            cases_per_min_95: (per(low, minutes), per(high, minutes)),
            by_semantic_temper: Share::by_temper(rides, 0),
            by_safety_temper: Share::by_temper(rides, 1),
            legs: Legs::of(rides),
        }
    }
}

#[cfg(test)]
mod tests {
    use drivers::temper::Temper;
    use proptest::prelude::*;

    use super::*;

    fn ride((km, is_case): (f64, bool)) -> Ride {
        let label = is_case.then_some(Label::Walker);
        let tempers = [Some(if km < 2.0 { Temper::Tired } else { Temper::Attentive }), None];
        Ride { km, minutes: 2.0 * km, is_case, label, perception_caused: is_case.then_some(true), tempers }
    }

    proptest! {
        #[test]
        fn nothing_that_was_driven_is_lost(rides in prop::collection::vec((0.01f64..9.0, any::<bool>()), 1..40)) {
            let rides: Vec<Ride> = rides.into_iter().map(ride).collect();
            let s = Statistics::of(&rides, Sampling::Length);
            let completed = s.legs.km_mean.map_or(0.0, |mean| mean * s.legs.completed as f64);
            prop_assert!((completed + s.legs.censored_km - s.km).abs() < 1e-9);
            prop_assert_eq!(s.legs.completed as u64, s.cases);
            prop_assert_eq!(s.cases_by_label.values().sum::<u64>(), s.cases);
            prop_assert_eq!(s.by_semantic_temper.values().map(|share| share.cases).sum::<u64>(), s.cases);
            prop_assert!((s.by_semantic_temper.values().map(|share| share.km).sum::<f64>() - s.km).abs() < 1e-9);
            prop_assert!(s.by_safety_temper.is_empty());
            prop_assert!(s.cases_per_km_95.0 <= s.cases_per_km && s.cases_per_km <= s.cases_per_km_95.1);
            // A kilometre takes two minutes here.
            prop_assert!((s.cases_per_km_95.1 - 2.0 * s.cases_per_min_95.1).abs() < 1e-9);
            prop_assert!((s.cases_per_km - 2.0 * s.cases_per_min).abs() < 1e-9);
        }

        #[test]
        fn the_order_of_rides_changes_legs_alone(rides in prop::collection::vec((0.01f64..9.0, any::<bool>()), 1..40)) {
            let rides: Vec<Ride> = rides.into_iter().map(ride).collect();
            let reversed: Vec<Ride> = rides.iter().rev().copied().collect();
            let (s, r) = (Statistics::of(&rides, Sampling::Length), Statistics::of(&reversed, Sampling::Length));
            prop_assert_eq!(s.cases, r.cases);
            prop_assert!((s.cases_per_km_95.1 - r.cases_per_km_95.1).abs() < 1e-9);
        }
    }

    #[test]
    fn drives_that_end_with_a_case_have_the_interval_of_inverse_sampling() {
        let rides: Vec<Ride> = [(2.0, true), (1.0, false), (3.0, true), (4.0, true)].map(ride).to_vec();
        let of = |sampling| Statistics::of(&rides, sampling);
        let (low, high) = of(Sampling::Cases).cases_per_km_95;
        // Chi-squared with 6 degrees of freedom: 1.23734 and 14.4494; over twice 10 km.
        assert!((low - 0.061_867).abs() < 1e-5 && (high - 0.722_47).abs() < 1e-4, "{low} {high}");
        let fixed = of(Sampling::Length);
        // With 8 degrees of freedom: 17.5345.
        assert!((fixed.cases_per_km_95.1 - 0.876_73).abs() < 1e-4 && (fixed.cases_per_km_95.0 - low).abs() < 1e-9);
        for assumed in [Sampling::Rides, Sampling::Unknown] {
            assert_eq!(Statistics { sampling: assumed, ..fixed.clone() }, of(assumed));
        }
        let text = |sampling| table([("full", &of(sampling), None)].into_iter());
        assert!(text(Sampling::Cases).contains("ended with the last corner case"));
        assert!(text(Sampling::Unknown).contains("assuming that the length was fixed"));
    }

    #[test]
    fn rates_are_compared_as_they_were_sampled() {
        let rides = |kms: &[f64]| kms.iter().map(|km| ride((*km, true))).collect::<Vec<_>>();
        let against = |first, second| {
            let reference = Statistics::of(&rides(&[4.0, 5.0, 6.0]), first);
            Comparison::of(&reference, &Statistics::of(&rides(&[1.0, 2.0, 1.0, 2.0]), second))
        };
        let (fixed, inverse) = (against(Sampling::Length, Sampling::Length), against(Sampling::Cases, Sampling::Cases));
        assert_eq!(inverse.ratio, fixed.ratio);
        assert_eq!(inverse.p, stats::inverse_same_rate_p((3, 4), (15.0, 6.0)));
        assert_eq!(inverse.power, stats::inverse_power((3.0, 4.0), (4.0 / 6.0) / (3.0 / 15.0)));
        assert!(fixed.ratio_95.0 < inverse.ratio_95.0 && inverse.ratio_95.1 < fixed.ratio_95.1);
        assert_eq!(against(Sampling::Cases, Sampling::Length), fixed);
    }
}
