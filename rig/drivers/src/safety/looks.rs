//! What the safety driver remembers of the last looks: how everyone changes speed.

use std::collections::BTreeMap;

use kernel::scene::{ActorScene, SceneSnapshot};
use kernel::time::{TICK_HZ, Tick};

/// Ticks between two looks at the road.
pub const LOOK_TICKS: Tick = 6;
const LOOK_S: f32 = LOOK_TICKS as f32 / TICK_HZ as f32;
/// Hardest braking that others are believed to keep up, m/s^2.
const BELIEVED_MPS2: f32 = 4.0;

/// Speeds at the last looks.
#[derive(Clone, Debug, Default)]
pub struct Looks {
    /// Of the ego car, newest last, m/s; none before the first look.
    ego_mps: Option<[f32; Self::ENOUGH]>,
    /// Of the others by their id: speed, m/s, and acceleration, m/s^2.
    others: BTreeMap<u32, (f32, f32)>,
}

impl Looks {
    /// So many looks tell how the ego car changes speed.
    pub const ENOUGH: usize = 3;

    /// Takes in what is to be seen now.
    pub fn look(&mut self, scene: &SceneSnapshot) {
        let now_mps = scene.ego.speed_mps;
        self.ego_mps = Some(self.ego_mps.map_or([now_mps; Self::ENOUGH], |[_, before, last]| [before, last, now_mps]));
        let seen = |actor: &ActorScene| {
            let before = self.others.get(&actor.id).map_or(actor.speed_mps, |(speed_mps, _)| *speed_mps);
            (actor.id, (actor.speed_mps, (actor.speed_mps - before) / LOOK_S))
        };
        self.others = scene.actors.iter().map(seen).collect();
    }

    /// The ego car's acceleration as felt, m/s^2.
    pub fn ego_mps2(&self) -> f32 {
        self.ego_mps.map_or(0.0, |[first, _, last]| (last - first) / (2.0 * LOOK_S))
    }

    /// Another's acceleration, m/s^2: a vehicle that brakes is seen to give way.
    pub fn actor_mps2(&self, actor: &ActorScene) -> f32 {
        self.others.get(&actor.id).map_or(0.0, |(_, acceleration)| acceleration.max(-BELIEVED_MPS2))
    }
}

#[cfg(test)]
mod tests {
    use kernel::{Scenario, TickInput, World, map};

    use super::*;

    #[test]
    fn who_looks_up_in_a_car_that_drives_feels_no_push() {
        let network = map::bundled("city").expect("it is bundled");
        let mut scene = World::new(&Scenario::default_for("city", 3), &network).expect("it fits").scene();
        let mut looks = Looks::default();
        scene.ego.speed_mps = 10.0;
        looks.look(&scene);
        assert_eq!(looks.ego_mps2(), 0.0);
        scene.ego.speed_mps = 9.0;
        looks.look(&scene);
        assert!((looks.ego_mps2() + 5.0).abs() < 1e-3);
    }

    #[test]
    fn changes_of_speed_are_those_of_the_world() {
        let network = map::bundled("city").expect("it is bundled");
        let mut world = World::new(&Scenario::default_for("city", 3), &network).expect("it fits");
        let mut looks = Looks::default();
        let (mut before, mut braking) = (world.scene(), 0);
        for tick in 0..1200 {
            if tick % LOOK_TICKS == 0 {
                let scene = world.scene();
                looks.look(&scene);
                for (actor, earlier) in scene.actors.iter().zip(&before.actors).filter(|_| tick > 0) {
                    let change_mps2 = (actor.speed_mps - earlier.speed_mps) / LOOK_S;
                    assert_eq!(looks.actor_mps2(actor), change_mps2.max(-BELIEVED_MPS2));
                    braking += u32::from(change_mps2 < -1.0);
                }
                before = scene;
            }
            world.step(&TickInput::default());
        }
        assert!(braking > 100, "{braking}");
    }
}
