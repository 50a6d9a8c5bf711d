//! How people on foot are seen: `people_spread PEOPLE|default SEED [MAP]...` drives each map with so many people on foot, draws a
//! frame a second, and prints the tables of docs/people.md (on stderr).
//!
//! Occluded is the share of who is 8 pixels high or more that is hidden by others: the silhouette in the street against that
//! without a street.

use std::collections::BTreeMap;

use base::maps::Map;
use base::say::say;
use kernel::map::{BUNDLED, MapData};
use kernel::scene::{ActorScene, SceneSnapshot};
use lab::dataset::drive::ExpertDrive;
use render::mesh::people::appearance::{Age, Appearance, Carried};
use render::{AdapterChoice, Camera, Frame, Renderer, SemanticTag, instance_of_actor};

const WIDTH: u32 = 512;
const HEIGHT: u32 = 256;
/// Scenes of a map, and frames of a scene.
const SCENES: u64 = 6;
const FRAMES: u32 = 40;
/// Upper ends of the classes of heights, pixels.
const HEIGHTS_PX: [u32; 6] = [4, 8, 16, 32, 64, HEIGHT + 1];
/// From here on looks are told, pixels.
const LOOKED_AT_PX: u32 = 8;
/// A frame has somebody to learn from at this height, pixels.
const LARGE_PX: u32 = 16;
/// Upper ends of the classes of speeds, m/s, and of what is hidden of somebody.
const SPEEDS_MPS: [f32; 4] = [0.2, 1.0, 2.0, 9.0];
const HIDDEN: [f32; 4] = [0.05, 0.25, 0.5, 1.01];

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let usage = "usage: people_spread PEOPLE|default SEED [MAP]...";
    let [people, seed, names @ ..] = arguments.as_slice() else { anyhow::bail!(usage) };
    let people: Option<u16> = if people == "default" { None } else { Some(people.parse()?) };
    let seed: u64 = seed.parse()?;
    let all = BUNDLED.map(String::from);
    let mut spread = Spread::default();
    say("| map | frames | with somebody of 16 px or more | people | median height | tallest tenth |");
    say("|---|---|---|---|---|---|");
    for name in if names.is_empty() { &all } else { names } {
        let map = Map::find(name)?;
        let mut seen = Spread::default();
        (0..SCENES).try_for_each(|scene| drive(&map, people, seed + scene, &mut seen))?;
        seen.line(name);
        spread.join(seen);
    }
    spread.line("all");
    spread.tables();
    Ok(())
}

/// Somebody in a frame.
struct Person {
    height_px: u32,
    speed_mps: f32,
    hidden: f32,
    looks: Option<Appearance>,
}

#[derive(Default)]
struct Spread {
    frames: u32,
    with_large: u32,
    people: Vec<Person>,
}

fn drive(map: &Map, people: Option<u16>, seed: u64, spread: &mut Spread) -> anyhow::Result<()> {
    let mut renderer = Renderer::new(&map.network, &AdapterChoice::default())?;
    let mut alone =
        Renderer::new(&MapData { name: "nothing".into(), ..MapData::default() }.into(), &AdapterChoice::default())?;
    let mut scenario = map.scenario(seed);
    scenario.traffic.pedestrians = people.unwrap_or(scenario.traffic.pedestrians);
    let mut drive = ExpertDrive::new(&scenario, map)?;
    let camera = Camera::driver(WIDTH, HEIGHT);
    for _ in 0..FRAMES {
        if !drive.next_frame()? {
            break;
        }
        let scene = drive.world().scene();
        let frame = renderer.draw_classes(&scene, &camera)?;
        spread.frames += 1;
        let mut tallest = 0;
        for (instance, seen) in on_foot(&frame) {
            let actor = scene.actors.iter().find(|actor| instance_of_actor(actor.id) == instance);
            let Some(actor) = actor else { continue };
            tallest = tallest.max(seen.height_px);
            let whole = if seen.height_px < LOOKED_AT_PX {
                seen.pixels
            } else {
                silhouette(&mut alone, &scene, actor, &camera)?
            };
            spread.people.push(Person {
                height_px: seen.height_px,
                speed_mps: actor.speed_mps.abs(),
                hidden: 1.0 - seen.pixels as f32 / whole.max(seen.pixels) as f32,
                looks: Appearance::of(actor.kind, actor.variant),
            });
        }
        spread.with_large += u32::from(tallest >= LARGE_PX);
    }
    Ok(())
}

