//! What the viewer shows and how it goes on: the state that keys and buttons act upon.

use std::ops::RangeInclusive;

use drivers::film::Viewpoint;
use kernel::time::{CLIP_STRIDE_TICKS, Tick};
use replay::Log;

use super::layers::Layer;
use super::playback::Playback;
use super::projector::Request;
use super::range::MarkedRange;
use super::timeline::{Timeline, seconds};

/// Ticks of a frame in a step: those of the clip of a corner case.
pub const FRAME_TICKS: i64 = CLIP_STRIDE_TICKS as i64;

/// What a key or button asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Play or stop.
    TogglePlay,
    /// Go so many ticks on or back, and stop.
    Step(i64),
    /// Go to a tick.
    Seek(Tick),
    /// Go to the first tick.
    Start,
    /// Go to the last tick.
    End,
    /// Go to the event before.
    PreviousMark,
    /// Go to the next event.
    NextMark,
    /// The next higher speed.
    Faster,
    /// The next lower speed.
    Slower,
    /// Show something in the left (0) or right (1) view.
    Show(usize, Layer),
    /// The next camera.
    NextViewpoint,
    /// The next checkpoint.
    NextCheckpoint,
    /// The range begins here.
    MarkFrom,
    /// The range ends here.
    MarkTo,
    /// Cut the range as a case.
    Cut,
    /// Save both views as a picture.
    Screenshot,
    /// Show or hide the HUD.
    ToggleHud,
}

/// Work that a key or button gives to others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Order {
    /// Cut a case.
    Cut(RangeInclusive<Tick>),
    /// Save what is on the screen.
    Screenshot,
}

/// How the viewer stands.
#[derive(Clone, Debug)]
pub struct Viewing {
    /// The ticks and what happened at them.
    pub timeline: Timeline,
    /// Where it stands, and whether it plays.
    pub playback: Playback,
    /// What the left and the right view show.
    pub layers: [Layer; 2],
    /// From where.
    pub viewpoint: Viewpoint,
    /// Index of the checkpoint that predicts.
    pub checkpoint: usize,
    /// Names of the checkpoints to choose from.
    pub checkpoints: Vec<String>,
    /// What is marked.
    pub range: MarkedRange,
    /// Whether the HUD is shown.
    pub has_hud: bool,
    /// What was last said to the person at the screen.
    pub said: String,
}

impl Viewing {
    /// Of a log, at its first tick; at the window's first tick in a case.
    pub fn new(log: &Log, checkpoints: Vec<String>) -> Self {
        let timeline = Timeline::of(log);
        let mut playback = Playback::new(timeline.first, timeline.last);
        let mut range = MarkedRange::default();
        if let Some(case) = &log.manifest.case {
            playback.seek(case.from);
            range = MarkedRange { from: Some(case.from), to: Some(case.to) };
        }
        let seen = if log.masks.is_empty() { Layer::Prediction } else { Layer::Seen };
        Self {
            timeline,
            playback,
            layers: [seen, Layer::Rgb],
            viewpoint: Viewpoint::default(),
            checkpoint: 0,
            checkpoints,
            range,
            has_hud: true,
            said: String::new(),
        }
    }

    /// What is to be shown now.
    pub fn request(&self) -> Request {
        let (viewpoint, layers, checkpoint) = (self.viewpoint, self.layers, self.checkpoint);
        Request { tick: self.playback.tick(), viewpoint, layers, checkpoint }
    }

    /// Name of the checkpoint that predicts.
    pub fn checkpoint_name(&self) -> &str {
        self.checkpoints.get(self.checkpoint).map_or("", String::as_str)
    }

