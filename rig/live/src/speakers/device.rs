//! The system's devices for sound, by cpal.

use anyhow::{Context, bail};
use base::say::say;
use cpal::traits::{DeviceTrait, HostTrait, StreamTrait};
use cpal::{FromSample, Sample, SampleFormat, SizedSample, Stream, StreamConfig};

use super::outlet::Player;

/// A device that plays until it is dropped.
pub struct Device {
    /// What the system calls it.
    pub name: String,
    _stream: Stream,
}

/// ALSA's own words on stderr about devices that it looked for in vain are kept from there: what matters is in the errors.
fn hush() {
    #[cfg(target_os = "linux")]
    drop(alsa::Output::local_error_handler());
}

/// The system's own choice; `None` where it has none that plays.
pub fn default() -> Option<cpal::Device> {
    hush();
    // ALSA names a default where there is no card; only its formats tell.
    cpal::default_host().default_output_device().filter(|device| device.default_output_config().is_ok())
}

/// The first device whose name holds a text.
pub fn named(text: &str) -> anyhow::Result<cpal::Device> {
    hush();
    let devices: Vec<cpal::Device> = cpal::default_host().output_devices().map(Iterator::collect).unwrap_or_default();
    let names: Vec<String> = devices.iter().map(name).collect();
    let found = names.iter().position(|name| name.to_lowercase().contains(&text.to_lowercase()));
    match found.and_then(|index| devices.into_iter().nth(index)) {
        Some(device) => Ok(device),
        None if names.is_empty() => bail!("no sound device {text:?}: this machine has none"),
        None => bail!("no sound device {text:?}; expected part of one of these names: {}", names.join(", ")),
    }
}

fn name(device: &cpal::Device) -> String {
    device.description().map_or_else(|_| device.to_string(), |description| description.name().to_owned())
}

impl Device {
    /// Begins to play on a device what a player for its rate of samples makes.
    pub fn open(device: &cpal::Device, player: impl FnOnce(u32) -> Player) -> anyhow::Result<Self> {
        let name = name(device);
        let config = device.default_output_config().with_context(|| format!("sound device {name}"))?;
        let player = player(config.sample_rate());
        let format = config.sample_format();
        let config = config.config();
        let stream = match format {
            SampleFormat::F32 => stream::<f32>(device, config, player),
            SampleFormat::F64 => stream::<f64>(device, config, player),
            SampleFormat::I24 => stream::<cpal::I24>(device, config, player),
            SampleFormat::U32 => stream::<u32>(device, config, player),
            SampleFormat::I16 => stream::<i16>(device, config, player),
            SampleFormat::I32 => stream::<i32>(device, config, player),
            SampleFormat::U16 => stream::<u16>(device, config, player),
            SampleFormat::U8 => stream::<u8>(device, config, player),
            other => bail!("sound device {name} wants samples as {other}, which the rig does not make"),
        };
        let stream = stream.with_context(|| format!("sound device {name}"))?;
        stream.play().with_context(|| format!("sound device {name}"))?;
        Ok(Self { name, _stream: stream })
    }
}

fn stream<T: SizedSample + FromSample<f32>>(
    device: &cpal::Device,
    config: StreamConfig,
    mut player: Player,
) -> Result<Stream, cpal::Error> {
    let channels = usize::from(config.channels).max(1);
    let outlet = player.outlet();
    let fill = move |samples: &mut [T], _: &cpal::OutputCallbackInfo| {
        player.play(samples.chunks_mut(channels), |frame, sides| put(frame, sides));
    };
    let failed = move |error: cpal::Error| match error.kind() {
        cpal::ErrorKind::Xrun => outlet.is_late(),
        cpal::ErrorKind::DeviceNotAvailable | cpal::ErrorKind::StreamInvalidated if outlet.lose() => {
            say(format_args!("sound: {error}; nothing more is heard of this device"));
        }
        _ => {}
    };
    device.build_output_stream(config, fill, failed, None)
}

/// Puts both sides into the first two channels of a device, or their mean into its only one.
fn put<T: Sample + FromSample<f32>>(frame: &mut [T], [left, right]: [f32; 2]) {
    match frame {
        [] => {}
        [only] => *only = T::from_sample(0.5 * (left + right)),
        [first, second, rest @ ..] => {
            (*first, *second) = (T::from_sample(left), T::from_sample(right));
            rest.fill(T::EQUILIBRIUM);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_go_where_a_device_has_them() {
        let of = |channels: usize| {
            let mut frame = vec![9_i16; channels];
            put(&mut frame, [0.5, -0.25]);
            frame
        };
        assert_eq!([of(1), of(2), of(4)], [vec![4096], vec![16384, -8192], vec![16384, -8192, 0, 0]]);
    }

    #[test]
    fn a_device_that_is_not_there_is_refused_by_its_name() {
        let said = named("no such device, surely").map(drop).unwrap_err().to_string();
        assert!(said.starts_with("no sound device \"no such device, surely\""), "{said}");
    }
}
