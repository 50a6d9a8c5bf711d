//! What happened in a window: events of one frame each, who drove in which frames, and what is said of the takeover.

use base::words;
use kernel::events::Event;
use kernel::time::Tick;
use replay::Log;

use super::document::{Agent, Data, Element, InFrame, Interval, Numbered, Relation, Value};
use super::tracks::Tracks;
use crate::redrive::Counterfactual;

/// Adds them to the frames.
pub struct Story {
    pub events: Numbered<Element>,
    pub actions: Numbered<Element>,
    pub relations: Numbered<Relation>,
}

impl Story {
    /// That of a log, in the window that the frames are of; `verdict` is on its takeover.
    pub fn of(log: &Log, (first, last): (Tick, Tick), verdict: Option<&Counterfactual>, tracks: &mut Tracks) -> Self {
        let mut story = Self { events: Numbered::new(), actions: Numbered::new(), relations: Numbered::new() };
        let inside = |tick: Tick| (first..=last).contains(&tick);
        for (tick, event) in log.events.iter().filter(|(tick, _)| inside(*tick)) {
            let uid = story.event(*tick, happened(*tick, event), tracks);
            if tracks.objects.contains_key(&event.actor) && event.actor != 0 {
                story.relate(event.actor, uid);
            }
        }
        if let Some(tick) = log.decided_at().filter(|tick| inside(*tick)) {
            story.event(tick, corner_case(log, tick, verdict), tracks);
        }
        story.drivers(log, last, tracks);
        story
    }

    fn event(&mut self, tick: Tick, element: Element, tracks: &mut Tracks) -> u32 {
        let (uid, frame) = (self.events.len() as u32, frame_of(tick, tracks));
        let frame_intervals = vec![Interval { frame_start: frame, frame_end: frame }];
        self.events.insert(uid, Element { frame_intervals, ..element });
        if let Some(frame) = tracks.frames.get_mut(&frame) {
            frame.events.insert(uid, InFrame::default());
        }
        uid
    }

    fn relate(&mut self, object: u32, event: u32) {
        let agent = |r#type, uid: u32| [Agent { r#type, uid: uid.to_string() }];
        let relation = Relation {
            name: format!("object {object} in event {event}"),
            r#type: "isInvolvedIn",
            rdf_subjects: agent("object", object),
            rdf_objects: agent("event", event),
        };
        self.relations.insert(self.relations.len() as u32, relation);
    }

    /// The semantic driver up to the takeover, the safety driver from there on.
    fn drivers(&mut self, log: &Log, last: Tick, tracks: &mut Tracks) {
        let end = tracks.frames.len() as u32;
        let takeover = log.intervention.map(|intervention| intervention.tick).filter(|tick| *tick <= last);
        let ticks: Vec<Tick> = tracks.frames.values().map(|frame| frame.frame_properties.tick).collect();
        let from = takeover.map_or(end, |tick| ticks.partition_point(|of_frame| *of_frame < tick) as u32);
        let parts = [
            ("SemanticDriverDrives", "the semantic driver drives", 0..from),
            ("SafetyDriverDrives", "the safety driver drives", from..end),
        ];
        for (class, name, frames) in parts.into_iter().filter(|(.., frames)| !frames.is_empty()) {
            let uid = self.actions.len() as u32;
            let frame_intervals = vec![Interval { frame_start: frames.start, frame_end: frames.end - 1 }];
            let element = Element { name: name.into(), r#type: class.into(), frame_intervals, ..Element::default() };
            self.actions.insert(uid, element);
            for (_, frame) in tracks.frames.range_mut(frames) {
                frame.actions.insert(uid, InFrame::default());
            }
        }
    }
}

/// The last frame that is not after a tick, or the first one.
fn frame_of(tick: Tick, tracks: &Tracks) -> u32 {
    let before = tracks.frames.iter().rev().find(|(_, frame)| frame.frame_properties.tick <= tick);
    before.map_or(0, |(number, _)| *number)
}

fn number(name: &'static str, val: f64) -> Value<f64> {
    Value { name, val }
}

fn happened(tick: Tick, event: &Event) -> Element {
    let num = vec![number("tick", tick as f64), number("ego_speed_mps", event.speed_mps.into())];
    let event_data = Data { num, ..Data::default() };
    Element { name: words::event(event), r#type: format!("{:?}", event.kind), event_data, ..Element::default() }
}

/// What the operators said of a corner case, and what would have happened without its takeover.
fn corner_case(log: &Log, tick: Tick, verdict: Option<&Counterfactual>) -> Element {
    let mut event_data = Data { num: vec![number("tick", tick as f64)], ..Data::default() };
    let mut text = |name, val: &str| event_data.text.push(Value { name, val: val.to_owned() });
    if let Some(said) = &log.annotation {
        text("label", said.label.name());
        if !said.comment.is_empty() {
            text("comment", &said.comment);
        }
    }
    if let Some(found) = verdict {
        text("verdict", found.verdict.name());
    }
    let mut boolean = |name, val| event_data.boolean.push(Value { name, val });
    if let Some(caused) = log.annotation.as_ref().and_then(|said| said.perception_caused) {
        boolean("perception_caused", caused);
    }
    if let Some(intervention) = log.intervention {
        boolean("by_brake", intervention.by_brake);
        boolean("by_steering", intervention.by_steering);
    }
    Element { name: "corner case".into(), r#type: "CornerCase".into(), event_data, ..Element::default() }
}
