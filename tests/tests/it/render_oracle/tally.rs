//! How many pixels of the renderer agree with rays, away from borders.

use render::{Frame, SemanticTag};

use super::bvh::Label;

/// Depths agree when they differ by less than this share.
const DEPTH_SHARE: f64 = 0.01;
/// Or, of plants, than this, metres: which leaves cover a sample depends on how coarse their picture is.
const LEAVES_M: f64 = 1.2;

/// By how much depths may differ that agree, metres.
fn depth_room(class: u8, distance: f64) -> f64 {
    let leaves = if class == SemanticTag::Vegetation as u8 { LEAVES_M } else { 0.0 };
    leaves.max(DEPTH_SHARE * distance)
}

/// What rays found in a picture's pixels, and how far away.
pub struct Truth {
    /// Pixels a row.
    pub width: usize,
    /// Row by row from above.
    pub pixels: Vec<(Label, f64)>,
}

impl Truth {
    /// Whether all eight neighbours show the same as a pixel.
    fn is_inside(&self, at: usize) -> bool {
        let (x, y) = (at % self.width, at / self.width);
        let near = |v: usize, end: usize| v.saturating_sub(1)..(v + 2).min(end);
        let label = |x: usize, y: usize| self.pixels[y * self.width + x].0;
        near(y, self.pixels.len() / self.width).all(|v| near(x, self.width).all(|u| label(u, v) == self.pixels[at].0))
    }
}

/// Pixels of one class of the rays.
#[derive(Clone, Copy, Default)]
pub struct Count {
    pub all: u32,
    /// Of those, of the same class.
    pub same: u32,
    /// Of those, of the same depth.
    pub close: u32,
    /// Of those of the same class, of the same instance.
    pub who: u32,
}

impl Count {
    /// A share of pixels; 0 of none, so that what was not seen passes no bar.
    pub fn share(part: u32, all: u32) -> f64 {
        if all == 0 { 0.0 } else { f64::from(part) / f64::from(all) }
    }
}

/// Pixels away from borders, by class of the rays.
#[derive(Default)]
pub struct Tally {
    pub classes: [Count; 23],
}

impl Tally {
    pub fn add(&mut self, frame: &Frame, truth: &Truth) {
        for at in (0..truth.pixels.len()).filter(|&at| truth.is_inside(at)) {
            let (label, distance) = truth.pixels[at];
            let same = frame.class_ids[at] == label.class;
            let depth = f64::from(frame.depth_m[at]);
            let close = depth == distance || (depth - distance).abs() < depth_room(label.class, distance);
            let count = &mut self.classes[label.class as usize];
            count.all += 1;
            count.same += u32::from(same);
            count.close += u32::from(same && close);
            count.who += u32::from(same && frame.instance_ids[at] == label.instance);
        }
    }

    pub fn sum(&self, of: impl Fn(&Count) -> u32) -> u32 {
        self.classes.iter().map(of).sum()
    }
}

/// What is below its bar, as text.
#[derive(Default)]
pub struct Failures(pub Vec<String>);

impl Failures {
    pub fn expect(&mut self, what: &str, share: f64, bar: f64) {
        println!("{what}: {share:.5}");
        if share < bar {
            self.0.push(format!("{what}: {share:.5} is below {bar}"));
        }
    }
}

/// A class by its name.
pub fn name(class: usize) -> &'static str {
    SemanticTag::from_id(class as u8).map_or("?", SemanticTag::name)
}
