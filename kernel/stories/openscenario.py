"""A story as OpenSCENARIO XML 1.2: places, actions and conditions by their names, and who plays. Angles are radians, lengths metres."""

from xml.sax.saxutils import quoteattr


def tag(name, /, *inner, **attributes):
    """An element."""
    told = "".join(f" {key}={quoteattr(str(value))}" for key, value in attributes.items())
    return f"<{name}{told}>{''.join(inner)}</{name}>" if inner else f"<{name}{told}/>"


# Places. Angles are radians, counter-clockwise.


def on_lane(road, lane, s, offset=0, turned=0):
    facing = tag("Orientation", type="relative", h=turned)
    return tag("LanePosition", facing, roadId=road, laneId=lane, s=s, offset=offset)


def on_road(road, s, t, turned=0):
    return tag("RoadPosition", tag("Orientation", type="relative", h=turned), roadId=road, s=s, t=t)


def world(x, y, heading):
    """A place in the coordinates of the map's file, metres."""
    return tag("WorldPosition", x=x, y=y, z=0, h=heading)


# Actions.


def teleport(place):
    return tag("TeleportAction", tag("Position", place))


def speed(mps, shape="step", dimension="time", value=0):
    """A speed that is reached at once, in a time or with a rate."""
    how = tag("SpeedActionDynamics", dynamicsShape=shape, value=value, dynamicsDimension=dimension)
    return tag("LongitudinalAction", tag("SpeedAction", how, tag("SpeedActionTarget", tag("AbsoluteTargetSpeed", value=mps))))


def as_fast_as(entity, delta=0, continuous=True):
    how = tag("SpeedActionDynamics", dynamicsShape="step", value=0, dynamicsDimension="time")
    target = tag(
        "RelativeTargetSpeed",
        entityRef=entity,
        value=delta,
        speedTargetValueType="delta",
        continuous=str(continuous).lower(),
    )
    return tag("LongitudinalAction", tag("SpeedAction", how, tag("SpeedActionTarget", target)))


def gap(entity, metres, side):
    limits = tag("DynamicConstraints", maxAcceleration=4, maxDeceleration=6, maxSpeed=40)
    action = tag(
        "LongitudinalDistanceAction",
        limits,
        entityRef=entity,
        distance=metres,
        freespace="true",
        continuous="true",
        coordinateSystem="entity",
        displacement=side,
    )
    return tag("LongitudinalAction", action)


def lane_change(lane, seconds, offset=0):
    how = tag("LaneChangeActionDynamics", dynamicsShape="sinusoidal", value=seconds, dynamicsDimension="time")
    target = tag("LaneChangeTarget", tag("AbsoluteTargetLane", value=lane))
    return tag("LateralAction", tag("LaneChangeAction", how, target, targetLaneOffset=offset))


def aside(metres, most_mps2=2):
    how = tag("LaneOffsetActionDynamics", dynamicsShape="sinusoidal", maxLateralAcc=most_mps2)
    target = tag("LaneOffsetTarget", tag("AbsoluteTargetLaneOffset", value=metres))
    return tag("LateralAction", tag("LaneOffsetAction", how, target, continuous="false"))


def along(*places):
    """A line that is followed at the own speed."""
    corners = "".join(tag("Vertex", tag("Position", place), time=0) for place in places)
    line = tag("Trajectory", tag("Shape", tag("Polyline", corners)), name="line", closed="false")
    return tag(
        "RoutingAction",
        tag(
            "FollowTrajectoryAction",
            line,
            tag("TimeReference", tag("None")),
            tag("TrajectoryFollowingMode", followingMode="position"),
        ),
    )


def route(*places):
    points = "".join(tag("Waypoint", tag("Position", place), routeStrategy="shortest") for place in places)
    return tag("RoutingAction", tag("AssignRouteAction", tag("Route", points, name="way", closed="false")))


def meets(master, their_place, own_place, mps):
    """Arrives at a place when another does at its own."""
    last = tag("FinalSpeed", tag("AbsoluteSpeed", value=mps))
    theirs, own = tag("TargetPositionMaster", their_place), tag("TargetPosition", own_place)
    return tag(
        "SynchronizeAction", theirs, own, last, masterEntityRef=master, targetToleranceMaster=1, targetTolerance=1
    )


