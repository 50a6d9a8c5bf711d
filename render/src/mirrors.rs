//! What wet roads mirror of what shines at night: streaks on the ground from below a lamp towards the eye, as rough ground
//! draws a mirror image out. They write neither class nor depth.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use kernel::SceneSnapshot;
use kernel::map::LightHead;
use kernel::ops;

use crate::glows::Glow;
use crate::horizon::Horizon;
use crate::street_lamps::StreetLamp;
use crate::view::View;

/// One streak, as `mirror.wgsl` reads it.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Streak {
    /// Its near and far end on the ground, and half of its width there, metres.
    pub(crate) near: [f32; 3],
    pub(crate) half_near_m: f32,
    pub(crate) far: [f32; 3],
    pub(crate) half_far_m: f32,
    /// Linear; 1 shines over everything.
    pub(crate) colour: [f32; 3],
}

/// Lamps farther away leave no streak, metres, and no more than so many do, the nearest.
const REACH_M: f32 = 110.0;
const MOST: usize = 96;
/// Nothing is mirrored closer than this, metres: one looks into the ground there.
const NEAREST_M: f32 = 2.0;
/// Where a streak begins, as a share of the distance of the mirror image in a smooth road, and how much of the way from
/// that to the point below the lamp it takes.
const NEAR: f32 = 0.6;
const FAR: f32 = 0.8;
/// A streak is so wide beside its lamp's glow, and widens with distance, as an angle.
const WIDTH: f32 = 0.42;
const SPREAD: f32 = 0.004;
/// Share of a lamp's shine that a wet road mirrors at most.
const SHARE: f32 = 0.75;
/// A vehicle or signal whose lamp it is stands no farther from it than this, metres.
const FOOT_M: f32 = 8.0;

/// Heights of the ground where things stand that shine.
pub(crate) struct Feet(Vec<Vec3>);

impl Feet {
    pub(crate) fn of(scene: &SceneSnapshot, heads: &[LightHead], lamps: &[StreetLamp]) -> Self {
        let actors = scene.actors.iter().map(|actor| actor.position);
        let heads = heads.iter().map(|head| head.position);
        let lamps = lamps.iter().map(|lamp| lamp.position.with_z(lamp.foot_m));
        Self(actors.chain(heads).chain(lamps).chain([scene.ego.position]).collect())
    }

    /// That of the nearest one.
    fn below(&self, at: Vec3) -> Option<f32> {
        let off_m = |foot: &Vec3| foot.truncate().distance(at.truncate());
        let nearest = self.0.iter().filter(|foot| foot.z < at.z).min_by(|a, b| off_m(a).total_cmp(&off_m(b)))?;
        (off_m(nearest) < FOOT_M).then_some(nearest.z)
    }
}

/// The streaks of what glows on a road that is so wet, from 0 to 1, where houses do not hide it.
pub(crate) fn of_glows(
    glows: &[Glow],
    feet: &Feet,
    (view, mut horizon): (&View, Horizon),
    wet: f32,
    streaks: &mut Vec<Streak>,
) {
    streaks.clear();
    let flat_m = |glow: &Glow| Vec3::from(glow.position).truncate().distance(view.eye.truncate());
    let mut near: Vec<(f32, &Glow)> = glows.iter().map(|glow| (flat_m(glow), glow)).filter(|g| g.0 < REACH_M).collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    near.retain(|(_, glow)| !horizon.hides(glow.position.into(), glow.radius_m));
    streaks.extend(near.iter().take(MOST).filter_map(|(_, glow)| {
        let at = Vec3::from(glow.position);
        of_lamp(glow, feet.below(at)?, view.eye, wet)
    }));
}

fn of_lamp(glow: &Glow, ground_m: f32, eye: Vec3, wet: f32) -> Option<Streak> {
    let at = Vec3::from(glow.position);
    let (foot, below_eye) = (at.with_z(ground_m), eye.with_z(ground_m));
    let (up_m, eye_up_m) = (at.z - ground_m, eye.z - ground_m);
    let way_m = foot.distance(below_eye);
    if eye_up_m <= 0.0 || way_m < NEAREST_M {
        return None;
    }
    let image_m = way_m * eye_up_m / (eye_up_m + up_m);
    let ends = [(NEAR * image_m).max(NEAREST_M), image_m + FAR * (way_m - image_m)];
    let [near, far] = ends.map(|m| below_eye + (foot - below_eye) * (m / way_m));
    let [half_near_m, half_far_m] = ends.map(|m| WIDTH * glow.radius_m * (0.5 + 0.5 * m / way_m) + SPREAD * m);
    // What comes steeply from above goes into the ground.
    let flat = way_m / ops::hypot(way_m, up_m + eye_up_m);
    let colour = (Vec3::from(glow.colour) * (SHARE * wet * flat * flat)).to_array();
    (ends[1] > ends[0]).then_some(Streak {
        near: near.to_array(),
        half_near_m,
        far: far.to_array(),
        half_far_m,
        colour,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn streak(lamp: Vec3) -> Option<Streak> {
        let glow = Glow { position: lamp.to_array(), radius_m: 0.4, colour: [1.0, 0.2, 0.1] };
        of_lamp(&glow, 5.0, Vec3::new(0.0, 0.0, 6.3), 1.0)
    }

    #[test]
    fn a_streak_lies_on_the_ground_between_eye_and_lamp_and_has_its_colour() {
        let low = streak(Vec3::new(30.0, 0.0, 5.7)).expect("one");
        assert!(low.near[2] == 5.0 && low.far[2] == 5.0 && low.near[1] == 0.0);
        assert!(2.0 < low.near[0] && low.near[0] < low.far[0] && low.far[0] < 30.0, "{low:?}");
        assert!(low.colour[0] > 4.0 * low.colour[1]);
        let high = streak(Vec3::new(30.0, 0.0, 13.0)).expect("one");
        assert!(high.near[0] < low.near[0] && high.colour[0] < low.colour[0], "{high:?}");
        assert_eq!(streak(Vec3::new(1.0, 0.0, 5.7)), None, "below the eye");
    }
}
