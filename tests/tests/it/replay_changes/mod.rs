//! Nothing of a recording or case can be changed unnoticed: reading refuses it, or the replay diverges.

pub mod parts;

use std::fmt;
use std::sync::{Arc, LazyLock};

use kernel::RoadNetwork;
use proptest::prelude::*;
use replay::{Case, Log, Recording, verify};
use tests::recordings::{WITH_TAKEOVER_SOON, record_all};
use tests::scenes::{Scene, scene};

use self::parts::{Parts, SEAL};

static SCENE: LazyLock<Scene> = LazyLock::new(|| {
    scene("map = \"city\"\nseed = 7\n[traffic]\ncars = 6\nmotorcycles = 1\nbicycles = 1\npedestrians = 4\n")
});
static RECORDING: LazyLock<Recording> =
    LazyLock::new(|| Recording::from_bytes(&record_all(&SCENE, 330, WITH_TAKEOVER_SOON)).expect("a recording"));
/// A recording and a case, as files.
pub static FILES: LazyLock<[Vec<u8>; 2]> = LazyLock::new(|| {
    let window = Case::window(RECORDING.log()).expect("an intervention");
    let case = Case::cut(&RECORDING, network(), window).expect("a case");
    [RECORDING.log(), case.log()].map(|log| log.encode().expect("a log"))
});

pub fn network() -> &'static Arc<RoadNetwork> {
    &SCENE.network
}

/// What became of a changed file.
#[derive(PartialEq)]
enum Verdict {
    Refused,
    Diverged,
    /// It verifies.
    Passed(Box<Log>),
}

impl fmt::Debug for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Refused => "refused",
            Self::Diverged => "diverged",
            Self::Passed(_) => "passed",
        })
    }
}

fn verdict(file: &[u8]) -> Verdict {
    let Ok(recording) = Recording::from_bytes(file) else { return Verdict::Refused };
    match verify(recording.log(), network()) {
        Err(_) => Verdict::Refused,
        Ok(report) if report.divergence.is_some() => Verdict::Diverged,
        Ok(_) if !recording.finished() => Verdict::Refused,
        Ok(_) => Verdict::Passed(Box::new(recording.into_log())),
    }
}

/// The log without what only the seals vouch for.
fn replayed(log: &Log) -> Log {
    let mut log = log.clone();
    (log.masks, log.notes, log.annotation) = (Vec::new(), Vec::new(), None);
    log.manifest.provenance.clear();
    log.manifest.engines.clear();
    log.manifest.case.iter_mut().for_each(|case| case.source = [0; 32]);
    log
}

fn original(which: usize) -> Log {
    Recording::from_bytes(&FILES[which]).expect("a file").into_log()
}

/// A change of one thing in a file.
#[derive(Clone, Debug)]
pub enum Change {
    Payload { message: prop::sample::Index, byte: prop::sample::Index, flip: u8 },
    Cut { message: prop::sample::Index, by: prop::sample::Index },
    Longer { message: prop::sample::Index, byte: u8 },
    Sequence { message: prop::sample::Index, by: u32 },
    Time { message: prop::sample::Index, by: u64 },
    Published { message: prop::sample::Index, by: u64 },
    Gone { message: prop::sample::Index },
    Twice { message: prop::sample::Index },
    Swapped { messages: [prop::sample::Index; 2] },
    Schema { which: prop::sample::Index, field: u8 },
    Channel { which: prop::sample::Index, field: u8 },
    Library,
}

pub fn change() -> impl Strategy<Value = Change> {
    use Change::*;
    let (index, flip) = (any::<prop::sample::Index>, 1u8..);
    prop_oneof![
        12 => (index(), index(), flip).prop_map(|(message, byte, flip)| Payload { message, byte, flip }),
        1 => (index(), index()).prop_map(|(message, by)| Cut { message, by }),
        1 => (index(), any::<u8>()).prop_map(|(message, byte)| Longer { message, byte }),
        1 => (index(), 1u32..).prop_map(|(message, by)| Sequence { message, by }),
        1 => (index(), 1u64..).prop_map(|(message, by)| Time { message, by }),
        1 => (index(), 1u64..).prop_map(|(message, by)| Published { message, by }),
        1 => index().prop_map(|message| Gone { message }),
        1 => index().prop_map(|message| Twice { message }),
        1 => any::<[prop::sample::Index; 2]>().prop_map(|messages| Swapped { messages }),
        1 => (index(), 0u8..3).prop_map(|(which, field)| Schema { which, field }),
        1 => (index(), 0u8..3).prop_map(|(which, field)| Channel { which, field }),
        1 => Just(Library),
    ]
}

