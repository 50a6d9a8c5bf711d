//! A window of a recording as a story in OpenSCENARIO XML 1.0, with the map beside it: everybody follows its own track.
//!
//! What esmini and CARLA's ScenarioRunner play alike: each vertex with its time and a `WorldPosition` with a heading, absolute
//! times, `followingMode` position, and actions that begin by a time above -1.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use base::output;
use base::progress::Interrupt;
use base::say::say;
use glam::{Quat, Vec3};
use kernel::map::bundled_text;
use kernel::scene::{ActorKind, SceneSnapshot};
use kernel::story::Story;
use kernel::time::{TICK_HZ, TICK_S, Tick};
use kernel::{RoadNetwork, ego};
use measures::footage::{self, Asked, Window};
use replay::Recording;

use super::film::Counts;
use super::options::{Export, Options};

/// What tells stories that were exported: bundled ones, with which others begin theirs, have the same author.
const EXPORTED: &str = "<Story name=\"recorded\"><Act name=\"as it was\">";
/// Most vertices of all tracks.
const VERTICES: usize = 1_000_000;
/// Fastest that anybody goes, m/s, and hardest that it accelerates and brakes, m/s².
const MOST_MPS: f32 = 100.0;
const MOST_MPS2: f32 = 100.0;

/// Where somebody was at a tick: place, heading.
type Pose = (Tick, Vec3, f32);

/// Somebody who plays.
struct Track {
    name: String,
    /// Nothing for the ego car.
    kind: Option<ActorKind>,
    size_m: Vec3,
    /// From each time that it comes until it leaves.
    stays: Vec<Vec<Pose>>,
    /// The last tick in which it was there.
    last: Tick,
}

/// Writes the story and its map, unless they are there.
pub fn export(args: &Options, file: &Path, out: PathBuf, interrupt: &Interrupt) -> anyhow::Result<Export> {
    let recording = Recording::open(file)?;
    let (log, network) = (recording.log(), recording.network()?);
    let asked = Asked { fps: TICK_HZ, ..args.asked() };
    let window = Window::of(log, &asked)?;
    let (from, to) = window.ticks.clone().into_inner();
    let ticks: Vec<Tick> = window.ticks.clone().collect();
    let scenes = footage::scenes(log, &network, &ticks, |_, _| ())?;
    if interrupt.is_raised() {
        bail!("interrupted; nothing of its export is kept");
    }
    let tracks = tracks(&scenes);
    let vertices = tracks.iter().flat_map(|track| &track.stays).map(Vec::len).sum::<usize>();
    if vertices > VERTICES {
        bail!("its tracks have {vertices} vertices, expected at most {VERTICES}; --last, --from and --to ask for less");
    }
    let map = out.with_extension("xodr");
    let map_name = map.file_name().context("a story without a name")?.to_string_lossy().into_owned();
    if map_name.starts_with('$') || map_name.trim() != map_name || map_name.contains(char::is_control) {
        bail!("{}: a story cannot name the map {map_name:?} beside it; expected another name", out.display());
    }
    let text = story(&tracks, &network, &map_name, (from, to));
    if let Err(error) = Story::read(&text) {
        say(format!("{}: A-Eye itself does not read it: {error}; --last, --from and --to ask for less", out.display()));
    }
    let map_text = map_text(&recording, &network)?;
    let there = |path: &Path| fs::read_to_string(path).ok();
    let kept = there(&out).as_ref() == Some(&text) && there(&map).as_ref() == Some(&map_text);
    if !kept {
        let others = there(&out).filter(|story| !story.contains(EXPORTED)).map(|_| &out);
        if let Some(path) = others.or_else(|| there(&map).filter(|known| *known != map_text).map(|_| &map)) {
            bail!("{}: exists already and is no export of this; expected another place", path.display());
        }
        let is_new = !map.exists();
        output::write_file(&map, map_text.as_bytes())?;
        output::write_file(&out, text.as_bytes()).inspect_err(|_| {
            // Both or none.
            if is_new {
                let _ = fs::remove_file(&map);
            }
        })?;
    }
    let counts = Counts { frames: 0, poses: ticks.len(), events: 0 };
    Ok(Export { file: file.to_owned(), out, from, to, kept, counts })
}

