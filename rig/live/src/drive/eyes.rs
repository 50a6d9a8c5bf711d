//! Draws the newest scene for both drivers, each in a thread of its own: inference does not delay what
//! the safety driver sees.

use std::sync::Arc;

use base::clock::SessionClock;
use base::image::Image;
use base::newest::Newest;
use drivers::vision::digest_of;
use perception::Mask;
use render::{AdapterChoice, Camera, Renderer};
use study::Lineup;
use viewers::feed::{Look, ShownMask, View};

use super::board::Board;

/// Draws what the safety driver sees through cameras side by side, left one first, until the scenes
/// end. `show` is called after every picture.
pub fn watch_as_safety(
    board: &Board,
    mut renderer: Renderer,
    cameras: &[Camera],
    clock: SessionClock,
    show: impl Fn(),
) -> anyhow::Result<()> {
    watch(&board.feed.scene, &board.feed.safety, show, |look| {
        let images = cameras.iter().map(|camera| Ok(Image::of(renderer.draw(&look.scene, camera)?)));
        let images: Vec<Image> = images.collect::<anyhow::Result<_>>()?;
        Ok(view(look, Image::side_by_side(&images), None, clock.now_us()))
    })
}

/// Draws what the semantic driver sees: the prediction of the run's eye, in class colours.
pub fn watch_as_semantic(
    board: &Board,
    mut renderer: Renderer,
    mut lineup: Lineup,
    clock: SessionClock,
    show: impl Fn(),
) -> anyhow::Result<()> {
    let camera = lineup.camera();
    watch(&board.feed.scene, &board.feed.semantic, show, |look| {
        let frame = renderer.draw(&look.scene, &camera)?;
        let Mask { width, height, ids } = lineup.see(look.run, frame)?;
        let rgb = render::tags::colours(&ids);
        let image = Image { width, height, rgb };
        let mask = ShownMask { digest: digest_of(&ids), ids };
        Ok(view(look, image, Some(mask), clock.now_us()))
    })
}

/// A renderer for one of the drivers.
pub fn renderer(network: &kernel::RoadNetwork) -> anyhow::Result<Renderer> {
    Ok(Renderer::new(network, &AdapterChoice::default())?)
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
