//! The simulated drivers at their screens.

use kernel::events::EventKind;
use kernel::{Seat, TickInput, World};
use replay::{Label, MaskShown};

use crate::readout::Readout;
use crate::safety::{SafetyBot, label_of};
use crate::semantic::SemanticBot;
use crate::vision::Vision;
use crate::{Driver, MaskView, SemanticView};

/// Bots in both seats, or in the one that nobody else has.
#[derive(Clone, Debug)]
pub struct Bots {
    semantic: Option<SemanticBot>,
    safety: Option<SafetyBot>,
}

impl Bots {
    /// In both seats.
    pub fn both(semantic: SemanticBot, safety: SafetyBot) -> Self {
        Self { semantic: Some(semantic), safety: Some(safety) }
    }

    /// Beside somebody else's seat in the run of a seed.
    pub fn beside(seat: Seat, seed: u64) -> Self {
        match seat {
            Seat::Semantic => Self { semantic: None, safety: Some(SafetyBot::drawn(seed)) },
            Seat::Safety => Self { semantic: Some(SemanticBot::drawn(seed)), safety: None },
        }
    }

    /// Whether one of them drives by the mask.
    pub fn needs_mask(&self) -> bool {
        self.semantic.is_some()
    }

    /// Puts the controls of their seats for the next tick in place. Without a mask the semantic one does nothing.
    pub fn act(&mut self, world: &World, mask: Option<MaskView<'_>>, input: &mut TickInput) {
        if let (Some(bot), Some(mask)) = (&mut self.semantic, mask) {
            input.semantic = bot.controls(&SemanticView { mask, hud: Readout::of(&world.hud()) });
        }
        if let Some(bot) = &mut self.safety {
            input.safety = bot.controls(world);
        }
    }

    /// What the truth says about how the run went wrong: label and comment.
    pub fn cause(&self, world: &World) -> Option<(Label, String)> {
        self.safety.as_ref().map_or_else(|| collision(world), |safety| cause(safety, world))
    }
}

/// Both seats taken by bots, and what the semantic one sees.
pub struct Crew {
    vision: Vision,
    bots: Bots,
}

impl Crew {
    /// Takes the seats in the run of a seed.
    pub fn drawn(vision: Vision, seed: u64) -> Self {
        Self::of(vision, SemanticBot::drawn(seed), SafetyBot::drawn(seed))
    }

    /// Takes the seats.
    pub fn of(vision: Vision, semantic: SemanticBot, safety: SafetyBot) -> Self {
        Self { vision, bots: Bots::both(semantic, safety) }
    }

    /// Both drivers' controls for the next tick, and what the semantic driver saw.
    pub fn act(&mut self, world: &World) -> anyhow::Result<(TickInput, MaskShown)> {
        let (mask, mut shown) = self.vision.look(world)?;
        shown.tick_shown += 1;
        let mut input = TickInput::default();
        self.bots.act(world, Some(mask), &mut input);
        Ok((input, shown))
    }

    /// What the truth says about how the run went wrong: label and comment.
    pub fn cause(&self, world: &World) -> Option<(Label, String)> {
        self.bots.cause(world)
    }

    /// Leaves the seats.
    pub fn into_vision(self) -> Vision {
        self.vision
    }
}

/// What the truth says about how a run went wrong: why the safety driver took over, or what was hit.
pub fn cause(safety: &SafetyBot, world: &World) -> Option<(Label, String)> {
    match safety.reason() {
        Some(hazard) => Some((hazard.label, hazard.comment.clone())),
        None => collision(world),
    }
}

/// What was hit in the last tick.
fn collision(world: &World) -> Option<(Label, String)> {
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
