//! The worst of a window.

use kernel::time::Tick;
use serde::{Deserialize, Serialize};

/// The worst value of a trace.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Extreme {
    /// Seconds or m/s^2.
    pub value: f64,
    /// When.
    pub tick: Tick,
    /// The other road user.
    pub with: String,
}
