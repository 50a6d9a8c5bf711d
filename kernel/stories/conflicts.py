"""Provoked accidents: conflicts that end in a collision when the ego car drives on, and in none when somebody looks out; what varies
from draw to draw are parameters with ranges. After the cases of Euro NCAP's test protocols (AEB C2C, AEB/LSS VRU) and UN Regulation 157,
on roads of the bundled maps.
"""

from openscenario import (
    Story,
    after,
    along,
    as_fast_as,
    aside,
    at_once,
    distance,
    gap,
    headway,
    lane_change,
    meets,
    on_lane,
    on_road,
    route,
    speed,
    stands_near,
    travelled,
    world,
)

# A straight village street of 380 m, 50 km/h: lanes of 3.5 m, a strip of 0.5 m and a pavement of 2 m on each side.
VILLAGE = "1760"
# The middle of the lane of whoever drives along the road's line.
LANE_T = -1.75
QUARTER_TURN, HALF_TURN = 1.5708, 3.14159


def village(name, about, s=40, mps=(11.0, 13.5), **ranges):
    """A story in the village; the ego car drives along its line."""
    story = Story(name, "motorway", about, ego_mps=mps, **ranges)
    return story.ego(VILLAGE, -1, s, "$ego_mps")


def crosses(story, who, kind, road, s, t_from, t_to, t_hit, walk, turned=None):
    """Somebody who sets off across the road so that the ego car, if it drives on, finds them at a place across it."""
    facing = turned if turned is not None else (QUARTER_TURN if t_to > t_from else -QUARTER_TURN)
    story.plays(who, kind, on_road(road, s, t_from, facing))
    takes = f"{abs(t_hit - t_from)} / ${walk}"
    line = along(on_road(road, s, t_from), on_road(road, s, t_to))
    return story.does(who, headway(who, f"${{{takes} + $off_s}}"), speed(f"${walk}"), line)


def child_from_behind_bus():
    story = village(
        "child_from_behind_bus",
        "A child walks onto the road from behind a bus that stands in a bay (after Euro NCAP CPNCO-50)",
        walk_mps=(1.2, 1.6),
        off_s=(-0.3, 0.1),
    )
    story.plays("Bus", "bus", on_road(VILLAGE, 186, -5.4))
    return crosses(story, "Child", "child", VILLAGE, 194, -6.4, 6, -1.2, "walk_mps")


def child_between_parked_cars():
    story = village(
        "child_between_parked_cars",
        "A child runs onto the road between two cars parked on the pavement (after Euro NCAP CPNCO-50)",
        walk_mps=(1.6, 2.0),
        off_s=(-0.2, 0.1),
    )
    story.plays("Car", "car", on_road(VILLAGE, 187, -5.4)).plays("Van", "van", on_road(VILLAGE, 180, -5.4))
    return crosses(story, "Child", "child", VILLAGE, 190.5, -7.0, 6, -1.1, "walk_mps")


def adult_from_the_right():
    story = village(
        "adult_from_the_right",
        "An adult walks onto the road from the near side without looking (Euro NCAP CPNA)",
        walk_mps=(1.2, 1.7),
        off_s=(-0.3, 0.2),
    )
    return crosses(story, "Adult", "adult", VILLAGE, 190, -6.0, 6, -1.5, "walk_mps")


def adult_runs_from_the_left():
    story = village(
        "adult_runs_from_the_left",
        "An adult runs onto the road from the far side (Euro NCAP CPFA)",
        walk_mps=(1.9, 2.5),
        off_s=(-0.3, 0.2),
    )
    return crosses(story, "Adult", "adult", VILLAGE, 190, 6.0, -6, -1.9, "walk_mps")


def wheelchair_crosses():
    story = village(
        "wheelchair_crosses", "Somebody in a wheelchair crosses where nobody expects it", walk_mps=(0.9, 1.2), off_s=(-0.4, 0.4)
    )
    return crosses(story, "Wheelchair", "wheelchair", VILLAGE, 190, -5.0, 6, -1.75, "walk_mps")


def adult_turns_back():
    story = village(
        "adult_turns_back",
        "An adult crosses from the far side, has passed the lane, and comes back onto it",
        walk_mps=(1.3, 1.7),
        off_s=(-0.2, 0.2),
    )
    story.plays("Adult", "adult", on_road(VILLAGE, 190, 4, -QUARTER_TURN))
    line = along(on_road(VILLAGE, 190, 4), on_road(VILLAGE, 190, -4.5), on_road(VILLAGE, 190, 4))
    # Down to 4.5 m on the right, and back to 1.5 m.
    return story.does("Adult", headway("Adult", "${(8.5 + 3) / $walk_mps + $off_s}"), speed("$walk_mps"), line)


