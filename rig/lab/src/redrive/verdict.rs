//! What a fork says about the intervention.

use kernel::time::Tick;
use serde::{Deserialize, Serialize};

use super::fork::{Course, Otherwise};
use super::near_miss::EARLY_TICKS;

/// Whether an intervention was needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Need {
    /// Harm of the same kind comes without it and came with it.
    #[serde(rename = "in vain")]
    InVain,
    /// Without it, harm comes within 3 s: a collision, a red light, the wrong way, or off the road.
    Necessary,
    /// Without it, no harm comes within 3 s, but somebody comes close: less than 1 s from a collision, or so that more
    /// than 6 m/s^2 are needed to prevent one.
    #[serde(rename = "near miss")]
    NearMiss,
    /// Without it, harm comes later.
    Early,
    /// Without it, no harm comes as long as the fork goes on.
    Needless,
    /// Through the other checkpoint there is an intervention, or a collision that nobody prevents.
    Again,
    /// Through the other checkpoint there is none.
    Avoided,
}

impl Need {
    /// Of a fork of a run with an intervention at a tick.
    pub fn of(course: &Course, otherwise: Otherwise, at: Tick) -> Self {
        match otherwise {
            Otherwise::NoIntervention { .. } => match &course.harm {
                Some(harm) if course.recorded_harm.as_ref().is_some_and(|came| came.what == harm.what) => Self::InVain,
                Some(harm) if harm.tick <= at + EARLY_TICKS => Self::Necessary,
                _ if course.near_miss => Self::NearMiss,
                Some(_) => Self::Early,
                None => Self::Needless,
            },
            Otherwise::OtherEye { .. } => {
                if course.collision.is_some() || course.intervention.is_some() {
                    Self::Again
                } else {
                    Self::Avoided
                }
            }
        }
    }

    /// Those of forks without the intervention.
    pub const WITHOUT_INTERVENTION: [Self; 5] =
        [Self::InVain, Self::Necessary, Self::NearMiss, Self::Early, Self::Needless];

    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            Self::InVain => "in vain",
            Self::Necessary => "necessary",
            Self::NearMiss => "near miss",
            Self::Early => "early",
            Self::Needless => "needless",
            Self::Again => "again",
            Self::Avoided => "avoided",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::redrive::fork::{Harm, HarmKind};
    use measures::criticality::Extremes;

    fn course(harm: Option<(Tick, HarmKind)>, intervention: Option<Tick>) -> Course {
        let harm = harm.map(|(tick, what)| Harm { tick, what, with: None, speed_kmh: 30.0 });
        let collision = harm.clone().filter(|harm| harm.what == HarmKind::Collision);
        let closest = Extremes { min_ttc_s: None, min_pret_s: None, max_required_deceleration_mps2: None, pet_s: None };
        let (recording, recorded_harm, near_miss) = (Vec::new(), None, false);
        Course { recording, fork_tick: 1, harm, collision, recorded_harm, intervention, near_miss, closest }
    }

    #[test]
    fn who_comes_close_without_it_is_a_near_miss() {
        let otherwise = Otherwise::NoIntervention { earlier_ticks: 0 };
        let verdict = |harm| Need::of(&Course { near_miss: true, ..course(harm, None) }, otherwise, 1000);
        assert_eq!(verdict(None), Need::NearMiss);
        assert_eq!(verdict(Some((1181, HarmKind::Collision))), Need::NearMiss);
        assert_eq!(verdict(Some((1180, HarmKind::Collision))), Need::Necessary);
    }

    #[test]
    fn harm_soon_after_makes_an_intervention_necessary() {
        let otherwise = Otherwise::NoIntervention { earlier_ticks: 0 };
        let verdict = |harm| Need::of(&course(harm, None), otherwise, 1000);
        assert_eq!(verdict(Some((1000, HarmKind::Collision))), Need::Necessary);
        assert_eq!(verdict(Some((1180, HarmKind::RedLight))), Need::Necessary);
        assert_eq!(verdict(Some((1181, HarmKind::Collision))), Need::Early);
        assert_eq!(verdict(None), Need::Needless);
    }

    #[test]
    fn harm_that_came_all_the_same_makes_an_intervention_vain() {
        let otherwise = Otherwise::NoIntervention { earlier_ticks: 0 };
        let verdict = |harm, came| {
            let recorded_harm = course(came, None).harm;
            Need::of(&Course { recorded_harm, ..course(harm, None) }, otherwise, 1000)
        };
        let collision = |tick| Some((tick, HarmKind::Collision));
        assert_eq!(verdict(collision(1010), collision(1012)), Need::InVain);
        assert_eq!(verdict(collision(1010), Some((1012, HarmKind::OffRoad))), Need::Necessary);
        assert_eq!(verdict(None, collision(1012)), Need::Needless);
    }

    #[test]
    fn another_eye_avoids_it_only_without_takeover_and_collision() {
        let verdict = |harm, taken_over| Need::of(&course(harm, taken_over), Otherwise::OtherEye { person: 0 }, 1000);
        assert_eq!(verdict(None, None), Need::Avoided);
        assert_eq!(verdict(Some((900, HarmKind::OffRoad)), None), Need::Avoided);
        assert_eq!(verdict(Some((900, HarmKind::Collision)), None), Need::Again);
        assert_eq!(verdict(None, Some(990)), Need::Again);
    }
}
