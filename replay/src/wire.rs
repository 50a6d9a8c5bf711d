//! The payloads of messages as bytes. The only file that names bincode; what it declares is the wire
//! layout that `layout.rs` describes.

use std::collections::BTreeMap;

use bincode::config::{Configuration, Limit, LittleEndian, Varint};
use bincode::{Decode, Encode};
use kernel::events::Event;
use kernel::state::State;
use kernel::time::Tick;
use kernel::world::PARTS;
use kernel::{Keyframe, Scenario, SceneSnapshot, Seat, StateHash, TickInput};

use crate::block::{BLOCK_TICKS, Block, Happenings};
use crate::columns::{self, ControlColumns};
use crate::layout::OLDEST_VERSION;
use crate::{
    Annotation, CaseInfo, ForeignMap, Label, LiveTimes, Manifest, Mark, MaskShown, Note, NoteKind, RunSummary,
};

/// Most bytes that a payload may claim; keeps damaged lengths from asking for memory.
const LIMIT: usize = 16 << 20;
/// Whose note it is that happened to all of the rig.
const WHOLE_RIG: u8 = 2;
/// Most masks, and most notes, of a tick.
pub(crate) const MOST_A_TICK: usize = 16;
/// Most masks, and most notes, of a message.
pub(crate) const MOST_ROWS: usize = MOST_A_TICK * BLOCK_TICKS as usize;

/// Most bytes that a keyframe may unpack to; one with 150 actors has about 4 kB.
const MAX_KEYFRAME: usize = 1 << 20;
/// Level of zstd; keyframes are rare, so it may take its time.
const KEYFRAME_LEVEL: i32 = 19;

/// Why a payload is not what its channel says.
pub(crate) type Wrong = String;

fn config() -> Configuration<LittleEndian, Varint, Limit<LIMIT>> {
    bincode::config::standard().with_limit::<LIMIT>()
}

fn encode(value: impl Encode) -> Vec<u8> {
    bincode::encode_to_vec(value, config()).expect("plain data within the limit can be encoded")
}

fn decode<T: Decode<()>>(bytes: &[u8]) -> Result<T, Wrong> {
    let (value, read) = bincode::decode_from_slice(bytes, config()).map_err(|e| e.to_string())?;
    if read == bytes.len() { Ok(value) } else { Err(format!("{} bytes are left over", bytes.len() - read)) }
}

fn state<T: State>(what: &str, bytes: &[u8]) -> Result<T, Wrong> {
    T::from_bytes(bytes).map_err(|e| format!("{what}: {e}"))
}

#[derive(Encode, Decode)]
struct ManifestWire {
    format: u16,
    kernel: String,
    engines: String,
    scenario: String,
    map_digest: [u8; 16],
    foreign_map: Option<[u8; 32]>,
    provenance: BTreeMap<String, String>,
    case: Option<([u8; 32], Tick, Tick)>,
}

/// The version of the layout since which a snapshot has the ego car's lamps, after tick, position, rotation, speed and wheel
/// angle, and at its end five numbers of weather from rain to fog.
const LAMPS_AND_RAIN_SINCE: u16 = 3;
const EGO_LAMPS_AT: usize = 8 + 9 * 4;
const RAIN_TO_FOG: usize = 5 * size_of::<f32>();

/// As version 1 of the layout had it.
#[derive(Encode, Decode)]
struct ManifestWire1 {
    format: u16,
    kernel: String,
    scenario: String,
    map_digest: [u8; 16],
    foreign_map: Option<String>,
    provenance: BTreeMap<String, String>,
    case: Option<([u8; 32], Tick, Tick)>,
}

pub(crate) fn manifest_bytes(manifest: &Manifest) -> Vec<u8> {
    encode(ManifestWire {
        format: manifest.format,
        kernel: manifest.kernel.clone(),
        engines: manifest.engines.clone(),
        scenario: manifest.scenario.to_toml(),
        map_digest: manifest.map_digest.to_le_bytes(),
        foreign_map: manifest.foreign_map.as_ref().map(|map| map.digest),
        provenance: manifest.provenance.clone(),
        case: manifest.case.as_ref().map(|c| (c.source, c.from, c.to)),
    })
}

