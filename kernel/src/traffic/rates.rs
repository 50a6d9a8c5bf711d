//! How often people at the wheel endanger others.

use crate::state;

state! {
    /// Rates of what people at the wheel do wrong. Shares are in [0, 1]; what happens at any time is counted by the
    /// hour that one vehicle spends where it can happen. Sources: docs/hazards.md.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct HazardRates {
        /// Share of those who would reach a light in its first seconds of red, could stop, and drive through.
        pub red_light_runners: f32,
        /// Share of those who come first to a stop sign and roll over its line, if nobody makes them wait.
        pub rolling_stops: f32,
        /// Share of drivers who follow at half a second.
        pub tailgaters: f32,
        /// Changes of lane right before somebody, 1/h, while somebody drives there beside the vehicle.
        pub cut_ins_per_h: f32,
        /// Hard braking for no reason, 1/h, of motor vehicles that drive faster than 5 m/s.
        pub hard_brakings_per_h: f32,
        /// Stops at the kerb that end without a look, 1/h, of cars on roads with room for that.
        pub pull_outs_per_h: f32,
        /// Doors that open without a look, 1/h, of a parked car beside a lane.
        pub doors_per_h: f32,
        /// Reaction times and errors of judgement, as a multiple of the published ones, 0 to 2.
        pub inattention: f32,
    }
}

/// A named set of rates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HazardLevel {
    /// Nobody makes mistakes.
    None,
    /// As often as has been seen on roads, or is assumed.
    Natural,
    /// So often that little driving shows all of them.
    Raised,
}

impl HazardLevel {
    /// Every level.
    pub const ALL: [Self; 3] = [Self::None, Self::Natural, Self::Raised];

    /// Its name in scenarios and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Natural => "natural",
            Self::Raised => "raised",
        }
    }

    /// The level of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|level| level.name() == name)
    }

    /// Its rates.
    pub fn rates(self) -> HazardRates {
        match self {
            Self::None => HazardRates::NONE,
            Self::Natural => HazardRates {
                red_light_runners: 0.05,
                rolling_stops: 0.37,
                tailgaters: 0.05,
                cut_ins_per_h: 2.0,
                hard_brakings_per_h: 0.1,
                pull_outs_per_h: 0.2,
                doors_per_h: 0.05,
                inattention: 1.0,
            },
            Self::Raised => HazardRates {
                red_light_runners: 0.5,
                rolling_stops: 0.8,
                tailgaters: 0.4,
                cut_ins_per_h: 120.0,
                hard_brakings_per_h: 40.0,
                pull_outs_per_h: 30.0,
                doors_per_h: 3.0,
                inattention: 1.5,
            },
        }
    }
}

impl HazardRates {
    /// Nobody makes mistakes.
    pub const NONE: Self = Self {
        red_light_runners: 0.0,
        rolling_stops: 0.0,
        tailgaters: 0.0,
        cut_ins_per_h: 0.0,
        hard_brakings_per_h: 0.0,
        pull_outs_per_h: 0.0,
        doors_per_h: 0.0,
        inattention: 0.0,
    };
}
