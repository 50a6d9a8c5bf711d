"""The map `suburb`: quiet streets with gardens, driveways and parked cars around a collector road with bicycle lanes.

The collector has a roundabout, a crossing with lights and streets that give way to it; elsewhere who comes from the right
goes first. Dead ends have a loop to turn.
"""

import math
from dataclasses import replace

from city import generator
from layout import Way, lay_out, ring
from site_plan import Site, lamps, out, parked, to_street
from streets import Profile, Strip, Town, sign

GUTTER = Strip("shoulder", 0.4, mark="curb")
PAVEMENT = Strip("sidewalk", 1.9)
GARDEN_DEPTH = 5.0
GARDEN = Strip("restricted", GARDEN_DEPTH)
GRASS, PAVED = "grass", "paving"


def both(*strips, kmh, middle="none"):
    return Profile(strips, strips, kmh, middle)


QUIET = both(Strip("driving", 2.9), GUTTER, PAVEMENT, GARDEN, kmh=30)
COLLECTOR = both(
    Strip("driving", 3.25, mark="solid"),
    Strip("biking", 1.6),
    GUTTER,
    replace(PAVEMENT, width=2.4),
    GARDEN,
    kmh=50,
    middle="broken",
)
CIRCLE = Profile((GUTTER,), (Strip("driving", 4.2), GUTTER, replace(PAVEMENT, width=2.2)), 30)
LOOP = Profile((GUTTER,), (Strip("driving", 4.0), GUTTER, PAVEMENT), 30)

PLACES = {
    # The collector.
    "c0": (-345, -22), "c1": (-222, 12), "c2": (-160, 14), "r": (-28, 0), "c3": (116, -18), "c4": (232, 12), "c5": (340, 2),
    # North and south of it.
    "n1": (-207, 170), "n2": (-44, 150), "n3": (96, 166), "n4": (226, 160),
    "s2": (-146, -160), "s3": (-24, -170), "s4": (120, -164),
    # The middles of loops to turn.
    "l1": (122, 276), "l2": (-176, -262),
}  # fmt: skip

WAYS = [
    Way("c0", "c1", COLLECTOR, "Hauptstrasse", bow=-7),
    Way("c1", "c2", COLLECTOR, "Hauptstrasse"),
    Way("c2", "r", COLLECTOR, "Hauptstrasse", bow=6),
    Way("r", "c3", COLLECTOR, "Hauptstrasse", bow=-5),
    Way("c3", "c4", COLLECTOR, "Hauptstrasse", bow=-8),
    Way("c4", "c5", COLLECTOR, "Hauptstrasse", bow=6),
    Way("c0", "n1", QUIET, "Ahornweg", via=((-362, 92), (-300, 160)), radius=38, bays="r"),
    Way("c1", "n1", QUIET, "Birkenweg", bow=-14, bays="l"),
    Way("r", "n2", QUIET, "Lindenweg", bow=-12, bays="r"),
    Way("c3", "n3", QUIET, "Buchenweg", bow=-13, bays="rl"),
    Way("c4", "n4", QUIET, "Erlenweg", bow=11, bays="l"),
    Way("c5", "n4", QUIET, "Eschenweg", via=((364, 96), (306, 168)), radius=36, bays="l"),
    Way("n1", "n2", QUIET, "Am Anger", via=((-122, 140),), radius=60, bays="l"),
    Way("n2", "n3", QUIET, "Am Anger", bow=12, bays="r"),
    Way("n3", "n4", QUIET, "Am Anger", bow=-14, bays="l"),
    Way("c0", "s2", QUIET, "Amselweg", via=((-366, -126), (-296, -184)), radius=40, bays="l"),
    Way("c2", "s2", QUIET, "Drosselweg", bow=13, bays="r"),
    Way("r", "s3", QUIET, "Finkenweg", bow=-11, bays="l"),
    Way("c3", "s4", QUIET, "Meisenweg", bow=12, bays="rl"),
    Way("c5", "s4", QUIET, "Lerchenweg", via=((366, -104), (288, -184)), radius=42, bays="r"),
    Way("s2", "s3", QUIET, "Sperlingsweg", bow=-15, bays="l"),
    Way("s3", "s4", QUIET, "Sperlingsweg", bow=13, bays="r"),
    Way("n3", "l1", QUIET, "Ulmenhof", bow=8),
    Way("s2", "l2", QUIET, "Starenhof", bow=-8),
]

