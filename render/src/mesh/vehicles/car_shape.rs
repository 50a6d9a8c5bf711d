//! Shapes of passenger cars: their side views, in metres, the origin below the middle.

use super::loft::{CLEARANCE_M, Section, Station, at};

/// A body with its cabin.
pub(super) struct Shape {
    /// The body from the front bumper to the rear bumper.
    pub(super) stations: [Station; 7],
    pub(super) cabin: Cabin,
    /// Axles' x.
    pub(super) axles: [f32; 2],
    pub(super) wheel_radius: f32,
    /// Rear lamps: width, lower and upper edge.
    pub(super) rear_lamp: [f32; 3],
    pub(super) has_rails: bool,
}

/// Windows and roof.
pub(super) struct Cabin {
    /// x of the feet of the windscreen and of the rear window, which stand on the body.
    pub(super) feet: [f32; 2],
    /// x and z of the tops of both.
    pub(super) tops: [(f32, f32); 2],
    pub(super) roof_z: f32,
}

/// Cross-sections of all passenger cars.
pub(super) const SECTION: Section = Section { sill: CLEARANCE_M, waist: 0.56, lean: 0.1, round: [0.06, 0.06] };

impl Shape {
    /// Half of the width where it is widest.
    pub(super) fn half(&self) -> f32 {
        self.stations.iter().fold(0.0, |most, s| s.half.max(most))
    }
}

const HATCHBACK: Shape = Shape {
    stations: [
        at(2.13, 0.5, 0.7),
        at(2.09, 0.72, 0.78),
        at(1.86, 0.84, 0.85),
        at(1.0, 0.98, 0.885),
        at(-1.85, 1.04, 0.87),
        at(-2.08, 0.94, 0.8),
        at(-2.1, 0.5, 0.78),
    ],
    cabin: Cabin { feet: [1.05, -1.98], tops: [(0.22, 1.38), (-1.52, 1.4)], roof_z: 1.47 },
    axles: [1.3, -1.28],
    wheel_radius: 0.315,
    rear_lamp: [0.24, 0.72, 0.92],
    has_rails: false,
};

const SALOON: Shape = Shape {
    stations: [
        at(2.25, 0.48, 0.7),
        at(2.2, 0.7, 0.79),
        at(1.96, 0.81, 0.86),
        at(0.95, 0.95, 0.89),
        at(-1.4, 1.01, 0.88),
        at(-2.2, 0.99, 0.8),
        at(-2.25, 0.5, 0.77),
    ],
    cabin: Cabin { feet: [1.02, -1.74], tops: [(0.12, 1.34), (-0.98, 1.36)], roof_z: 1.43 },
    axles: [1.38, -1.36],
    wheel_radius: 0.32,
    rear_lamp: [0.4, 0.74, 0.88],
    has_rails: false,
};

const ESTATE: Shape = Shape {
    stations: [
        at(2.25, 0.48, 0.7),
        at(2.2, 0.7, 0.79),
        at(1.96, 0.81, 0.86),
        at(0.95, 0.96, 0.89),
        at(-2.0, 1.02, 0.87),
        at(-2.22, 0.94, 0.81),
        at(-2.25, 0.5, 0.78),
    ],
    cabin: Cabin { feet: [1.02, -2.14], tops: [(0.14, 1.36), (-1.8, 1.36)], roof_z: 1.43 },
    axles: [1.38, -1.36],
    wheel_radius: 0.32,
    rear_lamp: [0.26, 0.72, 0.92],
    has_rails: true,
};

/// A sport utility vehicle.
pub(super) const SUV: Shape = Shape {
    stations: [
        at(2.18, 0.56, 0.74),
        at(2.15, 0.86, 0.82),
        at(1.92, 0.98, 0.88),
        at(1.0, 1.08, 0.91),
        at(-1.85, 1.13, 0.9),
        at(-2.12, 1.02, 0.84),
        at(-2.16, 0.56, 0.8),
    ],
    cabin: Cabin { feet: [1.04, -2.02], tops: [(0.4, 1.52), (-1.7, 1.53)], roof_z: 1.6 },
    axles: [1.32, -1.32],
    wheel_radius: 0.36,
    rear_lamp: [0.22, 0.78, 1.0],
    has_rails: true,
};

/// Shapes with their shares among passenger cars.
pub(super) const SHAPES: [(&Shape, u32); 4] = [(&HATCHBACK, 40), (&SALOON, 24), (&ESTATE, 22), (&SUV, 14)];
