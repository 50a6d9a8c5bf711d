//! Budgets of the benchmarks, kept as ratios measured in one run.
//!
//! Wall-clock figures drift from machine to machine and from hour to hour; a ratio to something
//! measured in the same run does not. A budget therefore compares a benchmark with real time at a
//! large factor, or with a reference benchmark.

pub mod scenes;

use std::fmt;

/// What a benchmark is held against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Against {
    /// Simulated seconds that one iteration covers; the ratio is simulated to measured time.
    RealTime(f64),
    /// Another benchmark's name; the ratio is its time to the benchmark's time.
    Reference(&'static str),
}

/// A lower bound on how fast a benchmark is in proportion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Name of the benchmark, as in `kernel/step`.
    pub bench: &'static str,
    /// What it is held against.
    pub against: Against,
    /// Least ratio that keeps the budget; higher is faster.
    pub at_least: f64,
}

/// A budget and the ratio that was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checked {
    /// The budget.
    pub budget: Budget,
    /// Time of one iteration, seconds.
    pub seconds: f64,
    /// Measured ratio.
    pub ratio: f64,
}

impl Checked {
    /// Whether the budget is kept.
    pub fn kept(&self) -> bool {
        self.ratio >= self.budget.at_least
    }
}

impl fmt::Display for Checked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let against = match self.budget.against {
            Against::RealTime(_) => "real time",
            Against::Reference(name) => name,
        };
        let verdict = if self.kept() { "kept" } else { "BROKEN" };
        let (name, ms) = (self.budget.bench, self.seconds * 1e3);
        write!(
            f,
            "{name:18} {ms:10.3} ms  {:9.3} times {against}, at least {:.3}: {verdict}",
            self.ratio, self.budget.at_least
        )
    }
}

/// Holds measured times against budgets; `seconds_of` gives the time of an iteration by name.
///
/// # Errors
/// Names the benchmark that was not measured.
pub fn check(budgets: &[Budget], seconds_of: impl Fn(&str) -> Option<f64>) -> Result<Vec<Checked>, String> {
    let seconds = |name: &str| seconds_of(name).ok_or_else(|| format!("{name}: not measured"));
    budgets
        .iter()
        .map(|budget| {
            let own_s = seconds(budget.bench)?;
            let base_s = match budget.against {
                Against::RealTime(simulated_s) => simulated_s,
                Against::Reference(name) => seconds(name)?,
            };
            Ok(Checked { budget: *budget, seconds: own_s, ratio: base_s / own_s })
        })
        .collect()
}

/// The mean time of an iteration in criterion's `estimates.json`, in seconds.
pub fn mean_seconds(estimates: &str) -> Option<f64> {
    let json: serde_json::Value = serde_json::from_str(estimates).ok()?;
    Some(json["mean"]["point_estimate"].as_f64()? * 1e-9)
}

/// Multiplies two `n` x `n` matrices in the plainest loop that compilers vectorise, and gives the
/// sum of the product: the yardstick for inference.
pub fn matrix_product(n: usize) -> f32 {
    let a: Vec<f32> = (0..n * n).map(|i| (i % 7) as f32).collect();
    let b: Vec<f32> = (0..n * n).map(|i| (i % 5) as f32).collect();
    let mut product = vec![0.0; n * n];
    for (row, out) in a.chunks_exact(n).zip(product.chunks_exact_mut(n)) {
        for (factor, line) in row.iter().zip(b.chunks_exact(n)) {
            out.iter_mut().zip(line).for_each(|(sum, value)| *sum += factor * value);
        }
    }
    product.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const BUDGETS: [Budget; 2] = [
        Budget { bench: "a", against: Against::RealTime(10.0), at_least: 150.0 },
        Budget { bench: "a", against: Against::Reference("b"), at_least: 0.5 },
    ];

    #[test]
    fn a_budget_is_broken_when_the_ratio_falls_below_it() {
        let times = |a: f64| move |name: &str| Some(if name == "a" { a } else { 0.03 });
        let kept = check(&BUDGETS, times(0.05)).expect("both measured");
        assert!(kept.iter().all(Checked::kept), "{kept:?}");
        let broken = check(&BUDGETS, times(0.07)).expect("both measured");
        assert!(broken.iter().all(|c| !c.kept()), "{broken:?}");
    }

    #[test]
    fn a_benchmark_that_was_not_measured_is_named() {
        assert_eq!(check(&BUDGETS, |name| (name == "a").then_some(1.0)), Err("b: not measured".into()));
    }

    #[test]
    fn estimates_are_nanoseconds() {
        assert_eq!(mean_seconds(r#"{"mean":{"point_estimate":2e9}}"#), Some(2.0));
        assert_eq!(mean_seconds("{}"), None);
    }
}
