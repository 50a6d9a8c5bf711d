//! Looks at pictures through a network and says how long each took, for `benches/peers/engines.py`, which looks at the
//! same ones with onnxruntime.
//!
//! `picture_to_mask NETWORK WIDTH HEIGHT` reads pictures from its input, three bytes a pixel, and writes for each the
//! CPU time in milliseconds (a little-endian `f64`) and the mask; before the first one, how many classes there are
//! (a byte) and their tags.

use std::io::{ErrorKind, Read, Write, stdin, stdout};
use std::process::ExitCode;

use nix::time::{ClockId, clock_gettime};
use perception::{Checkpoint, RgbView, Segmenter, bundled};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match serve(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("{reason}");
            ExitCode::FAILURE
        }
    }
}

fn serve(arguments: &[String]) -> Result<(), String> {
    let say = |error: &dyn std::fmt::Display| error.to_string();
    let [name, width, height] = arguments else { return Err("usage: picture_to_mask NETWORK WIDTH HEIGHT".into()) };
    let size = |text: &String| text.parse::<usize>().map_err(|error| say(&error));
    let (width, height) = (size(width)?, size(height)?);
    let network = bundled(name).unwrap_or_else(|| Checkpoint::load(name)).map_err(|error| say(&error))?;
    let mut segmenter = Segmenter::new(&network, width, height).map_err(|error| say(&error))?;
    let tags = network.classes().tags();
    let mut out = stdout().lock();
    out.write_all(&[tags.len() as u8]).and_then(|()| out.write_all(tags)).map_err(|error| say(&error))?;
    let mut rgb = vec![0; 3 * width * height];
    loop {
        out.flush().map_err(|error| say(&error))?;
        match stdin().read_exact(&mut rgb) {
            Ok(()) => {}
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Ok(()),
            Err(error) => return Err(say(&error)),
        }
        let image = RgbView::new(width, height, &rgb).map_err(|error| say(&error))?;
        let start = cpu_ms()?;
        let mask = segmenter.run(image).map_err(|error| say(&error))?;
        let taken = cpu_ms()? - start;
        out.write_all(&taken.to_le_bytes()).and_then(|()| out.write_all(&mask.ids)).map_err(|error| say(&error))?;
    }
}

/// CPU time of this thread, milliseconds.
fn cpu_ms() -> Result<f64, String> {
    let now = clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID).map_err(|error| error.to_string())?;
    Ok(now.tv_sec() as f64 * 1e3 + now.tv_nsec() as f64 * 1e-6)
}