/// The manifest of a file of layout `format`; the text of a foreign map is not yet known.
pub(crate) fn manifest(bytes: &[u8], format: u16) -> Result<Manifest, Wrong> {
    let (claimed, _) = bincode::decode_from_slice::<u16, _>(bytes, config()).map_err(|e| e.to_string())?;
    if claimed != format {
        return Err(format!("layout version {claimed}; its schemas are of version {format}"));
    }
    if format == OLDEST_VERSION {
        return manifest_1(decode(bytes)?);
    }
    let wire: ManifestWire = decode(bytes)?;
    let scenario = scenario(&wire.scenario)?;
    // Earlier kernels, whose logs no other can drive, knew fewer keys.
    if wire.kernel == kernel::identity() && scenario.to_toml() != wire.scenario {
        return Err("its scenario is not written as this program writes it".to_owned());
    }
    Ok(Manifest {
        format,
        kernel: wire.kernel,
        engines: wire.engines,
        scenario,
        map_digest: u128::from_le_bytes(wire.map_digest),
        foreign_map: wire.foreign_map.map(|digest| ForeignMap { digest, text: None, embedded: false }),
        provenance: wire.provenance,
        case: wire.case.map(|(source, from, to)| CaseInfo { source, from, to }),
    })
}

fn manifest_1(wire: ManifestWire1) -> Result<Manifest, Wrong> {
    Ok(Manifest {
        format: wire.format,
        kernel: wire.kernel,
        engines: String::new(),
        scenario: scenario(&wire.scenario)?,
        map_digest: u128::from_le_bytes(wire.map_digest),
        foreign_map: wire.foreign_map.map(|text| ForeignMap::new(text, true)),
        provenance: wire.provenance,
        case: wire.case.map(|(source, from, to)| CaseInfo { source, from, to }),
    })
}

fn scenario(toml: &str) -> Result<Scenario, Wrong> {
    let scenario = Scenario::from_toml(toml).map_err(|e| format!("scenario: {e}"))?;
    // What is made from a recording is filed under the name of its map.
    intake::check_name(&scenario.map).map_err(|reason| format!("map: {reason}"))?;
    Ok(scenario)
}

/// A keyframe repeats much of the one before it, which therefore serves as zstd's dictionary.
pub(crate) fn keyframe_bytes(keyframe: &Keyframe, before: &[u8]) -> Vec<u8> {
    let packed = zstd::bulk::Compressor::with_dictionary(KEYFRAME_LEVEL, before)
        .and_then(|mut packer| packer.compress(&keyframe.bytes))
        .expect("bytes in memory can be compressed");
    encode((keyframe.tick, keyframe.bytes.len(), packed, keyframe.hash().0.to_le_bytes()))
}

/// The keyframe of a file of layout `format`, the state before which is `before`.
pub(crate) fn keyframe(bytes: &[u8], before: &[u8], format: u16) -> Result<Keyframe, Wrong> {
    if format == OLDEST_VERSION {
        let (tick, length, packed) = decode(bytes)?;
        return unpacked(tick, length, packed, before);
    }
    let (tick, length, packed, hash): (_, _, _, [u8; 16]) = decode(bytes)?;
    let keyframe = unpacked(tick, length, packed, before)?;
    let (expected, got) = (StateHash(u128::from_le_bytes(hash)), keyframe.hash());
    if got == expected { Ok(keyframe) } else { Err(format!("the hash of its state is {got:?}, expected {expected:?}")) }
}

fn unpacked(tick: Tick, length: usize, packed: Vec<u8>, before: &[u8]) -> Result<Keyframe, Wrong> {
    if length > MAX_KEYFRAME {
        return Err(format!("it claims {length} bytes, more than {MAX_KEYFRAME}"));
    }
    let bytes = zstd::bulk::Decompressor::with_dictionary(before)
        .and_then(|mut unpacker| unpacker.decompress(&packed, length))
        .map_err(|e| format!("it does not unpack: {e}"))?;
    if bytes.len() == length {
        Ok(Keyframe { tick, bytes })
    } else {
        Err(format!("{} bytes, not {length}", bytes.len()))
    }
}

