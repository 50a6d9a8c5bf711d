//! How often corner cases happen: statistics of rides, simulated or with people, from recordings alone.

mod compare;
mod groups;
mod legs;
mod ride;
mod text;

use std::collections::BTreeMap;

use replay::Label;
use serde::Serialize;

pub use compare::Comparison;
pub use groups::{CheckpointStatistics, Choice, StatisticsOfAll, of_recordings};
pub use legs::Legs;
pub use ride::Ride;
pub use text::table;

use crate::stats;

/// Seed of the draws of rides.
const BOOTSTRAP_SEED: u64 = 1;
/// What cases without a label count as.
const UNLABELLED: &str = "unlabelled";

/// What rides came to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Statistics {
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
    /// Corner cases a kilometre.
    pub cases_per_km: f64,
    /// Exact 95 % interval of that rate; legs that did not end count as exposure.
    pub cases_per_km_95: (f64, f64),
    /// 95 % interval of that rate by drawing rides again; absent for a single ride,
    /// or without cases.
    pub cases_per_km_95_of_rides: Option<(f64, f64)>,
    /// Corner cases a minute.
    pub cases_per_min: f64,
    /// Exact 95 % interval of that rate.
    pub cases_per_min_95: (f64, f64),
    /// Kilometres and minutes between corner cases, as the paper prints them.
    pub legs: Legs,
}

impl Statistics {
    /// Of rides in the order in which they were driven.
    pub fn of(rides: &[Ride]) -> Self {
        let km: f64 = rides.iter().map(|r| r.km).sum();
        let cases = rides.iter().filter(|r| r.is_case);
        let number = cases.clone().count() as u64;
        let mut by_label = BTreeMap::new();
        for case in cases.clone() {
            *by_label.entry(case.label.map_or(UNLABELLED, Label::name)).or_insert(0) += 1;
        }
        let (low, high) = stats::poisson_interval(number);
        let minutes: f64 = rides.iter().map(|r| r.minutes).sum();
        let per = |n: f64, exposure: f64| if exposure > 0.0 { n / exposure } else { 0.0 };
        let clusters: Vec<(u64, f64)> = rides.iter().map(|r| (r.is_case.into(), r.km)).collect();
        Self {
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
            legs: Legs::of(rides),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn ride((km, is_case): (f64, bool)) -> Ride {
        let label = is_case.then_some(Label::Walker);
        Ride { km, minutes: 2.0 * km, is_case, label, perception_caused: is_case.then_some(true) }
    }

    proptest! {
        #[test]
        fn nothing_that_was_driven_is_lost(rides in prop::collection::vec((0.01f64..9.0, any::<bool>()), 1..40)) {
            let rides: Vec<Ride> = rides.into_iter().map(ride).collect();
            let s = Statistics::of(&rides);
            let completed = s.legs.km_mean.map_or(0.0, |mean| mean * s.legs.completed as f64);
            prop_assert!((completed + s.legs.censored_km - s.km).abs() < 1e-9);
            prop_assert_eq!(s.legs.completed as u64, s.cases);
            prop_assert_eq!(s.cases_by_label.values().sum::<u64>(), s.cases);
            prop_assert!(s.cases_per_km_95.0 <= s.cases_per_km && s.cases_per_km <= s.cases_per_km_95.1);
            // A kilometre takes two minutes here.
            prop_assert!((s.cases_per_km_95.1 - 2.0 * s.cases_per_min_95.1).abs() < 1e-9);
            prop_assert!((s.cases_per_km - 2.0 * s.cases_per_min).abs() < 1e-9);
        }

        #[test]
        fn the_order_of_rides_changes_legs_alone(rides in prop::collection::vec((0.01f64..9.0, any::<bool>()), 1..40)) {
            let rides: Vec<Ride> = rides.into_iter().map(ride).collect();
            let reversed: Vec<Ride> = rides.iter().rev().copied().collect();
            let (s, r) = (Statistics::of(&rides), Statistics::of(&reversed));
            prop_assert_eq!(s.cases, r.cases);
            prop_assert!((s.cases_per_km_95.1 - r.cases_per_km_95.1).abs() < 1e-9);
        }
    }
}
