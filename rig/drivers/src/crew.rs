//! The two simulated drivers at their screens.

use kernel::events::EventKind;
use kernel::{TickInput, World};
use replay::{Label, MaskShown};

use crate::safety::{SafetyBot, label_of};
use crate::semantic::SemanticBot;
use crate::vision::Vision;
use crate::{Driver, SemanticView};

/// Both seats taken by bots.
pub struct Crew {
    vision: Vision,
    semantic: SemanticBot,
    safety: SafetyBot,
}

impl Crew {
    /// Takes the seats.
    pub fn new(vision: Vision) -> Self {
        Self::with(vision, SafetyBot::default())
    }

    /// Takes the seats, with this safety driver.
    pub fn with(vision: Vision, safety: SafetyBot) -> Self {
        Self { vision, semantic: SemanticBot::default(), safety }
    }

    /// Both drivers' controls for the next tick, and what the semantic driver saw.
    pub fn act(&mut self, world: &World) -> anyhow::Result<(TickInput, MaskShown)> {
        let (mask, mut shown) = self.vision.look(world)?;
        shown.tick_shown += 1;
        let semantic = self.semantic.controls(&SemanticView { mask, hud: world.hud() });
        let safety = self.safety.controls(world);
        Ok((TickInput { semantic, safety }, shown))
    }

    /// What the truth says about how the run went wrong: label and comment.
    pub fn cause(&self, world: &World) -> Option<(Label, String)> {
        cause(&self.safety, world)
    }

    /// Leaves the seats.
    pub fn into_vision(self) -> Vision {
        self.vision
    }
}

/// What the truth says about how a run went wrong: why the safety driver took over, or what was hit.
pub fn cause(safety: &SafetyBot, world: &World) -> Option<(Label, String)> {
    if let Some(hazard) = safety.reason() {
        return Some((hazard.label, hazard.comment.clone()));
    }
    let hit = world.last_events().iter().find_map(|e| match e.kind {
        EventKind::CollisionActor => Some(e.actor),
        EventKind::CollisionScenery => Some(0),
        _ => None,
    })?;
    let scene = world.scene();
    let actor = scene.actors.iter().find(|a| a.id == hit);
    Some(match actor {
        Some(actor) => (label_of(actor.kind), format!("collision with actor {hit}")),
        None => (Label::Rules, "collision with scenery".into()),
    })
}
