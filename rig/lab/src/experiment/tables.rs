//! Tables 1 and 2.

use measures::statistics::CheckpointStatistics;
use serde::Serialize;

use super::table_1;

/// The content of `tables.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tables {
    /// How good the networks are.
    pub table_1: Vec<table_1::Row>,
    /// How they drive, a network of each set; the natural one is the reference.
    pub table_2: Vec<CheckpointStatistics>,
}
