//! Scenarios on the bundled maps, and a driver that follows the route.

use std::sync::Arc;

use kernel::map::bundled;
use kernel::{Controls, RoadNetwork, Scenario, TickInput, World, ops};

/// A scenario with its map.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What the run starts from.
    pub scenario: Scenario,
    /// Its map.
    pub network: Arc<RoadNetwork>,
}

/// The bundled city with 100 road users: 55 cars, 5 motorcycles, 10 bicycles, 30 pedestrians.
pub fn busy_city() -> Scene {
    let text = "map = \"city\"\nseed = 7\n[traffic]\ncars = 55\nmotorcycles = 5\nbicycles = 10\npedestrians = 30\n";
    scene(text)
}

/// The bundled rural road with its usual traffic.
pub fn country_road() -> Scene {
    scene("map = \"rural\"\nseed = 7\n")
}

/// The hamlet of the bundled rural map with 100 road users, a quarter of them near the ego car after
/// 20 s: 35 cars, 5 motorcycles, 10 bicycles, 50 pedestrians.
pub fn busy_hamlet() -> Scene {
    let text = "map = \"rural\"\nseed = 39\n[traffic]\ncars = 35\nmotorcycles = 5\nbicycles = 10\npedestrians = 50\n";
    scene(text)
}

/// A scene from the text of a scenario on a bundled map.
pub fn scene(scenario: &str) -> Scene {
    let scenario = Scenario::from_toml(scenario).expect("a valid scenario");
    let network = bundled(&scenario.map).expect("a bundled map");
    Scene { scenario, network }
}

impl Scene {
    /// A world at tick 0.
    pub fn world(&self) -> World {
        World::new(&self.scenario, &self.network).expect("the scenario fits its map")
    }

    /// A world at `ticks`, driven by [`follow_route`].
    pub fn world_after(&self, ticks: u64) -> World {
        let mut world = self.world();
        for _ in 0..ticks {
            let input = follow_route(&world);
            world.step(&input);
        }
        world
    }
}

/// Controls that follow the route by its true course, halt at red, and see nobody.
///
/// Steering is pure pursuit (Coulter 1992) with a look-ahead of 7 m.
pub fn follow_route(world: &World) -> TickInput {
    let hud = world.hud();
    let ego = world.scene().ego;
    let target = world.route_ahead(12.0).into_iter().rfind(|p| p.distance(ego.position) < 7.0);
    let local = ego.rotation.inverse() * (target.unwrap_or(ego.position) - ego.position);
    let bearing_rad = ops::atan2(local.y, local.x.max(1.0));
    let halts = hud.light.is_some_and(|l| l != kernel::signals::LightPhase::Green) && hud.light_distance_m < 15;
    let wanted_mps = if halts { 0.0 } else { hud.limit_mps.min(8.0) };
    let gap_mps = wanted_mps - hud.speed_mps;
    let controls = Controls::from_fractions(-1.5 * bearing_rad, 0.4 * gap_mps, -0.2 * gap_mps);
    TickInput { semantic: controls, safety: Controls::default() }
}