/// Whether somebody looks like that.
type Is = fn(&Appearance) -> bool;

/// Pixels of somebody.
#[derive(Default)]
struct Seen {
    first_row: u32,
    height_px: u32,
    pixels: u32,
}

/// People on foot in a frame by their instances.
fn on_foot(frame: &Frame) -> BTreeMap<u16, Seen> {
    let mut people: BTreeMap<u16, Seen> = BTreeMap::new();
    for (at, (id, instance)) in (0u32..).zip(frame.fine_ids.iter().zip(&frame.instance_ids)) {
        if *id == SemanticTag::Pedestrian as u8 {
            let row = at / frame.width;
            let seen = people.entry(*instance).or_insert(Seen { first_row: row, ..Seen::default() });
            seen.height_px = row - seen.first_row + 1;
            seen.pixels += 1;
        }
    }
    people
}

/// Pixels of somebody where there is nothing else.
fn silhouette(alone: &mut Renderer, scene: &SceneSnapshot, actor: &ActorScene, camera: &Camera) -> anyhow::Result<u32> {
    let bare = SceneSnapshot { actors: vec![*actor], lights: Vec::new(), ..scene.clone() };
    let frame = alone.draw_classes(&bare, camera)?;
    Ok(on_foot(&frame).values().map(|seen| seen.pixels).sum())
}

impl Spread {
    fn join(&mut self, other: Self) {
        self.frames += other.frames;
        self.with_large += other.with_large;
        self.people.extend(other.people);
    }

    fn line(&self, name: &str) {
        let mut heights: Vec<u32> = self.people.iter().map(|person| person.height_px).collect();
        heights.sort_unstable();
        let at = |percent: usize| heights.get(heights.len() * percent / 100).copied().unwrap_or(0);
        let (large, frames) = (percent(self.with_large as usize, self.frames as usize), self.frames);
        say(format_args!("| {name} | {frames} | {large} | {} | {} px | {} px |", heights.len(), at(50), at(90)));
    }

    fn tables(&self) {
        let heights = self.people.iter().map(|person| person.height_px as f32);
        table("height, px", &HEIGHTS_PX.map(|px| px as f32), heights);
        let near: Vec<&Person> = self.people.iter().filter(|person| person.height_px >= LOOKED_AT_PX).collect();
        table("speed, m/s", &SPEEDS_MPS, near.iter().map(|person| person.speed_mps));
        table("hidden share", &HIDDEN, near.iter().map(|person| person.hidden));
        let looks: Vec<Appearance> = near.iter().filter_map(|person| person.looks).collect();
        let kinds: [(&str, Is); 8] = [
            ("children", |looks| looks.age == Age::Child),
            ("old people", |looks| looks.age == Age::Old),
            ("dressed in dark", |looks| looks.is_dark),
            ("in a high-visibility vest", |looks| looks.has_vest),
            ("with a backpack", |looks| looks.carried == Carried::Backpack),
            ("with a bag", |looks| {
                matches!(looks.carried, Carried::Handbag | Carried::ShoppingBag | Carried::Briefcase)
            }),
            ("with a stick", |looks| looks.carried == Carried::Stick),
            ("with an umbrella, rolled up", |looks| looks.carried == Carried::RolledUmbrella),
        ];
        say("\n| looks | share |\n|---|---|");
        for (what, is) in kinds {
            say(format_args!("| {what} | {} |", percent(looks.iter().filter(|looks| is(looks)).count(), looks.len())));
        }
        let others = near.len() - looks.len();
        say(format_args!("| with a pram or in a wheelchair | {} |", percent(others, near.len())));
    }
}

fn percent(part: usize, all: usize) -> String {
    format!("{:.0} %", 100.0 * part as f64 / all.max(1) as f64)
}

/// Shares of values between the ends of classes.
fn table(what: &str, ends: &[f32], values: impl Iterator<Item = f32>) {
    let values: Vec<f32> = values.collect();
    say(format_args!("\n| {what} | share |\n|---|---|"));
    let mut from = 0.0;
    for &to in ends {
        let inside = values.iter().filter(|value| (from..to).contains(*value)).count();
        let range =
            if to == *ends.last().unwrap_or(&to) { format!("{from} and more") } else { format!("{from} to {to}") };
        say(format_args!("| {range} | {} |", percent(inside, values.len())));
        from = to;
    }
}
