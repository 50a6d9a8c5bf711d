//! Pictures into the bytes of a file.

use std::fs::{self, File};
use std::io::{BufWriter, ErrorKind, Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use anyhow::{Context, bail};
use png::text_metadata::TEXtChunk;
use tempfile::TempDir;

use crate::export::format::Format;

/// Name of the file in its folder.
const VIDEO: &str = "video";
/// What stands before the digest in the comment of a file.
const COMMENT: &str = "aeye export ";
/// The comment is within so many bytes of the end of a file.
const END_BYTES: usize = 256;
/// A GIF has a palette of its own; an MP4 has even sides, with black on the right and below where that takes it.
const OF_GIF: &[&str] =
    &["-vf", "split[a][b];[a]palettegen=stats_mode=diff[p];[b][p]paletteuse=dither=none", "-f", "gif"];
const OF_MP4: &[&str] = &[
    "-vf",
    "pad=ceil(iw/2)*2:ceil(ih/2)*2",
    "-c:v",
    "libx264",
    "-preset",
    "medium",
    "-crf",
    "18",
    "-pix_fmt",
    "yuv420p",
    "-movflags",
    "+faststart",
    "-f",
    "mp4",
];

/// A file that is being made, in a folder of its own.
pub struct Encoder {
    format: Format,
    folder: TempDir,
    maker: Maker,
}

enum Maker {
    Png(Box<png::Writer<BufWriter<File>>>),
    Ffmpeg(Child),
}

impl Encoder {
    /// Begins a file of so many pictures.
    pub fn new(format: Format, size: (u32, u32), fps: u32, frames: u32) -> anyhow::Result<Self> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join(VIDEO);
        let maker = match format {
            Format::Apng => Maker::Png(Box::new(png_writer(&path, size, fps, frames)?)),
            _ => Maker::Ffmpeg(ffmpeg(&path, format, size, fps)?),
        };
        Ok(Self { format, folder, maker })
    }

    /// Appends a picture, 3 bytes a pixel.
    pub fn push(&mut self, rgb: &[u8]) -> anyhow::Result<()> {
        let child = match &mut self.maker {
            Maker::Png(writer) => return Ok(writer.write_image_data(rgb)?),
            Maker::Ffmpeg(child) => child,
        };
        let Err(error) = child.stdin.as_mut().context("its stdin is open")?.write_all(rgb) else { return Ok(()) };
        drop(child.stdin.take());
        child.wait()?;
        bail!("ffmpeg: {}", said(child).unwrap_or_else(|| error.to_string()))
    }

    /// The bytes of the file, with the digest of what it was made from.
    pub fn finish(self, source: &str) -> anyhow::Result<Vec<u8>> {
        let comment = format!("{COMMENT}{source}");
        match self.maker {
            Maker::Png(mut writer) => {
                writer.write_text_chunk(&TEXtChunk::new("Comment", comment.clone()))?;
                writer.finish()?;
            }
            Maker::Ffmpeg(mut child) => {
                drop(child.stdin.take());
                let status = child.wait()?;
                if !status.success() {
                    bail!("ffmpeg: {}", said(&mut child).unwrap_or_else(|| status.to_string()));
                }
            }
        }
        let mut bytes = fs::read(self.folder.path().join(VIDEO)).context("the moving picture")?;
        match self.format {
            Format::Gif => add_to_gif(&mut bytes, comment.as_bytes())?,
            Format::Mp4 => add_to_mp4(&mut bytes, comment.as_bytes()),
            _ => {}
        }
        Ok(bytes)
    }
}

fn png_writer(
    path: &Path,
    (width, height): (u32, u32),
    fps: u32,
    frames: u32,
) -> anyhow::Result<png::Writer<BufWriter<File>>> {
    let mut encoder = png::Encoder::new(BufWriter::new(File::create_new(path)?), width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_animated(frames, 0)?;
    encoder.set_frame_delay(1, fps as u16)?;
    Ok(encoder.write_header()?)
}

fn ffmpeg(path: &Path, format: Format, (width, height): (u32, u32), fps: u32) -> anyhow::Result<Child> {
    let (size, fps) = (format!("{width}x{height}"), fps.to_string());
    let child = Command::new("ffmpeg")
        .args(["-hide_banner", "-loglevel", "error"])
        .args(["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", &size, "-r", &fps, "-i", "-"])
        .args(if format == Format::Gif { OF_GIF } else { OF_MP4 })
        .args(["-fflags", "+bitexact", "-flags:v", "+bitexact"])
        .arg(path)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn();
    match child {
        Ok(child) => Ok(child),
        Err(error) if error.kind() == ErrorKind::NotFound => {
            bail!("ffmpeg was not found; expected it on the PATH, or --format apng, which needs nothing")
        }
        Err(error) => Err(error).context("ffmpeg"),
    }
}

/// The first line that a process said on stderr.
fn said(child: &mut Child) -> Option<String> {
    let mut text = String::new();
    child.stderr.as_mut()?.take(4096).read_to_string(&mut text).ok()?;
    text.lines().next().map(str::to_owned)
}

/// A comment extension before the trailer (GIF89a, section 24).
fn add_to_gif(bytes: &mut Vec<u8>, comment: &[u8]) -> anyhow::Result<()> {
    if bytes.pop() != Some(0x3b) {
        bail!("ffmpeg: its GIF has no end");
    }
    bytes.extend([0x21, 0xfe, comment.len() as u8]);
    bytes.extend_from_slice(comment);
    bytes.extend([0, 0x3b]);
    Ok(())
}

/// A box of free space, which all readers skip, at the end (ISO/IEC 14496-12, section 8.1.2).
fn add_to_mp4(bytes: &mut Vec<u8>, comment: &[u8]) {
    bytes.extend((8 + comment.len() as u32).to_be_bytes());
    bytes.extend(b"free");
    bytes.extend_from_slice(comment);
}

/// Whether a file is an export that was made from what has this digest.
pub fn tells(bytes: &[u8], source: &str) -> bool {
    has(bytes, format!("{COMMENT}{source}").as_bytes())
}

/// Whether a file is an export of any kind here.
pub fn is_export(bytes: &[u8]) -> bool {
    has(bytes, COMMENT.as_bytes())
}

fn has(bytes: &[u8], comment: &[u8]) -> bool {
    bytes[bytes.len().saturating_sub(END_BYTES)..].windows(comment.len()).any(|window| window == comment)
}