ROUNDABOUT, ROUNDABOUT_MOUTHS, ROUNDABOUT_GAP = 18.0, 28.0, math.radians(34)
LOOP_RADIUS, LOOP_MOUTHS, LOOP_GAP = 9.0, 19.0, math.radians(42)
MOUTHS = {"r": ROUNDABOUT_MOUTHS, "l1": LOOP_MOUTHS, "l2": LOOP_MOUTHS}
YIELDS = {"c0": ("n1", "s2"), "c1": ("n1",), "c2": ("s2",), "c4": ("n4",), "c5": ("n4", "s4")}
ZEBRAS = [("c1", "c2"), ("n2", "n3"), ("s3", "s2"), ("c4", "c3"), ("n1", "n2"), ("s4", "s3")]
BUS_STOPS = [("c0", "c1"), ("r", "c3"), ("c4", "c5")]
PLAYGROUND = ("n1", "n2")


def height(x, y):
    return 3.4 * math.sin(x / 130.0) + 2.4 * math.sin(y / 105.0 + 0.5)


def junctions(town, plan):
    for place, arms in plan.arms.items():
        z = height(*PLACES[place])
        if place == "r":
            roundabout(town, place, arms, z)
        elif place in ("l1", "l2"):
            loop(town, place, arms[0], z)
        elif place in YIELDS:
            minor = [plan.between(place, other) for other in YIELDS[place]]
            major = [arm.road for arm in arms if arm.road not in minor]
            town.junction(arms, "yield", major, z)
        else:
            town.junction(arms, "lights" if place == "c3" else "none", z=z)
    for arm in plan.arms["c3"]:
        town.zebra_at(arm)
    for place, other in ZEBRAS:
        town.zebra_at(plan.arm(place, other))
    for arm in plan.arms["r"]:
        town.zebra_at(arm, before=18.0)
    town.bridge_the_walks()


def roundabout(town, place, legs, z):
    legs = sorted(legs, key=lambda arm: arm.heading % math.tau)
    angles = [arm.heading % math.tau for arm in legs]
    circle = ring(town, PLACES[place], ROUNDABOUT, CIRCLE, angles, ROUNDABOUT_GAP, z, "Kreisel")
    for leg, arms in zip(legs, circle):
        town.junction([leg, *arms], "yield", [arm.road for arm in arms], z)


def loop(town, place, leg, z):
    """The end of a street, where one drives round an island of grass and back."""
    (arms,) = ring(town, PLACES[place], LOOP_RADIUS, LOOP, [leg.heading % math.tau], LOOP_GAP, z, leg.road.name)
    town.junction([leg, *arms], "none", z=z, banned=[(arms[0].road, arms[0].road)])


# --- what stands there ----------------------------------------------------------------------------


def along(site, road, right, kind, name, start, end, beyond, profile, piece=3.0):
    """A row of pieces side by side, `profile` wide and high."""
    count = max(1, round((end - start) / piece))
    step = (end - start) / count
    for k in range(count):
        s = start + (k + 0.5) * step
        site.put(road, kind, name, (s, out(road, s, right, beyond)), (step - 0.05, *profile))


def front(site, road, right, start, end, style):
    """What divides a garden from the pavement."""
    if end - start < 1.0 or style > 0.85:
        return
    if style < 0.5:
        along(site, road, right, "vegetation", "hedge", start, end, 0.75, (0.7, site.between(0.9, 1.5)))
    else:
        along(site, road, right, "none", "gardenFence", start, end, 0.45, (0.1, site.between(0.8, 1.1)))


