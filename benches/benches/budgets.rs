//! Benchmarks with budgets.

fn main() {}
