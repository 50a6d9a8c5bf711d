//! Budgets of the benchmarks, kept as ratios measured in one run.
