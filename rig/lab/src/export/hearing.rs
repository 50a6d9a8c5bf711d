//! What the safety driver heard in a window of a recording, as a WAV file.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use anyhow::bail;
use base::output;
use base::progress::Interrupt;
use hound::{SampleFormat, WavSpec, WavWriter};
use kernel::Seat;
use kernel::time::TICK_HZ;
use measures::footage::{Asked, Window};
use replay::{Recording, Replayer};
use sound::{Ear, Heard, Mixer, SAMPLE_HZ};

use super::film::Counts;
use super::options::{Export, Options};

const SAMPLES_A_TICK: u32 = SAMPLE_HZ / TICK_HZ;
/// What sounded last rings on for so long, seconds.
const TAIL_S: u32 = 1;
/// The file is made in memory: so many ticks at most, an hour.
const MOST_TICKS: u64 = 3600 * TICK_HZ as u64;

/// Writes the file, unless it is there.
pub fn export(args: &Options, file: &Path, out: PathBuf, interrupt: &Interrupt) -> anyhow::Result<Export> {
    let recording = Recording::open(file)?;
    let (log, network) = (recording.log(), recording.network()?);
    let window = Window::of(log, &Asked { fps: TICK_HZ, ..args.asked() })?;
    let (from, to) = window.ticks.into_inner();
    if to - from > MOST_TICKS {
        bail!("a window of more than an hour; expected a shorter one by --last, --from and --to");
    }
    let mut replayer = Replayer::new(log, network)?;
    // A tick is heard by what it comes from; the first of a log has nothing before it.
    replayer.seek(from.saturating_sub(1)).or_else(|_| replayer.seek(from))?;
    let (mut ear, mut mixer) = (Ear::default(), Mixer::new(SAMPLE_HZ));
    let spec = WavSpec { channels: 2, sample_rate: SAMPLE_HZ, bits_per_sample: 16, sample_format: SampleFormat::Int };
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = WavWriter::new(&mut bytes, spec)?;
    let mut write = |mixer: &mut Mixer, samples: u32| {
        let both = (0..samples).flat_map(|_| mixer.sample());
        both.into_iter().try_for_each(|side| writer.write_sample((side * f32::from(i16::MAX)) as i16))
    };
    let mut ticks = 0;
    while replayer.world().tick() < to {
        if interrupt.is_raised() {
            bail!("interrupted; nothing of its export is kept");
        }
        let Some(output) = replayer.step()? else { break };
        mixer.hear(&ear.hear(&replayer.world().scene(), &output.applied.controls, &output.events).by(Seat::Safety));
        write(&mut mixer, SAMPLES_A_TICK)?;
        ticks += 1;
    }
    mixer.hear(&Heard::default());
    write(&mut mixer, TAIL_S * SAMPLE_HZ)?;
    writer.finalize()?;
    let bytes = bytes.into_inner();
    let kept = match fs::read(&out) {
        Ok(known) if known == bytes => true,
        Ok(_) => bail!("{}: exists already and is no export of this; expected another place", out.display()),
        Err(_) => false,
    };
    if !kept {
        output::write_file(&out, &bytes)?;
    }
    Ok(Export { file: file.to_owned(), out, from, to, kept, counts: Counts { frames: 0, poses: ticks, events: 0 } })
}
