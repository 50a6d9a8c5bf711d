//! Junctions and their connections.

use roxmltree::Node;

use super::constants::{CONNECTIONS, CONTROLLERS, JUNCTIONS, LINKS};
use super::document::children;
use super::numbers;
use super::objects::{self, References};
use super::sums::{Sums, at_most};
use crate::baking::error::BakeError;

/// Checks the junctions of a file.
pub fn check(root: Node<'_, '_>, references: &References<'_>, sums: &mut Sums) -> Result<(), BakeError> {
    at_most(root, children(root, "junction").count(), JUNCTIONS, "junctions")?;
    at_most(root, children(root, "controller").count(), CONTROLLERS, "controllers")?;
    for controller in children(root, "controller") {
        at_most(controller, children(controller, "control").count(), LINKS, "signals of a controller")?;
    }
    for junction in children(root, "junction") {
        numbers::check(junction)?;
        objects::check(junction, 0, references, sums)?;
        at_most(junction, children(junction, "connection").count(), CONNECTIONS, "connections of a junction")?;
        at_most(junction, children(junction, "priority").count(), LINKS, "priorities of a junction")?;
        at_most(junction, children(junction, "controller").count(), LINKS, "controllers of a junction")?;
        for connection in children(junction, "connection") {
            at_most(connection, children(connection, "laneLink").count(), LINKS, "lane links of a connection")?;
        }
    }
    Ok(())
}
