//! Pictures as PNG files: colour, class ids with the tags' palette, plain ids.

use std::io::Cursor;
use std::path::Path;

use anyhow::{Context, bail};
use render::tags;

use crate::files::{self, most};

fn encode(
    (width, height): (u32, u32),
    color: png::ColorType,
    depth: png::BitDepth,
    palette: Option<Vec<u8>>,
    bytes: &[u8],
) -> anyhow::Result<Vec<u8>> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    // A tenth of the time of `Balanced` or less, for files that are 15 to 30 % larger.
    encoder.set_compression(png::Compression::Fast);
    if let Some(palette) = palette {
        encoder.set_palette(palette);
    }
    let mut writer = encoder.write_header().context("PNG header")?;
    writer.write_image_data(bytes).context("PNG data")?;
    writer.finish().context("PNG end")?;
    Ok(out)
}

/// Colour, 3 bytes a pixel.
pub fn rgb(size: (u32, u32), bytes: &[u8]) -> anyhow::Result<Vec<u8>> {
    encode(size, png::ColorType::Rgb, png::BitDepth::Eight, None, bytes)
}

/// Tag ids: the values are exact for tools, the palette shows the tags' colours.
pub fn tags(size: (u32, u32), ids: &[u8]) -> anyhow::Result<Vec<u8>> {
    let palette = (0..tags::TAG_COUNT as u8).flat_map(tags::colour).collect();
    encode(size, png::ColorType::Indexed, png::BitDepth::Eight, Some(palette), ids)
}

/// One byte a pixel, as Cityscapes stores label ids.
pub fn grey(size: (u32, u32), ids: &[u8]) -> anyhow::Result<Vec<u8>> {
    encode(size, png::ColorType::Grayscale, png::BitDepth::Eight, None, ids)
}

/// Two bytes a pixel, as Cityscapes stores instance ids.
pub fn grey16(size: (u32, u32), ids: &[u16]) -> anyhow::Result<Vec<u8>> {
    let bytes: Vec<u8> = ids.iter().flat_map(|id| id.to_be_bytes()).collect();
    encode(size, png::ColorType::Grayscale, png::BitDepth::Sixteen, None, &bytes)
}

/// The samples of a file with `samples` bytes a pixel, palette indices as they are.
pub fn read(path: &Path, samples: usize) -> anyhow::Result<((u32, u32), Vec<u8>)> {
    let place = || path.display().to_string();
    let file = files::read(path, most::PICTURE)?;
    let mut decoder = png::Decoder::new(Cursor::new(file));
    decoder.set_transformations(png::Transformations::IDENTITY);
    let mut reader = decoder.read_info().with_context(place)?;
    let (width, height, bits) = (reader.info().width, reader.info().height, reader.info().bits_per_pixel());
    if bits != 8 * samples {
        bail!("{}: {bits} bits a pixel; expected {}", place(), 8 * samples);
    }
    if u64::from(width) * u64::from(height) > most::PIXELS {
        bail!("{}: {width}x{height}; expected at most {} pixels", place(), most::PIXELS);
    }
    let mut bytes = vec![0; width as usize * height as usize * samples];
    reader.next_frame(&mut bytes).with_context(place)?;
    Ok(((width, height), bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_exact_and_coloured() {
        let file = tags((2, 2), &[7, 4, 13, 22]).expect("encodes");
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.png");
        std::fs::write(&path, &file).expect("written");
        assert_eq!(read(&path, 1).expect("reads"), ((2, 2), vec![7, 4, 13, 22]));
        assert!(read(&path, 3).is_err());
        assert_eq!(file, tags((2, 2), &[7, 4, 13, 22]).expect("encodes"), "the same bytes each time");
        assert!(tags((2, 2), &[7]).is_err());
    }

    #[test]
    fn sixteen_bits_are_kept() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.png");
        std::fs::write(&path, grey16((2, 1), &[4001, 10]).expect("encodes")).expect("written");
        assert_eq!(read(&path, 2).expect("reads"), ((2, 1), vec![0x0f, 0xa1, 0, 10]));
    }
}