#[derive(Encode, Decode)]
struct BlockWire {
    first: Tick,
    semantic: ControlColumns,
    safety: ControlColumns,
    hashes: Vec<u8>,
    hash: [u8; 16],
    parts: [[u8; 8]; PARTS.len()],
    odometer_mm: u64,
}

pub(crate) fn block_bytes(block: &Block) -> Vec<u8> {
    encode(BlockWire {
        first: block.first,
        semantic: columns::split_controls(block.inputs.iter().map(|i| &i.semantic)),
        safety: columns::split_controls(block.inputs.iter().map(|i| &i.safety)),
        hashes: block.hashes.iter().flat_map(|h| h.to_le_bytes()).collect(),
        hash: block.mark.hash.0.to_le_bytes(),
        parts: block.mark.parts.map(u64::to_le_bytes),
        odometer_mm: block.mark.odometer_mm,
    })
}

/// A block without its events, masks and keyframes, which have messages of their own.
pub(crate) fn block(bytes: &[u8]) -> Result<Block, Wrong> {
    let wire: BlockWire = decode(bytes)?;
    let (hashes, rest) = wire.hashes.as_chunks::<4>();
    let ticks = hashes.len();
    if ticks == 0 || ticks as Tick > BLOCK_TICKS || !rest.is_empty() {
        return Err(format!("{} bytes of hashes, expected 4 for each of 1 to {BLOCK_TICKS} ticks", wire.hashes.len()));
    }
    let semantic = columns::join_controls(&wire.semantic, ticks)?;
    let safety = columns::join_controls(&wire.safety, ticks)?;
    let last = wire.first.checked_add(ticks as Tick - 1).filter(|_| wire.first > 0);
    let last = last.ok_or_else(|| format!("first tick {}", wire.first))?;
    Ok(Block {
        first: wire.first,
        inputs: semantic.into_iter().zip(safety).map(|(semantic, safety)| TickInput { semantic, safety }).collect(),
        hashes: hashes.iter().map(|h| u32::from_le_bytes(*h)).collect(),
        mark: Mark {
            tick: last,
            hash: StateHash(u128::from_le_bytes(wire.hash)),
            parts: wire.parts.map(u64::from_le_bytes),
            odometer_mm: wire.odometer_mm,
        },
        ..Block::starting_at(wire.first)
    })
}

#[derive(Encode, Decode)]
struct EventsWire {
    ticks: Vec<i64>,
    events: Vec<u8>,
    intervention: Option<Vec<u8>>,
}

pub(crate) fn happenings_bytes(happenings: &Happenings) -> Vec<u8> {
    let (ticks, events): (Vec<Tick>, Vec<Event>) = happenings.events.iter().copied().unzip();
    encode(EventsWire {
        ticks: columns::differences(ticks.into_iter()),
        events: events.to_bytes(),
        intervention: happenings.intervention.map(|i| i.to_bytes()),
    })
}

pub(crate) fn happenings(bytes: &[u8]) -> Result<Happenings, Wrong> {
    let wire: EventsWire = decode(bytes)?;
    let events: Vec<Event> = state("events", &wire.events)?;
    if events.len() != wire.ticks.len() {
        return Err(format!("{} ticks for {} events", wire.ticks.len(), events.len()));
    }
    Ok(Happenings {
        events: columns::sums(&wire.ticks).zip(events).collect(),
        intervention: wire.intervention.map(|b| state("intervention", &b)).transpose()?,
    })
}

fn at_most(rows: usize, what: &str) -> Result<usize, Wrong> {
    if rows <= MOST_ROWS { Ok(rows) } else { Err(format!("{rows} {what}, expected at most {MOST_ROWS}")) }
}

#[derive(Encode, Decode)]
struct MasksWire {
    shown: Vec<i64>,
    age: Vec<i64>,
    camera: Vec<u8>,
    digests: Vec<[u8; 8]>,
    /// Capture (differences), inference after capture, present after inference.
    times: Vec<Option<(i64, i64, i64)>>,
}

