//! What is heard in the ego car at a tick.

use glam::{Vec2, Vec3};
use kernel::events::{Event, EventKind};
use kernel::scene::{ActorKind, ActorScene, EgoScene, SceneSnapshot, lamps};
use kernel::time::TICK_HZ;
use kernel::{Controls, Seat};

/// Who is farther away is not heard, metres.
const EARSHOT_M: f32 = 60.0;
/// Who is farther above or below is on another road, metres.
const LEVEL_M: f32 = 6.0;
/// Most others that are heard at once, the nearest.
const MOST_AROUND: usize = 6;

/// Something that is heard once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cue {
    /// The car hit something, at so many m/s.
    Impact(f32),
    /// A wheel left the road.
    Kerb,
    /// The car did what it must not: a red light, a limit, the wrong way. For those who watch it.
    Warning,
    /// The safety driver took over.
    Takeover,
    /// The run ended.
    Ended,
}

impl Cue {
    fn of(event: &Event) -> Option<Self> {
        Some(match event.kind {
            EventKind::CollisionActor | EventKind::CollisionScenery => Self::Impact(event.speed_mps.abs()),
            EventKind::OffRoad => Self::Kerb,
            EventKind::RedLight | EventKind::Speeding | EventKind::WrongWay => Self::Warning,
            EventKind::Intervention => Self::Takeover,
            EventKind::Ended => Self::Ended,
            _ => return None,
        })
    }
}

/// How loud and how deep somebody sounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// Two wheels without a motor.
    Bicycle,
    /// A car.
    Light,
    /// A lorry, a bus or a tram.
    Heavy,
}

impl Size {
    fn of(kind: ActorKind) -> Option<Self> {
        Some(match kind {
            ActorKind::Bicycle | ActorKind::CargoBike => Self::Bicycle,
            ActorKind::Truck | ActorKind::Bus | ActorKind::Tram => Self::Heavy,
            ActorKind::Car | ActorKind::Van | ActorKind::Suv | ActorKind::Emergency => Self::Light,
            ActorKind::Motorcycle | ActorKind::Scooter => Self::Light,
            _ => return None,
        })
    }
}

/// Another road user who is heard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Around {
    /// Its number in the run.
    pub id: u32,
    /// How it sounds.
    pub size: Size,
    /// Where it is, metres to the front and to the left of the driver.
    pub forward_m: f32,
    /// Metres to the left.
    pub left_m: f32,
    /// Its speed over ground, m/s.
    pub speed_mps: f32,
    /// How fast it comes nearer, m/s.
    pub closing_mps: f32,
}

/// What is heard at a tick.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heard {
    /// Speed of the car, m/s, without its direction.
    pub speed_mps: f32,
    /// What is asked of the motor, [0, 1].
    pub load: f32,
    /// How hard the tyres are used, m/s^2.
    pub grip_mps2: f32,
    /// The indicators are on, the horn sounds, the wipers wipe.
    pub indicates: bool,
    /// The horn.
    pub horn: bool,
    /// The wipers.
    pub wipes: bool,
    /// Rain that falls, water on the road, and wind, [0, 1].
    pub rain: f32,
    /// Water on the road.
    pub wet: f32,
    /// Wind.
    pub wind: f32,
    /// Others in earshot, the nearest first.
    pub around: Vec<Around>,
    /// What began in this tick.
    pub cues: Vec<Cue>,
}

impl Heard {
    /// What somebody in a seat hears of it. The semantic driver is told of nothing that a driver in that car would not
    /// notice, but of takeovers.
    pub fn by(mut self, seat: Seat) -> Self {
        self.cues.retain(|cue| seat == Seat::Safety || *cue != Cue::Warning);
        self
    }

    /// Takeovers and ends alone, for who is to hear nothing of the car.
    pub fn signals_alone(self) -> Self {
        let cues = self.cues.into_iter().filter(|cue| matches!(cue, Cue::Takeover | Cue::Ended)).collect();
        Self { cues, ..Self::default() }
    }
}

/// Listens to the ticks of a run.
#[derive(Clone, Debug, Default)]
pub struct Ear {
    last: Option<EgoScene>,
}

impl Ear {
    /// What is heard at a tick: the scene that was reached, the controls that reached the car, and what happened.
    pub fn hear(&mut self, scene: &SceneSnapshot, applied: &Controls, events: &[Event]) -> Heard {
        let ego = &scene.ego;
        let forward = (ego.rotation * Vec3::X).truncate();
        let velocity = ego.speed_mps * forward;
        let before = self.last.replace(*ego).map_or(velocity, |last| {
            let forward = (last.rotation * Vec3::X).truncate();
            last.speed_mps * forward
        });
        let weather = &scene.weather;
        let share = |percent: f32| (0.01 * percent).clamp(0.0, 1.0);
        Heard {
            speed_mps: ego.speed_mps.abs(),
            load: if applied.brake > 0 { 0.0 } else { applied.throttle_fraction() },
            grip_mps2: (velocity - before).length() * TICK_HZ as f32,
            indicates: ego.lamps & (lamps::LEFT | lamps::RIGHT) != 0,
            horn: applied.has(Controls::HORN),
            wipes: applied.has(Controls::WIPERS),
            rain: share(weather.precipitation_pct),
            wet: share(weather.wetness_pct),
            wind: share(weather.wind_pct),
            around: around(ego, velocity, &scene.actors),
            cues: events.iter().filter_map(Cue::of).collect(),
        }
    }
}

