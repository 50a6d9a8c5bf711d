//! Draws the newest scene for both drivers, each in a thread of its own: inference does not delay what
//! the safety driver sees.

use std::sync::Arc;

use perception::Mask;
use render::{Camera, Frame, RenderOptions, Renderer};

use super::board::{Board, Look, ShownMask, View};
use crate::clock::SessionClock;
use crate::desktop::Image;
use crate::newest::Newest;
use crate::vision::{Eye, digest_of};

/// Draws what the safety driver sees, at a size in pixels, until the scenes end. `show` is called
/// after every picture.
pub fn watch_as_safety(
    board: &Board,
    mut renderer: Renderer,
    size: (u32, u32),
    clock: SessionClock,
    show: impl Fn(),
) -> anyhow::Result<()> {
    let camera = Camera::driver(size.0, size.1);
    watch(&board.scene, &board.safety, show, |look| {
        let frame = renderer.draw(&look.scene, &camera)?;
        Ok(view(look, &frame, frame.rgb.clone(), None, clock.now_us()))
    })
}

/// Draws what the semantic driver sees: the prediction of the eye, in class colours.
pub fn watch_as_semantic(
    board: &Board,
    mut renderer: Renderer,
    mut eye: Eye,
    clock: SessionClock,
    show: impl Fn(),
) -> anyhow::Result<()> {
    let (width, height) = eye.size();
    let camera = Camera::driver(width, height);
    watch(&board.scene, &board.semantic, show, |look| {
        let frame = renderer.draw(&look.scene, &camera)?;
        let Mask { ids, .. } = eye.see(frame.clone())?;
        let rgb = ids.iter().flat_map(|id| render::tags::colour(*id)).collect();
        let mask = ShownMask { digest: digest_of(&ids), ids };
        Ok(view(look, &frame, rgb, Some(mask), clock.now_us()))
    })
}

/// A renderer for one of the drivers.
pub fn renderer(network: &kernel::RoadNetwork) -> anyhow::Result<Renderer> {
    Ok(Renderer::new(network, &RenderOptions::default())?)
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

fn view(look: &Look, frame: &Frame, rgb: Vec<u8>, mask: Option<ShownMask>, ready_us: u64) -> View {
    View {
        run: look.run,
        tick: frame.tick,
        image: Arc::new(Image { width: frame.width as usize, height: frame.height as usize, rgb }),
        mask,
        captured_us: look.captured_us,
        ready_us,
    }
}