pub(crate) fn masks_bytes(masks: &[MaskShown]) -> Vec<u8> {
    let mut before_us = 0;
    let mut times = |t: LiveTimes| {
        let since = |later: u64, earlier: u64| later.wrapping_sub(earlier) as i64;
        let capture = since(t.capture_us, std::mem::replace(&mut before_us, t.capture_us));
        (capture, since(t.inference_us, t.capture_us), since(t.present_us, t.inference_us))
    };
    encode(MasksWire {
        shown: columns::differences(masks.iter().map(|m| m.tick_shown)),
        age: masks.iter().map(|m| m.tick_shown.wrapping_sub(m.tick_of_frame) as i64).collect(),
        camera: masks.iter().map(|m| m.camera).collect(),
        digests: masks.iter().map(|m| m.digest.to_le_bytes()).collect(),
        times: masks.iter().map(|m| m.times.map(&mut times)).collect(),
    })
}

pub(crate) fn masks(bytes: &[u8]) -> Result<Vec<MaskShown>, Wrong> {
    let wire: MasksWire = decode(bytes)?;
    let rows = at_most(wire.shown.len(), "masks")?;
    if [wire.age.len(), wire.camera.len(), wire.digests.len(), wire.times.len()].iter().any(|n| *n != rows) {
        return Err(format!("columns of different lengths for {rows} masks"));
    }
    let mut capture_us = 0u64;
    let mut times = |(capture, inference, present): (i64, i64, i64)| {
        capture_us = capture_us.wrapping_add(capture as u64);
        let inference_us = capture_us.wrapping_add(inference as u64);
        LiveTimes { capture_us, inference_us, present_us: inference_us.wrapping_add(present as u64) }
    };
    let shown = columns::sums(&wire.shown).enumerate();
    Ok(shown
        .map(|(i, tick_shown)| MaskShown {
            tick_shown,
            tick_of_frame: tick_shown.wrapping_sub(wire.age[i] as u64),
            camera: wire.camera[i],
            digest: u64::from_le_bytes(wire.digests[i]),
            times: wire.times[i].map(&mut times),
        })
        .collect())
}

#[derive(Encode, Decode)]
struct NotesWire {
    ticks: Vec<i64>,
    kinds: Vec<u8>,
    seats: Vec<u8>,
}

pub(crate) fn notes_bytes(notes: &[Note]) -> Vec<u8> {
    encode(NotesWire {
        ticks: columns::differences(notes.iter().map(|n| n.tick)),
        kinds: notes.iter().map(|n| n.kind as u8).collect(),
        seats: notes.iter().map(|n| n.seat.map_or(WHOLE_RIG, |seat| seat as u8)).collect(),
    })
}

pub(crate) fn notes(bytes: &[u8]) -> Result<Vec<Note>, Wrong> {
    let wire: NotesWire = decode(bytes)?;
    let rows = at_most(wire.ticks.len(), "notes")?;
    if [wire.kinds.len(), wire.seats.len()].iter().any(|n| *n != rows) {
        return Err(format!("columns of different lengths for {rows} notes"));
    }
    let codes = wire.kinds.iter().zip(&wire.seats);
    let rows = columns::sums(&wire.ticks).zip(codes).map(|(tick, (kind, seat))| {
        let known = NoteKind::ALL.into_iter().find(|k| *k as u8 == *kind);
        let kind = known.ok_or_else(|| format!("unknown kind {kind} of note"))?;
        let whose = [Seat::Semantic, Seat::Safety].into_iter().find(|s| *s as u8 == *seat);
        if whose.is_none() && *seat != WHOLE_RIG {
            return Err("a note of an unknown seat".to_owned());
        }
        Ok(Note { tick, kind, seat: whose })
    });
    rows.collect()
}

#[derive(Encode, Decode)]
struct EndWire {
    annotation: Option<(u8, String, Option<bool>)>,
    summary: Option<(Tick, u64, Vec<u8>, Vec<u8>)>,
}

pub(crate) fn end_bytes(annotation: Option<&Annotation>, summary: Option<&RunSummary>) -> Vec<u8> {
    encode(EndWire {
        annotation: annotation.map(|a| (a.label as u8, a.comment.clone(), a.perception_caused)),
        summary: summary.map(|s| (s.ticks, s.odometer_mm, s.intervention.to_bytes(), s.outcome.to_bytes())),
    })
}