fn map_text(recording: &Recording, network: &RoadNetwork) -> anyhow::Result<String> {
    match (bundled_text(&network.name), &recording.log().manifest.foreign_map) {
        (_, Some(foreign)) => Ok(foreign.text.as_ref().context("the file of its map is not there")?.to_string()),
        (Some(text), None) => Ok(text.to_owned()),
        (None, None) => bail!("the file of map {} is not there", network.name),
    }
}

fn heading_rad(rotation: Quat) -> f32 {
    let ahead = rotation * Vec3::X;
    kernel::ops::atan2(ahead.y, ahead.x)
}

/// Everybody in the scenes, the ego car first. A tick between two that are the same as it is left out.
fn tracks(scenes: &[SceneSnapshot]) -> Vec<Track> {
    let mut ego = Track { name: "Ego".to_owned(), kind: None, size_m: ego::SIZE_M, stays: Vec::new(), last: 0 };
    let mut others: BTreeMap<u32, Track> = BTreeMap::new();
    for scene in scenes {
        let (at, turned) = (scene.ego.position, scene.ego.rotation);
        let middle = at + turned * Vec3::new(ego::CENTRE_M.x, 0.0, 0.0);
        ego.add((scene.tick, middle, heading_rad(turned)));
        for actor in scene.actors.iter().filter(|actor| actor.kind != ActorKind::Door) {
            let track = others.entry(actor.id).or_insert_with(|| Track {
                name: format!("{:?}{}", actor.kind, actor.id),
                kind: Some(actor.kind),
                size_m: actor.kind.size_m(),
                stays: Vec::new(),
                last: 0,
            });
            track.add((scene.tick, actor.position, heading_rad(actor.rotation)));
        }
    }
    std::iter::once(ego).chain(others.into_values()).collect()
}

impl Track {
    fn add(&mut self, pose: Pose) {
        let is_here = self.last + 1 == pose.0;
        self.last = pose.0;
        let Some(poses) = self.stays.last_mut().filter(|_| is_here) else {
            self.stays.push(vec![pose]);
            return;
        };
        if let [.., before, last] = poses.as_slice()
            && (before.1, before.2) == (last.1, last.2)
            && (last.1, last.2) == (pose.1, pose.2)
        {
            poses.pop();
        }
        poses.push(pose);
    }

    /// Where it was first.
    fn first(&self) -> Pose {
        self.stays[0][0]
    }

    /// As fast as in its first tick, m/s.
    fn begins_mps(&self) -> f32 {
        match self.stays[0].as_slice() {
            [(from, a, _), (to, b, _), ..] => a.distance(*b) / ((to - from) as f32 * TICK_S),
            _ => 0.0,
        }
    }
}

fn story(tracks: &[Track], network: &RoadNetwork, map: &str, (from, to): (Tick, Tick)) -> String {
    let name = escaped(&network.name);
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<OpenSCENARIO>\n\
         <FileHeader revMajor=\"1\" revMinor=\"0\" date=\"2000-01-01T00:00:00\" description=\"On map {name}, from tick {from} on\" \
         author=\"A-Eye\"/>\n<CatalogLocations/>\n<RoadNetwork><LogicFile filepath=\"{}\"/></RoadNetwork>\n<Entities>\n",
        escaped(map)
    );
    tracks.iter().for_each(|track| entity(track, &mut text));
    text.push_str("</Entities>\n<Storyboard>\n<Init><Actions>\n");
    let world = |position: Vec3, heading_rad: f32| {
        let [east, north] = network.origin_m;
        let (x, y) = (f64::from(position.x) + east, f64::from(position.y) + north);
        format!("<WorldPosition x=\"{x}\" y=\"{y}\" z=\"{}\" h=\"{heading_rad}\"/>", position.z)
    };
    for track in tracks {
        let (_, position, heading_rad) = track.first();
        let (name, at, mps) = (&track.name, world(position, heading_rad), track.begins_mps());
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "<Private entityRef=\"{name}\"><PrivateAction><TeleportAction><Position>{at}</Position></TeleportAction>\
             </PrivateAction><PrivateAction><LongitudinalAction><SpeedAction><SpeedActionDynamics dynamicsShape=\"step\" \
             value=\"0\" dynamicsDimension=\"time\"/><SpeedActionTarget><AbsoluteTargetSpeed value=\"{mps}\"/>\
             </SpeedActionTarget></SpeedAction></LongitudinalAction></PrivateAction></Private>"
        );
    }
    let _ = write!(text, "</Actions></Init>\n{EXPORTED}\n");
    for track in tracks {
        group(track, (from, to), &world, &mut text);
    }
    let start = start("act", -1.0);
    let _ = write!(text, "{start}\n</Act></Story>\n<StopTrigger/>\n</Storyboard>\n</OpenSCENARIO>\n");
    text
}

