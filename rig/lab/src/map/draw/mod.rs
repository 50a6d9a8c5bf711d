//! A map as a picture in SVG that needs nothing else. The same file gives the same bytes.

mod frame;
mod ground;
mod paint;
mod path;
mod sheet;
mod signs;

use std::fmt;
use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::bail;
use base::json::Typed;
use base::output;
use kernel::map::Baked;
use serde::Serialize;

use self::frame::Key;
use self::sheet::Sheet;
use super::look;

/// What is drawn, and where it goes.
#[derive(Clone, Debug)]
pub struct Options {
    /// A bundled map by name, or an OpenDRIVE file.
    pub file: String,
    /// Longest side of the map in the picture, pixels.
    pub size_px: u32,
    /// Where the picture goes.
    pub out: PathBuf,
}

/// A picture of a map.
#[derive(Clone, Debug, Serialize)]
pub struct Drawing {
    /// The map's file, or the name of a bundled map.
    pub file: String,
    /// Where the picture is.
    pub out: String,
    /// Its size.
    pub bytes: usize,
    /// Its width and height with title and legend, pixels.
    pub size_px: [u32; 2],
    /// How many pixels are a metre.
    pub px_per_m: f64,
}

/// What `aeye map draw` prints.
impl Typed for Drawing {
    const TYPE: &'static str = "aeye.map.drawing";
}

impl fmt::Display for Drawing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size_px;
        let Self { file, out, bytes, px_per_m, .. } = self;
        write!(f, "{file} is drawn to {out}: {width}x{height} pixels, {px_per_m:.2} a metre, {bytes} bytes")
    }
}

/// Draws a map to a file that there is not yet.
pub fn draw(options: &Options) -> anyhow::Result<Drawing> {
    let Options { file, size_px, out } = options;
    if out.exists() {
        bail!("{}: exists already; expected a new file", out.display());
    }
    output::check_file(out)?;
    let baked = look::baked(file)?;
    let sheet = Sheet::of(&baked.map, *size_px);
    let picture = svg(&baked, &sheet);
    output::write_file(out, picture.text.as_bytes())?;
    Ok(Drawing {
        file: file.clone(),
        out: out.display().to_string(),
        bytes: picture.text.len(),
        size_px: picture.size_px,
        px_per_m: (1000.0 * sheet.px_per_m).round() / 1000.0,
    })
}

/// A picture and its size.
struct Picture {
    text: String,
    size_px: [u32; 2],
}

/// The layers from the ground up, in a frame that explains them.
fn svg(baked: &Baked, sheet: &Sheet) -> Picture {
    let mut body = String::new();
    let mut keys: Vec<Key> = Vec::new();
    ground::water(sheet, &baked.map, &mut body, &mut keys);
    ground::strips(sheet, baked, &mut body, &mut keys);
    ground::scenery(sheet, &baked.map, &mut body, &mut keys);
    ground::lanes(sheet, baked, &mut body, &mut keys);
    paint::marks(sheet, baked, &mut body, &mut keys);
    ground::junctions(sheet, &baked.map, &mut body, &mut keys);
    paint::arrows(sheet, &baked.map, &mut body, &mut keys);
    ground::parked(sheet, &baked.map, &mut body, &mut keys);
    signs::all(sheet, &baked.map, &mut body, &mut keys);
    let (head, foot, size_px) = frame::around(sheet, baked, &keys);
    let mut text = head;
    // Writing to a string cannot fail.
    let _ = write!(text, "{body}{foot}");
    Picture { text, size_px }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_well_formed_and_the_same_each_time() {
        for name in kernel::map::BUNDLED {
            let baked = look::baked(name).expect("bundled");
            let sheet = Sheet::of(&baked.map, 800);
            let picture = svg(&baked, &sheet);
            assert!(picture.text == svg(&look::baked(name).expect("bundled"), &sheet).text, "{name}");
            assert!(
                picture.text.is_ascii() && !picture.text.contains("NaN") && !picture.text.contains("inf"),
                "{name}"
            );
            let layers = ["driving", "mark", "arrow", "sidewalk", "crosswalk", "building", "junction", "parked"];
            assert_eq!(picture.text.contains("class=\"water"), ["ring", "lakeside"].contains(&name), "{name}");
            for layer in if name == "city" { &layers[..] } else { &layers[..3] } {
                assert!(picture.text.contains(&format!("class=\"{layer}")), "{name} has no {layer}");
            }
            assert_eq!(picture.text.matches("<g").count(), picture.text.matches("</g>").count(), "{name}");
            assert_eq!(picture.text.matches("<svg").count(), picture.text.matches("</svg>").count(), "{name}");
            let quotes = picture.text.matches('"').count();
            assert!(quotes.is_multiple_of(2) && picture.size_px[0] >= 620, "{name}");
        }
    }

    #[test]
    fn files_that_are_there_stay() {
        let dir = tempfile::tempdir().expect("a folder");
        let options = Options { file: "rural".into(), size_px: 400, out: dir.path().join("m.svg") };
        let drawn = draw(&options).expect("drawn");
        assert_eq!(std::fs::metadata(&options.out).expect("there").len(), drawn.bytes as u64);
        let said = draw(&options).expect_err("is there").to_string();
        assert!(said.ends_with("m.svg: exists already; expected a new file"), "{said}");
        assert_eq!(std::fs::read_dir(dir.path()).expect("readable").count(), 1, "nothing temporary remains");
    }
}