def plots(site, road, right):
    """Houses in their gardens, each with a driveway; returns where these are, as (from, to)."""
    gates, s = [], 1.0
    while s + 14.0 < road.length:
        width = site.between(15.0, 19.0)
        drive_first, drive, style = site.rng() < 0.5, 3.0, site.rng()
        gate = (s + 0.4, s + 0.4 + drive) if drive_first else (s + width - 0.4 - drive, s + width - 0.4)
        frontage, depth = site.between(8.5, 10.5), site.between(8.0, 10.0)
        house_at = s + width / 2 + (1.6 if drive_first else -1.6)
        place = (house_at, out(road, house_at, right, GARDEN_DEPTH + site.between(0.3, 1.2) + depth / 2))
        size = (depth, frontage, 3.0 * round(site.between(1.0, 2.4)) + 2.6)
        if gate[1] > road.length - 1.0 or not site.put(road, "building", "house", place, size, to_street(right), room=0.3):
            s += 2.0
            continue
        driveway(site, road, right, gate)
        gates.append(gate)
        front(site, road, right, s if not drive_first else gate[1], s + width if drive_first else gate[0], style)
        garden(site, road, right, s, width)
        s += width
    return gates


def driveway(site, road, right, gate):
    """A garage at the end of some, a car on some."""
    middle = sum(gate) / 2
    place = lambda beyond: (middle, out(road, middle, right, beyond))
    if site.rng() < 0.6:
        site.put(road, "building", "garageBuilding", place(GARDEN_DEPTH + 3.4), (6.0, 2.9, 2.7), to_street(right))
    if site.rng() < 0.45:
        site.put(road, "none", "parkedCar", place(2.8), (4.4, 1.8, 1.5), to_street(right))
    site.keep_free(road, place(GARDEN_DEPTH / 2), (GARDEN_DEPTH, gate[1] - gate[0]), to_street(right))


def garden(site, road, right, s, width):
    """A hedge to the neighbours', trees before and behind the house."""
    end = s + width
    site.put(road, "vegetation", "hedge", (end, out(road, end, right, 3.0)), (3.6, 0.6, 1.2), to_street(right))
    for beyond, size in ((site.between(2.0, 3.4), 3.0), (site.between(19.0, 24.0), 4.0), (site.between(22.0, 34.0), 5.0)):
        at = s + site.between(2.0, width - 2.0)
        if site.rng() < 0.75:
            tall = site.between(1.4, 2.0) * size
            site.put(road, "tree", "tree", (at, out(road, at, right, beyond)), (size, size, tall))


def bins(site, road, right, gates):
    """What stands at the kerb on the day of the dustmen: bins beside every other driveway."""
    for _, end in gates[::2]:
        if end + 1.4 < road.length:
            site.put(road, "none", "bin", (end + 0.7, out(road, end, right, 0.4)), (0.6, 0.6, 1.1))


def blocks_of_flats(site, road, right):
    s = 2.0
    while s + 14.0 < road.length:
        frontage, depth = site.between(14.0, 20.0), site.between(10.0, 12.0)
        at = s + frontage / 2
        place = (at, out(road, at, right, GARDEN_DEPTH + 0.6 + depth / 2))
        size = (depth, frontage, 3.0 * round(site.between(2.6, 4.4)) + 1.2)
        if at + frontage / 2 < road.length and site.put(road, "building", "flatsBuilding", place, size, to_street(right)):
            s += frontage + site.between(4.0, 7.0)
        else:
            s += 2.0


def avenue(site, road, right):
    s = 7.0
    while s < road.length - 5.0:
        site.put(road, "tree", "tree", (s, out(road, s, right, 1.9)), (3.2, 3.2, site.between(6.0, 8.0)))
        s += 11.0