/// What begins after a time: at once where that is -1. A rising edge, or a time of 0, would come a tick late or never.
fn start(of: &str, after_s: f64) -> String {
    format!(
        "<StartTrigger><ConditionGroup><Condition name=\"start of {of}\" delay=\"0\" conditionEdge=\"none\"><ByValueCondition>\
         <SimulationTimeCondition value=\"{after_s}\" rule=\"greaterThan\"/></ByValueCondition></Condition></ConditionGroup></StartTrigger>"
    )
}

fn group(track: &Track, (from, to): (Tick, Tick), world: &impl Fn(Vec3, f32) -> String, text: &mut String) {
    let name = &track.name;
    let _ = writeln!(
        text,
        "<ManeuverGroup name=\"group of {name}\" maximumExecutionCount=\"1\"><Actors selectTriggeringEntities=\"false\">\
         <EntityRef entityRef=\"{name}\"/></Actors><Maneuver name=\"manoeuvre of {name}\">"
    );
    let time_s = |tick: Tick| (tick - from) as f64 / f64::from(TICK_HZ);
    for (number, poses) in track.stays.iter().enumerate() {
        // Of all but the first stay their number is told.
        let of = if number == 0 { name.clone() } else { format!("{name} again {number}") };
        let (first, position, heading_rad) = poses[0];
        let last = poses[poses.len() - 1].0;
        let (comes, begin) = if number == 0 {
            (String::new(), start(&of, -1.0))
        } else {
            let at =
                format!("<AddEntityAction><Position>{}</Position></AddEntityAction>", world(position, heading_rad));
            (entity_action(name, &format!("coming of {of}"), &at), start(&of, time_s(first) - f64::from(TICK_S) / 2.0))
        };
        let _ = writeln!(
            text,
            "<Event name=\"event of {of}\" priority=\"overwrite\">{comes}<Action name=\"action of {of}\">"
        );
        line(&of, poses, &time_s, world, text);
        let _ = writeln!(text, "</Action>{begin}</Event>");
        if last < to {
            let leaves = entity_action(name, &format!("leaving of {of}"), "<DeleteEntityAction/>");
            let end = start(&format!("leaving of {of}"), time_s(last));
            let _ = writeln!(text, "<Event name=\"{of} leaves\" priority=\"overwrite\">{leaves}{end}</Event>");
        }
    }
    text.push_str("</Maneuver></ManeuverGroup>\n");
}

fn entity_action(name: &str, action: &str, what: &str) -> String {
    format!(
        "<Action name=\"{action}\"><GlobalAction><EntityAction entityRef=\"{name}\">{what}</EntityAction></GlobalAction></Action>"
    )
}

