//! What force feedback asks of a device.

use std::io;

use super::effects::Effects;

/// A device that moves by itself.
pub trait Actuator {
    /// Makes the device feel so from now on.
    fn apply(&mut self, effects: &Effects) -> io::Result<()>;
}
