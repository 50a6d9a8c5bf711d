//! Stories as they are played: on a straight road of two lanes each way.

mod actions;
mod conditions;
mod interruptions;
mod library;
mod lights;
mod reading;
mod ways;
mod worlds;

use std::sync::{Arc, OnceLock};

use crate::RoadNetwork;
use crate::controls::TickInput;
use crate::map::bake;
use crate::scenario::{HazardLevel, Scenario};
use crate::scene::ActorScene;
use crate::story::Story;
use crate::time::Tick;
use crate::traffic::TrafficCounts;
use crate::world::World;

/// A road of 1000 m along the x axis, two lanes of 3.5 m in each direction.
pub const ROAD: &str = r#"<?xml version="1.0"?>
<OpenDRIVE><header revMajor="1" revMinor="6"/>
<road name="" length="1000" id="7" junction="-1">
<planView><geometry s="0" x="0" y="0" hdg="0" length="1000"><line/></geometry></planView>
<lanes><laneSection s="0">
<left>
<lane id="2" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane>
<lane id="1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane>
</left>
<center><lane id="0" type="none"/></center>
<right>
<lane id="-1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane>
<lane id="-2" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane>
</right>
</laneSection></lanes></road></OpenDRIVE>"#;

pub fn road() -> &'static Arc<RoadNetwork> {
    static MAP: OnceLock<Arc<RoadNetwork>> = OnceLock::new();
    MAP.get_or_init(|| Arc::new(bake("road", ROAD).expect("it is a road")))
}

/// A car that begins on a lane at some speed.
pub fn begins(name: &str, lane: i32, s_m: f32, mps: f32) -> String {
    format!(
        r#"<Private entityRef="{name}">
<PrivateAction><TeleportAction><Position><LanePosition roadId="7" laneId="{lane}" s="{s_m}"/></Position></TeleportAction></PrivateAction>
<PrivateAction><LongitudinalAction><SpeedAction><SpeedActionDynamics dynamicsShape="step" value="0" dynamicsDimension="time"/>
<SpeedActionTarget><AbsoluteTargetSpeed value="{mps}"/></SpeedActionTarget></SpeedAction></LongitudinalAction></PrivateAction>
</Private>"#
    )
}

/// A speed that is reached.
pub fn speed(shape: &str, value: f32, dimension: &str, mps: f32) -> String {
    format!(
        r#"<PrivateAction><LongitudinalAction><SpeedAction>
<SpeedActionDynamics dynamicsShape="{shape}" value="{value}" dynamicsDimension="{dimension}"/>
<SpeedActionTarget><AbsoluteTargetSpeed value="{mps}"/></SpeedActionTarget>
</SpeedAction></LongitudinalAction></PrivateAction>"#
    )
}

/// A condition of time.
pub fn after(seconds: f32) -> String {
    format!(
        r#"<ConditionGroup><Condition name="" delay="0" conditionEdge="none"><ByValueCondition>
<SimulationTimeCondition value="{seconds}" rule="greaterThan"/></ByValueCondition></Condition></ConditionGroup>"#
    )
}

/// A condition of an entity.
pub fn when(name: &str, edge: &str, condition: &str) -> String {
    format!(
        r#"<ConditionGroup><Condition name="" delay="0" conditionEdge="{edge}"><ByEntityCondition>
<TriggeringEntities triggeringEntitiesRule="any"><EntityRef entityRef="{name}"/></TriggeringEntities>
<EntityCondition>{condition}</EntityCondition></ByEntityCondition></Condition></ConditionGroup>"#
    )
}

/// An event of a name.
pub fn event(name: &str, action: &str, trigger: &str) -> String {
    format!(
        r#"<Event name="{name}" priority="overwrite"><Action name="of {name}">{action}</Action>
<StartTrigger>{trigger}</StartTrigger></Event>"#
    )
}

/// A story of the ego car, a car `Other` and somebody on foot `Walker`.
pub fn text(init: &str, events: &str) -> String {
    format!(
        r#"<?xml version="1.0"?>
<OpenSCENARIO><FileHeader revMajor="1" revMinor="0" date="2026-01-01T00:00:00" description="" author=""/>
<ParameterDeclarations><ParameterDeclaration name="fast" parameterType="double" value="20"/></ParameterDeclarations>
<CatalogLocations/>
<RoadNetwork><LogicFile filepath="road.xodr"/></RoadNetwork>
<Entities>
<ScenarioObject name="Ego"><Vehicle name="car" vehicleCategory="car"><BoundingBox/><Performance maxSpeed="69" maxDeceleration="10" maxAcceleration="10"/><Axles/><Properties/></Vehicle></ScenarioObject>
<ScenarioObject name="Other"><Vehicle name="car" vehicleCategory="car"/></ScenarioObject>
<ScenarioObject name="Walker"><Pedestrian name="child" model="child" mass="30" pedestrianCategory="pedestrian"/></ScenarioObject>
</Entities>
<Storyboard><Init><Actions>{init}
<Private entityRef="Walker"><PrivateAction><TeleportAction><Position><WorldPosition x="900" y="30" z="0" h="0"/></Position></TeleportAction></PrivateAction></Private>
</Actions></Init>
<Story name="story"><Act name="act"><ManeuverGroup name="group" maximumExecutionCount="1">
<Actors selectTriggeringEntities="false"><EntityRef entityRef="Other"/></Actors>
<Maneuver name="manoeuvre">{events}</Maneuver></ManeuverGroup>
<StartTrigger>{start}</StartTrigger></Act></Story>
<StopTrigger/></Storyboard></OpenSCENARIO>"#,
        start = after(0.0)
    )
}

pub fn scenario(text: &str) -> Scenario {
    let story = Story::read(text).unwrap_or_else(|error| panic!("{error}"));
    Scenario {
        traffic: TrafficCounts::NONE,
        hazards: HazardLevel::None.rates(),
        story: Some(Arc::new(story)),
        ..Scenario::default_for("road", 1)
    }
}

/// The world of a story on the road.
pub fn world(text: &str) -> World {
    World::new(&scenario(text), road()).unwrap_or_else(|error| panic!("{error}"))
}

/// A world in which the ego car stands at 500 m of its road, and `Other` drives from 100 m on at 10 m/s.
pub fn played(events: &str) -> World {
    world(&text(&(begins("Ego", -2, 500.0, 0.0) + &begins("Other", -1, 100.0, 10.0)), events))
}

/// Goes on for some seconds without controls.
pub fn go_on(world: &mut World, seconds: f32) {
    (0..(seconds * 60.0) as Tick).for_each(|_| drop(world.step(&TickInput::default())));
}

pub fn other(world: &World) -> ActorScene {
    let other = super::FIRST_STORY_ID + 1;
    *world.scene().actors.iter().find(|actor| actor.id == other).expect("it plays")
}