/// The action that follows a track.
fn line(
    of: &str,
    poses: &[Pose],
    time_s: &impl Fn(Tick) -> f64,
    world: &impl Fn(Vec3, f32) -> String,
    text: &mut String,
) {
    let _ = writeln!(
        text,
        "<PrivateAction><RoutingAction><FollowTrajectoryAction><Trajectory name=\"track of {of}\" closed=\"false\"><Shape><Polyline>"
    );
    let mut vertex = |tick: Tick, position: Vec3, heading_rad: f32| {
        let (time_s, at) = (time_s(tick), world(position, heading_rad));
        let _ = writeln!(text, "<Vertex time=\"{time_s}\"><Position>{at}</Position></Vertex>");
    };
    poses.iter().for_each(|(tick, position, heading_rad)| vertex(*tick, *position, *heading_rad));
    // A line has two ends.
    if let [(tick, position, heading_rad)] = poses {
        vertex(tick + 1, *position, *heading_rad);
    }
    let _ = writeln!(
        text,
        "</Polyline></Shape></Trajectory><TimeReference><Timing domainAbsoluteRelative=\"absolute\" scale=\"1\" \
         offset=\"0\"/></TimeReference><TrajectoryFollowingMode followingMode=\"position\"/></FollowTrajectoryAction>\
         </RoutingAction></PrivateAction>"
    );
}

fn entity(track: &Track, text: &mut String) {
    let (name, Vec3 { x: length, y: width, z: height }) = (&track.name, track.size_m);
    // Above the ground, the middle of the body; the ego car has room below.
    let middle_m = if track.kind.is_none() { ego::CENTRE_M.z } else { height / 2.0 };
    let bounds = format!(
        "<BoundingBox><Center x=\"0\" y=\"0\" z=\"{middle_m}\"/><Dimensions width=\"{width}\" length=\"{length}\" height=\"{height}\"/>\
         </BoundingBox>"
    );
    let body = match track.kind {
        Some(kind) if kind.is_on_foot() => {
            let category = if kind == ActorKind::Wheelchair { "wheelchair" } else { "pedestrian" };
            let model = format!("{kind:?}").to_lowercase();
            format!(
                "<Pedestrian name=\"{model}\" model=\"{model}\" mass=\"{}\" pedestrianCategory=\"{category}\">{bounds}\
                 <Properties/></Pedestrian>",
                kind.mass_kg()
            )
        }
        Some(ActorKind::Obstacle) => format!(
            "<MiscObject name=\"{name}\" mass=\"{}\" miscObjectCategory=\"obstacle\">{bounds}<Properties/></MiscObject>",
            ActorKind::Obstacle.mass_kg()
        ),
        kind => {
            let (axle_m, wheel_m) = match kind {
                None => (ego::WHEELBASE_M / 2.0, 2.0 * ego::WHEEL_RADIUS_M),
                Some(_) => (length * 0.28, 0.6_f32.min(height)),
            };
            let ego = "<Property name=\"type\" value=\"ego_vehicle\"/>";
            format!(
                "<Vehicle name=\"{name}\" vehicleCategory=\"{}\">{bounds}<Performance maxSpeed=\"{MOST_MPS}\" \
                 maxAcceleration=\"{MOST_MPS2}\" maxDeceleration=\"{MOST_MPS2}\"/><Axles><FrontAxle maxSteering=\"0.6\" \
                 wheelDiameter=\"{wheel_m}\" trackWidth=\"{width}\" positionX=\"{axle_m}\" positionZ=\"{half}\"/><RearAxle \
                 maxSteering=\"0\" wheelDiameter=\"{wheel_m}\" trackWidth=\"{width}\" positionX=\"-{axle_m}\" \
                 positionZ=\"{half}\"/></Axles><Properties>{}</Properties></Vehicle>",
                category(kind),
                if kind.is_none() { ego } else { "" },
                half = wheel_m / 2.0,
            )
        }
    };
    let _ = writeln!(text, "<ScenarioObject name=\"{name}\">{body}</ScenarioObject>");
}

/// What the standard calls a vehicle.
fn category(kind: Option<ActorKind>) -> &'static str {
    match kind {
        Some(ActorKind::Truck) => "truck",
        Some(ActorKind::Bus) => "bus",
        Some(ActorKind::Van) => "van",
        Some(ActorKind::Tram) => "tram",
        Some(kind) if kind.is_motorcycle() => "motorbike",
        Some(kind) if kind.is_pedalled() => "bicycle",
        _ => "car",
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
