//! Writes what the viewer is asked to keep: cases and screenshots, beside the file that is looked at.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::Receiver;

use anyhow::bail;
use base::failure::sentence;
use base::image::Image;
use base::output;
use base::png;
use base::say;
use drivers::film::Film;
use kernel::time::Tick;
use replay::Case;

use super::projector::Shown;

/// Something to be kept.
pub enum Errand {
    /// A range, as a case.
    Case(RangeInclusive<Tick>),
    /// Both views, side by side.
    Screenshot(Arc<Shown>),
}

/// Does errands until there are no more; says of each how the file beside the film is called, or why
/// there is none. Where the file is goes to stderr.
pub fn work(film: &Film, errands: &Receiver<Errand>, say: impl Fn(String)) {
    for errand in errands {
        let (what, kept) = match &errand {
            Errand::Case(ticks) => ("corner case", keep_case(film, ticks)),
            Errand::Screenshot(shown) => ("screenshot", keep_screenshot(film, shown)),
        };
        match kept {
            Ok(path) => {
                say::say(format_args!("{what} {}", path.display()));
                say(format!("{what} {}", path.file_name().unwrap_or_default().to_string_lossy()));
            }
            Err(error) => {
                let said = format!("error: {}", sentence(&error));
                say::say(&said);
                say(said);
            }
        }
    }
}

fn keep_case(film: &Film, ticks: &RangeInclusive<Tick>) -> anyhow::Result<PathBuf> {
    let case = Case::cut(&film.recording, &film.network, ticks.clone())?;
    let name = format!("{}-{}-{}", stem(&film.path), ticks.start(), ticks.end());
    output::write_new(&film.path.with_file_name(name), "case.mcap", &case.encode()?)
}

fn keep_screenshot(film: &Film, shown: &Shown) -> anyhow::Result<PathBuf> {
    let views: Vec<&Arc<Image>> = shown.views.iter().flatten().collect();
    if views.is_empty() {
        bail!("there is no picture to be kept");
    }
    let image = beside(&views);
    let bytes = png::rgb((image.width as u32, image.height as u32), &image.rgb)?;
    let name = format!("{}-{}", stem(&film.path), shown.request.tick);
    output::write_new(&film.path.with_file_name(name), "png", &bytes)
}

/// The file's name without `.case.mcap` or `.mcap`.
fn stem(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.strip_suffix(".mcap").unwrap_or(&name);
    name.strip_suffix(".case").unwrap_or(name).to_owned()
}

/// Images side by side, as high as the highest; each pixel of a lower one is repeated.
fn beside(images: &[&Arc<Image>]) -> Image {
    let height = images.iter().map(|image| image.height).max().unwrap_or_default();
    let times = |image: &Image| (height / image.height).max(1);
    let width = images.iter().map(|image| image.width * times(image)).sum();
    let mut rgb = Vec::with_capacity(3 * width * height);
    for y in 0..height {
        for image in images {
            let times = times(image);
            let row = image.rgb.chunks_exact(3 * image.width).nth(y / times);
            let pixels = row.map(|row| row.as_chunks::<3>().0).unwrap_or_default();
            let black = [[0; 3]].into_iter().cycle();
            let line = pixels.iter().flat_map(|pixel| std::iter::repeat_n(*pixel, times)).chain(black);
            rgb.extend(line.take(image.width * times).flatten());
        }
    }
    Image { width, height, rgb }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lose_their_endings() {
        for (path, name) in [("a/drive.mcap", "drive"), ("drive-2.case.mcap", "drive-2"), ("odd", "odd")] {
            assert_eq!(stem(Path::new(path)), name);
        }
    }

    #[test]
    fn views_of_different_sizes_stand_side_by_side() {
        let image = |width, height, value| Arc::new(Image { width, height, rgb: vec![value; 3 * width * height] });
        let (small, large) = (image(1, 2, 9), image(2, 5, 7));
        let both = beside(&[&small, &large]);
        assert_eq!((both.width, both.height), (2 + 2, 5));
        let row = |y: usize| both.rgb[12 * y..][..12].iter().step_by(3).copied().collect::<Vec<u8>>();
        assert_eq!((row(0), row(3), row(4)), (vec![9, 9, 7, 7], vec![9, 9, 7, 7], vec![0, 0, 7, 7]));
    }
}
