//! Runs that operators say are no corner case.

use std::fmt;

use replay::Label;
use serde::Serialize;

use super::Ride;

/// What was set aside for one reason.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SetAside {
    /// Why: `driver-error`, `technical-fault` or `discarded`.
    pub label: &'static str,
    /// Number of runs.
    pub runs: usize,
    /// Kilometres driven in them.
    pub km: f64,
    /// Whether these kilometres are among those of the statistics.
    pub counts: bool,
}

impl SetAside {
    /// Adds a ride to what was set aside, by the order of labels, if it was.
    pub fn add(all: &mut Vec<Self>, ride: &Ride) {
        let Some(label) = ride.set_aside() else { return };
        let at = all.iter().position(|it| it.label == label.name()).unwrap_or_else(|| {
            all.push(Self { label: label.name(), runs: 0, km: 0.0, counts: label.counts() });
            all.len() - 1
        });
        all[at].runs += 1;
        all[at].km += ride.km;
        all.sort_by_key(|it| Label::SET_ASIDE.iter().position(|label| label.name() == it.label));
    }
}

impl fmt::Display for SetAside {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { label, runs, km, counts } = self;
        let counted = if *counts { "which count" } else { "which do not count" };
        write!(f, "{runs} {label} ({km:.2} km, {counted})")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_set_aside_by_why() {
        let ride =
            |km, label| Ride { km, minutes: 1.0, is_case: false, label, perception_caused: None, tempers: [None; 2] };
        let mut all = Vec::new();
        let labels = [Label::Discarded, Label::Walker, Label::DriverError, Label::Discarded];
        labels.iter().for_each(|label| SetAside::add(&mut all, &ride(1.5, Some(*label))));
        SetAside::add(&mut all, &ride(1.5, None));
        let words: Vec<String> = all.iter().map(ToString::to_string).collect();
        assert_eq!(words, ["1 driver-error (1.50 km, which count)", "2 discarded (3.00 km, which do not count)"]);
    }
}
