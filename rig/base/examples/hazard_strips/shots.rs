//! How each hazard is looked at.

use kernel::events::EventKind;

/// Pictures of a strip.
pub const PICTURES: usize = 4;

/// How a hazard is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trace {
    /// An event tells it.
    Event(EventKind),
    /// Somebody follows another within 0.7 s.
    Close,
    /// Somebody brakes a second or more after the one ahead.
    Late,
}

/// How a hazard is looked at.
pub struct Shot {
    /// Name of the scenario.
    pub name: &'static str,
    /// How it is found.
    pub trace: Trace,
    /// Times of the pictures, s after the moment.
    pub times_s: [f32; PICTURES],
    /// Place of the camera from the one who makes the mistake: forward, left and up, metres.
    pub from_m: [f32; 3],
    /// What it looks at, likewise.
    pub to_m: [f32; 3],
    /// Horizontal field of view, degrees.
    pub fov_deg: f32,
    /// Whether the camera stays where it is.
    pub stays: bool,
    /// Whether somebody behind is to be seen.
    pub others: bool,
}

const fn shot(name: &'static str, trace: Trace, times_s: [f32; PICTURES]) -> Shot {
    let (from_m, to_m) = ([-13.0, 0.0, 4.5], [4.0, 0.0, 1.0]);
    Shot { name, trace, times_s, from_m, to_m, fov_deg: 60.0, stays: false, others: false }
}

/// All hazards.
pub const SHOTS: [Shot; 8] = [
    shot("red-light-runners", Trace::Event(EventKind::HazardRedLight), [0.0, 1.2, 2.4, 3.6]),
    shot("rolling-stops", Trace::Event(EventKind::HazardRollingStop), [-1.6, -0.4, 0.8, 2.0]),
    Shot { from_m: [-5.0, 9.0, 8.0], to_m: [5.0, 0.0, 0.5], ..shot("tailgaters", Trace::Close, [0.0, 1.2, 2.4, 3.6]) },
    Shot {
        from_m: [-26.0, 0.0, 11.0],
        to_m: [-7.0, 0.0, 0.0],
        fov_deg: 46.0,
        others: true,
        ..shot("cut-ins", Trace::Event(EventKind::HazardCutIn), [-0.5, 1.0, 2.5, 4.0])
    },
    Shot {
        from_m: [-26.0, 0.0, 11.0],
        to_m: [-7.0, 0.0, 0.0],
        fov_deg: 46.0,
        others: true,
        ..shot("hard-braking", Trace::Event(EventKind::HazardBraking), [-0.3, 0.7, 1.4, 2.4])
    },
    Shot {
        from_m: [-15.0, 1.0, 5.0],
        stays: true,
        ..shot("pull-outs", Trace::Event(EventKind::HazardPullOut), [-1.0, 0.8, 2.0, 3.2])
    },
    Shot {
        from_m: [9.0, 0.0, 3.0],
        to_m: [-1.0, 0.0, 0.7],
        stays: true,
        ..shot("doors", Trace::Event(EventKind::HazardDoor), [0.1, 0.5, 1.2, 3.0])
    },
    Shot {
        from_m: [-17.0, 0.0, 6.5],
        to_m: [7.0, 0.0, 0.0],
        fov_deg: 38.0,
        ..shot("inattention", Trace::Late, [-0.3, 0.6, 1.2, 2.0])
    },
];
