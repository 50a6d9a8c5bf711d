//! Lists and calibrates wheels and gamepads.

use std::io::{BufRead, Write};
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use anyhow::{Context, anyhow, bail};
use base::failure::Usage;
use base::files::{self, most};
use base::json::Typed;
use base::output;
use base::say::say;
use live::units::calibration::{self, Calibration};
use live::units::hardware::Hardware;
use live::units::source::DeviceInfo;
use live::units::wizard::{Console, calibrate};
use live::units::{calibration_of, carla};
use serde::Serialize;

use crate::cli::{WheelCalibrateArgs, WheelCommand, WheelImportArgs, WheelListArgs};
use crate::exit::Verdict;
use crate::print::print;

/// How often devices are listened to while their driver reads the question.
const LISTEN: Duration = Duration::from_millis(5);

/// Runs `aeye wheel`.
pub fn run(command: &WheelCommand, json: bool) -> anyhow::Result<Verdict> {
    match command {
        WheelCommand::List(args) => list(args, json)?,
        WheelCommand::Calibrate(args) => by_asking(args, json)?,
        WheelCommand::Import(args) => by_import(args, json)?,
    }
    Ok(Verdict::Ok)
}

/// A device.
#[derive(Debug, Serialize)]
struct Entry {
    /// Where it is.
    path: String,
    /// Its name.
    name: String,
    /// Number of its vendor.
    vendor: u16,
    /// Number of the product.
    product: u16,
    /// Number of its axes.
    axes: usize,
    /// Number of its buttons.
    buttons: usize,
    /// Where its calibration comes from; none when it has to be calibrated first.
    calibration: Option<&'static str>,
}

/// Every device.
#[derive(Debug, Serialize)]
struct Listed {
    /// Those that are there.
    devices: Vec<Entry>,
}

/// What `aeye wheel list` prints.
impl Typed for Listed {
    const TYPE: &'static str = "aeye.wheel.list";
}

fn list(args: &WheelListArgs, json: bool) -> anyhow::Result<()> {
    let own = args.calibration.iter().map(|file| calibration::read(file)).collect::<anyhow::Result<Vec<_>>>()?;
    let devices = Hardware::open()?.devices();
    let listed = Listed { devices: devices.iter().map(|device| entry(&own, device)).collect() };
    print(json, &listed, || {
        let lines: Vec<String> = listed.devices.iter().map(line).collect();
        if lines.is_empty() { none_found() } else { lines.join("\n") }
    })
}

/// What there is to say when nothing is plugged in.
pub fn none_found() -> String {
    String::from(
        "none: plug a wheel or gamepad in (on Linux it needs read and write permission on /dev/input/event*); \
         aeye drive uses the keyboard then, or what --semantic and --safety say",
    )
}

fn entry(own: &[Calibration], device: &DeviceInfo) -> Entry {
    let is_own = own.iter().any(|c| c.device == device.name);
    let calibration = calibration_of(own, device).map(|_| if is_own { "file" } else { "preset" });
    Entry {
        path: device.path.clone(),
        name: device.name.clone(),
        vendor: device.vendor,
        product: device.product,
        axes: device.axes.len(),
        buttons: device.buttons.len(),
        calibration,
    }
}

fn line(entry: &Entry) -> String {
    let Entry { path, name, vendor, product, axes, buttons, calibration } = entry;
    let calibration = calibration.unwrap_or("none, run aeye wheel calibrate");
    format!("{path}  {name} ({vendor:04x}:{product:04x}), {axes} axes, {buttons} buttons, calibration: {calibration}")
}

fn by_asking(args: &WheelCalibrateArgs, json: bool) -> anyhow::Result<()> {
    output::check_file(&args.out)?;
    let mut hardware = Hardware::open()?;
    let device = pick(&hardware.devices(), args.device.as_deref())?;
    say(format_args!("{} at {}", device.name, device.path));
    let calibration = calibrate(&mut hardware, &device, &mut Terminal::new())?;
    write(&calibration, &args.out, json)
}

fn by_import(args: &WheelImportArgs, json: bool) -> anyhow::Result<()> {
    output::check_file(&args.out)?;
    let name = args.file.display();
    let text = files::read_text(&args.file, most::TEXT)?;
    let device = args.device.as_deref().map(|path| pick(&Hardware::open()?.devices(), Some(path))).transpose()?;
    let calibration = carla::import(&text, device.as_ref()).map_err(|problem| anyhow!("{name}: {problem}"))?;
    write(&calibration, &args.out, json)
}

fn write(calibration: &Calibration, path: &Path, json: bool) -> anyhow::Result<()> {
    if let Some(there) = calibration::read(path).ok().filter(|there| there.device != calibration.device) {
        let (path, other, device) = (path.display(), there.device, &calibration.device);
        bail!("{path}: holds the calibration of {other}; expected another place for {device}");
    }
    output::write_file(path, calibration.to_toml()?.as_bytes())?;
    print(json, calibration, || format!("{}: calibration of {}", path.display(), calibration.device))
}

/// The device at a path, or the only one.
fn pick(devices: &[DeviceInfo], path: Option<&str>) -> anyhow::Result<DeviceInfo> {
    let real = |path: &str| std::fs::canonicalize(path).ok().and_then(|p| p.to_str().map(str::to_owned));
    match (path, devices) {
        (Some(path), _) => {
            let path = real(path).unwrap_or_else(|| path.to_owned());
            devices.iter().find(|d| d.path == path).cloned().ok_or_else(|| anyhow!("{path}: no wheel or gamepad"))
        }
        (None, [device]) => Ok(device.clone()),
        (None, []) => bail!("found no wheel or gamepad; plug one in (it must be readable and writable for you)"),
        (None, several) => {
            let paths: Vec<&str> = several.iter().map(|d| d.path.as_str()).collect();
            Err(Usage(format!("several devices: name one of {} with --device", paths.join(", "))).into())
        }
    }
}

/// Questions on stderr, answers on stdin, which is read beside so that no movement is missed.
struct Terminal(Receiver<std::io::Result<String>>);

impl Terminal {
    fn new() -> Self {
        let (sender, lines) = channel();
        std::thread::spawn(move || {
            for line in std::io::stdin().lock().lines() {
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
        Self(lines)
    }
}

impl Console for Terminal {
    fn ask(&mut self, question: &str, meanwhile: &mut dyn FnMut()) -> anyhow::Result<String> {
        let mut stderr = std::io::stderr().lock();
        write!(stderr, "{question} ").and_then(|()| stderr.flush()).context("stderr")?;
        loop {
            match self.0.recv_timeout(LISTEN) {
                Ok(line) => return line.context("stdin"),
                Err(RecvTimeoutError::Timeout) => meanwhile(),
                Err(RecvTimeoutError::Disconnected) => bail!("stdin ended before the calibration"),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_device_needs_no_name_and_several_do() {
        let device = |id, path: &str| DeviceInfo {
            id,
            path: path.into(),
            name: "pad".into(),
            vendor: 0,
            product: 0,
            axes: Vec::new(),
            buttons: Vec::new(),
            layout: None,
        };
        let two = [device(0, "/dev/input/event98"), device(1, "/dev/input/event99")];
        assert_eq!(pick(&two[..1], None).unwrap().id, 0);
        assert_eq!(pick(&two, Some("/dev/input/event99")).unwrap().id, 1);
        assert!(pick(&two, None).unwrap_err().is::<Usage>());
        assert!(pick(&[], None).unwrap_err().to_string().contains("plug one in"));
        assert!(line(&entry(&[], &two[0])).ends_with("run aeye wheel calibrate"));
    }
}
