//! What stands around the map: title, legend, scale and north.

use std::fmt::Write;

use base::words;
use kernel::map::{Baked, LaneKind};

use super::sheet::Sheet;
use crate::map::measure::{extent_m, km};
use crate::plot::escape;

/// Narrowest picture, pixels: what is said below the title must fit, and for the title so much for each letter.
const LEAST_WIDTH_PX: u32 = 620;
const LETTER_PX: u32 = 13;
/// Room left and right of the map, and above it, pixels.
const SIDE_PX: u32 = 16;
const TITLE_PX: u32 = 58;
/// Room below the map for the scale, and for a row of the legend, pixels.
const SCALE_PX: u32 = 40;
const ROW_PX: u32 = 22;
/// Width of an entry of the legend, pixels.
const ENTRY_PX: u32 = 190;
/// The scale is at most this share of the width.
const SCALE: f64 = 0.3;
const INK: &str = "#1d2329";
const SOFT: &str = "#5d6873";

/// An entry of the legend.
pub struct Key {
    pub swatch: Swatch,
    pub name: &'static str,
}

/// How something looks on the map.
pub enum Swatch {
    Area(&'static str),
    Tint(&'static str),
    Disc(&'static str),
    Line(&'static str),
    /// Paint on a road, with the pattern of its dashes.
    Bar(&'static str, &'static str),
    Thin,
    Stripes,
    Arrow,
    Symbol(&'static str),
}

/// What comes before the layers of the map and what comes after, and the size of the picture.
pub fn around(sheet: &Sheet, baked: &Baked, keys: &[Key]) -> (String, String, [u32; 2]) {
    let [map_width, map_height] = sheet.size_px();
    let letters = baked.map.name.chars().count() as u32;
    let width = (map_width.max(letters * LETTER_PX) + 2 * SIDE_PX).max(LEAST_WIDTH_PX);
    let columns = ((width - 2 * SIDE_PX) / ENTRY_PX).max(1);
    let rows = (keys.len() as u32).div_ceil(columns);
    let height = TITLE_PX + map_height + SCALE_PX + rows * ROW_PX + SIDE_PX;
    let left = (width - map_width) / 2;
    let [cm_width, cm_height] = sheet.size_cm();
    let mut head = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"system-ui, sans-serif\" font-size=\"12\">\n\
         <title>{}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n",
        name(baked)
    );
    // Writing to strings cannot fail.
    let _ = write!(
        head,
        "<text x=\"{SIDE_PX}\" y=\"26\" font-size=\"20\" font-weight=\"600\" fill=\"{INK}\">{}</text>\n\
         <text x=\"{SIDE_PX}\" y=\"46\" fill=\"{SOFT}\">{}</text>\n\
         <svg x=\"{left}\" y=\"{TITLE_PX}\" width=\"{map_width}\" height=\"{map_height}\" \
         viewBox=\"0 0 {cm_width} {cm_height}\" fill=\"none\" stroke-linejoin=\"round\">\n\
         <rect width=\"{cm_width}\" height=\"{cm_height}\" fill=\"#eef1e6\"/>\n",
        name(baked),
        about(baked)
    );
    let mut foot = String::from("</svg>\n");
    let below = TITLE_PX + map_height;
    north(&mut foot, left + map_width - 32, TITLE_PX + 8);
    scale(&mut foot, sheet, left, below, f64::from(map_width));
    for (k, key) in (0..).zip(keys) {
        let (column, row) = (k % columns, k / columns);
        entry(&mut foot, key, SIDE_PX + column * ENTRY_PX, below + SCALE_PX + row * ROW_PX);
    }
    foot.push_str("</svg>\n");
    (head, foot, [width, height])
}

/// The name of the map in ASCII, as everything in the picture.
fn name(baked: &Baked) -> String {
    let ascii = |c: char| if c.is_ascii() { c.to_string() } else { format!("&#{};", u32::from(c)) };
    escape(&baked.map.name).chars().map(ascii).collect()
}

/// What is worth a line under the title.
fn about(baked: &Baked) -> String {
    let [east_m, north_m] = extent_m(&baked.map);
    let driving = baked.map.lanes.iter().filter(|lane| lane.kind == LaneKind::Driving);
    let driving_km = km(driving.map(|lane| f64::from(lane.length_m)).sum());
    let version = match baked.told.version.as_str() {
        "" => "OpenDRIVE".to_owned(),
        version => format!("OpenDRIVE {version}"),
    };
    let digest = format!("{:032x}", baked.map.digest);
    format!(
        "{version}, {east_m:.0} m x {north_m:.0} m, {driving_km:.1} km of driving lanes, {}, digest {}",
        words::count(baked.map.junctions.len(), "junction"),
        &digest[..8]
    )
}

/// An arrow to the north.
fn north(out: &mut String, x: u32, y: u32) {
    let _ = writeln!(
        out,
        "<g class=\"north\" transform=\"translate({x} {y})\"><circle cx=\"7\" cy=\"20\" r=\"19\" fill=\"#fff\" fill-opacity=\".8\"/>\
         <path d=\"M7 4l6 18-6-4-6 4z\" fill=\"{INK}\"/>\
         <text x=\"7\" y=\"35\" text-anchor=\"middle\" font-size=\"11\" font-weight=\"600\" fill=\"{INK}\">N</text></g>"
    );
}

/// A bar of a round number of metres.
fn scale(out: &mut String, sheet: &Sheet, x: u32, y: u32, width_px: f64) {
    let most_m = SCALE * width_px / sheet.px_per_m;
    let power = 10f64.powi(most_m.log10().floor() as i32);
    let metres = [5.0, 2.0, 1.0].map(|n| n * power).into_iter().find(|m| *m <= most_m).unwrap_or(power);
    let length = metres * sheet.px_per_m;
    let said = if metres >= 1000.0 { format!("{} km", metres / 1000.0) } else { format!("{metres} m") };
    let _ = writeln!(
        out,
        "<g class=\"scale\" transform=\"translate({x} {})\"><path d=\"M0 -6v6h{length:.1}v-6\" fill=\"none\" stroke=\"{INK}\" \
         stroke-width=\"1.5\"/><text x=\"{:.1}\" y=\"0\" fill=\"{INK}\">{said}</text></g>",
        y + 20,
        length + 8.0
    );
}

/// A swatch of 26 by 14 pixels and its name.
fn entry(out: &mut String, key: &Key, x: u32, y: u32) {
    let road = "<rect width=\"26\" height=\"14\" fill=\"#878c93\"/>";
    let swatch = match key.swatch {
        Swatch::Area(fill) => format!("<rect width=\"26\" height=\"14\" fill=\"{fill}\"/>"),
        Swatch::Tint(ink) => format!(
            "<rect x=\".5\" y=\".5\" width=\"25\" height=\"13\" fill=\"{ink}\" fill-opacity=\".12\" stroke=\"{ink}\" \
             stroke-opacity=\".6\"/>"
        ),
        Swatch::Disc(fill) => format!("<circle cx=\"13\" cy=\"7\" r=\"7\" fill=\"{fill}\"/>"),
        Swatch::Line(ink) => format!("<path d=\"M0 7h26\" stroke=\"{ink}\" stroke-width=\"2\"/>"),
        Swatch::Bar(ink, dash) => {
            format!("{road}<path d=\"M0 7h26\" stroke=\"{ink}\" stroke-width=\"3\" stroke-dasharray=\"{dash}\"/>")
        }
        Swatch::Thin => {
            format!("{road}<path d=\"M0 12q13 0 26-10\" fill=\"none\" stroke=\"#fff\" stroke-opacity=\".7\"/>")
        }
        Swatch::Stripes => {
            format!("{road}<path d=\"M1 7h26\" stroke=\"#fff\" stroke-width=\"10\" stroke-dasharray=\"3\"/>")
        }
        Swatch::Arrow => format!("{road}<path d=\"M19 7l-11-4 3 4-3 4z\" fill=\"#fff\"/>"),
        Swatch::Symbol(shape) => format!("<g transform=\"translate(13 7) scale(.75)\">{shape}</g>"),
    };
    let _ = writeln!(
        out,
        "<g class=\"key\" transform=\"translate({x} {y})\">{swatch}<text x=\"33\" y=\"11\" fill=\"{INK}\">{}</text></g>",
        key.name
    );
}
