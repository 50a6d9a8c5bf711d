//! Who plays.

use crate::actor::ActorKind;
use crate::story::error::StoryError;
use crate::story::script::Role;

use super::document::Element;
use super::vary;

/// Most roles.
const ROLES: usize = 200;
/// Names by which files call the ego car.
const EGO: [&str; 4] = ["ego", "hero", "ego_vehicle", "egovehicle"];
/// Fastest that somebody goes where the file does not say, m/s.
const MOST_MPS: f32 = 100.0;

const VEHICLES: &[(&str, ActorKind)] = &[
    ("car", ActorKind::Car),
    ("van", ActorKind::Van),
    ("truck", ActorKind::Truck),
    ("semitrailer", ActorKind::Truck),
    ("trailer", ActorKind::Truck),
    ("bus", ActorKind::Bus),
    ("motorbike", ActorKind::Motorcycle),
    ("bicycle", ActorKind::Bicycle),
    ("train", ActorKind::Tram),
    ("tram", ActorKind::Tram),
];
const PEOPLE: &[(&str, ActorKind)] = &[("pedestrian", ActorKind::Pedestrian), ("wheelchair", ActorKind::Wheelchair)];

/// The roles of a file. The ego car is the vehicle that is called so, or whose property `type` is `ego_vehicle`, or else
/// the first one, rather with four wheels than with two.
pub fn read(entities: Element<'_>) -> Result<Vec<Role>, StoryError> {
    let mut cast: Vec<Role> = Vec::new();
    let mut egos = Vec::new();
    for object in entities.all("ScenarioObject") {
        let name = object.text("name")?;
        if cast.len() == ROLES {
            return Err(object.wrong(format!("expected at most {ROLES} entities")));
        }
        if cast.iter().any(|role| role.name == name) {
            return Err(object.wrong(format!("there are two entities of the name {name:?}")));
        }
        let body = object.choice()?;
        vary::pass_parameters(body)?;
        let (kind, most_mps) = match body.tag() {
            "Vehicle" => vehicle(body)?,
            "Pedestrian" => (person(body)?, MOST_MPS),
            "MiscObject" => (thing(body)?, MOST_MPS),
            "CatalogReference" => (guessed(&body.text("catalogName")?, &body.text("entryName")?), MOST_MPS),
            _ => return Err(body.unsupported()),
        };
        let drives = kind.is_vehicle();
        if drives && (EGO.contains(&name.to_lowercase().as_str()) || is_ego(body)?) {
            egos.push(cast.len());
        }
        let guessed = body.tag() == "CatalogReference";
        cast.push(Role { name, kind: Some(kind), guessed, most_mps, at: object.begins() });
    }
    let drives = |role: &Role| role.kind.is_some_and(ActorKind::is_vehicle);
    let is_car = |role: &Role| role.kind.is_some_and(ActorKind::is_car_or_heavier);
    let first = cast.iter().position(is_car).or_else(|| cast.iter().position(drives));
    let Some(ego) = egos.first().copied().or(first) else {
        return Err(entities.wrong("expected a vehicle that is the ego car"));
    };
    cast[ego].kind = None;
    Ok(cast)
}

/// What an entry of a catalog is by its name, where the catalog is not there: a car unless it says otherwise.
fn guessed(catalog: &str, entry: &str) -> ActorKind {
    if catalog.to_lowercase().contains("misc") {
        return ActorKind::Obstacle;
    }
    let entry = entry.to_lowercase();
    let named =
        [("motorbike", ActorKind::Motorcycle), ("motorcycle", ActorKind::Motorcycle), ("bicycle", ActorKind::Bicycle)];
    let named = named.into_iter().chain([
        ("bike", ActorKind::Bicycle),
        ("cyclist", ActorKind::Bicycle),
        ("child", ActorKind::Child),
    ]);
    let named = named.chain([
        ("pedestrian", ActorKind::Pedestrian),
        ("walker", ActorKind::Pedestrian),
        ("truck", ActorKind::Truck),
    ]);
    let mut named = named.chain([
        ("trailer", ActorKind::Truck),
        ("bus", ActorKind::Bus),
        ("van", ActorKind::Van),
        ("tram", ActorKind::Tram),
    ]);
    named.find(|(word, _)| entry.contains(word)).map_or(ActorKind::Car, |(_, kind)| kind)
}

fn vehicle(body: Element<'_>) -> Result<(ActorKind, f32), StoryError> {
    let kind = body.word("vehicleCategory", VEHICLES)?;
    let most_mps = match body.child("Performance") {
        Some(performance) => performance.amount("maxSpeed")?.min(MOST_MPS),
        None => MOST_MPS,
    };
    Ok((kind, most_mps))
}

/// What stands in the way: other things are parts of a map.
fn thing(body: Element<'_>) -> Result<ActorKind, StoryError> {
    const THINGS: &[(&str, ActorKind)] =
        &[("obstacle", ActorKind::Obstacle), ("barrier", ActorKind::Obstacle), ("none", ActorKind::Obstacle)];
    body.word("miscObjectCategory", THINGS)
}

fn person(body: Element<'_>) -> Result<ActorKind, StoryError> {
    let kind = body.word("pedestrianCategory", PEOPLE)?;
    let said = format!("{} {}", body.given("model")?.unwrap_or_default(), body.given("name")?.unwrap_or_default());
    let is_child = kind == ActorKind::Pedestrian && said.to_lowercase().contains("child");
    Ok(if is_child { ActorKind::Child } else { kind })
}

/// Whether a property says that it is the ego car, as ScenarioRunner's files do.
fn is_ego(body: Element<'_>) -> Result<bool, StoryError> {
    let Some(properties) = body.child("Properties") else { return Ok(false) };
    for property in properties.all("Property") {
        if property.given("name")?.as_deref() == Some("type")
            && property.given("value")?.as_deref() == Some("ego_vehicle")
        {
            return Ok(true);
        }
    }
    Ok(false)
}
