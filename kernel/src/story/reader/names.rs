//! Roles and programmes of lights by their names.

use crate::story::error::StoryError;
use crate::story::script::{Programme, Role, RoleId};

use super::document::Element;

/// Names of roles, and of programmes of lights.
pub struct Names<'a> {
    pub cast: &'a [Role],
    pub programmes: &'a [Programme],
    /// What leads to the left and turns to the left in the file, in CARLA's files to the right: 1 or -1.
    pub left: f64,
}

impl Names<'_> {
    /// The role that an attribute names.
    pub fn role(&self, element: Element<'_>, attribute: &str) -> Result<RoleId, StoryError> {
        let name = element.text(attribute)?;
        let found = self.cast.iter().position(|role| role.name == name);
        found.ok_or_else(|| {
            let known: Vec<_> = self.cast.iter().take(8).map(|role| role.name.as_str()).collect();
            let expected = format!("expected an entity of the file: {}", known.join(", "));
            element.wrong(format!("{attribute} of <{}> is {name:?}, {expected}", element.tag()))
        })
    }

    /// The programme of lights and its phase that two attributes name.
    pub fn phase(&self, element: Element<'_>, attribute: &str, phase: &str) -> Result<(usize, usize), StoryError> {
        let (name, phase) = (element.text(attribute)?, element.text(phase)?);
        let number = self.programmes.iter().position(|programme| programme.name == name);
        let of = number.and_then(|number| {
            let phases = &self.programmes[number].phases;
            phases.iter().position(|(other, ..)| *other == phase).map(|phase| (number, phase))
        });
        let expected = "expected a <TrafficSignalController> of the file and one of its phases";
        of.ok_or_else(|| element.wrong(format!("<{}> names {name:?}, {phase:?}: {expected}", element.tag())))
    }
}