pub(crate) fn end(bytes: &[u8]) -> Result<(Option<Annotation>, Option<RunSummary>), Wrong> {
    let wire: EndWire = decode(bytes)?;
    let annotation = wire.annotation.map(|(code, comment, perception_caused)| {
        let label = Label::all().find(|l| *l as u8 == code).ok_or(format!("unknown label {code}"))?;
        Ok::<_, Wrong>(Annotation { label, comment, perception_caused })
    });
    let summary = wire.summary.map(|(ticks, odometer_mm, intervention, outcome)| {
        let (intervention, outcome) = (state("intervention", &intervention)?, state("outcome", &outcome)?);
        Ok::<_, Wrong>(RunSummary { ticks, odometer_mm, intervention, outcome })
    });
    Ok((annotation.transpose()?, summary.transpose()?))
}

pub(crate) fn scenes_bytes(scenes: &[SceneSnapshot]) -> Vec<u8> {
    let rows: Vec<Vec<u8>> = scenes.iter().map(State::to_bytes).collect();
    let lengths: Vec<usize> = rows.iter().map(Vec::len).collect();
    encode((lengths, columns::stack(&rows)))
}

pub(crate) fn scenes(bytes: &[u8], format: u16) -> Result<Vec<SceneSnapshot>, Wrong> {
    scene_rows(bytes, format)?.iter().map(|row| state("scene", row)).collect()
}

/// The last of the scenes, if there are any.
pub(crate) fn last_scene(bytes: &[u8], format: u16) -> Result<Option<SceneSnapshot>, Wrong> {
    scene_rows(bytes, format)?.last().map(|row| state("scene", row)).transpose()
}

