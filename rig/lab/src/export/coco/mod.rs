//! A window of a recording as a folder of pictures annotated as in COCO, and one for each further camera in `cameras/NAME`: `images/TICK.png`; `panoptic.json` with
//! `panoptic/TICK.png`, whose colours are the ids of segments; `instances.json` with boxes and masks of what is counted.

mod segments;
mod tables;

use std::fs::{self, File};
use std::io::{BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use base::output::PendingFolder;
use base::png;
use base::progress::Interrupt;
use kernel::time::Tick;
use measures::footage::{self, Window};
use render::Frame;
use replay::Recording;
use serde::{Deserialize, Serialize};

use self::segments::{ids, segments};
use self::tables::{About, Category, Image, Info, Instance, Panoptic, SegmentInfo, Table};
use super::about::about;
use super::film::Counts;
use super::options::{Export, Options};
use crate::cameras::Named;
use crate::looks::{Size, Studio};

const CAMERAS: &str = "cameras";
const IMAGES: &str = "images";
const PANOPTIC: &str = "panoptic";
const PANOPTIC_TABLE: &str = "panoptic.json";
const INSTANCES_TABLE: &str = "instances.json";

/// Writes the folder, unless it is there.
pub fn export(
    (args, size): (&Options, Size),
    file: &Path,
    out: PathBuf,
    (studio, others): (&mut Studio, &[Named]),
    interrupt: &Interrupt,
) -> anyhow::Result<Export> {
    let recording = Recording::open(file)?;
    let (log, network) = (recording.log(), recording.network()?);
    let window = Window::of(log, &args.asked())?;
    let ticks: Vec<Tick> = window.pictures().collect();
    let (Some(&from), Some(&to)) = (ticks.first(), ticks.last()) else {
        bail!("no picture falls into the window; expected a longer one, or more pictures a second");
    };
    let about = about(&recording, &window, (args, size), (&[], others));
    let kept = made_from(&out).as_ref() == Some(&about);
    let counts = Counts { frames: ticks.len(), ..Counts::default() };
    let export = Export { file: file.to_owned(), out, from, to, kept, counts };
    if kept {
        return Ok(export);
    }
    let folder = PendingFolder::new(&export.out)?;
    let driver = (*studio.camera(), Album::new(folder.path().to_owned(), network.name.as_str(), about.clone())?);
    let mut albums = vec![driver];
    for Named { name, camera } in others {
        let about = about.clone().into_iter().chain([("camera".to_owned(), name.clone())]).collect();
        let below = folder.path().join(CAMERAS).join(name);
        albums.push((*camera, Album::new(below, network.name.as_str(), about)?));
    }
    footage::each_scene(log, &network, &ticks, |_, scene| {
        for (camera, album) in &mut albums {
            if interrupt.is_raised() {
                bail!("interrupted; nothing of its export is kept");
            }
            album.add(&studio.draw_through(&network, &scene, camera)?)?;
        }
        Ok(())
    })?;
    albums.iter().try_for_each(|(_, album)| album.finish())?;
    folder.finish()?;
    Ok(export)
}

/// What the folder's annotations were made from, if they are of such an export.
fn made_from(folder: &Path) -> Option<About> {
    #[derive(Deserialize)]
    struct Head {
        info: Info,
    }
    let table = File::open(folder.join(INSTANCES_TABLE)).ok()?;
    Some(serde_json::from_reader::<_, Head>(BufReader::new(table)).ok()?.info.aeye)
}

/// A folder that grows by a picture at a time.
struct Album {
    folder: PathBuf,
    info: Info,
    images: Vec<Image>,
    panoptic: Vec<Panoptic>,
    instances: Vec<Instance>,
}

impl Album {
    fn new(folder: PathBuf, map: &str, aeye: About) -> anyhow::Result<Self> {
        for below in [IMAGES, PANOPTIC] {
            let below = folder.join(below);
            fs::create_dir_all(&below).with_context(|| below.display().to_string())?;
        }
        let description = format!("A simulated drive on map {map}, by A-Eye");
        let info = Info { description, version: env!("CARGO_PKG_VERSION").to_owned(), aeye };
        Ok(Self { folder, info, images: Vec::new(), panoptic: Vec::new(), instances: Vec::new() })
    }

    fn add(&mut self, frame: &Frame) -> anyhow::Result<()> {
        let (tick, size) = (frame.tick, (frame.width, frame.height));
        let name = format!("{tick:08}.png");
        let ids = ids(frame);
        let segments = segments(&ids, frame.width);
        let colours: Vec<u8> = ids.iter().flat_map(|id| [*id as u8, (id >> 8) as u8, (id >> 16) as u8]).collect();
        self.write(&format!("{IMAGES}/{name}"), &png::rgb(size, &frame.rgb)?)?;
        self.write(&format!("{PANOPTIC}/{name}"), &png::rgb(size, &colours)?)?;
        self.instances.extend(Instance::of_picture(self.instances.len() + 1, (tick, size), &ids, &segments));
        let segments_info = segments.iter().map(|(id, segment)| SegmentInfo::of(*id, segment)).collect();
        self.panoptic.push(Panoptic { image_id: tick, file_name: name.clone(), segments_info });
        self.images.push(Image::of(tick, name, size));
        Ok(())
    }

    fn finish(&self) -> anyhow::Result<()> {
        self.table(PANOPTIC_TABLE, &self.panoptic, Category::all())?;
        self.table(INSTANCES_TABLE, &self.instances, Category::things())
    }

    fn table<A: Serialize>(&self, name: &str, annotations: &[A], categories: Vec<Category>) -> anyhow::Result<()> {
        let table = Table { info: &self.info, licenses: [], images: &self.images, annotations, categories };
        let path = self.folder.join(name);
        let place = || path.display().to_string();
        let mut file = BufWriter::new(File::create(&path).with_context(place)?);
        serde_json::to_writer(&mut file, &table).with_context(place)?;
        file.flush().with_context(place)
    }

    fn write(&self, name: &str, bytes: &[u8]) -> anyhow::Result<()> {
        let path = self.folder.join(name);
        fs::write(&path, bytes).with_context(|| path.display().to_string())
    }
}
