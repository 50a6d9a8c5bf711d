//! OpenSCENARIO XML, 1.0 to 1.2, to a [`Script`]. `coverage` says which elements are read.

mod actions;
mod catalogs;
mod conditions;
mod coverage;
mod document;
mod dynamics;
mod entities;
mod environment;
mod names;
mod positions;
mod signals;
mod speeds;
mod storyboard;
mod value;
mod vary;

pub use catalogs::{folders, put_in};
pub use coverage::{ELEMENTS, Row, Support};
pub use vary::{drawn, varied, with_shares};

use super::error::StoryError;
use super::plan;
use super::script::Script;
use document::{Element, Shared};
use names::Names;
use storyboard::{Beginning, Board};

/// What a text says besides its script.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Read {
    /// What it says of who plays, and what happens.
    pub script: Script,
    /// The file of the map, as it is called in the text.
    pub map: String,
    /// What was passed over, by line: harmless, and of each element the first one only.
    pub passed: Vec<(u32, String)>,
}

/// Reads a text.
///
/// # Errors
/// One sentence with the line of what is no OpenSCENARIO, or is not supported.
pub fn read(text: &str) -> Result<Read, StoryError> {
    let document = document::parse(text)?;
    let shared = Shared::of(&document);
    let root = Element::root(&document, &shared)?;
    for (other, what) in [("Catalog", "a catalog"), ("ParameterValueDistribution", "a distribution of parameters")] {
        if root.child(other).is_some() {
            return Err(root.wrong(format!("it is {what}, expected a story")));
        }
    }
    document::check_version(&document)?;
    let header = root.child("FileHeader");
    vary::pass_parameters(root)?;
    let network = root.need("RoadNetwork")?;
    let map = network.need("LogicFile")?.text("filepath")?;
    let cast = entities::read(root.need("Entities")?)?;
    let programmes = signals::programmes(network.child("TrafficSignals"))?;
    // As CARLA's ScenarioRunner tells them.
    let is_carla =
        header.map_or(Ok(None), |header| header.given("description"))?.is_some_and(|d| d.starts_with("CARLA:"));
    let names = Names { cast: &cast, programmes: &programmes, left: if is_carla { -1.0 } else { 1.0 } };
    let Board { init, acts, stop } = storyboard::read(root.need("Storyboard")?, &names)?;
    let passed = shared.leftovers(&document)?;
    let Beginning { actions: init, lights, environment } = init;
    let script = Script { init, acts, stop, cast, lights, programmes, environment };
    if let Some((at, wrong)) = plan::dangling(&script) {
        return Err(StoryError::at(document.text_pos_at(at).row, wrong));
    }
    Ok(Read { script, map, passed })
}