def playground(site, road, right, start, end, depth=20.0):
    """Behind a fence with one gate: swings, a slide, a frame to climb, a sand pit, benches and trees."""
    middle = (start + end) / 2
    along(site, road, right, "none", "fence", start, middle - 1.5, 0.45, (0.1, 1.2))
    along(site, road, right, "none", "fence", middle + 1.5, end, 0.45, (0.1, 1.2))
    along(site, road, right, "none", "fence", start, end, depth, (0.1, 1.2))
    for s in (start, end):
        place = (s, out(road, s, right, depth / 2 + 0.2))
        site.put(road, "none", "fence", place, (depth - 0.6, 0.1, 1.2), to_street(right))
    # Nobody runs straight out of the gate onto the road.
    site.put(road, "barrier", "guardRail", (middle, out(road, middle, right, 1.5)), (3.0, 0.15, 1.0))
    things = (
        ("swing", 0.2, 12.0, (4.0, 1.6, 2.3)), ("slide", 0.4, 13.0, (3.6, 0.8, 2.1)),
        ("climbingFrame", 0.62, 11.0, (3.2, 3.2, 2.6)), ("sandPit", 0.82, 12.0, (4.5, 4.5, 0.3)),
        ("bench", 0.3, 3.0, (1.6, 0.6, 0.9)), ("bench", 0.7, 3.0, (1.6, 0.6, 0.9)),
    )  # fmt: skip
    for name, share, beyond, size in things:
        s = start + share * (end - start)
        site.put(road, "obstacle", name, (s, out(road, s, right, beyond)), size)
    for share, beyond in ((0.08, 16.0), (0.5, 17.0), (0.92, 5.0), (0.1, 5.0), (0.75, 17.0)):
        s = start + share * (end - start)
        site.put(road, "tree", "tree", (s, out(road, s, right, beyond)), (4.0, 4.0, 7.5))
    site.keep_free(road, (middle, out(road, middle, right, depth / 2)), (end - start, depth))


def islands(site, town):
    """A tree and bushes in the middle of each circle."""
    for road in town.roads:
        if road.sections[0][1] is LOOP:
            site.put(road, "tree", "tree", (1.0, LOOP_RADIUS), (4.0, 4.0, 7.0))
        elif road.sections[0][1] is CIRCLE:
            site.put(road, "tree", "tree", (2.0, ROUNDABOUT - 4.0), (4.0, 4.0, 8.0))
            site.put(road, "vegetation", "bush", (2.0, 6.0), (2.2, 1.4, 1.1))


def signs(town, plan):
    for (a, b), road in plan.streets.items():
        if a[0] in "cr" and b[0] in "cr":
            continue
        if a[0] in "cr":
            road.signals.append(sign(town.id(), road, 9.0, True, "274.1", 30))
    for pair in BUS_STOPS:
        road = plan.between(*pair)
        for forward in (True, False):
            road.signals.append(sign(town.id(), road, road.length / 2 + (9 if forward else -9), forward, "224"))


def grounds(gates):
    """Grass, but for the driveways."""
    records = [(0.0, GRASS)]
    for start, end in gates:
        records += [(start, PAVED), (end, GRASS)]
    return records


def furnish(town, plan):
    site = Site(town, generator(23))
    islands(site, town)
    yard = plan.between(*PLAYGROUND)
    playground(site, yard, True, 50.0, 92.0)
    for road in plan.streets.values():
        is_collector = road.name == "Hauptstrasse"
        skip = []
        for right in (True, False):
            lamps(site, road, right, 30.0)
            gates = []
            if is_collector:
                avenue(site, road, right)
                blocks_of_flats(site, road, right)
            else:
                gates = plots(site, road, right)
            road.grounds[right] = grounds(gates)
            bins(site, road, right, gates)
            skip += [(right, *gate) for gate in gates]
        parked(site, road, 0.8, skip)


def suburb():
    town = Town("suburb")
    plan = lay_out(town, PLACES, WAYS, height, 6.0, MOUTHS)
    junctions(town, plan)
    signs(town, plan)
    furnish(town, plan)
    return town
