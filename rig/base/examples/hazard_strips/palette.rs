//! Small picture files: a palette of few colours by median cut (Heckbert 1982).

use anyhow::Context;

/// Other colours of a file: as many of these as it has room for.
const COLOURS: [usize; 4] = [26, 20, 14, 10];
/// What small things are told by, which a median cut would lose: lamps, mark and text.
const KEPT: [Colour; 6] =
    [[255, 44, 36], [255, 158, 32], [70, 220, 110], [255, 255, 255], [24, 24, 24], super::caption::MARK];
/// Room for a file, bytes.
const MOST_BYTES: usize = 58_000;
/// Every so many pixels one is asked for its colour.
const SAMPLE: usize = 7;

type Colour = [u8; 3];

/// A PNG file of a picture, 3 bytes a pixel.
pub fn png(size: (u32, u32), rgb: &[u8]) -> anyhow::Result<Vec<u8>> {
    let pixels: Vec<Colour> = rgb.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    let files = COLOURS.map(|colours| {
        let palette = [&KEPT[..], &median_cut(pixels.iter().step_by(SAMPLE).copied().collect(), colours)].concat();
        let ids: Vec<u8> = pixels.iter().map(|pixel| nearest(&palette, *pixel)).collect();
        encoded(size, &palette, &ids)
    });
    let mut files = files.into_iter().collect::<anyhow::Result<Vec<_>>>()?.into_iter();
    files.find(|file| file.len() <= MOST_BYTES).context("too large a picture")
}

fn encoded(size: (u32, u32), palette: &[Colour], ids: &[u8]) -> anyhow::Result<Vec<u8>> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, size.0, size.1);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_palette(palette.concat());
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header().context("PNG header")?;
    writer.write_image_data(ids).context("PNG data")?;
    writer.finish().context("PNG end")?;
    Ok(out)
}

/// Cuts the box of colours that spreads most in two, again and again.
fn median_cut(colours: Vec<Colour>, count: usize) -> Vec<Colour> {
    let mut boxes = vec![colours];
    while boxes.len() < count {
        let spread = |colours: &[Colour], c: usize| {
            let values = || colours.iter().map(|colour| colour[c]);
            f64::from(values().max().unwrap_or(0) - values().min().unwrap_or(0)) * (colours.len() as f64).sqrt()
        };
        let sides = boxes.iter().enumerate().flat_map(|(i, b)| (0..3).map(move |c| (spread(b, c), i, c)));
        let Some((_, widest, c)) = sides.max_by(|a, b| a.0.total_cmp(&b.0)) else { break };
        let mut low = boxes.swap_remove(widest);
        low.sort_by_key(|colour| colour[c]);
        let high = low.split_off(low.len() / 2);
        boxes.extend([low, high]);
    }
    boxes.iter().filter(|colours| !colours.is_empty()).map(|colours| mean(colours)).collect()
}

fn mean(colours: &[Colour]) -> Colour {
    [0, 1, 2].map(|c| (colours.iter().map(|colour| usize::from(colour[c])).sum::<usize>() / colours.len()) as u8)
}

fn nearest(palette: &[Colour], pixel: Colour) -> u8 {
    let distance = |colour: &Colour| (0..3).map(|c| i32::from(colour[c].abs_diff(pixel[c])).pow(2)).sum::<i32>();
    (0..palette.len()).min_by_key(|i| distance(&palette[*i])).unwrap_or_default() as u8
}
