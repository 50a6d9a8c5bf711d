//! Logs without a simulation behind them, for the tests of this crate.

use kernel::arbiter::{Intervention, Outcome};
use kernel::events::{Event, EventKind};
use kernel::time::Tick;
use kernel::world::PARTS;
use kernel::{Controls, Keyframe, Scenario, Seat, StateHash, TickInput};

use crate::{
    Annotation, FORMAT_VERSION, ForeignMap, Label, LiveTimes, Log, Manifest, Mark, MaskShown, Note, NoteKind,
    RunSummary,
};

/// A log of `ticks` ticks with something of everything in it.
pub(crate) fn sample(ticks: Tick) -> Log {
    let controls = |tick: Tick, k: u64| Controls {
        steer: (tick * 37 * k) as i16,
        throttle: 60_000u16.wrapping_add((tick * k) as u16),
        brake: 0,
        flags: (tick % 90 / 89) as u8 * Controls::SEEN,
    };
    let hash = |tick: Tick| u128::from(tick).wrapping_mul(0x9e37_79b9_7f4a_7c15_f39c_c060_5ced_c835);
    let mark = |tick: Tick| Mark {
        tick,
        hash: StateHash(hash(tick)),
        parts: [tick.wrapping_mul(0x9e37_79b9_7f4a_7c15); PARTS.len()],
        odometer_mm: tick * 231,
    };
    let takeover = ticks / 2 + 1;
    let intervention =
        Intervention { tick: takeover, controls: controls(1, 1), by_brake: true, by_steering: false, speed_mps: 8.5 };
    let marked = |tick: &Tick| tick.is_multiple_of(60) || *tick == takeover || *tick == ticks;
    Log {
        manifest: manifest(),
        keyframes: (0..=ticks).step_by(50).map(|tick| Keyframe { tick, bytes: vec![tick as u8; 70] }).collect(),
        inputs: (1..=ticks).map(|t| TickInput { semantic: controls(t, 1), safety: controls(t, 0) }).collect(),
        hashes: (1..=ticks).map(|t| hash(t) as u32).collect(),
        marks: (1..=ticks).filter(marked).map(mark).collect(),
        events: vec![(takeover, Event { kind: EventKind::Intervention, actor: 0, speed_mps: 8.5 })],
        intervention: Some(intervention),
        masks: (1..=ticks).step_by(6).map(mask).collect(),
        notes: vec![
            Note { tick: 1, kind: NoteKind::UnitArmed, seat: Some(Seat::Semantic) },
            Note { tick: takeover, kind: NoteKind::UnitLost, seat: Some(Seat::Safety) },
            Note { tick: ticks + 1, kind: NoteKind::UnitReturned, seat: Some(Seat::Safety) },
        ],
        annotation: Some(Annotation { label: Label::Walker, comment: "dusk".into(), perception_caused: Some(true) }),
        summary: Some(RunSummary {
            ticks,
            odometer_mm: ticks * 231,
            intervention: Some(intervention),
            outcome: Some(Outcome::Intervened),
        }),
        scenes: Vec::new(),
    }
}

fn manifest() -> Manifest {
    Manifest {
        format: FORMAT_VERSION,
        kernel: kernel::identity(),
        engines: kernel::ENGINES.to_owned(),
        scenario: Scenario::default_for("nowhere", 3),
        map_digest: 0x1234_5678_9abc_def0_1234_5678_9abc_def0,
        foreign_map: Some(ForeignMap::new("<OpenDRIVE/>", true)),
        provenance: [("checkpoint", "early"), ("camera", "driver 256x128")].map(|(k, v)| (k.into(), v.into())).into(),
        case: None,
    }
}

fn mask(tick: Tick) -> MaskShown {
    let us = tick * 16_667;
    MaskShown {
        tick_shown: tick,
        tick_of_frame: tick - 1,
        camera: 0,
        digest: tick.wrapping_mul(0x2545_f491_4f6c_dd1d),
        times: tick.is_multiple_of(2).then_some(LiveTimes {
            capture_us: us,
            inference_us: us + 9000,
            present_us: us + 12_000,
        }),
    }
}
