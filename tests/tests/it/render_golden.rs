//! A street looks as the golden pictures say, on every adapter: which class is where, and the colours as seen from
//! afar. `AEYE_BLESS=1 cargo test --release -p tests --test it render_golden` writes them, and the renderer has
//! another identity from then on ([`render::identity`]).

use std::fmt::Write;

use kernel::weather::WeatherPreset;
use render::{AdapterChoice, Camera, Frame, Quality, Renderer};
use tests::street;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../render/golden_pictures.txt");
/// Moments of the street, whose weather is dry and whose sun is at various heights; all qualities draw them.
const MOMENTS: [u32; 4] = [0, 4, 9, 14];
/// Weathers of others, which the quality with smooth edges draws.
const WEATHERS: [(u32, &str); 8] = [
    (2, "CloudyNoon"),
    (3, "HardRainNoon"),
    (5, "FoggyNoon"),
    (6, "WetSunset"),
    (7, "ClearDusk"),
    (8, "DryNight"),
    (10, "CloudyNight"),
    (11, "HardRainNight"),
];
const WIDTH: usize = 96;
const HEIGHT: usize = 48;
/// Colours are means over squares of so many pixels.
const SQUARE: usize = 12;
/// How many labels in a thousand may differ: adapters round edges differently.
const PER_MILLE: usize = 3;
/// How far a mean colour may be off, of 255.
const MARGIN: u8 = 6;

/// A frame as text: a line for each row with a digit, to base 36, for each pixel's class; then a line for each row
/// of squares with their colours.
fn picture(frame: &Frame) -> String {
    let digit = |id: &u8| char::from_digit(u32::from(*id), 36).expect("there are 29 classes");
    let mut text: String =
        frame.class_ids.chunks(WIDTH).map(|row| row.iter().map(digit).collect::<String>() + "\n").collect();
    for y in 0..HEIGHT / SQUARE {
        let colours: Vec<String> = (0..WIDTH / SQUARE).map(|x| colour(&frame.rgb, x, y)).collect();
        writeln!(text, "{}", colours.join(" ")).expect("writing to a string");
    }
    text
}

/// The mean colour of a square.
fn colour(rgb: &[u8], x: usize, y: usize) -> String {
    let pixels = (0..SQUARE * SQUARE).map(|i| (y * SQUARE + i / SQUARE) * WIDTH + x * SQUARE + i % SQUARE);
    let mean = |channel| pixels.clone().map(|at| usize::from(rgb[3 * at + channel])).sum::<usize>() / (SQUARE * SQUARE);
    format!("{:02x}{:02x}{:02x}", mean(0), mean(1), mean(2))
}

/// What is wrong with a picture, if anything.
fn difference(golden: &str, drawn: &str) -> Option<String> {
    let rows = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    let (golden, drawn) = (rows(golden), rows(drawn));
    if golden.len() != drawn.len() {
        return Some(format!("{} lines instead of {}", drawn.len(), golden.len()));
    }
    let labels = |rows: &[String]| rows[..HEIGHT].concat();
    let (before, after) = (labels(&golden), labels(&drawn));
    let others: Vec<usize> =
        before.bytes().zip(after.bytes()).enumerate().filter(|(_, (a, b))| a != b).map(|(at, _)| at).collect();
    if before.len() != after.len() || 1000 * others.len() > PER_MILLE * WIDTH * HEIGHT {
        let first = others.first().map_or_else(String::new, |at| {
            let class = |labels: &str| labels.as_bytes()[*at] as char;
            format!(
                ", first at column {}, row {}: {} instead of {}",
                at % WIDTH,
                at / WIDTH,
                class(&after),
                class(&before)
            )
        });
        return Some(format!("{} labels differ{first}", others.len()));
    }
    let bytes = |rows: &[String]| -> Vec<u8> {
        let colours = rows[HEIGHT..].join(" ").replace(' ', "");
        (0..colours.len() / 2)
            .map(|i| u8::from_str_radix(&colours[2 * i..2 * i + 2], 16).expect("hexadecimal"))
            .collect()
    };
    let far = bytes(&golden).into_iter().zip(bytes(&drawn)).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0);
    (far > MARGIN).then(|| format!("a colour is off by {far} of 255"))
}

/// A picture of the street that is golden.
struct Golden {
    quality: Quality,
    moment: u32,
    weather: Option<&'static str>,
}

impl Golden {
    fn all() -> Vec<Self> {
        let dry = |quality| MOMENTS.map(|moment| Self { quality, moment, weather: None });
        let wild = WEATHERS.map(|(moment, name)| Self { quality: Quality::Standard, moment, weather: Some(name) });
        Quality::ALL.into_iter().flat_map(dry).chain(wild).collect()
    }

    fn draw(&self, renderer: &mut Renderer) -> Frame {
        let mut scene = street::scene(self.moment);
        if let Some(name) = self.weather {
            scene.weather = WeatherPreset::find(name).expect("a preset").weather(scene.weather.sun_azimuth_deg);
        }
        let camera = Camera::driver(WIDTH as u32, HEIGHT as u32).at(self.quality);
        renderer.draw(&scene, &camera).expect("a frame")
    }

    fn name(&self) -> String {
        format!("{} at moment {} in {}", self.quality.name(), self.moment, self.weather.unwrap_or("its weather"))
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_street_looks_as_the_golden_pictures_say() {
    let mut renderer = Renderer::new(&street::network(), &AdapterChoice::default()).expect("an adapter");
    let which = Golden::all();
    let drawn: Vec<String> = which.iter().map(|golden| picture(&golden.draw(&mut renderer))).collect();
    let differing = |golden: &str| -> Vec<String> {
        let golden: Vec<_> = golden.split("\n\n").collect();
        let differences = drawn.iter().zip(&which).enumerate().map(|(i, (drawn, which))| {
            let golden = golden.get(i).copied().unwrap_or_default();
            difference(golden.trim_end(), drawn.trim_end()).map(|what| format!("{}: {what}", which.name()))
        });
        differences.flatten().collect()
    };
    let golden = std::fs::read_to_string(FILE).expect("render/golden_pictures.txt is there");
    if std::env::var("AEYE_BLESS").is_ok_and(|bless| bless == "1") {
        // What is as good as before stays, and so does the renderer's identity.
        if !differing(&golden).is_empty() {
            std::fs::write(FILE, drawn.join("\n")).expect("writable");
        }
        return;
    }
    let differing = differing(&golden);
    assert!(differing.is_empty(), "this renderer draws otherwise than the golden pictures: {}", differing.join("; "));
}

#[test]
fn labels_and_colours_that_differ_are_told() {
    let frame = Frame { class_ids: vec![7; WIDTH * HEIGHT], rgb: vec![128; 3 * WIDTH * HEIGHT], ..Frame::default() };
    let golden = picture(&frame);
    assert_eq!(difference(&golden, &golden), None);
    let mut person = frame.clone();
    (0..20).for_each(|i| person.class_ids[3 * WIDTH + 40 + i] = 12);
    let said = difference(&golden, &picture(&person)).expect("twenty pixels");
    assert_eq!(said, "20 labels differ, first at column 40, row 3: c instead of 7");
    let mut bright = frame;
    bright.rgb.iter_mut().take(3 * WIDTH * SQUARE).for_each(|value| *value = 136);
    assert_eq!(difference(&golden, &picture(&bright)), Some("a colour is off by 8 of 255".into()));
    assert!(difference("", &golden).is_some());
}