def people_at_night():
    story = village(
        "people_at_night",
        "Two adults walk onto the road at night, one after the other (Euro NCAP CPNA at night)",
        mps=(9.0, 11.0),
        walk_mps=(1.2, 1.6),
        off_s=(-0.3, 0.2),
    )
    story.weather(sun_rad=-0.4, clouds="sevenOktas")
    crosses(story, "First", "adult", VILLAGE, 190, -6.0, 6, -0.9, "walk_mps")
    return crosses(story, "Second", "adult", VILLAGE, 191.2, -6.8, 6, -1.7, "walk_mps")


def adult_along_the_lane_at_night():
    story = village(
        "adult_along_the_lane_at_night",
        "An adult walks along the lane at night, with the back to traffic (Euro NCAP CPLA)",
        walk_mps=(0.9, 1.5),
        off_m=(-0.6, 0.2),
    )
    story.weather(sun_rad=-0.4)
    return story.plays("Adult", "adult", on_lane(VILLAGE, -1, 180, "$off_m"), "$walk_mps")


def cyclist_crosses():
    story = Story(
        "cyclist_crosses",
        "motorway",
        "A cyclist rides across the road from the near side (Euro NCAP CBNA)",
        ego_mps=(11.0, 13.5),
        ride_mps=(3.5, 4.5),
        off_s=(-0.3, 0.1),
    )
    story.ego("1597", -1, 12, "$ego_mps")
    return crosses(story, "Cyclist", "bicycle", "1597", 130, -16, 14, -1.0, "ride_mps")


def cyclist_swerves():
    story = village(
        "cyclist_swerves",
        "A cyclist at the edge of the lane swings out before a parked car",
        ride_mps=(3.5, 4.5),
        ahead_s=(1.9, 2.4),
    )
    story.plays("Parked", "car", on_road(VILLAGE, 215, -4.2))
    story.plays("Cyclist", "bicycle", on_lane(VILLAGE, -1, 150, -1.5), "$ride_mps")
    return story.does("Cyclist", headway("Cyclist", "$ahead_s"), aside(0.1, 3))


def cyclist_along_the_lane_at_night():
    story = village(
        "cyclist_along_the_lane_at_night",
        "A cyclist rides in the lane at night in the rain (Euro NCAP CBLA)",
        mps=(10.0, 12.5),
        ride_mps=(3.0, 4.5),
        off_m=(-0.7, 0.0),
    )
    story.weather(sun_rad=-0.4, clouds="eightOktas", rain_mm_h=10, wetness="moist")
    return story.plays("Cyclist", "bicycle", on_lane(VILLAGE, -1, 140, "$off_m"), "$ride_mps")


def pulls_out_from_the_kerb():
    story = village(
        "pulls_out_from_the_kerb",
        "A car pulls out from the kerb before the ego car",
        pull_mps=(2.5, 4.0),
        ahead_s=(2.3, 2.9),
    )
    story.plays("Car", "car", on_lane(VILLAGE, -1, 180, -2.9))
    return story.does("Car", headway("Car", "$ahead_s"), speed("$pull_mps", "linear", "rate", 3), lane_change(-1, 2.2))


def leader_brakes():
    story = village(
        "leader_brakes",
        "The car ahead brakes to a stand (Euro NCAP CCRb)",
        mps=(12.5, 13.5),
        gap_m=(14.0, 24.0),
        brake_mps2=(4.0, 6.0),
    )
    story.plays("Leader", "car", on_lane(VILLAGE, -1, "${44.5 + $gap_m}"), "$ego_mps")
    return story.does("Leader", travelled(90, "Leader"), speed(0, "linear", "rate", "$brake_mps2"))


def oncoming_overtaker():
    story = village(
        "oncoming_overtaker",
        "A car that comes the other way overtakes a cyclist in the ego car's lane, and brakes late",
        mps=(11.5, 13.0),
        over_mps=(10.0, 12.0),
        late_s=(-0.4, 0.0),
    )
    story.plays("Cyclist", "bicycle", on_lane(VILLAGE, 1, 250, -0.6), 4)
    story.plays("Car", "car", on_lane(VILLAGE, 1, 330), "$over_mps")
    story.does("Car", headway("Car", 8), lane_change(-1, 2.0), name="out")
    story.does("Car", headway("Car", "${2.9 + $late_s}"), speed(0, "linear", "rate", 6), name="late")
    return story


