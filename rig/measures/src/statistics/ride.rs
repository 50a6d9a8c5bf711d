//! A run, as statistics count it.

use drivers::temper::Temper;
use kernel::Seat;
use replay::{Label, Recording};

/// A run of a study or a campaign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ride {
    /// Kilometres driven.
    pub km: f64,
    /// Minutes of the simulated world.
    pub minutes: f64,
    /// Whether it ended by an intervention, or by a collision that nobody prevented.
    pub is_case: bool,
    /// What kind of corner case, or why none.
    pub label: Option<Label>,
    /// Whether true masks avoid the corner case, where that is known.
    pub perception_caused: Option<bool>,
    /// Which simulated drivers sat in the seats, the semantic one first; `None` for a person.
    pub tempers: [Option<Temper>; 2],
}

impl Ride {
    /// That of a recording; `None` for a drive to get used to the rig.
    pub fn of(recording: &Recording) -> Option<Self> {
        let log = recording.log();
        if study::is_familiarisation(&log.manifest.provenance) {
            return None;
        }
        let annotation = log.annotation.as_ref();
        Some(Self {
            km: log.odometer_mm() as f64 / 1e6,
            minutes: log.last_tick() as f64 / f64::from(60 * kernel::time::TICK_HZ),
            is_case: log.decided_at().is_some(),
            label: annotation.map(|a| a.label),
            perception_caused: annotation.and_then(|a| a.perception_caused),
            tempers: [Seat::Semantic, Seat::Safety].map(|seat| Temper::told(&log.manifest.provenance, seat)),
        })
    }

    /// Why operators said that it is no corner case, if they did.
    pub fn set_aside(&self) -> Option<Label> {
        self.label.filter(|label| !label.is_case())
    }

    /// Whether what was driven counts as driven.
    pub fn counts(&self) -> bool {
        self.label.is_none_or(Label::counts)
    }

    /// The same drive where its end is not to count as a corner case.
    pub fn uncounted(self) -> Self {
        Self { is_case: false, label: None, perception_caused: None, ..self }
    }
}
