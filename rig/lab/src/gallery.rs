//! A gallery: one moment of a drive through each map, in each light.

use std::collections::BTreeSet;
use std::fmt::{self, Write};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use base::failure::Usage;
use base::json::{Typed, json_file};
use base::output::{self, OutputFolder};
use base::png;
use base::progress::{self, Interrupt};
use base::setting::{Changes, Setting};
use base::words::count;
use drivers::film::Viewpoint;
use kernel::time::Tick;
use kernel::weather::{Weather, WeatherPreset};
use kernel::{RoadNetwork, Scenario};
use render::{Imaging, ModelsId, Quality, Sensor};
use serde::Serialize;

use super::cameras;
use super::looks::Size;
use super::plot::escape;
use super::still;

/// Where the sun stands in all pictures, degrees counter-clockwise from east.
const SUN_AZIMUTH_DEG: f32 = 40.0;

/// Pictures that are asked for.
#[derive(Clone, Debug)]
pub struct Options {
    /// Bundled maps or OpenDRIVE files.
    pub maps: Vec<String>,
    /// Seed of the runs.
    pub seed: u64,
    /// Their moment.
    pub tick: Tick,
    /// From where they are taken.
    pub camera: Viewpoint,
    /// Width and height, pixels.
    pub size: Size,
    /// How they are made.
    pub imaging: Imaging,
    /// The folder they go to.
    pub out: PathBuf,
}

/// A gallery, which `gallery.json` in its folder holds too.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Gallery {
    /// Version of the kernel that drove.
    pub kernel: String,
    /// The renderer that drew.
    pub renderer: String,
    /// Seed of the runs.
    pub seed: u64,
    /// Moment of the pictures.
    pub tick: Tick,
    /// From where they are taken.
    pub camera: String,
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// How good they are.
    pub quality: Quality,
    /// What lens and chip do to them; left out where they are ideal.
    #[serde(skip_serializing_if = "Sensor::is_ideal")]
    pub sensor: Sensor,
    /// Digest of models of a user's own; left out where there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub models: Option<ModelsId>,
    /// A picture of each map in each light.
    pub pictures: Vec<Picture>,
}

/// A picture of a gallery.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Picture {
    /// Its file.
    pub file: String,
    /// Of which map.
    pub map: String,
    /// Its digest, hexadecimal.
    pub map_digest: String,
    /// In which light: `noon`, `dusk`, `rain`, `fog` or `night`.
    pub light: &'static str,
}

/// What `aeye gallery` prints.
impl Typed for Gallery {
    const TYPE: &'static str = "aeye.gallery";
}

impl fmt::Display for Gallery {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&count(self.pictures.len(), "picture"))
    }
}