def broken_down_at_night_in_rain():
    story = village(
        "broken_down_at_night_in_rain",
        "A broken-down car stands in the lane at night in the rain",
        mps=(10.0, 12.5),
        stands_m=(190.0, 230.0),
        off_m=(-0.5, 0.3),
    )
    story.weather(sun_rad=-0.4, clouds="eightOktas", rain_mm_h=20, wetness="wetWithPuddles")
    return story.plays("Car", "car", on_lane(VILLAGE, -1, "$stands_m", "$off_m"))


def reverses_onto_the_road():
    story = village(
        "reverses_onto_the_road",
        "A car comes backwards out of a drive, onto the road",
        back_mps=(1.5, 2.2),
        off_s=(-0.2, 0.3),
    )
    story.plays("Car", "car", on_road(VILLAGE, 190, -9.5, -QUARTER_TURN))
    line = along(on_road(VILLAGE, 190, -9.5, -QUARTER_TURN), on_road(VILLAGE, 190, -1.0, -QUARTER_TURN))
    # Its tail, 2.25 m behind its middle, comes to the far side of the lane.
    story.does("Car", headway("Car", "${5.9 / $back_mps + $off_s}"), speed("$back_mps"), line)
    return story.does("Car", stands_near("Car", 6), speed(0, "linear", "rate", 7))


def queue_behind_a_crest():
    story = Story(
        "queue_behind_a_crest",
        "lakeside",
        "The end of a queue stands behind the crest of a hill (UN R157: stationary vehicle)",
        ego_mps=(12.0, 13.8),
        queue_m=(725.0, 755.0),
    )
    story.ego("831", -1, 560, "$ego_mps")
    for k, kind in enumerate(["car", "van", "car"]):
        story.plays(f"Car{k}", kind, on_lane("831", -1, f"${{$queue_m + {7 * k}}}"))
    return story


def cut_in_and_brakes():
    story = Story(
        "cut_in_and_brakes",
        "lakeside",
        "A faster car cuts in close ahead and brakes (UN R157: cut-in)",
        ego_mps=(12.5, 13.8),
        gap_m=(4.0, 8.0),
        brake_mps2=(3.5, 5.5),
    )
    story.ego("638", -2, 240, "$ego_mps")
    story.plays("Car", "car", on_lane("638", -1, 238), 18)
    story.does("Car", distance("Ego", "$gap_m", rule="greaterThan", who="Car"), lane_change(-2, 1.8), as_fast_as("Ego", 1, False), name="in")
    return story.does("Car", after("in"), speed(0, "linear", "rate", "$brake_mps2"))


def cut_out():
    story = Story(
        "cut_out",
        "lakeside",
        "The van ahead leaves the lane before a car that stands in it (UN R157: cut-out)",
        ego_mps=(12.5, 13.5),
        late_m=(22.0, 28.0),
        gap_m=(16.0, 22.0),
    )
    story.ego("638", -2, 240, "$ego_mps")
    story.plays("Van", "van", on_lane("638", -2, "${245 + $gap_m}"), "$ego_mps")
    story.plays("Broken", "car", on_lane("638", -2, 420))
    story.does("Van", at_once(), gap("Ego", "$gap_m", "leadingReferencedEntity"))
    return story.does("Van", distance("Broken", "$late_m", who="Van"), lane_change(-1, 1.8))


def motorcycle_cuts_in():
    story = Story(
        "motorcycle_cuts_in",
        "lakeside",
        "A motorcycle cuts in and brakes",
        ego_mps=(12.5, 13.8),
        gap_m=(4.0, 7.0),
        brake_mps2=(4.0, 6.0),
    )
    story.ego("638", -2, 240, "$ego_mps")
    story.plays("Motorcycle", "motorbike", on_lane("638", -1, 239), 19)
    story.does(
        "Motorcycle",
        distance("Ego", "$gap_m", rule="greaterThan", who="Motorcycle"),
        lane_change(-2, 1.5),
        as_fast_as("Ego", 1, False),
        name="in",
    )
    return story.does("Motorcycle", after("in"), speed(0, "linear", "rate", "$brake_mps2"))


def wrong_way_driver():
    story = Story(
        "wrong_way_driver",
        "motorway",
        "A car comes towards the ego car in its own lane of the motorway, sees it, and brakes late",
        ego_mps=(12.5, 13.8),
        wrong_mps=(10.0, 14.0),
        sees_s=(1.7, 2.1),
    )
    story.ego("2", -2, 200, "$ego_mps")
    story.plays("Car", "car", on_lane("2", -2, 500, 0, HALF_TURN), "$wrong_mps")
    return story.does("Car", headway("Car", "${2 * $sees_s}"), speed(0, "linear", "rate", 7))