# Conditions.


def when(condition, delay=0, edge="none"):
    return tag("ConditionGroup", tag("Condition", condition, name="cue", delay=delay, conditionEdge=edge))


def at_once():
    return when(tag("ByValueCondition", tag("SimulationTimeCondition", value=-1, rule="greaterThan")))


def of(entity, condition, **delayed):
    who = tag("TriggeringEntities", tag("EntityRef", entityRef=entity), triggeringEntitiesRule="any")
    return when(tag("ByEntityCondition", who, tag("EntityCondition", condition)), **delayed)


def headway(entity, seconds, who="Ego"):
    """Somebody is so many seconds from where another is now, along its own heading."""
    return of(
        who,
        tag(
            "TimeHeadwayCondition",
            entityRef=entity,
            value=seconds,
            freespace="true",
            coordinateSystem="entity",
            relativeDistanceType="longitudinal",
            rule="lessThan",
        ),
    )


def distance(entity, metres, rule="lessThan", who="Ego", along_heading=True):
    kind = "longitudinal" if along_heading else "euclidianDistance"
    return of(
        who,
        tag(
            "RelativeDistanceCondition",
            entityRef=entity,
            value=metres,
            freespace="true",
            coordinateSystem="entity",
            relativeDistanceType=kind,
            rule=rule,
        ),
    )


def travelled(metres, who="Ego", **delayed):
    return of(who, tag("TraveledDistanceCondition", value=metres), **delayed)


def stands_near(who, metres, entity="Ego"):
    """Somebody stands within so many metres of another."""
    near = distance(entity, metres, who=who, along_heading=False)
    stands = of(entity, tag("SpeedCondition", value=0.5, rule="lessThan"))
    return near.removesuffix("</ConditionGroup>") + stands.removeprefix("<ConditionGroup>")


def after(event, delay=0):
    """So long after an event is over."""
    state = tag(
        "StoryboardElementStateCondition",
        storyboardElementType="event",
        storyboardElementRef=event,
        state="completeState",
    )
    return when(tag("ByValueCondition", state), delay=delay)


# Who plays.

SIZES = {
    "car": (4.5, 1.8, 1.5),
    "van": (5.5, 2.0, 2.4),
    "truck": (9.0, 2.5, 3.5),
    "bus": (12.0, 2.55, 3.1),
    "motorbike": (2.2, 0.8, 1.5),
    "bicycle": (1.8, 0.6, 1.7),
}
PEOPLE = {"adult": (0.5, 0.6, 1.75), "child": (0.4, 0.5, 1.3), "wheelchair": (1.2, 0.7, 1.4)}


def box(length, width, height):
    size = tag("Dimensions", width=width, length=length, height=height)
    return tag("BoundingBox", tag("Center", x=0, y=0, z=height / 2), size)


def entity(name, kind):
    if kind in PEOPLE:
        category = "wheelchair" if kind == "wheelchair" else "pedestrian"
        body = tag(
            "Pedestrian",
            box(*PEOPLE[kind]),
            tag("Properties"),
            name=kind,
            model=kind,
            mass=35 if kind == "child" else 75,
            pedestrianCategory=category,
        )
        return tag("ScenarioObject", body, name=name)
    length, width, height = SIZES[kind]
    wheel = min(0.7, height / 2)
    axle = {"wheelDiameter": wheel, "trackWidth": width, "positionZ": wheel / 2}
    axles = tag(
        "Axles",
        tag("FrontAxle", maxSteering=0.6, positionX=length * 0.3, **axle),
        tag("RearAxle", maxSteering=0, positionX=-length * 0.3, **axle),
    )
    told = tag("Properties", tag("Property", name="type", value="ego_vehicle")) if name == "Ego" else tag("Properties")
    limits = tag("Performance", maxSpeed=70, maxAcceleration=10, maxDeceleration=10)
    body = tag("Vehicle", box(length, width, height), limits, axles, told, name=kind, vehicleCategory=kind)
    return tag("ScenarioObject", body, name=name)


