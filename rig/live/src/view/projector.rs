//! Makes the pictures of a tick: the run simulated again, drawn, and looked at through checkpoints.

use std::sync::Arc;

use base::failure::{is_divergence, sentence};
use base::image::Image;
use base::newest::Newest;
use drivers::film::reel::{Moment, Reel};
use drivers::film::seen::{Picture, Seen, SeenTrack};
use drivers::film::{Film, Viewpoint};
use drivers::vision::Eye;
use kernel::time::Tick;
use perception::{ConfusionMatrix, Mask};
use render::{AdapterChoice, Frame, Renderer};

use super::layers::{self, Layer};

/// Width of images and true classes, pixels: the multiple of the semantic driver's camera nearest below.
const WIDTH: u32 = 768;

/// What is to be shown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Request {
    /// The tick.
    pub tick: Tick,
    /// From where; what was seen is always from the driver's place.
    pub viewpoint: Viewpoint,
    /// What the left and the right view show.
    pub layers: [Layer; 2],
    /// Index of the checkpoint that predicts.
    pub checkpoint: usize,
}

/// What was asked for.
#[derive(Debug)]
pub struct Shown {
    /// By which request.
    pub request: Request,
    /// The tick; `None` when the replay is not the run that was recorded.
    pub moment: Option<Arc<Moment>>,
    /// The left and the right view.
    pub views: [Picture; 2],
    /// The mask that was on the semantic driver's screen.
    pub seen: Option<Seen>,
    /// Share of the pixels that the checkpoint has right, [0, 1], where that was measured.
    pub accuracy: Option<f64>,
}

/// Draws and predicts, one request after the other.
pub struct Projector<'a> {
    film: &'a Film,
    reel: Reel<'a>,
    seen: SeenTrack<'a>,
    eyes: Vec<Eye>,
    /// Of images and true classes.
    large: Renderer,
    /// Of pictures that are predicted from.
    small: Renderer,
}

impl<'a> Projector<'a> {
    /// With the eyes to choose from, and the one that the run was driven through, if it is at hand.
    pub fn new(film: &'a Film, eyes: Vec<Eye>, recorded: Option<Eye>) -> anyhow::Result<Self> {
        let renderer = || Renderer::new(&film.network, &AdapterChoice::default());
        Ok(Self {
            film,
            reel: Reel::new(film.log(), &film.network)?,
            seen: SeenTrack::new(film, recorded)?,
            eyes,
            large: renderer()?,
            small: renderer()?,
        })
    }

    /// Serves the newest request until there are no more; `show` is called after each.
    pub fn run(mut self, requests: &Newest<Request>, shown: &Newest<Shown>, show: impl Fn()) -> anyhow::Result<()> {
        let mut served = 0;
        while let Some((number, request)) = requests.wait(served) {
            served = number;
            shown.put(self.show(&request)?);
            show();
        }
        Ok(())
    }

    /// Makes what is asked for. A replay that diverges is part of the answer, a renderer or network that
    /// fails is an error.
    pub fn show(&mut self, request: &Request) -> anyhow::Result<Shown> {
        match self.take(request) {
            Err(error) if is_divergence(&error) => {
                let why = sentence(&error);
                let views = [Err(why.clone()), Err(why)];
                Ok(Shown { request: request.clone(), moment: None, views, seen: None, accuracy: None })
            }
            shown => shown,
        }
    }

    fn take(&mut self, request: &Request) -> anyhow::Result<Shown> {
        let moment = self.reel.at(request.tick)?;
        let wants = |layers: &[Layer]| request.layers.iter().any(|layer| layers.contains(layer));
        let (large, small) = (large_size(self.film.eye.size()), self.film.eye.size());
        let mut take = Take::default();
        if wants(&[Layer::Rgb, Layer::Truth]) {
            let imaging = self.film.eye.camera.imaging().in_quality(self.large.quality_for_people());
            let camera = request.viewpoint.camera(large).at(imaging);
            take.large = Some(self.large.draw(&moment.scene, &camera)?);
        }
        if wants(&[Layer::Prediction, Layer::Difference, Layer::Confidence]) {
            let camera = request.viewpoint.camera(small).at(self.film.eye.camera.imaging());
            let frame = self.small.draw(&moment.scene, &camera)?;
            let eye = &mut self.eyes[request.checkpoint];
            let (mask, certainty) = if wants(&[Layer::Confidence]) {
                eye.see_with_certainty(&frame)?
            } else {
                (eye.see(frame.clone())?, None)
            };
            take.predicted =
                Some(Predicted { frame, mask, confidence: certainty.map(|certainty| certainty.confidence) });
        }
        let (seen, picture) = self.seen.at(request.tick, wants(&[Layer::Seen]), &mut self.small)?;
        take.seen = Some(picture);
        let accuracy = take.predicted.as_ref().and_then(Predicted::accuracy);
        let views = request.layers.map(|layer| take.picture(layer));
        Ok(Shown { request: request.clone(), moment: Some(moment), views, seen, accuracy })
    }
}

/// The camera's size times a whole number.
fn large_size((width, height): (u32, u32)) -> (u32, u32) {
    let times = (WIDTH / width).max(1);
    (times * width, times * height)
}

/// A frame and what a checkpoint makes of it.
struct Predicted {
    frame: Frame,
    mask: Mask,
    confidence: Option<Vec<f32>>,
}

impl Predicted {
    fn accuracy(&self) -> Option<f64> {
        let mut matrix = ConfusionMatrix::default();
        matrix.add(&self.frame.class_ids, &self.mask.ids);
        Some(matrix.scores().accuracy).filter(|accuracy| accuracy.is_finite())
    }
}

