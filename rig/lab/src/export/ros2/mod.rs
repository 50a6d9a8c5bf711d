//! A window of a recording as a bag of ROS 2. Times are simulated time, so that the same export gives the same bytes.

mod bag;
mod cameras;
mod definitions;
mod messages;
mod motion;
mod tell;
#[cfg(test)]
mod tests;
mod token;

use std::path::{Path, PathBuf};

use anyhow::ensure;
use base::output::PendingFolder;
use base::png;
use base::progress::Interrupt;
use drivers::vision::Eye;
use kernel::RoadNetwork;
use kernel::scene::SceneSnapshot;
use kernel::time::Tick;
use measures::footage::{self, Window};
use replay::{Exported, Recording, exported, nanoseconds};

use self::bag::{Bag, Durability, MESSAGES, Topic};
use self::cameras::Pictures;
pub use self::cameras::check_names;
use self::messages::{Clock, CompressedImage, Log, MarkerArray, Odometry, TFMessage, Time};
use self::motion::{Motion, SPAN_TICKS};
use self::token::token;
use super::about::{about, origin};
use super::film::{Camera, Counts};
use super::happenings;
use super::options::{Export, Options};
use crate::cameras::Named;
use crate::looks::{Size, look};

/// Writes the folder, unless it is there.
pub fn export(
    (args, size): (&Options, Size),
    file: &Path,
    out: PathBuf,
    camera: &mut Camera<'_>,
    interrupt: &Interrupt,
) -> anyhow::Result<Export> {
    let recording = Recording::open(file)?;
    let (log, network) = (recording.log(), recording.network()?);
    let window = Window::of(log, &args.asked())?;
    let mut about = about(&recording, &window, (args, size), (&*camera.eyes, camera.others));
    about.extend(origin(&network));
    let (from, to) = window.ticks.clone().into_inner();
    let kept = exported(&out.join(MESSAGES)) == Some(Exported { about: about.clone(), is_whole: true });
    let export = Export { file: file.to_owned(), out, from, to, kept, counts: Counts::of(log, &window) };
    if kept {
        return Ok(export);
    }
    let folder = PendingFolder::new(&export.out)?;
    let mut bag = Bag::new(folder.path(), about)?;
    let topics = Topics::declare(&mut bag, camera.eyes.iter().map(Eye::name), camera.others)?;
    let others = topics.others.iter().zip(camera.others.iter().map(|named| &named.camera));
    let mounted = [(&topics.driver, camera.studio.camera())].into_iter().chain(others);
    let mounted = mounted.map(|(pictures, camera)| (pictures.frame.as_str(), camera));
    bag.put(&topics.mounting, from, &tell::mounting(mounted, nanoseconds(from)))?;
    bag.put(&topics.labels, from, &tell::labels(nanoseconds(from)))?;
    let mut happenings = happenings::lines(log, &window.ticks).into_iter().peekable();
    let mut motion = Motion::default();
    // Some ticks before the window, so that it is known how the car moves.
    let ticks: Vec<Tick> = (from.saturating_sub(SPAN_TICKS).max(log.first_tick())..=to).collect();
    footage::each_scene(log, &network, &ticks, |_, scene| {
        let (tick, twist) = (scene.tick, motion.at(scene.tick, &scene.ego));
        ensure!(!interrupt.is_raised(), "interrupted; nothing of its export is kept");
        if tick < from {
            return Ok(());
        }
        let time_ns = nanoseconds(tick);
        bag.put(&topics.clock, tick, &Clock { clock: Time::of(time_ns) })?;
        bag.put(&topics.transforms, tick, &tell::ego(&scene.ego, time_ns))?;
        bag.put(&topics.odometry, tick, &tell::odometry(&scene.ego, &twist, time_ns))?;
        while let Some((_, line)) = happenings.next_if(|(at, _)| *at <= tick) {
            bag.put(&topics.events, tick, &tell::happening(line, time_ns))?;
        }
        if window.has_picture(tick) { picture(&mut bag, &topics, (&network, &scene), camera) } else { Ok(()) }
    })?;
    bag.finish()?;
    folder.finish()?;
    Ok(export)
}

fn picture(
    bag: &mut Bag,
    topics: &Topics,
    (network, scene): (&RoadNetwork, &SceneSnapshot),
    camera: &mut Camera<'_>,
) -> anyhow::Result<()> {
    let (tick, time_ns, driver) = (scene.tick, nanoseconds(scene.tick), *camera.studio.camera());
    let frame = camera.studio.draw(network, scene)?;
    let size = (frame.width, frame.height);
    bag.put(&topics.markers, tick, &tell::markers(scene))?;
    topics.driver.put(bag, &driver, &frame)?;
    for (topic, mask) in topics.predicted.iter().zip(look(camera.eyes, &frame)?) {
        bag.put(topic, tick, &tell::mask(png::grey(size, &mask.ids)?, &topics.driver.frame, time_ns))?;
    }
    for (pictures, Named { camera: other, .. }) in topics.others.iter().zip(camera.others) {
        pictures.put(bag, other, &camera.studio.draw_through(network, scene, other)?)?;
    }
    Ok(())
}

/// Every topic.
struct Topics {
    clock: Topic<Clock>,
    transforms: Topic<TFMessage>,
    mounting: Topic<TFMessage>,
    odometry: Topic<Odometry>,
    markers: Topic<MarkerArray>,
    events: Topic<Log>,
    driver: Pictures,
    /// One for each camera beside the drivers'.
    others: Vec<Pictures>,
    labels: Topic<messages::LabelInfo>,
    /// One for each checkpoint.
    predicted: Vec<Topic<CompressedImage>>,
}

impl Topics {
    fn declare<'a>(
        bag: &mut Bag,
        checkpoints: impl Iterator<Item = &'a str>,
        others: &[Named],
    ) -> anyhow::Result<Self> {
        use Durability::{TransientLocal, Volatile};
        let mut predicted = Vec::new();
        for name in checkpoints {
            predicted.push(bag.topic(&format!("/camera/predicted/{}/compressed", token(name)), Volatile)?);
        }
        Ok(Self {
            clock: bag.topic("/clock", Volatile)?,
            transforms: bag.topic("/tf", Volatile)?,
            mounting: bag.topic("/tf_static", TransientLocal)?,
            odometry: bag.topic("/odom", Volatile)?,
            markers: bag.topic("/actors", Volatile)?,
            events: bag.topic("/events", Volatile)?,
            driver: Pictures::of_driver(bag)?,
            others: others.iter().map(|named| Pictures::of(named, bag)).collect::<anyhow::Result<_>>()?,
            labels: bag.topic("/camera/label_info", TransientLocal)?,
            predicted,
        })
    }
}
