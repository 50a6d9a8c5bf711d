//! The frames on which checkpoints differ most.

use super::looking::Looked;

/// Frames that are shown, at most one of each case.
const SHOWN: usize = 8;

/// A frame of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Differing {
    /// Number of the case.
    pub case: usize,
    /// Number of the frame.
    pub frame: usize,
    /// By how many pixels of people and vehicles the worst checkpoint is more wrong than the best.
    pub pixels: u64,
}

/// Those with the greatest difference, in descending order.
pub fn most(looked: &[Looked]) -> Vec<Differing> {
    let mut found: Vec<Differing> =
        looked.iter().enumerate().filter_map(|(case, looked)| of_case(case, looked)).collect();
    found.sort_by_key(|each| (std::cmp::Reverse(each.pixels), each.case));
    found.truncate(SHOWN);
    found
}

fn of_case(case: usize, looked: &Looked) -> Option<Differing> {
    let pixels = |frame: usize| {
        let wrong = || looked.scores.iter().map(move |score| score.frames[frame].wrong);
        wrong().max().zip(wrong().min()).map_or(0, |(most, least)| most - least)
    };
    let frames = (0..looked.facts.ticks.len()).map(|frame| Differing { case, frame, pixels: pixels(frame) });
    frames.max_by_key(|each| (each.pixels, std::cmp::Reverse(each.frame))).filter(|each| each.pixels > 0)
}
