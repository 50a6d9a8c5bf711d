//! Roles by their names.

use crate::story::error::StoryError;
use crate::story::script::{Role, RoleId};

use super::document::Element;

/// Names of roles.
pub struct Names<'a> {
    pub cast: &'a [Role],
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
}