class Story:
    """A story: who plays, how it begins, and what happens."""

    # Then all is over, seconds.
    lasts_s = 30

    def __init__(self, name, map_name, about, **ranges):
        self.name, self.map, self.about, self.ranges = name, map_name, about, ranges
        self.cast, self.init, self.events, self.globals = [], [], {}, []

    def plays(self, name, kind, place, mps=0, *more):
        """Somebody, and where it begins as fast as what."""
        self.cast.append(entity(name, kind))
        actions = "".join(tag("PrivateAction", action) for action in (teleport(place), speed(mps), *more))
        self.init.append(tag("Private", actions, entityRef=name))
        return self

    def ego(self, road, lane, s, mps, *more):
        return self.plays("Ego", "car", on_lane(road, lane, s), mps, *more)

    def does(self, who, cue, *actions, name=None):
        """What somebody does on a cue; more than one thing at the same time."""
        events = self.events.setdefault(who, [])
        name = name or f"{who} {len(events) + 1}"
        done = "".join(tag("Action", tag("PrivateAction", action), name=f"{name} {k}") for k, action in enumerate(actions, 1))
        events.append(tag("Event", done, tag("StartTrigger", cue), name=name, priority="parallel", maximumExecutionCount=1))
        return self

    def light(self, signal, state):
        action = tag("TrafficSignalAction", tag("TrafficSignalStateAction", name=signal, state=state))
        self.globals.append(tag("GlobalAction", tag("InfrastructureAction", action)))
        return self

    def weather(self, sun_rad=0.6, clouds="twoOktas", fog_m=100000, rain_mm_h=0, wetness="dry", friction=1):
        """The sun's height, clouds, how far one sees, rain, and how wet the road is."""
        weather = tag(
            "Weather",
            tag("Sun", azimuth=3.5, elevation=sun_rad, illuminance=10 if sun_rad < 0 else 50000),
            tag("Fog", visualRange=fog_m),
            tag("Precipitation", precipitationType="rain" if rain_mm_h else "dry", precipitationIntensity=rain_mm_h),
            fractionalCloudCover=clouds,
        )
        time = tag("TimeOfDay", animation="false", dateTime="2026-11-01T22:00:00" if sun_rad < 0 else "2026-06-01T14:00:00")
        road = tag("RoadCondition", frictionScaleFactor=friction, wetness=wetness)
        self.globals.insert(0, tag("GlobalAction", tag("EnvironmentAction", tag("Environment", time, weather, road, name="weather"))))
        return self

    def text(self):
        def declared(name, low, high):
            bounds = tag("ValueConstraint", rule="greaterOrEqual", value=low) + tag(
                "ValueConstraint", rule="lessOrEqual", value=high
            )
            middle = round((low + high) / 2, 3)
            return tag("ParameterDeclaration", tag("ConstraintGroup", bounds), name=name, parameterType="double", value=middle)

        parameters = "\n".join(declared(name, *bounds) for name, bounds in self.ranges.items())
        groups = "\n".join(
            tag(
                "ManeuverGroup",
                tag("Actors", tag("EntityRef", entityRef=who), selectTriggeringEntities="false"),
                "\n" + tag("Maneuver", "\n" + "\n".join(events) + "\n", name=f"of {who}") + "\n",
                name=f"group of {who}",
                maximumExecutionCount=1,
            )
            for who, events in self.events.items()
        ) or tag("ManeuverGroup", tag("Actors", selectTriggeringEntities="false"), name="nobody", maximumExecutionCount=1)
        head = tag("FileHeader", revMajor=1, revMinor=2, date="2026-01-01T00:00:00", description=self.about, author="A-Eye")
        return f"""<?xml version="1.0" encoding="UTF-8"?>
<OpenSCENARIO>
{head}
<ParameterDeclarations>
{parameters}
</ParameterDeclarations>
<CatalogLocations/>
<RoadNetwork><LogicFile filepath="{self.map}.xodr"/></RoadNetwork>
<Entities>
{chr(10).join(self.cast)}
</Entities>
<Storyboard>
<Init><Actions>
{chr(10).join(self.globals + self.init)}
</Actions></Init>
<Story name="{self.name}"><Act name="act">
{groups}
<StartTrigger>{at_once()}</StartTrigger></Act></Story>
<StopTrigger>{when(tag("ByValueCondition", tag("SimulationTimeCondition", value=self.lasts_s, rule="greaterThan")))}</StopTrigger>
</Storyboard>
</OpenSCENARIO>
"""
