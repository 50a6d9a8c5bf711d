//! What is measured. Every scene proves that it is the one the budgets were set for before a clock
//! starts: its golden is compared first.

use std::fs;
use std::io::Cursor;
use std::path::PathBuf;
use std::sync::Arc;

use kernel::map::MapData;
use kernel::time::{TICK_HZ, Tick, seconds};
use kernel::{RoadNetwork, SceneSnapshot, TickInput, World};
use replay::{Log, Manifest, Provenance, Recorder, Recording};

use ::tests::scenes::{Scene, busy_hamlet, follow_route};
use ::tests::town::Town;

/// Ticks of driving before measuring starts: traffic has spread by then.
pub const WARM_UP_TICKS: Tick = seconds(20);
/// Simulated seconds of one iteration of `kernel/step`; it holds two keyframes.
pub const STEP_S: u32 = 20;

/// A world in dense traffic, and the inputs that drive it on.
pub struct BusyDrive {
    /// Scenario and map.
    pub scene: Scene,
    /// The world after [`WARM_UP_TICKS`].
    pub world: World,
    /// Inputs of the next [`STEP_S`] seconds.
    pub inputs: Vec<TickInput>,
    /// The scene at their end.
    pub snapshot: SceneSnapshot,
}

impl BusyDrive {
    /// Drives the scene and compares it with its golden.
    ///
    /// # Errors
    /// Says which value differs from `benches/golden.txt`.
    pub fn prepare() -> Result<Self, String> {
        let scene = busy_hamlet();
        let world = scene.world_after(WARM_UP_TICKS);
        let mut end = world.clone();
        let inputs = (0..STEP_S * TICK_HZ)
            .map(|_| {
                let input = follow_route(&end);
                end.step(&input);
                input
            })
            .collect();
        let snapshot = end.scene();
        compare_golden(&[
            ("actors", snapshot.actors.len().to_string()),
            ("moving", moving(&snapshot).to_string()),
            ("near", near(&snapshot).to_string()),
            ("state", format!("{:?}", end.hash())),
        ])?;
        Ok(Self { scene, world, inputs, snapshot })
    }
}

/// Simulated seconds of one iteration of `kernel/scale`.
pub const SCALE_S: u32 = 10;

/// A town in traffic, and the inputs that drive it on.
pub struct TownDrive {
    /// The world after [`WARM_UP_TICKS`].
    pub world: World,
    /// Inputs of the next [`SCALE_S`] seconds.
    pub inputs: Vec<TickInput>,
    /// Road users that found room.
    pub placed: u32,
}

/// A town of so many junctions with about so many road users, 45 % of them cars, 40 % people on foot.
pub fn town(actors: u16, columns: usize, rows: usize) -> TownDrive {
    let share = |pct: u32| u32::from(actors) * pct / 100;
    let (motorcycles, bicycles, people) = (share(5), share(10), share(40));
    let cars = u32::from(actors) - motorcycles - bicycles - people;
    let scenario = format!(
        "map = \"town\"\nseed = 1\n[traffic]\ncars = {cars}\nmotorcycles = {motorcycles}\nbicycles = {bicycles}\n\
         pedestrians = {people}\n"
    );
    let text = Town { columns, rows, pitch_m: 130.0 }.text();
    let network = Arc::new(kernel::map::bake("town", &text).expect("the town bakes"));
    let scenario = kernel::Scenario::from_toml(&scenario).expect("a valid scenario");
    let world = Scene { scenario, network }.world_after(WARM_UP_TICKS);
    let (mut end, mut inputs) = (world.clone(), Vec::new());
    for _ in 0..SCALE_S * TICK_HZ {
        inputs.push(follow_route(&end));
        end.step(&inputs[inputs.len() - 1]);
    }
    TownDrive { placed: world.scene().actors.len() as u32, world, inputs }
}

/// A map of which nothing is to be seen.
pub fn bare(network: &RoadNetwork) -> RoadNetwork {
    MapData { surfaces: Vec::new(), props: Vec::new(), ..MapData::clone(network) }.into()
}

/// The log of the first seconds of a scene, driven by [`follow_route`].
///
/// # Errors
/// Says what could not be recorded or read back.
pub fn recorded(scene: &Scene, drive_s: u32) -> Result<Log, String> {
    let mut world = scene.world();
    let manifest = Manifest::new(&scene.scenario, &scene.network, None, Provenance::new());
    let file = Cursor::new(Vec::new());
    let mut recorder = Recorder::new(file, &manifest, &world.initial_keyframe()).map_err(|e| e.to_string())?;
    for _ in 0..drive_s * TICK_HZ {
        let input = follow_route(&world);
        let output = world.step(&input);
        recorder.tick(&input, &output, &world.part_hashes()).map_err(|e| e.to_string())?;
    }
    let bytes = recorder.finish(world.arbiter().outcome).map_err(|e| e.to_string())?.into_inner();
    Ok(Recording::from_bytes(&bytes).map_err(|e| e.to_string())?.log().clone())
}

/// Actors that move at more than 0.1 m/s.
pub fn moving(scene: &SceneSnapshot) -> usize {
    scene.actors.iter().filter(|a| a.speed_mps.abs() > 0.1).count()
}

/// Actors within 60 m of the ego car.
pub fn near(scene: &SceneSnapshot) -> usize {
    scene.actors.iter().filter(|a| a.position.distance(scene.ego.position) < 60.0).count()
}

fn compare_golden(values: &[(&str, String)]) -> Result<(), String> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("golden.txt");
    let text: String = values.iter().map(|(name, value)| format!("{name} {value}\n")).collect();
    if std::env::var_os("AEYE_BLESS").is_some() {
        return fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()));
    }
    let golden = fs::read_to_string(&path).map_err(|e| format!("{}: {e}; AEYE_BLESS=1 writes it", path.display()))?;
    if golden == text { Ok(()) } else { Err(format!("the scene is not its golden: expected\n{golden}got\n{text}")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_busy_drive_is_its_golden_and_busy() {
        let drive = BusyDrive::prepare().expect("the golden");
        assert_eq!(drive.snapshot.actors.len(), 100);
        assert!(moving(&drive.snapshot) >= 80, "{} move", moving(&drive.snapshot));
        assert!(near(&drive.snapshot) >= 15, "{} near", near(&drive.snapshot));
    }
}
