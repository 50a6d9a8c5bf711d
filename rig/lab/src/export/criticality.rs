//! The criticality of a tick as a message of our own, made to be plotted.

use foxglove::Encode;
use measures::criticality::{Sample, Worst};

/// How critical a tick is, as `aeye inspect` tells it; NaN and empty where there is no value.
#[derive(Clone, Debug, PartialEq, Encode)]
pub struct Criticality {
    /// Number of the tick.
    pub tick: u64,
    /// Time to collision, seconds.
    pub ttc_s: f64,
    /// With whom.
    pub ttc_with: String,
    /// Predicted post-encroachment time, seconds.
    pub pret_s: f64,
    /// With whom.
    pub pret_with: String,
    /// Required deceleration of the ego car, m/s^2.
    pub required_deceleration_mps2: f64,
    /// Because of whom.
    pub required_deceleration_with: String,
    /// Whether an encroachment is predicted within 2 s on the route.
    pub encroachment: bool,
}

impl Criticality {
    /// Of a sample.
    pub fn of(sample: &Sample) -> Self {
        let told = |worst: &Option<Worst>| match worst {
            Some(Worst { value, with }) => (*value, with.clone()),
            None => (f64::NAN, String::new()),
        };
        let (ttc_s, ttc_with) = told(&sample.ttc_s);
        let (pret_s, pret_with) = told(&sample.pret_s);
        let (required_deceleration_mps2, required_deceleration_with) = told(&sample.required_deceleration_mps2);
        Self {
            tick: sample.tick,
            ttc_s,
            ttc_with,
            pret_s,
            pret_with,
            required_deceleration_mps2,
            required_deceleration_with,
            encroachment: sample.encroachment.is_some(),
        }
    }
}
