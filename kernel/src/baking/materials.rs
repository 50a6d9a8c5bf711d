//! What lanes are made of, along their strips.

use std::ops::Range;

use glam::Vec3;

use super::notes::{Notes, Passed};
use super::rounding::snap3;
use super::source::Source;
use crate::map_data::SurfaceKind;

/// What a lane is made of by its type.
pub(super) fn material(kind: xodr::LaneType) -> SurfaceKind {
    use xodr::LaneType as T;
    match kind {
        T::Sidewalk | T::Curb => SurfaceKind::Sidewalk,
        T::None | T::Median | T::Unknown => SurfaceKind::Terrain,
        T::Rail | T::Tram => SurfaceKind::Track,
        T::Restricted => SurfaceKind::Ground,
        _ => SurfaceKind::Road,
    }
}

/// What a lane of a road is made of by the words of a file, whose codes OpenDRIVE leaves open; `None` where they say
/// nothing that is known. Its friction is not used: of which tyre it would be, the file does not say.
fn named(surface: &str) -> Option<SurfaceKind> {
    use SurfaceKind as K;
    const WORDS: [(SurfaceKind, &[&str]); 4] = [
        (K::Gravel, &["gravel", "unpaved", "dirt"]),
        (K::Setts, &["cobble", "setts", "paving"]),
        (K::Terrain, &["grass", "soil", "mud"]),
        (K::Road, &["asphalt", "concrete", "tarmac"]),
    ];
    let surface = surface.to_ascii_lowercase();
    WORDS.iter().find(|(_, words)| words.iter().any(|word| surface.contains(word))).map(|(kind, _)| *kind)
}

/// The strip of a lane, cut where its material changes.
pub(super) fn stretches(
    source: &Source,
    lane: &xodr::Lane,
    ribs: Vec<[Vec3; 2]>,
    notes: &mut Notes,
) -> Vec<(SurfaceKind, Vec<[Vec3; 2]>)> {
    let usual = material(lane.kind);
    let told = source.materials(lane.id);
    if told.is_empty() || !matches!(usual, SurfaceKind::Road | SurfaceKind::Ground) {
        return vec![(usual, ribs)];
    }
    let places = measured(&ribs);
    let mut stretches = Vec::new();
    let mut from_m = 0.0;
    for stretch in told {
        stretches.push((usual, cut(&ribs, &places, from_m..stretch.from)));
        let kind = named(&stretch.value.surface).unwrap_or_else(|| {
            let what = || format!("material {}", stretch.value.surface);
            notes.pass(Passed::Surface, "counts as asphalt", what, || source.place_of_lane(lane.id));
            usual
        });
        // What is not for driving is no road, however it is paved.
        let is_paved = matches!(kind, SurfaceKind::Road | SurfaceKind::Setts);
        let kind = if usual == SurfaceKind::Ground && is_paved { usual } else { kind };
        stretches.push((kind, cut(&ribs, &places, stretch.from..stretch.to)));
        from_m = stretch.to;
    }
    stretches.push((usual, cut(&ribs, &places, from_m..f32::MAX)));
    stretches
}

/// How far along the middle of a strip each of its ribs is, metres.
fn measured(ribs: &[[Vec3; 2]]) -> Vec<f32> {
    let middle = |rib: &[Vec3; 2]| 0.5 * (rib[0] + rib[1]);
    let mut along_m = 0.0;
    let steps = ribs.windows(2).map(|pair| {
        along_m += middle(&pair[0]).distance(middle(&pair[1]));
        along_m
    });
    std::iter::once(0.0).chain(steps).collect()
}

/// The part of a strip between two places along it, metres.
fn cut(ribs: &[[Vec3; 2]], places: &[f32], between_m: Range<f32>) -> Vec<[Vec3; 2]> {
    let mut part = Vec::new();
    for (pair, place) in ribs.windows(2).zip(places.windows(2)) {
        let (start, end) = (place[0].max(between_m.start), place[1].min(between_m.end));
        if start >= end {
            continue;
        }
        let at = |s_m: f32| {
            let share = (s_m - place[0]) / (place[1] - place[0]);
            [0, 1]
                .map(|side| if share == 1.0 { pair[1][side] } else { snap3(pair[0][side].lerp(pair[1][side], share)) })
        };
        if part.is_empty() {
            part.push(at(start));
        }
        part.push(at(end));
    }
    part
}