def crossing(name, about, ego, own_mps, who, kind, begins, at, straight_m, way, mps=None, **ranges):
    """A conflict in a junction of the city: somebody is timed to be at a place when the ego car is, and after some metres goes on as
    fast as it is then, or with a speed of its own."""
    story = Story(name, "city", about, ego_mps=(10.0, 12.0), run_mps=own_mps, **ranges)
    story.ego(*ego, "$ego_mps", route(on_lane(*ego), way))
    story.plays(who, kind, begins, "$run_mps")
    x, y, theirs, own = at
    own_place = own if isinstance(own, str) else world(x, y, own)
    story.does(who, at_once(), meets("Ego", world(f"${{{x} + $off_m}}", y, theirs), own_place, "$run_mps"))
    then = speed(mps, "linear", "rate", 3) if mps else as_fast_as(who, 0, False)
    story.does(who, travelled(straight_m, who), then)
    # Nobody drives on into a car that stands there.
    return story.does(who, stands_near(who, 9), speed(0, "linear", "rate", 7))


def red_light_runner():
    story = crossing(
        "red_light_runner",
        "A car runs a red light across the ego car's way (Euro NCAP CCCscp)",
        ("5", -1, 20),
        (8.0, 10.0),
        "Car",
        "car",
        on_lane("13", -1, 24),
        (143.6, 254.4, 0, QUARTER_TURN),
        62,
        way=on_lane("14", -1, 50),
        off_m=(-1.0, 2.0),
    )
    for signal, state in (("140", "green"), ("134", "green"), ("131", "red"), ("137", "red")):
        story.light(signal, state)
    return story


def stop_sign_runner():
    return crossing(
        "stop_sign_runner",
        "A van drives over a stop line across the ego car's way",
        ("3", -1, 15),
        (6.5, 8.5),
        "Van",
        "van",
        on_lane("11", -1, 30),
        (143.6, 126.25, 0, QUARTER_TURN),
        74.8,
        way=on_lane("12", -1, 40),
        off_m=(-1.0, 0.5),
    )


def turns_left_across():
    story = crossing(
        "turns_left_across",
        "An oncoming car turns left across the ego car's way (Euro NCAP CCFtap)",
        ("3", -1, 15),
        (3.5, 5.0),
        "Car",
        "car",
        on_lane("12", 1, 55),
        (143.5, 126.25, 0, -2.2),
        61,
        way=on_lane("12", -1, 40),
        off_m=(-1.0, 2.0),
    )
    way = route(on_lane("12", 1, 50), on_lane("11", 1, 60))
    return story.does("Car", at_once(), way)


def cyclist_at_the_right_turn():
    story = crossing(
        "cyclist_at_the_right_turn",
        "A cyclist on the path beside the road rides straight on where the ego car turns right (Euro NCAP CBTA)",
        ("5", -2, 20),
        (4.0, 5.0),
        "Cyclist",
        "bicycle",
        on_road("5", 48, -8),
        # When the ego car begins to turn, which takes it 2.7 s to the path.
        (129, 251.1, 0, world(126.5, 248, 0)),
        62,
        way=on_lane("13", 1, 50),
        mps="$run_mps",
        off_m=(-1.0, 1.0),
    )
    for signal in ("140", "134"):
        story.light(signal, "green")
    return story.does("Cyclist", at_once(), along(on_road("5", 48, -8), on_road("5", 115, -8), world(170, 248, 0)))


ALL = [
    make()
    for make in (
        child_from_behind_bus,
        child_between_parked_cars,
        adult_from_the_right,
        adult_runs_from_the_left,
        wheelchair_crosses,
        adult_turns_back,
        people_at_night,
        adult_along_the_lane_at_night,
        cyclist_crosses,
        cyclist_swerves,
        cyclist_along_the_lane_at_night,
        pulls_out_from_the_kerb,
        leader_brakes,
        oncoming_overtaker,
        broken_down_at_night_in_rain,
        reverses_onto_the_road,
        queue_behind_a_crest,
        cut_in_and_brakes,
        cut_out,
        motorcycle_cuts_in,
        wrong_way_driver,
        red_light_runner,
        stop_sign_runner,
        turns_left_across,
        cyclist_at_the_right_turn,
    )
]