/// The nearest who make a sound.
fn around(ego: &EgoScene, velocity: Vec2, actors: &[ActorScene]) -> Vec<Around> {
    let forward = (ego.rotation * Vec3::X).truncate().normalize_or(Vec2::X);
    let heard = actors.iter().filter_map(|actor| {
        let size = Size::of(actor.kind)?;
        let between = actor.position - ego.position;
        let flat = between.truncate();
        let is_near = flat.length() < EARSHOT_M && between.z.abs() < LEVEL_M;
        let own = actor.speed_mps * (actor.rotation * Vec3::X).truncate();
        is_near.then(|| Around {
            id: actor.id,
            size,
            forward_m: flat.dot(forward),
            left_m: flat.dot(forward.perp()),
            speed_mps: actor.speed_mps.abs(),
            closing_mps: (velocity - own).dot(flat.normalize_or_zero()),
        })
    });
    let mut heard: Vec<Around> = heard.collect();
    let squared_m2 = |other: &Around| other.forward_m * other.forward_m + other.left_m * other.left_m;
    heard.sort_by(|a, b| squared_m2(a).total_cmp(&squared_m2(b)));
    heard.truncate(MOST_AROUND);
    heard
}

#[cfg(test)]
mod tests {
    use glam::Quat;
    use kernel::scene::Weather;

    use super::*;

    fn ego(speed_mps: f32, heading_rad: f32) -> EgoScene {
        let rotation = Quat::from_rotation_z(heading_rad);
        EgoScene { position: Vec3::ZERO, rotation, speed_mps, wheel_angle_rad: 0.0, lamps: 0 }
    }

    fn actor(id: u32, kind: ActorKind, at: (f32, f32), speed_mps: f32) -> ActorScene {
        ActorScene {
            id,
            kind,
            variant: 0,
            position: Vec3::new(at.0, at.1, 0.0),
            rotation: Quat::IDENTITY,
            speed_mps,
            phase_rad: 0.0,
            lamps: 0,
        }
    }

    fn scene(ego: EgoScene, actors: Vec<ActorScene>) -> SceneSnapshot {
        SceneSnapshot { tick: 0, ego, actors, lights: Vec::new(), weather: Weather::dry(0.0, 0.0, 45.0, 0.0) }
    }

    fn heard(scene: &SceneSnapshot, kinds: &[EventKind]) -> Heard {
        let events: Vec<Event> = kinds.iter().map(|kind| Event { kind: *kind, actor: 0, speed_mps: 5.0 }).collect();
        Ear::default().hear(scene, &Controls::from_fractions(0.0, 0.5, 0.0), &events)
    }

    #[test]
    fn places_are_the_drivers_and_those_who_come_nearer_close_in() {
        // The car looks north, and somebody comes from the east, before it.
        let looks_north = ego(0.0, std::f32::consts::FRAC_PI_2);
        let others = vec![
            actor(1, ActorKind::Car, (20.0, 10.0), -8.0),
            actor(2, ActorKind::Pedestrian, (2.0, 0.0), 1.0),
            actor(3, ActorKind::Bus, (0.0, -5.0), 0.0),
            actor(4, ActorKind::Car, (200.0, 0.0), 9.0),
        ];
        let around = heard(&scene(looks_north, others), &[]).around;
        let [near, far] = around.as_slice() else { panic!("{around:?}") };
        assert!((near.id, near.size) == (3, Size::Heavy) && (near.forward_m + 5.0).abs() < 1e-3, "{near:?}");
        assert!((far.forward_m - 10.0).abs() < 1e-3 && (far.left_m + 20.0).abs() < 1e-3, "{far:?}");
        assert!(far.speed_mps == 8.0 && (7.0..7.3).contains(&far.closing_mps), "{far:?}");
    }

    #[test]
    fn the_semantic_driver_is_not_warned() {
        let all = heard(&scene(ego(3.0, 0.0), Vec::new()), &[EventKind::RedLight, EventKind::Intervention]);
        assert_eq!(all.cues, [Cue::Warning, Cue::Takeover]);
        assert_eq!(all.clone().by(Seat::Safety), all);
        assert_eq!(all.clone().by(Seat::Semantic).cues, [Cue::Takeover]);
        let signals = all.signals_alone();
        assert_eq!(signals, Heard { cues: vec![Cue::Takeover], ..Heard::default() });
    }

    #[test]
    fn tyres_are_used_by_turning_and_braking() {
        let mut ear = Ear::default();
        let mut hear = |ego: EgoScene| ear.hear(&scene(ego, Vec::new()), &Controls::default(), &[]).grip_mps2;
        assert_eq!(hear(ego(10.0, 0.0)), 0.0);
        assert_eq!(hear(ego(10.0, 0.0)), 0.0);
        let turns = hear(ego(10.0, 0.6 / 60.0));
        assert!((turns - 6.0).abs() < 0.1, "{turns}");
        let brakes = hear(ego(9.9, 0.6 / 60.0));
        assert!((brakes - 6.0).abs() < 0.1, "{brakes}");
    }
}