    /// Does what is asked for; what others have to do is handed on.
    pub fn act(&mut self, action: Action) -> Option<Order> {
        let tick = self.playback.tick();
        self.said.clear();
        match action {
            Action::TogglePlay => self.playback.toggle(),
            Action::Step(ticks) => self.playback.step(ticks),
            Action::Seek(tick) => self.playback.seek(tick),
            Action::Start => self.playback.seek(self.timeline.first),
            Action::End => self.playback.seek(self.timeline.last),
            Action::PreviousMark => self.jump(self.timeline.previous_mark(tick), "no event before this tick"),
            Action::NextMark => self.jump(self.timeline.next_mark(tick), "no event after this tick"),
            Action::Faster => self.playback.change_speed(true),
            Action::Slower => self.playback.change_speed(false),
            Action::Show(view, layer) => self.layers[view] = layer,
            Action::NextViewpoint => self.viewpoint = self.viewpoint.next(),
            Action::NextCheckpoint => self.checkpoint = (self.checkpoint + 1) % self.checkpoints.len().max(1),
            Action::MarkFrom => self.range.mark_from(tick),
            Action::MarkTo => self.range.mark_to(tick),
            Action::ToggleHud => self.has_hud = !self.has_hud,
            Action::Screenshot => return Some(Order::Screenshot),
            Action::Cut => return self.cut(),
        }
        None
    }

    fn jump(&mut self, to: Option<Tick>, otherwise: &str) {
        let Some(tick) = to else {
            self.said = otherwise.into();
            return;
        };
        self.playback.seek(tick);
        let marks = self.timeline.marks.iter().filter(|mark| mark.tick == tick);
        let texts: Vec<&str> = marks.map(|mark| mark.text.as_str()).collect();
        self.said = format!("{:.2} s: {}", seconds(tick), texts.join("; "));
    }

    fn cut(&mut self) -> Option<Order> {
        let ticks = self.range.ticks();
        self.said = match &ticks {
            Some(ticks) => format!("cutting ticks {} to {}", ticks.start(), ticks.end()),
            None => "mark a range to be cut: I at its first tick, O at its last".into(),
        };
        ticks.map(Order::Cut)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::timeline::{Mark, MarkKind};

    fn viewing() -> Viewing {
        let mark = |tick| Mark { tick, kind: MarkKind::Event, text: format!("event {tick}") };
        let timeline = Timeline { first: 0, last: 600, marks: [60, 240].map(mark).into() };
        Viewing {
            playback: Playback::new(0, 600),
            timeline,
            layers: [Layer::Seen, Layer::Rgb],
            viewpoint: Viewpoint::Driver,
            checkpoint: 0,
            checkpoints: vec!["early".into(), "full".into()],
            range: MarkedRange::default(),
            has_hud: true,
            said: String::new(),
        }
    }

    #[test]
    fn a_range_marked_between_two_events_is_cut() {
        let mut viewing = viewing();
        assert_eq!(viewing.act(Action::Cut), None);
        assert!(viewing.said.contains("mark a range"));
        for action in [Action::NextMark, Action::MarkFrom, Action::NextMark, Action::Step(-FRAME_TICKS), Action::MarkTo]
        {
            assert_eq!(viewing.act(action), None);
        }
        assert_eq!(viewing.act(Action::Cut), Some(Order::Cut(60..=234)));
    }

    #[test]
    fn jumps_say_what_is_there_and_end_where_events_end() {
        let mut viewing = viewing();
        viewing.act(Action::End);
        viewing.act(Action::PreviousMark);
        assert_eq!((viewing.playback.tick(), viewing.said.as_str()), (240, "4.00 s: event 240"));
        viewing.act(Action::NextMark);
        assert_eq!((viewing.playback.tick(), viewing.said.as_str()), (240, "no event after this tick"));
    }

    #[test]
    fn what_is_chosen_is_what_is_asked_for() {
        let mut viewing = viewing();
        for action in [
            Action::Show(0, Layer::Difference),
            Action::NextViewpoint,
            Action::NextCheckpoint,
            Action::Seek(9),
            Action::Screenshot,
        ] {
            let order = viewing.act(action);
            assert_eq!(order.is_some(), action == Action::Screenshot);
        }
        let expected =
            Request { tick: 9, viewpoint: Viewpoint::Chase, layers: [Layer::Difference, Layer::Rgb], checkpoint: 1 };
        assert_eq!((viewing.request(), viewing.checkpoint_name()), (expected, "full"));
        viewing.act(Action::NextCheckpoint);
        assert_eq!(viewing.checkpoint_name(), "early");
    }
}
