//! The replay viewer: a recording or case in a window, tick by tick, in every layer.
//!
//! The window never waits: what is to be shown is a request of which the newest wins, and another
//! thread simulates, draws and predicts. Files are written by a third.

mod clerk;
mod hud;
mod layers;
mod playback;
mod projector;
mod range;
mod staleness;
mod timeline;
mod viewing;
mod windows;

use std::collections::BTreeSet;
use std::sync::mpsc;

use anyhow::Context;
use base::newest::Newest;
use drivers::checkpoint::CheckpointChoice;
use drivers::film::Film;
use drivers::vision::Eye;

use projector::Projector;
use viewing::Viewing;
use windows::{Links, Window, Word};

/// Shows a recording or case in a window until that is closed.
pub fn watch(film: &Film, choices: &[CheckpointChoice]) -> anyhow::Result<()> {
    let window = Window::new()?;
    let recorded = film.eye.find_as_it_was(choices)?;
    let eyes = eyes(film, recorded.as_ref(), choices)?;
    let viewing = Viewing::new(film.log(), eyes.iter().map(|eye| eye.name().to_owned()).collect());
    let projector = Projector::new(film, eyes, recorded).with_context(|| film.path.display().to_string())?;
    show(film, window, viewing, projector)
}

/// The eyes to choose from: the recorded one first, then those asked for, or else the bundled ones.
fn eyes(film: &Film, recorded: Option<&Eye>, choices: &[CheckpointChoice]) -> anyhow::Result<Vec<Eye>> {
    let bundled = perception::BUNDLED.map(CheckpointChoice::Bundled);
    let choices = if choices.is_empty() { &bundled } else { choices };
    let open = |choice| Ok(Eye::open_at(choice, film.eye.size())?.at(film.eye.camera.imaging()));
    let asked = choices.iter().map(open).collect::<anyhow::Result<Vec<_>>>()?;
    let mut known = BTreeSet::new();
    Ok(recorded.cloned().into_iter().chain(asked).filter(|eye| known.insert(eye.digest())).collect())
}

/// Opens the window, with the threads around it, until it is closed.
fn show(film: &Film, window: Window, viewing: Viewing, projector: Projector<'_>) -> anyhow::Result<()> {
    let (requests, shown) = (Newest::default(), Newest::default());
    let (errands, list) = mpsc::channel();
    let voice = window.voice();
    std::thread::scope(|scope| {
        scope.spawn({
            let (voice, requests, shown) = (voice.clone(), &requests, &shown);
            move || {
                let _over = Over(voice.clone());
                let show = || voice.say(Word::Shown);
                if let Err(error) = projector.run(requests, shown, show) {
                    voice.say(Word::Failed(error));
                }
            }
        });
        scope.spawn(move || clerk::work(film, &list, |said| voice.say(Word::Said(said))));
        let result = window.show(viewing, Links { film, requests: &requests, shown: &shown, errands });
        requests.close();
        result
    })
}

/// Ends the window when the projector ends, however it does.
struct Over(windows::Voice);

impl Drop for Over {
    fn drop(&mut self) {
        self.0.say(Word::Over);
    }
}