/// What a request needs, made once for both views.
#[derive(Default)]
struct Take {
    large: Option<Frame>,
    predicted: Option<Predicted>,
    seen: Option<Picture>,
}

impl Take {
    fn picture(&self, layer: Layer) -> Picture {
        let missing = || Err("not drawn".to_owned());
        match (layer, &self.large, &self.predicted) {
            (Layer::Seen, ..) => self.seen.clone().unwrap_or_else(missing),
            (Layer::Rgb, Some(frame), _) => Ok(image(frame, frame.rgb.clone())),
            (Layer::Truth, Some(frame), _) => Ok(image(frame, frame.class_colours())),
            (Layer::Prediction, _, Some(p)) => Ok(image(&p.frame, render::tags::colours(&p.mask.ids))),
            (Layer::Difference, _, Some(p)) => Ok(image(&p.frame, layers::difference(&p.frame.class_ids, &p.mask.ids))),
            (Layer::Confidence, _, Some(p)) => match &p.confidence {
                Some(confidence) => Ok(image(&p.frame, layers::doubt(confidence))),
                None => Err("this checkpoint gives classes only: it does not say how sure it is".into()),
            },
            _ => missing(),
        }
    }
}

fn image(frame: &Frame, rgb: Vec<u8>) -> Arc<Image> {
    Arc::new(Image { width: frame.width as usize, height: frame.height as usize, rgb })
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::maps::Map;
    use drivers::checkpoint::CheckpointChoice;
    use drivers::simulate;
    use drivers::vision::Vision;

    #[test]
    fn images_are_a_multiple_of_what_the_eye_takes() {
        assert_eq!(large_size((256, 128)), (768, 384));
        assert_eq!(large_size((320, 180)), (640, 360));
        assert_eq!(large_size((1024, 512)), (1024, 512));
    }

    #[test]
    fn viewpoints_go_round() {
        let round = Viewpoint::Driver.next().next().next();
        assert_eq!(round, Viewpoint::Driver);
    }

    const EARLY: CheckpointChoice = CheckpointChoice::Bundled("early");

    /// A few seconds driven through `early`.
    fn film(folder: &std::path::Path) -> Film {
        let map = Map::find("rural").expect("bundled");
        let renderer = Renderer::new(&map.network, &AdapterChoice::default()).expect("an adapter");
        let vision = Vision::new(renderer, Eye::open(&EARLY).expect("bundled"));
        let path = folder.join("drive.mcap");
        let file = std::fs::File::create(&path).expect("writable");
        simulate::drive(&map.scenario(2), &map, vision, file, |world| world.tick() < 130).expect("a drive");
        Film::open(&path).expect("a recording")
    }

    fn ask(tick: Tick, viewpoint: Viewpoint, layers: [Layer; 2], checkpoint: usize) -> Request {
        Request { tick, viewpoint, layers, checkpoint }
    }

    #[test]
    #[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
    fn what_was_seen_is_what_the_checkpoint_predicts_of_its_frame_in_whatever_order() {
        let dir = tempfile::tempdir().expect("a folder");
        let film = film(dir.path());
        let early = || Eye::open(&EARLY).expect("bundled");
        let mut projector = Projector::new(&film, vec![early()], Some(early())).expect("a projector");
        for tick in [100, 30, 31, 130, 7, 0, 55] {
            let shown = projector.show(&ask(tick, Viewpoint::Top, [Layer::Seen, Layer::Truth], 0)).expect("shown");
            let Seen { logged, rebuilt } = shown.seen.expect("a mask from the first tick on");
            assert_eq!(rebuilt, Some(logged.digest), "tick {tick}");
            let frame = ask(logged.tick_of_frame, Viewpoint::Driver, [Layer::Prediction, Layer::Rgb], 0);
            let predicted = projector.show(&frame).expect("shown");
            assert_eq!(shown.views[0], predicted.views[0], "tick {tick}");
            assert_ne!(shown.views[0], predicted.views[1], "tick {tick}");
        }
    }

    #[test]
    #[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
    fn every_layer_is_shown_from_everywhere_or_says_why_not() {
        let dir = tempfile::tempdir().expect("a folder");
        let film = film(dir.path());
        let eyes = vec![Eye::open(&EARLY).expect("bundled"), Eye::Truth];
        let mut projector = Projector::new(&film, eyes, None).expect("a projector");
        for viewpoint in [Viewpoint::Driver, Viewpoint::Chase, Viewpoint::Top] {
            for layers in [[Layer::Rgb, Layer::Truth], [Layer::Prediction, Layer::Difference]] {
                let views = projector.show(&ask(90, viewpoint, layers, 0)).expect("shown").views;
                assert!(views.iter().all(Result::is_ok) && views[0] != views[1], "{viewpoint:?} {layers:?}");
            }
        }
        let views =
            projector.show(&ask(90, Viewpoint::Driver, [Layer::Confidence, Layer::Seen], 0)).expect("shown").views;
        assert!(views[0].is_ok() && views[1].as_ref().is_err_and(|why| why.contains("--checkpoint")));
        let shown =
            projector.show(&ask(90, Viewpoint::Driver, [Layer::Confidence, Layer::Difference], 1)).expect("shown");
        assert!(shown.views[0].as_ref().is_err_and(|why| why.contains("classes only")));
        assert_eq!(shown.accuracy, Some(1.0), "ground truth is right");
    }
}
