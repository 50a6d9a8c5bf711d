//! Differences between individuals: functions of the seed and the actor's id, never stored.

use glam::Vec3;

use crate::actor::ActorKind;
use crate::rng::{Stream, bits, unit};
use crate::weather::Conditions;

/// Hardest braking on a dry road, m/s².
const EMERGENCY_MPS2: f32 = 8.0;

use super::population::Population;

/// What draws the kind of somebody on foot, as a key of random numbers.
const WALKER_KIND: u64 = 32;

/// How somebody drives. Parameters of the intelligent driver model (Treiber, Hennecke and Helbing
/// 2000) around the values of its section on city traffic.
#[derive(Clone, Copy, Debug)]
pub(super) struct Driver {
    /// Share of the speed limit that is aimed at: about it, as free speeds measured in towns are.
    pub limit_share: f32,
    /// Highest speed at all, m/s.
    pub top_mps: f32,
    /// Greatest acceleration, m/s².
    pub accel_mps2: f32,
    /// Comfortable braking, m/s², positive.
    pub brake_mps2: f32,
    /// Hardest braking, m/s², positive.
    pub hardest_mps2: f32,
    /// Time headway, s.
    pub headway_s: f32,
    /// Distance kept at standstill, metres.
    pub gap_m: f32,
    /// Length, width and height, metres.
    pub size_m: Vec3,
    /// Distance of its middle from the edge of the lane at the kerb; cars keep to the middle.
    pub from_kerb_m: Option<f32>,
    /// Ticks until it reacts to the vehicle ahead.
    pub reaction_ticks: u8,
    /// Selects colour and shape.
    pub variant: u32,
}

impl Driver {
    /// The same in a weather.
    pub fn heeding(self, conditions: &Conditions) -> Self {
        Self {
            limit_share: self.limit_share * conditions.speed,
            top_mps: (self.top_mps * conditions.speed).min(conditions.sight_mps),
            brake_mps2: self.brake_mps2 * conditions.brake,
            hardest_mps2: self.hardest_mps2 * conditions.grip,
            headway_s: self.headway_s * conditions.headway,
            ..self
        }
    }

    /// Where across a lane of this half width it drives, metres to the left of the middle; the kerb is to the left (1)
    /// or right (-1).
    pub fn keeps_to_m(&self, half_width_m: f32, kerb: i8) -> f32 {
        self.from_kerb_m.map_or(0.0, |m| f32::from(kerb) * (half_width_m - m).max(0.0))
    }
}

/// How somebody walks.
#[derive(Clone, Copy, Debug)]
pub(super) struct WalkerTraits {
    /// Alone, a child, with a pram or in a wheelchair.
    pub kind: ActorKind,
    /// Speed aimed at, m/s: 0.8 to 1.8, half of all between 1.1 and 1.5; less with wheels.
    pub speed_mps: f32,
    /// Preferred place across the way, -1 (right edge as the edge runs) to 1.
    pub place: f32,
    /// Selects looks.
    pub variant: u32,
}

fn trait_unit(seed: u64, id: u16, which: u64) -> f32 {
    unit(seed, Stream::Trait, u64::from(id), which)
}

fn between(lo: f32, hi: f32, t: f32) -> f32 {
    lo + (hi - lo) * t
}

impl WalkerTraits {
    /// The same in a weather.
    pub fn heeding(self, conditions: &Conditions) -> Self {
        Self { speed_mps: self.speed_mps * conditions.pace, ..self }
    }
}

/// The driver of vehicle `id` in a population.
pub(super) fn driver(population: &Population, seed: u64, id: u16, kind: ActorKind) -> Driver {
    let t = |which| trait_unit(seed, id, which);
    let drawn = |[low, high]: [f32; 2], which| between(low, high, t(which));
    let cars = drawn(population.speed_share, 0);
    let more = cars - drawn(Population::USUAL.speed_share, 0);
    let (limit_share, top_mps, accel_mps2, from_kerb_m) = match kind {
        ActorKind::Bicycle => (1.0, between(3.5, 6.0, t(0)), 0.9, Some(0.6)),
        // The load makes it slower off the mark.
        ActorKind::CargoBike => (1.0, between(3.5, 5.5, t(0)), 0.7, Some(0.65)),
        // 125 cm³.
        ActorKind::Scooter => (between(0.85, 1.05, t(0)) + more, 26.0, 1.8, Some(1.1)),
        ActorKind::Motorcycle => (between(0.9, 1.1, t(0)) + more, 40.0, 2.2, Some(1.2)),
        ActorKind::Truck | ActorKind::Bus | ActorKind::Tram => (between(0.8, 0.95, t(0)) + more, 25.0, 1.0, None),
        ActorKind::Van => (cars, 38.0, between(1.1, 1.6, t(1)), None),
        _ => (cars, 40.0, between(1.3, 2.0, t(1)), None),
    };
    Driver {
        limit_share,
        top_mps,
        accel_mps2,
        brake_mps2: between(1.8, 2.4, t(2)),
        hardest_mps2: EMERGENCY_MPS2,
        headway_s: drawn(population.headway_s, 3),
        gap_m: between(1.8, 2.8, t(4)),
        size_m: kind.size_m(),
        from_kerb_m,
        reaction_ticks: 0,
        variant: variant(seed, id),
    }
}

