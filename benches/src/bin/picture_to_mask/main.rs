//! Times networks from picture to mask: our engine, onnxruntime alone on the same file, and onnxruntime below our decoding
//! (`--inference ort`), turn by turn on one thread, and compares the masks.
//!
//! `picture_to_mask WIDTH HEIGHT ROUNDS FILE.onnx...`, with `ORT_DYLIB_PATH` as `--inference ort` needs it. Of onnxruntime
//! alone only its run counts, with what the file has of upsampling and argmax: what it needs before (normalised planes) and
//! after (upsampling and argmax where the file has none) is done here and costs an application more. Times are medians
//! of the thread's CPU time.

mod pictures;
mod theirs;

use std::path::Path;
use std::process::ExitCode;

use anyhow::Context;
use nix::time::{ClockId, clock_gettime};
use perception::{Checkpoint, Compute, Mask, RgbView, Segmenter};

use theirs::Theirs;

/// Pictures that the networks look at in turn.
const VIEWS: u64 = 3;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match compare_all(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error:#}");
            ExitCode::FAILURE
        }
    }
}

fn compare_all(arguments: &[String]) -> anyhow::Result<()> {
    let usage = "usage: picture_to_mask WIDTH HEIGHT ROUNDS FILE.onnx...";
    let [width, height, rounds, files @ ..] = arguments else { anyhow::bail!(usage) };
    let number = |text: &String| text.parse::<usize>().context(usage);
    let (size, rounds) = ((number(width)?, number(height)?), number(rounds)?.max(1));
    let mut all = Vec::new();
    for file in files {
        let compared = Compared::of(Path::new(file), size, rounds).with_context(|| file.clone())?;
        println!("{}", compared.told());
        all.push(compared);
    }
    for (what, number) in [("ours", 0), ("--inference ort", 1)] {
        let ratios = all.iter().map(|compared| compared.ratio(number));
        let (mean, highest) = (ratios.clone().sum::<f64>() / all.len() as f64, ratios.fold(0.0, f64::max));
        println!("{what}: mean ratio {mean:.2}, highest {highest:.2}");
    }
    Ok(())
}

/// What came of a network.
struct Compared {
    name: String,
    /// Medians of our engine, of `--inference ort` and of onnxruntime alone, milliseconds.
    ms: [f64; 3],
    /// Share of the pixels of the former two that onnxruntime alone sees alike.
    same: [f64; 2],
    /// Classes that onnxruntime alone sees.
    classes: usize,
}

impl Compared {
    fn of(path: &Path, (width, height): (usize, usize), rounds: usize) -> anyhow::Result<Self> {
        let checkpoint = Checkpoint::load(path)?;
        let open = |compute| Segmenter::on(compute, &checkpoint, width, height);
        let mut ours = [open(Compute::Cpu)?, open(Compute::OnnxRuntime)?];
        let mut theirs = Theirs::open(path, &checkpoint, (width, height))?;
        let tags = checkpoint.classes().tags();
        let views: Vec<Vec<u8>> = (0..VIEWS).map(|seed| pictures::picture(width, height, seed)).collect();
        let mut times = [const { Vec::new() }; 3];
        let (mut same, mut seen) = ([0; 2], [false; 256]);
        for (round, rgb) in views.iter().cycle().take(rounds).enumerate() {
            let image = RgbView::new(width, height, rgb)?;
            let mut masks: [Option<Mask>; 2] = [None, None];
            let mut expected = Vec::new();
            // Nobody is always the first.
            for who in (0..3).map(|step| (round + step) % 3) {
                let ms = match who {
                    2 => theirs.tags(rgb, tags, &mut expected)?,
                    _ => {
                        let (mask, ms) = timed(|| Ok(ours[who].run(image)?))?;
                        masks[who] = Some(mask);
                        ms
                    }
                };
                times[who].push(ms);
            }
            for (same, mask) in same.iter_mut().zip(masks.iter().flatten()) {
                *same += mask.ids.iter().zip(&expected).filter(|(a, b)| a == b).count();
            }
            expected.iter().for_each(|tag| seen[usize::from(*tag)] = true);
        }
        Ok(Self {
            name: checkpoint.name().to_owned(),
            ms: times.map(median),
            same: same.map(|same| same as f64 / (rounds * width * height) as f64),
            classes: seen.into_iter().filter(|seen| *seen).count(),
        })
    }

    /// How many times as long as onnxruntime alone.
    fn ratio(&self, number: usize) -> f64 {
        self.ms[number] / self.ms[2]
    }

    fn told(&self) -> String {
        let Self { name, ms: [ours, below, theirs], same, classes } = self;
        format!(
            "{name:18} onnxruntime {theirs:7.2} ms; ours {ours:7.2} ms: {:.2}, same {:.3} %; --inference ort {below:7.2} ms: \
             {:.2}, same {:.3} % of {classes} classes",
            self.ratio(0),
            100.0 * same[0],
            self.ratio(1),
            100.0 * same[1],
        )
    }
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// What some work gives, and the CPU time of this thread that it takes, milliseconds.
fn timed<T>(work: impl FnOnce() -> anyhow::Result<T>) -> anyhow::Result<(T, f64)> {
    let start = clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID)?;
    let done = work()?;
    let taken = clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID)? - start;
    Ok((done, taken.tv_sec() as f64 * 1e3 + taken.tv_nsec() as f64 * 1e-6))
}
