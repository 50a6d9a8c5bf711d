//! What happened in a tick, and what the HUD shows.

use crate::light::LightPhase;
use crate::map_data::Turn;
use crate::{state, state_enum};

state_enum! {
    /// What kind of event.
    pub enum EventKind {
        /// The ego car began to touch an actor; `actor` names it.
        CollisionActor = 0,
        /// The ego car began to touch a static object.
        CollisionScenery = 1,
        /// The ego car passed a stop line at red.
        RedLight = 2,
        /// The ego car began to exceed the limit by more than 3 km/h.
        Speeding = 3,
        /// A wheel of the ego car left road and parking lanes.
        OffRoad = 4,
        /// The ego car began to drive against the direction of its lane.
        WrongWay = 5,
        /// The run is armed: from now on the safety driver's action counts as an intervention.
        Armed = 6,
        /// The safety driver intervened.
        Intervention = 7,
        /// A driver pressed the "I see it" button.
        Seen = 8,
        /// The run ended.
        Ended = 9,
        /// A vehicle of traffic has stood for a minute without a reason; `actor` names it. A fault of the simulation.
        Stuck = 10,
        /// It was taken off the road because of that and enters the map elsewhere; `actor` names it. Counts as a failure.
        Dissolved = 11,
        /// A vehicle began to drive through a light that turns red; `actor` names it, as in those that follow.
        HazardRedLight = 12,
        /// It rolls over the line of a stop sign.
        HazardRollingStop = 13,
        /// It brakes hard for no reason.
        HazardBraking = 14,
        /// It changes lanes right before somebody.
        HazardCutIn = 15,
        /// It drives off from the kerb without a look.
        HazardPullOut = 16,
        /// It ran into another vehicle, or that into it.
        HazardCollision = 17,
        /// A door of a parked car begins to open into a lane; `actor` names the door.
        HazardDoor = 18,
    }
}

state! {
    /// An event of the ego car, or one of other vehicles: what the watchdog tells, and their mistakes.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Event {
        /// What happened.
        pub kind: EventKind,
        /// The other actor's id, or 0.
        pub actor: u32,
        /// Speed of the ego car, m/s.
        pub speed_mps: f32,
    }
}

state! {
    /// The navigation arrow of the HUD.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct RouteArrow {
        /// Which way the route leads at the junction ahead.
        pub turn: Turn,
        /// Distance to that junction in whole metres; 0 inside it.
        pub distance_m: u16,
        /// Bearing of the route 12 m ahead relative to the car in degrees, positive to the right,
        /// in steps of 5.
        pub bearing_deg: i16,
    }
}

state! {
    /// What the HUD of both drivers is drawn from.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Hud {
        /// Speed of the ego car, m/s.
        pub speed_mps: f32,
        /// Speed limit, m/s; at most [`Rules::max_speed_kmh`](crate::scenario::Rules).
        pub limit_mps: f32,
        /// Phase of the next traffic light on the route, within 50 m or from where people have to be able to see it:
        /// 84 m at 50 km/h.
        pub light: Option<LightPhase>,
        /// Distance to its stop line in whole metres; 0 when there is none.
        pub light_distance_m: u16,
        /// The navigation arrow.
        pub arrow: RouteArrow,
    }
}
