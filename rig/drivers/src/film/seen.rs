//! What was on the semantic driver's screen, made again.

use std::sync::Arc;

use base::image::Image;
use kernel::time::Tick;
use render::Renderer;
use replay::MaskShown;

use super::Film;
use super::reel::Reel;
use crate::vision::{Eye, digest_of};

/// An image, or why there is none.
pub type Picture = Result<Arc<Image>, String>;

/// The mask on the semantic driver's screen at a tick.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seen {
    /// As it was logged.
    pub logged: MaskShown,
    /// Its digest when made again; `None` when that was not asked for or cannot be done.
    pub rebuilt: Option<u64>,
}

/// Makes logged masks again.
pub struct SeenTrack<'a> {
    film: &'a Film,
    /// The eye that the run was driven through.
    eye: Option<Eye>,
    /// Stands at frames, which are older than the ticks at which they are on the screen.
    reel: Reel<'a>,
    last: Option<Rebuilt>,
}

struct Rebuilt {
    tick_of_frame: Tick,
    digest: u64,
    image: Arc<Image>,
}

impl<'a> SeenTrack<'a> {
    /// With the eye that the run was driven through, if it is at hand.
    pub fn new(film: &'a Film, eye: Option<Eye>) -> anyhow::Result<Self> {
        Ok(Self { film, eye, reel: Reel::new(film.log(), &film.network)?, last: None })
    }

    /// The mask on the screen at a tick, and its picture if it is wanted.
    pub fn at(
        &mut self,
        tick: Tick,
        is_wanted: bool,
        renderer: &mut Renderer,
    ) -> anyhow::Result<(Option<Seen>, Picture)> {
        let Some(logged) = self.film.mask_at(tick) else {
            return Ok((None, Err("no mask was on the semantic driver's screen yet".into())));
        };
        let seen = |rebuilt| Some(Seen { logged: *logged, rebuilt });
        if let Some(reason) = self.obstacle(logged).filter(|_| is_wanted) {
            return Ok((seen(None), Err(reason)));
        }
        if !is_wanted {
            return Ok((seen(None), Err("not drawn".into())));
        }
        let rebuilt = self.rebuilt(logged.tick_of_frame, renderer)?;
        Ok((seen(rebuilt.map(|r| r.digest)), rebuilt.map_or_else(|| Err("not drawn".into()), |r| Ok(r.image.clone()))))
    }

    /// Why a mask cannot be made again.
    fn obstacle(&self, logged: &MaskShown) -> Option<String> {
        let eye = &self.film.eye;
        if self.eye.is_none() {
            return Some(format!("driven through {}: give that file with --checkpoint to see its masks", eye.name));
        }
        if logged.camera != 0 {
            return Some(format!("camera {} is not known", logged.camera));
        }
        let is_there = self.film.holds(logged.tick_of_frame);
        (!is_there).then(|| format!("its frame, tick {}, is from before this file", logged.tick_of_frame))
    }

    fn rebuilt(&mut self, tick_of_frame: Tick, renderer: &mut Renderer) -> anyhow::Result<Option<&Rebuilt>> {
        if self.last.as_ref().is_none_or(|last| last.tick_of_frame != tick_of_frame) {
            let Some(eye) = &mut self.eye else { return Ok(None) };
            let moment = self.reel.at(tick_of_frame)?;
            let frame = eye.draw(renderer, &moment.scene, &self.film.eye.camera)?;
            let mask = eye.see(frame)?;
            let image = Image { width: mask.width, height: mask.height, rgb: render::tags::colours(&mask.ids) };
            self.last = Some(Rebuilt { tick_of_frame, digest: digest_of(&mask.ids), image: Arc::new(image) });
        }
        Ok(self.last.as_ref())
    }
}
