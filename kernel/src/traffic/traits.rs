//! Differences between individuals: functions of the seed and the actor's id, never stored.

use glam::Vec3;

use crate::actor::ActorKind;
use crate::rng::{Stream, bits, unit};
use crate::weather::Conditions;

/// Hardest braking on a dry road, m/s².
const EMERGENCY_MPS2: f32 = 8.0;

use super::population::Population;

/// Half of the length up to which a vehicle turns within its lane, metres.
pub(super) const LONG_HALF_M: f32 = 2.5;
/// What draws the kind of somebody on foot, its age and its haste, as keys of random numbers.
const WALKER_KIND: u64 = 32;
const WALKER_AGE: u64 = 33;
const WALKER_HASTE: u64 = 34;
/// Share of people of 65 years or more (Eurostat 2023: 21 % of the EU's population); all of them in [`ActorKind::Pedestrian`].
const OLD: f32 = 0.21;
/// Their pace: 1.25 m/s at crossings on average, where others go at 1.51 m/s (Knoblauch, Pietrucha and Nitzburg 1996).
const OLD_PACE: f32 = 1.25 / 1.51;
/// Share of those without wheels and below 65 who are in a hurry, and their pace (both assumptions).
const HURRIED: f32 = 0.1;
const HURRIED_PACE: f32 = 1.25;
/// Mean speed of people who are neither old nor in a hurry, m/s; at crossings they are 15 % faster.
const MEAN_MPS: f32 = 1.3;

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
    /// Whether the vehicle needs more than its lane to turn.
    pub fn is_long(&self) -> bool {
        self.size_m.x * 0.5 > LONG_HALF_M
    }

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
    /// Speed aimed at, m/s: 0.8 to 1.8, half of all between 1.1 and 1.5; less with wheels and when old, more in a hurry.
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
    let usual_mps = between(MEAN_MPS - 0.5, MEAN_MPS + 0.5, 0.5 * (t(0) + t(1)));
    WalkerTraits {
        kind,
        speed_mps: usual_mps * pace(kind) * haste(kind, t(WALKER_AGE), t(WALKER_HASTE)),
        place: between(-1.0, 1.0, t(2)),
        variant: variant(seed, id),
    }
}

/// What is drawn from here on is somebody without a pram and no child.
const ALONE: f32 = 0.12;

/// Among people on foot: children by their share of 6 to 14 years in the EU's population (Eurostat 2023: 9 %), prams and
/// wheelchairs by assumption.
fn walker_kind(drawn: f32) -> ActorKind {
    match drawn {
        0.0..0.09 => ActorKind::Child,
        0.09..0.11 => ActorKind::Pram,
        0.11..ALONE => ActorKind::Wheelchair,
        _ => ActorKind::Pedestrian,
    }
}

/// Pace as a share of that of others of the same haste: 1.26 m/s of children (7 to 12 years, Surabaya 2022), 1.08 m/s in
/// wheelchairs (US Access Board: 3.55 ft/s), with prams by assumption.
fn pace(kind: ActorKind) -> f32 {
    match kind {
        ActorKind::Child => 1.26 / MEAN_MPS,
        ActorKind::Pram => 0.9,
        ActorKind::Wheelchair => 1.08 / MEAN_MPS,
        _ => 1.0,
    }
}

/// The same by age and haste.
fn haste(kind: ActorKind, age: f32, haste: f32) -> f32 {
    match kind {
        ActorKind::Pedestrian if age < OLD / (1.0 - ALONE) => OLD_PACE,
        ActorKind::Pedestrian | ActorKind::Child if haste < HURRIED => HURRIED_PACE,
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
            (ActorKind::Pedestrian, 0.88, 1.27),
            (ActorKind::Child, 0.09, 1.29),
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
    fn the_old_are_slow_and_the_hurried_are_fast() {
        let kinds = |kind| (1..=20_000).map(move |id| (id, walker_traits(5, id))).filter(move |(_, w)| w.kind == kind);
        let t = |id, which| trait_unit(5, id, which);
        let of_haste = |least: f32, below: f32| -> Vec<f32> {
            let is_so = move |id: u16| {
                let haste = haste(ActorKind::Pedestrian, t(id, WALKER_AGE), t(id, WALKER_HASTE));
                (least..below).contains(&haste)
            };
            kinds(ActorKind::Pedestrian).filter(|(id, _)| is_so(*id)).map(|(_, w)| w.speed_mps).collect()
        };
        let (old, usual, hurried) = (of_haste(0.0, 0.99), of_haste(0.99, 1.01), of_haste(1.01, 2.0));
        let mean = |speeds: &[f32]| speeds.iter().sum::<f32>() / speeds.len() as f32;
        let share = |speeds: &[f32]| speeds.len() as f32 / 2e4;
        assert!((share(&old) - 0.21).abs() < 0.01, "{}", share(&old));
        assert!((share(&hurried) - 0.1 * (0.88 - 0.21)).abs() < 0.01, "{}", share(&hurried));
        // At crossings, where people go 1.15 times as fast.
        let others = [usual.clone(), hurried.clone()].concat();
        assert!((mean(&old) * 1.15 - 1.25).abs() < 0.03, "{}", mean(&old) * 1.15);
        assert!((mean(&others) * 1.15 - 1.51).abs() < 0.05, "{}", mean(&others) * 1.15);
        assert!(mean(&hurried) > 1.2 * mean(&usual));
        assert!(kinds(ActorKind::Wheelchair).all(|(_, w)| w.speed_mps <= 1.8 * 1.08 / 1.3 + 1e-4));
    }

    #[test]
    fn the_usual_population_fills_its_ranges() {
        let shares = (1..2000).map(|id| driver(&Population::USUAL, 1, id, ActorKind::Car).limit_share);
        let (low, high) = shares.fold((f32::MAX, f32::MIN), |(low, high), s| (low.min(s), high.max(s)));
        assert!((0.88..0.882).contains(&low) && (1.058..=1.06).contains(&high), "{low} {high}");
    }
}
