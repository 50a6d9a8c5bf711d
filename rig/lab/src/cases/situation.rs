//! Which cases show nearly the same situation, as far as that is known without simulating them.

use std::collections::HashMap;

use kernel::SceneSnapshot;
use kernel::scene::ActorScene;

/// Two cases are near each other where the ego car was within this distance at the takeover, metres ...
pub const NEAR_M: f64 = 10.0;
/// ... drove at about the same speed, m/s ...
pub const NEAR_MPS: f64 = 3.0;
/// ... and in about the same direction: the cosine of 30 degrees. Map, label and who was next ahead are the same.
pub const NEAR_COS: f64 = 0.866_025_403_784_438_6;

/// Who is next ahead is looked for up to this distance before the rear axle, metres ...
const AHEAD_M: f32 = 40.0;
/// ... and to either side.
const ASIDE_M: f32 = 6.0;

/// Where the ego car was at a takeover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Place of the rear axle on the map, metres.
    pub x_m: f64,
    /// North of the map's zero.
    pub y_m: f64,
    /// Direction of driving, a vector of length 1.
    pub ahead_x: f64,
    /// Its northern part.
    pub ahead_y: f64,
}

/// What is compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Situation {
    /// Digest of the map.
    pub map_digest: [u8; 16],
    /// What it was labelled as.
    pub label: Option<String>,
    /// What kind of road user was next ahead.
    pub nearest: Option<String>,
    /// Where.
    pub spot: Spot,
    /// How fast, m/s.
    pub speed_mps: f64,
}

impl Spot {
    /// That of a scene.
    pub fn of(scene: &SceneSnapshot) -> Self {
        let ahead = (scene.ego.rotation * glam::Vec3::X).truncate().normalize_or(glam::Vec2::X);
        let at = scene.ego.position;
        Self { x_m: at.x.into(), y_m: at.y.into(), ahead_x: ahead.x.into(), ahead_y: ahead.y.into() }
    }

    /// Whether all of it are numbers, which a damaged case may not have.
    pub fn is_finite(&self) -> bool {
        [self.x_m, self.y_m, self.ahead_x, self.ahead_y].iter().all(|number| number.is_finite())
    }

    /// Square of the distance to another, m^2.
    pub fn distance2(&self, other: &Self) -> f64 {
        let (x, y) = (self.x_m - other.x_m, self.y_m - other.y_m);
        x * x + y * y
    }
}

impl Situation {
    /// Whether both are nearly the same.
    pub fn is_near(&self, other: &Self) -> bool {
        let cosine = self.spot.ahead_x * other.spot.ahead_x + self.spot.ahead_y * other.spot.ahead_y;
        (self.map_digest, &self.label, &self.nearest) == (other.map_digest, &other.label, &other.nearest)
            && self.spot.distance2(&other.spot) <= NEAR_M * NEAR_M
            && (self.speed_mps - other.speed_mps).abs() <= NEAR_MPS
            && cosine >= NEAR_COS
    }
}

/// The road user next ahead of the ego car, and how far from its rear axle, metres.
pub fn next_ahead(scene: &SceneSnapshot) -> Option<(&ActorScene, f32)> {
    let back = scene.ego.rotation.inverse();
    let seen = scene.actors.iter().filter_map(|actor| {
        let at = back * (actor.position - scene.ego.position);
        let is_ahead = (0.0..=AHEAD_M).contains(&at.x) && at.y.abs() <= ASIDE_M;
        is_ahead.then(|| (actor, at.truncate().length()))
    });
    seen.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Puts cases that are near each other in groups, each of which is named by its first one: a case joins the nearest first
/// one that it is near to. Cases of which nobody knows where they were stand alone.
pub fn groups<'a>(cases: impl Iterator<Item = Option<&'a Situation>>) -> Vec<usize> {
    let (mut firsts, mut groups) = (HashMap::<_, Vec<(usize, &Situation)>>::new(), Vec::new());
    for (number, case) in cases.enumerate() {
        let Some(case) = case else {
            groups.push(number);
            continue;
        };
        let cell = |x: i64, y: i64| (case.map_digest, &case.label, &case.nearest, x, y);
        let (x, y) = ((case.spot.x_m / NEAR_M).floor() as i64, (case.spot.y_m / NEAR_M).floor() as i64);
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| (x.saturating_add(i), y.saturating_add(j))));
        let near =
            around.filter_map(|(x, y)| firsts.get(&cell(x, y))).flatten().filter(|(_, first)| first.is_near(case));
        let nearest = near.min_by(|a, b| {
            let distance = |first: &Situation| first.spot.distance2(&case.spot);
            distance(a.1).total_cmp(&distance(b.1)).then(a.0.cmp(&b.0))
        });
        match nearest {
            Some((first, _)) => groups.push(*first),
            None => {
                firsts.entry(cell(x, y)).or_default().push((number, case));
                groups.push(number);
            }
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn situation(x_m: f64, heading_deg: f64, speed_mps: f64, label: &str) -> Situation {
        let (ahead_y, ahead_x) = heading_deg.to_radians().sin_cos();
        let spot = Spot { x_m, y_m: 0.5 * x_m, ahead_x, ahead_y };
        Situation { map_digest: [1; 16], label: Some(label.into()), nearest: None, spot, speed_mps }
    }

    #[test]
    fn near_is_the_same_place_direction_speed_and_label() {
        let one = situation(100.0, 350.0, 9.0, "walker");
        assert!(one.is_near(&situation(108.0, 15.0, 11.9, "walker")));
        assert!(!one.is_near(&situation(110.0, 350.0, 9.0, "walker")));
        assert!(!one.is_near(&situation(100.0, 25.0, 9.0, "walker")));
        assert!(!one.is_near(&situation(100.0, 350.0, 12.1, "walker")));
        assert!(!one.is_near(&situation(100.0, 350.0, 9.0, "vehicle")));
    }

    proptest! {
        /// As by comparing each with every first one.
        #[test]
        fn groups_are_those_of_all_comparisons(
            all in prop::collection::vec((-60.0..60.0, 0.0..90.0, 5.0..12.0, prop::bool::ANY), 0..60),
        ) {
            let label = |is: bool| if is { "walker" } else { "vehicle" };
            let cases: Vec<_> = all.iter().map(|(x, deg, mps, is)| situation(*x, *deg, *mps, label(*is))).collect();
            let mut expected: Vec<usize> = Vec::new();
            for (number, case) in cases.iter().enumerate() {
                let firsts = (0..number).filter(|first| expected[*first] == *first && cases[*first].is_near(case));
                let distance = |first: &usize| cases[*first].spot.distance2(&case.spot);
                let nearest = firsts.min_by(|a, b| distance(a).total_cmp(&distance(b)));
                expected.push(nearest.unwrap_or(number));
            }
            prop_assert_eq!(groups(cases.iter().map(Some)), expected);
        }
    }
}