/// The lights by name.
fn lights() -> anyhow::Result<[(&'static str, Weather); 5]> {
    let preset = |name| WeatherPreset::find(name).context(name).map(|preset| preset.weather(SUN_AZIMUTH_DEG));
    Ok([
        ("noon", preset("ClearNoon")?),
        ("dusk", preset("ClearDusk")?),
        ("rain", preset("MidRainyNoon")?),
        ("fog", preset("FoggyNoon")?),
        ("night", preset("DryNight")?),
    ])
}

/// Makes a gallery; a folder of the same that was interrupted is gone on with.
pub fn gallery(options: &Options, interrupt: &Interrupt) -> anyhow::Result<Gallery> {
    let camera = options.camera.camera(options.size).at(options.imaging);
    cameras::check(&camera)?;
    let settings = options.maps.iter().map(|map| Setting::of_map(map)).collect::<anyhow::Result<Vec<_>>>()?;
    let mut names = BTreeSet::new();
    if let Some(twice) = settings.iter().map(|setting| &setting.map.network.name).find(|name| !names.insert(*name)) {
        return Err(Usage(format!("two maps are named {twice}; expected maps with different names")).into());
    }
    let lights = lights()?;
    let gallery = of(options, &settings, lights.map(|(light, _)| light));
    let _folder = OutputFolder::open(&options.out)?;
    begin(&gallery, &options.out)?;
    let bar = progress::bar("pictures", gallery.pictures.len() as u64);
    let all = settings.iter().flat_map(|setting| lights.iter().map(move |(_, weather)| (setting, weather)));
    for ((setting, weather), picture) in all.zip(&gallery.pictures) {
        let path = options.out.join(&picture.file);
        if !path.exists() {
            let scenario = setting.scenario(Some(options.seed), &Changes::default());
            let scenario = Scenario { weather: *weather, ..scenario };
            let (scene, mut renderer) = still::of_run(&setting.map, &scenario, options.tick, interrupt)
                .with_context(|| format!("{} at {}", picture.map, picture.light))?;
            let frame = renderer.draw(&scene, &camera)?;
            output::write_file(&path, &png::rgb(options.size, &frame.rgb)?)?;
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    output::write_file(&options.out.join("index.html"), page(&gallery)?.as_bytes())?;
    Ok(gallery)
}

fn of(options: &Options, settings: &[Setting], lights: [&'static str; 5]) -> Gallery {
    let picture = |network: &RoadNetwork, light| {
        let (map, map_digest) = (network.name.clone(), format!("{:032x}", network.digest));
        Picture { file: format!("{map}-{light}.png"), map, map_digest, light }
    };
    let maps = settings.iter().map(|setting| &setting.map.network);
    let (width, height) = options.size;
    Gallery {
        kernel: kernel::identity(),
        renderer: render::identity(),
        seed: options.seed,
        tick: options.tick,
        camera: options.camera.name().to_owned(),
        size_px: [width, height],
        quality: options.imaging.quality,
        sensor: options.imaging.sensor,
        models: options.imaging.models,
        pictures: maps.flat_map(|map| lights.map(|light| picture(map, light))).collect(),
    }
}

/// Says in the folder what is to be in it, or finds that said.
fn begin(gallery: &Gallery, out: &Path) -> anyhow::Result<()> {
    let (path, text) = (out.join("gallery.json"), json_file(gallery)?);
    match fs::read_to_string(&path) {
        Ok(there) if there == text => Ok(()),
        Ok(_) => bail!("{}: is another gallery's; expected an empty folder or the same options", path.display()),
        Err(_) if fs::read_dir(out)?.next().is_some() => {
            bail!("{}: holds other files; expected an empty folder or a gallery's", out.display())
        }
        Err(_) => output::write_file(&path, text.as_bytes()),
    }
}

/// A file's name as a link in double quotes.
fn linked(file: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.".contains(&byte);
    file.bytes().map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") }).collect()
}

/// A page that shows all of it, a row for each map.
fn page(gallery: &Gallery) -> Result<String, fmt::Error> {
    let mut page = String::from(
        "<!doctype html>\n<meta charset=\"utf-8\">\n<title>Gallery</title>\n<style>body{font:14px sans-serif;margin:1em}\
         figure{display:inline-block;margin:.3em}img{width:19vw}</style>\n",
    );
    for pictures in gallery.pictures.chunk_by(|a, b| a.map == b.map) {
        page.push_str("<div>\n");
        for Picture { file, map, light, .. } in pictures {
            let (file, map) = (linked(file), escape(map));
            writeln!(
                page,
                "<figure><a href=\"{file}\"><img src=\"{file}\"></a><figcaption>{map}, {light}</figcaption></figure>"
            )?;
        }
        page.push_str("</div>\n");
    }
    Ok(page)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_hold_no_letter_that_means_something_else() {
        assert_eq!(linked("town-noon.png"), "town-noon.png");
        assert_eq!(linked("a\"b #1?.png"), "a%22b%20%231%3F.png");
        assert_eq!(linked("ä.png"), "%C3%A4.png");
    }
}