impl Change {
    pub fn make(&self, parts: &mut Parts) {
        let all: Vec<_> =
            (0..parts.chunks.len()).flat_map(|c| (0..parts.chunks[c].len()).map(move |m| (c, m))).collect();
        match self {
            Self::Payload { message, byte, flip } => {
                let payload = &mut parts.at(message).payload;
                if !payload.is_empty() {
                    let at = byte.index(payload.len());
                    payload[at] ^= flip;
                }
            }
            Self::Cut { message, by } => {
                let payload = &mut parts.at(message).payload;
                payload.truncate(by.index(payload.len() + 1).saturating_sub(1));
            }
            Self::Longer { message, byte } => parts.at(message).payload.push(*byte),
            Self::Sequence { message, by } => {
                let header = &mut parts.at(message).header;
                header.sequence = header.sequence.wrapping_add(*by);
            }
            Self::Time { message, by } => {
                let header = &mut parts.at(message).header;
                header.log_time = header.log_time.wrapping_add(*by);
                header.publish_time = header.log_time;
            }
            Self::Published { message, by } => {
                let header = &mut parts.at(message).header;
                header.publish_time = header.publish_time.wrapping_add(*by);
            }
            Self::Gone { message } => {
                let (chunk, at) = *message.get(&all);
                parts.chunks[chunk].remove(at);
                parts.count();
            }
            Self::Twice { message } => {
                let (chunk, at) = *message.get(&all);
                let copy = parts.chunks[chunk][at].clone();
                parts.chunks[chunk].insert(at, copy);
                parts.count();
            }
            Self::Swapped { messages: [a, b] } => {
                let (a, b) = (*a.get(&all), *b.get(&all));
                let (left, right) = (parts.chunks[a.0][a.1].clone(), parts.chunks[b.0][b.1].clone());
                parts.chunks[a.0][a.1] = right;
                parts.chunks[b.0][b.1] = left;
                parts.count();
            }
            Self::Schema { which, field } => {
                let at = which.index(parts.schemas.len());
                let schema = &mut parts.schemas[at];
                match field {
                    0 => schema.name.push('x'),
                    1 => schema.encoding.push('x'),
                    _ => schema.text.push(b'.'),
                }
            }
            Self::Channel { which, field } => {
                let at = which.index(parts.channels.len());
                let channel = &mut parts.channels[at];
                match field {
                    0 => channel.topic.push('x'),
                    1 => channel.message_encoding.push('x'),
                    _ => drop(channel.metadata.insert("a".into(), "b".into())),
                }
            }
            Self::Library => parts.library.push('x'),
        }
    }
}

impl Parts {
    fn at(&mut self, message: &prop::sample::Index) -> &mut parts::Message {
        let count = self.messages().count();
        self.messages().nth(message.index(count)).expect("one of them")
    }

    /// Numbers the messages anew.
    fn count(&mut self) {
        self.messages().enumerate().for_each(|(number, message)| message.header.sequence = number as u32);
    }
}

#[test]
fn taken_apart_and_put_together_it_is_the_same() {
    for (which, file) in FILES.iter().enumerate() {
        let mut parts = Parts::of(file);
        assert_eq!(verdict(&parts.file()), Verdict::Passed(Box::new(original(which))));
        parts.messages().filter(|message| message.header.channel_id == SEAL).for_each(|seal| seal.payload.clear());
        parts.seal();
        assert_eq!(verdict(&parts.file()), Verdict::Passed(Box::new(original(which))), "the seals are as documented");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1200))]

    /// Checksums and indexes fit, the seals do not.
    #[test]
    fn whatever_is_changed_is_refused(which in 0usize..2, change in change()) {
        let mut parts = Parts::of(&FILES[which]);
        change.make(&mut parts);
        if Parts::of(&FILES[which]).file() != parts.file() {
            prop_assert_eq!(verdict(&parts.file()), Verdict::Refused);
        }
    }

    /// The seals are made anew as well: what follows from a replay is still found.
    #[test]
    fn the_replay_vouches_for_world_rules_inputs_scenes_and_times(which in 0usize..2, change in change()) {
        let mut parts = Parts::of(&FILES[which]);
        change.make(&mut parts);
        parts.seal();
        if let Verdict::Passed(log) = verdict(&parts.file()) {
            prop_assert!(replayed(&log) == replayed(&original(which)), "it passes and says something else");
        }
    }

    /// The records around the messages, and the index at the end. zstd has several ways to pack the same bytes.
    #[test]
    fn a_changed_byte_is_found_although_the_checksums_fit(
        which in 0usize..2, at in any::<prop::sample::Index>(), flip in 1u8..,
    ) {
        let mut file = FILES[which].clone();
        file[at.index(FILES[which].len())] ^= flip;
        repair(&mut file);
        if let Verdict::Passed(log) = verdict(&file) {
            prop_assert!(*log == original(which), "it passes and says something else");
        }
    }
}

