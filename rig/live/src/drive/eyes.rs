//! Draws the newest scene for both drivers, each in a thread of its own: inference does not delay what
//! the safety driver sees.

use std::sync::Arc;

use base::clock::SessionClock;
use base::image::Image;
use base::newest::Newest;
use drivers::vision::digest_of;
use kernel::RoadNetwork;
use perception::Mask;
use render::{AdapterChoice, Camera, Frame, Quality, Renderer};
use study::Lineup;
use viewers::feed::{Look, ShownMask, View};

use super::board::Board;

/// A renderer for one of the drivers, of the map that is driven on.
pub struct Eyes {
    network: Arc<RoadNetwork>,
    renderer: Renderer,
}

impl Eyes {
    /// On a map.
    pub fn on(network: &Arc<RoadNetwork>) -> anyhow::Result<Self> {
        Ok(Self { network: network.clone(), renderer: Renderer::new(network, &AdapterChoice::default())? })
    }

    /// The best quality that this machine draws for people.
    pub fn quality_for_people(&self) -> Quality {
        self.renderer.quality_for_people()
    }

    fn draw(&mut self, look: &Look, camera: &Camera) -> anyhow::Result<Frame> {
        if !Arc::ptr_eq(&self.network, &look.network) {
            *self = Self::on(&look.network)?;
        }
        Ok(self.renderer.draw(&look.scene, camera)?)
    }
}

/// Draws what the safety driver sees through cameras side by side, left one first, until the scenes
/// end. `show` is called after every picture.
pub fn watch_as_safety(
    board: &Board,
    mut eyes: Eyes,
    cameras: &[Camera],
    clock: SessionClock,
    show: impl Fn(),
) -> anyhow::Result<()> {
    watch(&board.feed.scene, &board.feed.safety, show, |look| {
        let images = cameras.iter().map(|camera| Ok(Image::of(eyes.draw(look, camera)?)));
        let images: Vec<Image> = images.collect::<anyhow::Result<_>>()?;
        Ok(view(look, Image::side_by_side(&images), None, clock.now_us()))
    })
}

/// Draws what the semantic driver sees: the prediction of the run's eye, in class colours.
pub fn watch_as_semantic(
    board: &Board,
    mut eyes: Eyes,
    mut lineup: Lineup,
    clock: SessionClock,
    show: impl Fn(),
) -> anyhow::Result<()> {
    let camera = lineup.camera();
    watch(&board.feed.scene, &board.feed.semantic, show, |look| {
        let frame = eyes.draw(look, &camera)?;
        let Mask { width, height, ids } = lineup.see(look.eye, frame)?;
        let rgb = render::tags::colours(&ids);
        let image = Image { width, height, rgb };
        let mask = ShownMask { digest: digest_of(&ids), ids };
        Ok(view(look, image, Some(mask), clock.now_us()))
    })
}

fn watch(
    scenes: &Newest<Look>,
    views: &Newest<View>,
    show: impl Fn(),
    mut draw: impl FnMut(&Look) -> anyhow::Result<View>,
) -> anyhow::Result<()> {
    let mut seen = 0;
    while let Some((number, look)) = scenes.wait(seen) {
        seen = number;
        views.put(draw(&Arc::clone(&look))?);
        show();
    }
    Ok(())
}

fn view(look: &Look, image: Image, mask: Option<ShownMask>, ready_us: u64) -> View {
    View { run: look.run, tick: look.scene.tick, image: Arc::new(image), mask, captured_us: look.captured_us, ready_us }
}