/// The walker `id`.
pub(super) fn walker_traits(seed: u64, id: u16) -> WalkerTraits {
    let t = |which| trait_unit(seed, id, which);
    let kind = walker_kind(t(WALKER_KIND));
    WalkerTraits {
        kind,
        speed_mps: pace(kind) * between(0.8, 1.8, 0.5 * (t(0) + t(1))),
        place: between(-1.0, 1.0, t(2)),
        variant: variant(seed, id),
    }
}

/// Among people on foot: children by their share of 6 to 14 years in the EU's population (Eurostat 2023: 9 %), prams and
/// wheelchairs by assumption.
fn walker_kind(drawn: f32) -> ActorKind {
    match drawn {
        0.0..0.09 => ActorKind::Child,
        0.09..0.11 => ActorKind::Pram,
        0.11..0.12 => ActorKind::Wheelchair,
        _ => ActorKind::Pedestrian,
    }
}

/// Pace as a share of that of others of the same haste: 1.08 m/s in wheelchairs (US Access Board: 3.55 ft/s), with prams by
/// assumption.
fn pace(kind: ActorKind) -> f32 {
    match kind {
        ActorKind::Pram => 0.9,
        ActorKind::Wheelchair => 1.08 / 1.3,
        _ => 1.0,
    }
}

fn variant(seed: u64, id: u16) -> u32 {
    bits(seed, Stream::Trait, u64::from(id), 16) as u32 & 0xffff
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINDS: [ActorKind; 10] = [
        ActorKind::Car,
        ActorKind::Truck,
        ActorKind::Bus,
        ActorKind::Motorcycle,
        ActorKind::Bicycle,
        ActorKind::Van,
        ActorKind::Suv,
        ActorKind::Scooter,
        ActorKind::CargoBike,
        ActorKind::Emergency,
    ];

    #[test]
    fn drivers_are_drawn_from_the_ranges_of_their_population() {
        let hasty = Population { speed_share: [1.1, 1.3], headway_s: [0.5, 0.8], politeness: 0.0 };
        for id in 1..400 {
            let car = driver(&hasty, 7, id, ActorKind::Car);
            assert!((1.1..=1.3).contains(&car.limit_share), "{}", car.limit_share);
            for kind in KINDS {
                let (usual, hasty) = (driver(&Population::USUAL, 7, id, kind), driver(&hasty, 7, id, kind));
                assert!((1.0..=1.8).contains(&usual.headway_s) && (0.5..=0.8).contains(&hasty.headway_s));
                let faster = hasty.limit_share - usual.limit_share;
                assert!(kind.is_pedalled() && faster == 0.0 || faster > 0.15, "{kind:?}: {faster}");
            }
        }
    }

    #[test]
    fn people_on_foot_are_of_all_kinds_in_their_shares() {
        let people: Vec<WalkerTraits> = (1..=20_000).map(|id| walker_traits(5, id)).collect();
        let of = |kind| people.iter().filter(move |walker| walker.kind == kind);
        for (kind, share, pace_mps) in [
            (ActorKind::Pedestrian, 0.88, 1.3),
            (ActorKind::Child, 0.09, 1.3),
            (ActorKind::Pram, 0.02, 1.17),
            (ActorKind::Wheelchair, 0.01, 1.08),
        ] {
            let count = of(kind).count() as f32;
            assert!(kind.is_on_foot() && (count / 2e4 - share).abs() < 0.007, "{kind:?}: {count}");
            let mean_mps = of(kind).map(|walker| walker.speed_mps).sum::<f32>() / count;
            assert!((mean_mps - pace_mps).abs() < 0.04, "{kind:?}: {mean_mps}");
        }
    }

    #[test]
    fn the_usual_population_fills_its_ranges() {
        let shares = (1..2000).map(|id| driver(&Population::USUAL, 1, id, ActorKind::Car).limit_share);
        let (low, high) = shares.fold((f32::MAX, f32::MIN), |(low, high), s| (low.min(s), high.max(s)));
        assert!((0.88..0.882).contains(&low) && (1.058..=1.06).contains(&high), "{low} {high}");
    }
}