/// Makes the checksums of data and index fit, as far as the file still says where these are.
fn repair(file: &mut [u8]) {
    let footer = file.len() - 8 - 20;
    let index = u64::from_le_bytes(file[footer..footer + 8].try_into().expect("8 bytes")) as usize;
    if (13..footer).contains(&index) {
        let data = crc32fast::hash(&file[..index - 13]);
        file[index - 4..index].copy_from_slice(&data.to_le_bytes());
        let sum = crc32fast::hash(&file[index..footer + 16]);
        file[footer + 16..footer + 20].copy_from_slice(&sum.to_le_bytes());
    }
}

type LogChange = fn(&mut Log);

/// Changes of the content, written as this program writes it.
#[test]
fn a_changed_world_diverges_although_everything_fits() {
    let changes: &[(&str, LogChange)] = &[
        ("sun", |log| log.manifest.scenario.weather.sun_altitude_deg += 1.0),
        ("limit", |log| log.manifest.scenario.rules.max_speed_kmh -= 1.0),
        ("brake threshold", |log| log.manifest.scenario.rules.brake_threshold += 0.01),
        ("steering threshold", |log| log.manifest.scenario.rules.steer_threshold += 0.01),
        ("least speed", |log| log.manifest.scenario.rules.least_intervention_kmh += 1.0),
        ("takeover", |log| log.manifest.scenario.rules.takeover_s += 1),
        ("time", |log| log.manifest.scenario.rules.max_seconds += 1),
        ("jaywalks", |log| log.manifest.scenario.traffic.jaywalks_per_min += 0.5),
        ("headway", |log| log.manifest.scenario.traffic.drivers.headway_s[1] += 0.1),
        ("seed", |log| log.manifest.scenario.seed += 1),
        ("start", |log| log.manifest.scenario.ego.s_m += 0.5),
        ("helpers of the car", |log| log.manifest.scenario.car.esc = false),
        ("window's begin", |log| log.manifest.case.iter_mut().for_each(|case| case.from += 6)),
        ("window's end", |log| log.manifest.case.iter_mut().for_each(|case| case.to -= 6)),
        ("window beyond the log", |log| log.manifest.case.iter_mut().for_each(|case| case.to += 6000)),
        ("scenes in another order", |log| log.scenes.reverse()),
        ("a scene less", |log| drop(log.scenes.pop())),
        ("a scene twice", |log| log.scenes.extend(log.scenes.last().cloned())),
        ("scenes of a recording", |log| log.manifest.case = None),
        ("weather of a scene", |log| log.scenes[3].weather.cloudiness_pct += 1.0),
        ("an event", |log| log.events.truncate(1)),
        ("no intervention", |log| log.intervention = None),
        ("outcome", |log| log.summary.iter_mut().for_each(|summary| summary.outcome = None)),
        ("distance", |log| log.summary.iter_mut().for_each(|summary| summary.odometer_mm += 1)),
        ("keyframe", |log| log.keyframes[0].bytes[20] ^= 1),
    ];
    for (what, change) in changes {
        let mut log = original(1);
        change(&mut log);
        assert_ne!(log, original(1), "{what}");
        let found = verdict(&log.encode().expect("a log"));
        assert!(matches!(found, Verdict::Diverged | Verdict::Refused), "{what}");
    }
}

#[test]
fn a_case_that_was_cut_off_is_damaged() {
    let [recording, case] = &*FILES;
    let (recording, case) = (&recording[..recording.len() - 1], &case[..case.len() - 1]);
    assert!(!Recording::from_bytes(recording).expect("a recording grows").finished());
    let said = Recording::from_bytes(case).expect_err("a case is written as a whole").to_string();
    assert!(said.contains("it was cut off"), "{said}");
}
