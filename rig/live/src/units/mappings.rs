//! What is known of the layouts of gamepads: SDL's mappings, and what drivers say themselves. The only
//! file that names the upper layer of gilrs.
//!
//! gilrs gives its mappings for devices that it has opened itself only, so it opens all of them once
//! more for a moment, when a device of an unknown make is there. Events come from the raw layer alone.

use std::collections::BTreeMap;

use gilrs::{Axis, Button, Gamepad, GilrsBuilder, MappingSource};

use super::layout::{Layout, Trigger};

/// A make of devices, as SDL tells them apart.
type Make = [u8; 16];

/// Layouts of the makes of devices that have been there; none of those that are no gamepads.
#[derive(Debug, Default)]
pub(super) struct Mappings(BTreeMap<Make, Option<Elements>>);

impl Mappings {
    /// Those of the devices that are there now.
    pub fn read() -> Self {
        let quiet = GilrsBuilder::new().with_default_filters(false).with_force_feedback(false).set_update_state(false);
        // Where it finds nothing, devices can still be calibrated.
        let Ok(gilrs) = quiet.build() else { return Self::default() };
        Self(gilrs.gamepads().map(|(_, pad)| (pad.uuid(), Elements::of(&pad))).collect())
    }

    /// A device is there: looks again unless its make is known.
    pub fn meet(&mut self, make: Make) {
        if !self.0.contains_key(&make) {
            self.0.append(&mut Self::read().0);
        }
    }

    /// The layout of a device with these axes and buttons.
    pub fn layout(&self, make: Make, axes: &[u32], buttons: &[u32]) -> Option<Layout> {
        self.0.get(&make)?.as_ref()?.layout(axes, buttons)
    }
}

/// What gilrs calls the codes of a gamepad's elements: with the kind of event above the number.
#[derive(Debug)]
struct Elements {
    left_stick_x: Option<u32>,
    right_trigger: Option<u32>,
    left_trigger: Option<u32>,
    south: Option<u32>,
    east: Option<u32>,
    west: Option<u32>,
    north: Option<u32>,
    shoulders: [Option<u32>; 2],
    middle: [Option<u32>; 2],
}

impl Elements {
    fn of(pad: &Gamepad<'_>) -> Option<Self> {
        let button = |button| pad.button_code(button).map(|code| code.into_u32());
        let axis = |axis| pad.axis_code(axis).map(|code| code.into_u32());
        // What SDL does not list is a gamepad if its driver says so: wheels and joysticks have other buttons.
        if pad.mapping_source() != MappingSource::SdlMappings && button(Button::South).is_none() {
            return None;
        }
        // Without axes for a right stick these are the right stick, which rests in the middle.
        let z = |z| axis(z).filter(|_| axis(Axis::RightStickX).is_some());
        let trigger = |along, lower, upper| z(along).or(button(lower)).or(button(upper));
        Some(Self {
            left_stick_x: axis(Axis::LeftStickX),
            right_trigger: trigger(Axis::RightZ, Button::RightTrigger2, Button::RightTrigger),
            left_trigger: trigger(Axis::LeftZ, Button::LeftTrigger2, Button::LeftTrigger),
            south: button(Button::South),
            east: button(Button::East),
            west: button(Button::West),
            north: button(Button::North),
            shoulders: [Button::LeftTrigger, Button::RightTrigger].map(button),
            middle: [Button::Select, Button::Start].map(button),
        })
    }

    /// The layout, as far as the device has what the mapping says; nothing without a stick and two triggers.
    fn layout(&self, axes: &[u32], buttons: &[u32]) -> Option<Layout> {
        let one_of =
            |codes: &[u32], code: Option<u32>| code.filter(|code| codes.contains(code)).map(|code| code as u16);
        let (axis, button) = (|code| one_of(axes, code), |code| one_of(buttons, code));
        let trigger = |code| axis(code).map(Trigger::Axis).or(button(code).map(Trigger::Button));
        let pedals = [self.right_trigger, self.left_trigger];
        Some(Layout {
            left_stick_x: axis(self.left_stick_x)?,
            right_trigger: trigger(self.right_trigger)?,
            left_trigger: trigger(self.left_trigger)?,
            north: button(self.north),
            shoulders: self.shoulders.map(|code| button(code.filter(|_| !pedals.contains(&code)))),
            middle: self.middle.map(button),
            south: button(self.south),
            east: button(self.east),
            west: button(self.west),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Codes of Linux: kind 3 is an axis, 1 a button.
    const AXES: [u32; 3] = [0x3_0000, 0x3_0003, 0x3_0004];
    const BUTTONS: [u32; 2] = [0x1_0131, 0x1_0137];

    fn elements() -> Elements {
        let [left_stick_x, left_trigger, _] = AXES.map(Some);
        let [south, right_trigger] = BUTTONS.map(Some);
        Elements {
            left_stick_x,
            right_trigger,
            left_trigger,
            south,
            east: Some(0x1_0132),
            west: None,
            north: None,
            shoulders: [None, right_trigger],
            middle: [south, None],
        }
    }

    #[test]
    fn triggers_are_axes_or_buttons_and_what_the_device_lacks_is_left_out() {
        let expected = Layout {
            left_stick_x: 0,
            right_trigger: Trigger::Button(0x137),
            left_trigger: Trigger::Axis(3),
            south: Some(0x131),
            east: None,
            west: None,
            north: None,
            shoulders: [None; 2],
            middle: [Some(0x131), None],
        };
        assert_eq!(elements().layout(&AXES, &BUTTONS), Some(expected));
    }

    #[test]
    fn a_pad_without_a_stick_or_a_trigger_has_no_layout() {
        assert_eq!(elements().layout(&AXES[1..], &BUTTONS), None);
        assert_eq!(elements().layout(&AXES, &BUTTONS[..1]), None);
        assert_eq!(Elements { left_trigger: None, ..elements() }.layout(&AXES, &BUTTONS), None);
    }

    #[test]
    fn a_make_that_was_never_there_has_no_layout() {
        assert_eq!(Mappings::default().layout([0; 16], &AXES, &BUTTONS), None);
    }
}
