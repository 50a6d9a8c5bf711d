//! A virtual display with a keyboard, and what is to be seen on it.

use std::collections::HashSet;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Folder for pictures of the display; unset, none are kept.
const KEEP: &str = "AEYE_SCREENSHOTS";

/// One server looks for a number at a time: two could take the socket that a third one left behind.
static STARTS: Mutex<()> = Mutex::new(());

/// A display of its own; closed when dropped.
pub struct Display {
    server: Child,
    name: String,
    /// Where the server keeps its pixels, as an X window dump.
    pixels: PathBuf,
}

impl Display {
    /// Opens one with a number that is free, and keeps its pixels in a folder.
    pub fn open(folder: &Path) -> Self {
        let starts = STARTS.lock().unwrap_or_else(PoisonError::into_inner);
        let mut server = Command::new("Xvfb")
            // A server that begins anew when its last client leaves refuses whoever comes just then.
            .args(["-noreset", "-displayfd", "1", "-screen", "0", "1300x960x24", "-nolisten", "tcp", "-fbdir"])
            .arg(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb starts");
        let mut number = String::new();
        let stdout = server.stdout.take().expect("piped");
        BufReader::new(stdout).read_line(&mut number).expect("the number of the display");
        drop(starts);
        Self { server, name: format!(":{}", number.trim()), pixels: folder.join("Xvfb_screen0") }
    }

    /// Where its pixels are, and whatever else lasts as long.
    pub fn folder(&self) -> &Path {
        self.pixels.parent().expect("a file in a folder")
    }

    /// As DISPLAY has it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The number of the window with a title, once it is there.
    pub fn window(&self, title: &str) -> String {
        let output = self.xdotool(&["search", "--sync", "--onlyvisible", "--name", title]);
        output.lines().next().expect("a window").to_owned()
    }

    /// Gives a window the keyboard.
    pub fn focus(&self, window: &str) {
        self.xdotool(&["windowfocus", "--sync", window]);
    }

    /// Presses keys, with xdotool's words.
    pub fn keys(&self, words: &[&str]) {
        self.xdotool(words);
        // X delivers in order but not at once; holding keys for less than a tick would not be seen.
        std::thread::sleep(Duration::from_millis(200));
    }

    fn xdotool(&self, words: &[&str]) -> String {
        let output = Command::new("xdotool").args(words).env("DISPLAY", &self.name).output().expect("xdotool runs");
        assert!(output.status.success(), "{words:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    /// What is on the display now.
    pub fn picture(&self) -> Picture {
        let dump = fs::read(&self.pixels).expect("the display's pixels");
        let word = |i: usize| u32::from_be_bytes(dump[4 * i..4 * i + 4].try_into().expect("4 bytes")) as usize;
        // XWDFile.h: header size, ..., width, height, ..., bytes a line, ..., colour map entries of 12 bytes.
        let (start, width, height, line) = (word(0) + 12 * word(19), word(4), word(5), word(12));
        let row = |y: usize| dump[start + y * line..][..4 * width].as_chunks::<4>().0;
        let rgb = (0..height).flat_map(|y| row(y).iter().map(|[b, g, r, _]| [*r, *g, *b])).collect();
        Picture { width, height, rgb }
    }

    /// Keeps a picture of the windows on the display, if a folder is named for that.
    pub fn keep(&self, name: &str) {
        let Some(folder) = std::env::var_os(KEEP) else { return };
        let picture = self.picture().without_ground();
        let file = fs::File::create(Path::new(&folder).join(format!("{name}.png"))).expect("writable");
        let mut encoder = png::Encoder::new(file, picture.width as u32, picture.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("written");
        writer.write_image_data(picture.rgb.as_flattened()).expect("written");
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// Pixels of the display, rows from top to bottom.
pub struct Picture {
    width: usize,
    height: usize,
    rgb: Vec<[u8; 3]>,
}

impl Picture {
    /// Without the black rows and columns below and to the right of everything.
    fn without_ground(&self) -> Self {
        let places = self.rgb.iter().enumerate().filter(|(_, pixel)| **pixel != [0; 3]);
        let ends = places.map(|(i, _)| (i % self.width + 1, i / self.width + 1));
        let (width, height) = ends.fold((1, 1), |(x, y), (right, bottom)| (x.max(right), y.max(bottom)));
        Self { width, height, rgb: self.part([0, 0], [width, height]).collect() }
    }

    fn part(&self, [x, y]: [usize; 2], [width, height]: [usize; 2]) -> impl Iterator<Item = [u8; 3]> + '_ {
        (y..y + height).flat_map(move |y| self.rgb[y * self.width + x..][..width].iter().copied())
    }

    /// Share of a part's pixels that have a colour.
    pub fn share(&self, colour: [u8; 3], at: [usize; 2], size: [usize; 2]) -> f64 {
        let near = |pixel: [u8; 3]| pixel.iter().zip(colour).all(|(a, b)| a.abs_diff(b) <= 2);
        self.part(at, size).filter(|pixel| near(*pixel)).count() as f64 / (size[0] * size[1]) as f64
    }

    /// Number of different colours in a part.
    pub fn colours(&self, at: [usize; 2], size: [usize; 2]) -> usize {
        self.part(at, size).collect::<HashSet<_>>().len()
    }
}
