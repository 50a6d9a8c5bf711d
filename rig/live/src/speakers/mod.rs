//! What the drivers hear: made of each tick by [`sound`], played on devices by threads of their own. The simulation waits
//! for none of them.

mod choice;
mod device;
mod null;
mod outlet;

use std::sync::Arc;

use base::say::say;
use kernel::{Seat, TickOutput, World};
use sound::{Ear, Heard, SAMPLE_HZ};

pub use choice::Choice;
use device::Device;
use null::Null;
use outlet::{Outlet, Player};

/// What is played where.
#[derive(Clone, Debug)]
pub struct Options {
    /// Where the safety driver, and the operators, hear the car and are warned.
    pub safety: Choice,
    /// Where the semantic driver hears takeovers.
    pub semantic: Choice,
    /// The semantic driver hears the car, too: it tells what the mask does not.
    pub semantic_hears_car: bool,
}

impl Options {
    /// What is heard by nobody, and computed all the same.
    pub fn null() -> Self {
        Self { safety: Choice::Null, semantic: Choice::Off, semantic_hears_car: false }
    }
}

/// Devices that play until this is dropped.
#[derive(Default)]
pub struct Speakers {
    _devices: Vec<Device>,
    _nulls: Vec<Null>,
}

/// Takes in the ticks of a session, and tells the devices what is heard.
#[derive(Default)]
pub struct Sound {
    ear: Ear,
    seats: Vec<SeatSound>,
    is_muted: bool,
    has_rested: bool,
    /// One was asked for that this machine does not have.
    is_missing: bool,
}

struct SeatSound {
    seat: Seat,
    hears_car: bool,
    /// Where it is heard; nowhere, where it is only computed.
    device: Option<String>,
    outlet: Arc<Outlet>,
}

/// Opens the devices that are asked for. Where the system has none of its own, that is said, and the session is silent.
pub fn open(options: &Options) -> anyhow::Result<(Speakers, Sound)> {
    let (mut speakers, mut sound) = (Speakers::default(), Sound::default());
    let seats =
        [(Seat::Safety, &options.safety, true), (Seat::Semantic, &options.semantic, options.semantic_hears_car)];
    for (seat, choice, hears_car) in seats {
        let outlet = Arc::new(Outlet::default());
        let player = |sample_hz| Player::new(outlet.clone(), sample_hz);
        let found = match choice {
            Choice::Off => continue,
            Choice::Null => {
                speakers._nulls.push(Null::open(player(SAMPLE_HZ)));
                sound.seats.push(SeatSound { seat, hears_car, device: None, outlet });
                continue;
            }
            Choice::Default => device::default(),
            Choice::Named(name) => Some(device::named(name)?),
        };
        let opened = match (found.map(|found| Device::open(&found, player)).transpose(), choice) {
            // Nobody asked for this one by its name.
            (Err(error), Choice::Default) => {
                say(format_args!("{error:#}"));
                None
            }
            (opened, _) => opened?,
        };
        match opened {
            Some(device) => {
                sound.seats.push(SeatSound { seat, hears_car, device: Some(device.name.clone()), outlet });
                speakers._devices.push(device);
            }
            None => {
                sound.is_missing = true;
                say("no sound device: the session is silent");
            }
        }
    }
    Ok((speakers, sound))
}

impl Sound {
    /// A tick was driven.
    pub fn tick(&mut self, world: &World, output: &TickOutput) {
        if self.seats.is_empty() {
            return;
        }
        self.has_rested = false;
        let heard = self.ear.hear(&world.scene(), &output.applied.controls, &output.events);
        self.put(&heard);
    }

    /// Time stands, or no run is on: silence.
    pub fn rest(&mut self) {
        if !std::mem::replace(&mut self.has_rested, true) {
            self.ear = Ear::default();
            self.put(&Heard::default());
        }
    }

    fn put(&self, heard: &Heard) {
        for seat in &self.seats {
            let heard = heard.clone().by(seat.seat);
            seat.outlet.put(if seat.hears_car { heard } else { heard.signals_alone() });
        }
    }

    /// Plays nothing, or plays again.
    pub fn toggle(&mut self) {
        self.is_muted = !self.is_muted;
        self.seats.iter().for_each(|seat| seat.outlet.mute(self.is_muted));
    }

    /// Who hears the car now, for the recording; nobody where it is only computed, muted, or its device is gone.
    pub fn heard_by(&self) -> Vec<Seat> {
        let plays = |seat: &&SeatSound| seat.device.is_some() && !self.is_muted && !seat.outlet.is_lost();
        let hears = self.seats.iter().filter(plays).filter(|seat| seat.hears_car);
        hears.map(|seat| seat.seat).collect()
    }

    /// How often samples came too late.
    pub fn late_count(&self) -> u64 {
        self.seats.iter().map(|seat| seat.outlet.late_count()).sum()
    }

    /// How it is, in words.
    pub fn words(&self) -> String {
        let device = |seat: &SeatSound| match &seat.device {
            Some(_) if seat.outlet.is_lost() => "a device that is gone".to_owned(),
            Some(name) => name.clone(),
            None => "nowhere".to_owned(),
        };
        let devices = self.seats.iter().map(device);
        let devices: Vec<String> = devices.collect();
        match (devices.is_empty(), self.is_muted) {
            (true, _) if self.is_missing => "no device".into(),
            (true, _) => "off".into(),
            (false, true) => "muted (M plays)".into(),
            (false, false) => format!("on {} (M mutes)", devices.join(" and ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opened(semantic: Choice, semantic_hears_car: bool) -> Sound {
        let options = Options { safety: Choice::Null, semantic, semantic_hears_car };
        open(&options).expect("nothing is asked of the machine").1
    }

    #[test]
    fn who_asked_for_nothing_hears_nothing() {
        let options = Options { safety: Choice::Off, semantic: Choice::Off, semantic_hears_car: true };
        let (_, sound) = open(&options).unwrap();
        assert_eq!((sound.words().as_str(), sound.heard_by(), sound.late_count()), ("off", vec![], 0));
    }

    #[test]
    fn what_nobody_hears_is_not_said_to_be_heard() {
        let mut sound = opened(Choice::Null, true);
        assert_eq!((sound.seats.len(), sound.heard_by()), (2, vec![]));
        assert_eq!(sound.words(), "on nowhere and nowhere (M mutes)");
        sound.toggle();
        assert_eq!(sound.words(), "muted (M plays)");
    }

    #[test]
    fn a_device_that_is_not_there_is_an_error_and_not_silence() {
        let named = Options { safety: Choice::Named("surely none".into()), ..Options::null() };
        assert!(open(&named).map(drop).unwrap_err().to_string().contains("surely none"));
    }
}