/// State bytes of each scene.
fn scene_rows(bytes: &[u8], format: u16) -> Result<Vec<Vec<u8>>, Wrong> {
    let (lengths, stacked): (Vec<usize>, Vec<u8>) = decode(bytes)?;
    let mut rows = columns::unstack(&lengths, &stacked)?;
    if format < LAMPS_AND_RAIN_SINCE {
        for row in rows.iter_mut().filter(|row| row.len() > EGO_LAMPS_AT) {
            row.insert(EGO_LAMPS_AT, 0);
            row.extend([0; RAIN_TO_FOG]);
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FORMAT_VERSION;
    use kernel::scene::EgoScene;
    use proptest::prelude::*;

    #[test]
    fn a_map_whose_name_leads_elsewhere_is_refused() {
        let mut log = crate::testing::sample(60);
        assert!(manifest(&manifest_bytes(&log.manifest), FORMAT_VERSION).is_ok());
        for name in ["../../x", "/tmp/x", "", ".."] {
            log.manifest.scenario.map = name.into();
            let said = manifest(&manifest_bytes(&log.manifest), FORMAT_VERSION).unwrap_err();
            assert!(said.starts_with("map: the name") && said.contains("cannot be a file's"), "{said}");
        }
    }

    fn mask() -> impl Strategy<Value = MaskShown> {
        let times = (any::<u64>(), any::<u64>(), any::<u64>())
            .prop_map(|(capture_us, inference_us, present_us)| LiveTimes { capture_us, inference_us, present_us });
        let fields = (any::<u64>(), any::<u64>(), any::<u8>(), any::<u64>(), prop::option::of(times));
        fields.prop_map(|(tick_shown, tick_of_frame, camera, digest, times)| MaskShown {
            tick_shown,
            tick_of_frame,
            camera,
            digest,
            times,
        })
    }

    fn note() -> impl Strategy<Value = Note> {
        let (kinds, seats) = (NoteKind::ALL.to_vec(), vec![None, Some(Seat::Semantic), Some(Seat::Safety)]);
        let fields = (any::<u64>(), prop::sample::select(kinds), prop::sample::select(seats));
        fields.prop_map(|(tick, kind, seat)| Note { tick, kind, seat })
    }

    proptest! {
        #[test]
        fn any_notes_come_back(rows in prop::collection::vec(note(), 0..40)) {
            prop_assert_eq!(notes(&notes_bytes(&rows)), Ok(rows));
        }

        #[test]
        fn any_masks_come_back(rows in prop::collection::vec(mask(), 0..40)) {
            prop_assert_eq!(masks(&masks_bytes(&rows)), Ok(rows));
        }

        #[test]
        fn foreign_payloads_are_no_panic(mut bytes in prop::collection::vec(any::<u8>(), 0..200), small in any::<bool>()) {
            if small {
                // Small numbers pass for lengths and get further.
                bytes.iter_mut().for_each(|b| *b &= 7);
            }
            for format in [OLDEST_VERSION, FORMAT_VERSION] {
                let _ = (manifest(&bytes, format), keyframe(&bytes, b"before", format), scenes(&bytes, format));
            }
            let _ = (block(&bytes), happenings(&bytes));
            let _ = (masks(&bytes), end(&bytes), notes(&bytes));
        }
    }

    #[test]
    fn before_version_3_the_ego_car_had_no_lamps() {
        let ego = EgoScene {
            position: [1.0, 2.0, 3.0].into(),
            rotation: Default::default(),
            speed_mps: 4.0,
            wheel_angle_rad: 0.5,
            lamps: 7,
        };
        let weather = kernel::Scenario::default_for("field", 1).weather;
        let scene = SceneSnapshot { tick: 9, ego, actors: Vec::new(), lights: Vec::new(), weather };
        assert_eq!(scenes(&scenes_bytes(std::slice::from_ref(&scene)), FORMAT_VERSION), Ok(vec![scene.clone()]));
        let mut row = scene.to_bytes();
        assert_eq!(row.remove(EGO_LAMPS_AT), 7);
        row.truncate(row.len() - RAIN_TO_FOG);
        let old = encode((vec![row.len()], columns::stack(&[row])));
        let dark = SceneSnapshot { ego: EgoScene { lamps: 0, ..ego }, ..scene };
        assert_eq!(scenes(&old, 2), Ok(vec![dark]));
        assert!(scenes(&old, FORMAT_VERSION).is_err());
    }

    #[test]
    fn an_unknown_note_is_an_error() {
        let wire = |kind, seat| encode(NotesWire { ticks: vec![5], kinds: vec![kind], seats: vec![seat] });
        assert!(notes(&wire(0, 1)).is_ok() && notes(&wire(4, 2)).is_ok());
        assert_eq!(notes(&wire(200, 1)), Err("unknown kind 200 of note".to_owned()));
        assert_eq!(notes(&wire(0, 3)), Err("a note of an unknown seat".to_owned()));
        let short = encode(NotesWire { ticks: vec![5], kinds: vec![], seats: vec![0] });
        assert!(notes(&short).is_err_and(|e| e.contains("different lengths")));
    }

    #[test]
    fn bytes_left_over_are_an_error() {
        let mut bytes = keyframe_bytes(&Keyframe { tick: 3, bytes: vec![1, 2] }, &[]);
        assert!(keyframe(&bytes, &[], FORMAT_VERSION).is_ok());
        bytes.push(0);
        assert_eq!(keyframe(&bytes, &[], FORMAT_VERSION), Err("1 bytes are left over".to_owned()));
    }

    #[test]
    fn a_keyframe_like_the_one_before_takes_next_to_nothing() {
        let state: Vec<u8> = (0..125u8).flat_map(|i| *blake3::hash(&[i]).as_bytes()).collect();
        let again = Keyframe { tick: 600, bytes: state.clone() };
        assert!(keyframe_bytes(&again, &[]).len() > 3900);
        let bytes = keyframe_bytes(&again, &state);
        assert!(bytes.len() < 56, "{} bytes", bytes.len());
        assert_eq!(keyframe(&bytes, &state, FORMAT_VERSION), Ok(again));
        assert!(keyframe(&bytes, &[], FORMAT_VERSION).is_err());
    }

    #[test]
    fn another_version_of_the_layout_is_refused_by_number() {
        let mut log = crate::testing::sample(1);
        log.manifest.format = FORMAT_VERSION + 1;
        let said = manifest(&manifest_bytes(&log.manifest), FORMAT_VERSION).expect_err("another version");
        assert_eq!(said, "layout version 4; its schemas are of version 3");
    }
}
