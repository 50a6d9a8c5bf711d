"""The map `old_town`: cobbled lanes around a market square, inside a ring on the line of the old wall.

Whoever comes from the right goes first at most corners. In the west the ring is a boulevard with tramway tracks in its
middle. What lies inside the inner ring is paved with cobbles.
"""

import math
from dataclasses import replace

from city import generator
from layout import Way, lay_out
from opendrive import num
from site_plan import Site, lamps, out, parked, to_street
from streets import Profile, Strip, Town, sign

COBBLES = "cobblestone"
GUTTER, PAVEMENT = Strip("shoulder", 0.4, mark="curb"), Strip("sidewalk", 1.8)
STONES = Strip("driving", 2.85, COBBLES)
ASPHALT = Strip("driving", 3.0)
TRAM, ISLAND = Strip("tram", 2.8, mark="solid"), Strip("median", 2.8, mark="solid")
TRACK_GAUGE = 1.5  # between the middles of rails


def both(*strips, kmh, middle="none"):
    return Profile(strips, strips, kmh, middle)


def paved(strip, material):
    return replace(strip, material=material)


COBBLED_GUTTER = paved(GUTTER, COBBLES)
LANE = both(STONES, COBBLED_GUTTER, PAVEMENT, kmh=30)
ALLEY = Profile((COBBLED_GUTTER, PAVEMENT), (replace(STONES, width=3.0), COBBLED_GUTTER, PAVEMENT), 20)
STREET = both(ASPHALT, GUTTER, replace(PAVEMENT, width=2.0), kmh=30, middle="broken")
BOULEVARD = both(TRAM, ASPHALT, GUTTER, replace(PAVEMENT, width=2.6), kmh=30)
TERMINUS = both(ISLAND, ASPHALT, GUTTER, replace(PAVEMENT, width=2.6), kmh=30)


def on_the_square(depth, one_way=False):
    """A street beside the market, which lies to its left: a broad pavement, then so much of the square."""
    broad, square = replace(PAVEMENT, width=4.0), Strip("restricted", depth, COBBLES)
    left = (COBBLED_GUTTER, broad, square)
    right = (STONES, COBBLED_GUTTER, PAVEMENT)
    return Profile(left if one_way else (STONES, *left), right, 20)


PLACES = {
    # The market square.
    "m1": (-36, -28), "m2": (40, -28), "m3": (40, 34), "m4": (-36, 34),
    # The inner ring.
    "i0": (116, -18), "i1": (92, 90), "i2": (-4, 122), "i3": (-106, 84), "i4": (-124, -20), "i5": (-72, -108),
    "i6": (36, -116),
    # Where alleys leave the inner ring.
    "q1": (46, 112), "q2": (-106, -68), "q3": (84, -76),
    # The ring on the line of the wall.
    "o0": (222, -44), "o1": (196, 80), "o2": (112, 186), "o3": (-26, 222), "o4": (-146, 172), "o5": (-226, 40),
    "o6": (-212, -96), "o7": (-96, -206), "o8": (52, -214), "o9": (166, -156),
}  # fmt: skip

WAYS = [
    Way("m1", "m2", on_the_square(24.0), "Markt"),
    Way("m2", "m3", on_the_square(9.0, True), "Markt"),
    Way("m3", "m4", on_the_square(24.0), "Markt"),
    Way("m4", "m1", on_the_square(9.0, True), "Markt"),
    Way("m1", "i4", ALLEY, "Gerbergasse", bow=14),
    Way("i5", "m1", ALLEY, "Salzgasse", via=((-46, -72),)),
    Way("m2", "i6", LANE, "Brueckenstrasse", bow=-12),
    Way("m2", "i0", LANE, "Torstrasse", bow=10),
    Way("m3", "i1", LANE, "Muehlenstrasse", via=((58, 66),), radius=25),
    Way("i2", "m4", ALLEY, "Kirchgasse", bow=-10),
    Way("m4", "i3", LANE, "Domstrasse", bow=12),
    Way("i0", "i1", LANE, "Am Graben", bow=-16),
    Way("i1", "q1", LANE, "Am Graben", bow=-6),
    Way("q1", "i2", LANE, "Am Graben", bow=-5),
    Way("i2", "i3", LANE, "Am Graben", via=((-60, 118),), radius=30),
    Way("i3", "i4", LANE, "Fischerstrasse", bow=-15),
    Way("i4", "q2", LANE, "Fischerstrasse", bow=-4),
    Way("q2", "i5", LANE, "Fischerstrasse", bow=-8),
    Way("i5", "i6", LANE, "Am Spital", via=((-20, -122),), radius=40),
    Way("i6", "q3", LANE, "Am Spital", bow=-6),
    Way("q3", "i0", LANE, "Am Spital", bow=-6),
    Way("i0", "o0", STREET, "Osttor", bow=8, bays="r"),
    Way("i1", "o1", STREET, "Neugasse", bow=-12, bays="l"),
    Way("i2", "o3", STREET, "Nordtor", bow=9),
    Way("i3", "o4", STREET, "Bleiche", bow=-7, bays="r"),
    Way("i4", "o5", STREET, "Westtor", bow=-10),
    Way("i5", "o7", STREET, "Suedtor", bow=8),
    Way("i6", "o8", STREET, "Ziegelgasse", bow=-8, bays="r"),
    Way("q1", "o2", ALLEY, "Nonnengasse", via=((86, 144),), radius=20),
    Way("o6", "q2", ALLEY, "Farbgasse", via=((-156, -66),), radius=20),
    Way("q3", "o9", ALLEY, "Schmiedgasse", bow=12),
    Way("o0", "o1", STREET, "Ostwall", bow=-9, bays="r"),
    Way("o1", "o2", STREET, "Ostwall", bow=-10, bays="l"),
    Way("o2", "o3", STREET, "Nordwall", bow=-9, bays="r"),
    Way("o3", "o4", STREET, "Nordwall", bow=-11, bays="l"),
    Way("o4", "o5", BOULEVARD, "Westwall", bow=-12),
    Way("o5", "o6", BOULEVARD, "Westwall", bow=-10),
    Way("o6", "o7", BOULEVARD, "Suedwall", bow=-12),
    Way("o7", "o8", BOULEVARD, "Suedwall", bow=-8),
    Way("o8", "o9", STREET, "Suedwall", bow=-10, bays="r"),
    Way("o9", "o0", STREET, "Ostwall", bow=-9, bays="r"),
]

LIGHTS = {"o5", "o7", "i2", "i6"}
STOPS = {"o0": ("o9", "o1"), "o3": ("o2", "o4")}
YIELDS = {"o1": ("o0", "o2"), "o8": ("o7", "o9"), "o4": ("o3", "o5"), "i3": ("i2", "i4")}
ZEBRAS = [("i0", "i1"), ("i4", "i3"), ("i5", "i6"), ("o3", "i2"), ("o8", "i6"), ("m2", "i0")]
TERMINI = [("o4", "o5"), ("o8", "o7")]  # the tracks end before these junctions, on the way to the other place
STOP_SHORT = 26.0
WALLED = [("o0", "o1"), ("o1", "o2"), ("o2", "o3"), ("o3", "o4")]  # along the outside of these the wall still stands


def height(x, y):
    """The market lies on a hill, and the town falls away to the river in the south."""
    return 5.5 * math.exp(-((x * x + y * y) / 200.0**2)) + 0.006 * y


def junctions(town, plan):
    for place, arms in plan.arms.items():
        z = height(*PLACES[place])
        if place in LIGHTS:
            town.junction(arms, "lights", z=z)
            for arm in arms:
                town.zebra_at(arm)
        elif place in STOPS or place in YIELDS:
            major = [plan.between(place, other) for other in {**STOPS, **YIELDS}[place]]
            town.junction(arms, "stop" if place in STOPS else "yield", major, z)
        else:
            town.junction(arms, "none", z=z)
    for place, other in ZEBRAS:
        town.zebra_at(plan.arm(place, other))
    town.bridge_the_walks()


# --- the tramway ----------------------------------------------------------------------------------


def tracks(town, plan):
    """Rails across the junctions of the boulevard, as those in their lanes; at both ends an island of grass takes their place."""
    for place, other in TERMINI:
        terminus(plan.arm(place, other))
    for c in (c for j in town.junctions for c in j.connections):
        ends = [arm.strips(inward)[0].kind for arm, inward in ((c.source, True), (c.target, False))]
        if c.is_driven and ends == ["tram", "tram"]:
            c.objects += rails(town, 0.0, c.path.length, (1.4,))


def terminus(arm):
    road = arm.road
    if arm.contact == "start":
        road.sections = [(0.0, TERMINUS), (STOP_SHORT, BOULEVARD)]
    else:
        road.sections = [(0.0, BOULEVARD), (road.length - STOP_SHORT, TERMINUS)]


def rails(town, s, length, middles):
    half = TRACK_GAUGE / 2
    return [
        f'<object id="{town.id()}" type="none" name="tramTrack" s="{num(s)}" t="{num(t)}" zOffset="0" hdg="0" '
        f'orientation="none" length="{num(length)}" width="0.07" height="0.01"><repeat s="{num(s)}" length="{num(length)}" '
        f'distance="0" tStart="{num(t)}" tEnd="{num(t)}" widthStart="0.07" widthEnd="0.07" heightStart="0.01" '
        f'heightEnd="0.01" zOffsetStart="0" zOffsetEnd="0"/></object>'
        for middle in middles
        for t in (middle - half, middle + half)
    ]


# --- what stands there ----------------------------------------------------------------------------


def houses(site, road, right, inner, front_garden=0.0):
    """Gable to gable, right behind the pavement; lower and with gaps outside the inner ring."""
    s = -2.0
    while s < road.length + 2.0:
        frontage = site.between(6.0, 10.5) if inner else site.between(8.0, 13.0)
        depth, floors = site.between(8.5, 12.0), round(site.between(1.6, 4.4) if inner else site.between(1.6, 3.6))
        setback = front_garden + (site.between(0.5, 0.7) if inner else site.between(0.6, 1.6))
        at = s + frontage / 2
        if at > road.length:
            break
        size = (depth, frontage, 3.0 * floors + site.between(0.6, 2.4))
        place = (max(at, 0.0), out(road, at, right, setback + depth / 2))
        if site.put(road, "building", "house", place, size, to_street(right)):
            s += frontage + (0.3 if inner or site.rng() < 0.6 else site.between(2.0, 6.0))
        else:
            s += 1.0


def market(site, plan):
    """A town hall, a church tower, a fountain, stalls under trees."""
    south, north = plan.between("m1", "m2"), plan.between("m3", "m4")
    left = lambda road, beyond: out(road, 0.0, False, beyond)
    site.put(south, "building", "townHallBuilding", (15.0, left(south, 14.0)), (13.0, 18.0, 13.5), -math.pi / 2)
    site.put(south, "building", "churchBuilding", (34.5, left(south, 15.0)), (17.0, 10.0, 15.0), -math.pi / 2)
    site.put(south, "building", "towerBuilding", (34.5, left(south, 26.8)), (5.0, 5.0, 32.0), -math.pi / 2)
    site.put(south, "obstacle", "fountain", (24.5, left(south, 3.5)), (3.0, 3.0, 1.1))
    for road, beyond in ((south, 2.0), (north, 2.2), (north, 8.5)):
        s = 3.0
        while s < road.length - 3.0:
            site.put(road, "obstacle", "marketStall", (s, left(road, beyond)), (3.2, 2.0, 2.3), room=0.5)
            s += site.between(5.0, 6.5)
    for road in (south, north):
        for s in range(4, int(road.length) - 2, 9):
            site.put(road, "tree", "tree", (float(s), left(road, 5.4)), (3.4, 3.4, 7.0))


def town_wall(site, plan):
    """What is left of the wall, with its towers."""
    for pair in WALLED:
        road, s = plan.between(*pair), 4.0
        middle = road.length / 2
        site.put(road, "building", "towerBuilding", (middle, out(road, middle, True, 4.0)), (5.5, 5.5, 12.0))
        while s < road.length - 4.0:
            size = (3.8, 1.0, site.between(3.6, 4.4))
            site.put(road, "none", "cityWall", (s, out(road, s, True, 2.2)), size)
            s += 3.85
            if site.rng() < 0.06:
                s += 9.0  # a breach


def trees(site, road, right, pitch, beyond=1.5):
    s = 6.0
    while s < road.length - 4.0:
        place = (s, out(road, s, right, beyond * site.between(0.9, 1.15)))
        site.put(road, "tree", "tree", place, (2.4, 2.4, site.between(5.5, 8.0)))
        s += pitch * site.between(0.8, 1.2)


def bins(site, road, right):
    """Bins behind the pavement, and a post box here and there."""
    s = 9.0 + 8.0 * site.rng()
    while s < road.length - 5.0:
        place = (s, out(road, s, right, 0.35))
        if site.rng() < 0.8:
            site.put(road, "none", "bin", place, (0.5, 0.5, 1.0))
        else:
            site.put(road, "none", "postbox", place, (0.4, 0.4, 1.3), to_street(right))
        s += site.between(9.0, 22.0)


def signs(town, plan):
    for road in town.roads:
        if road.name in ("Osttor", "Nordtor", "Westtor", "Suedtor"):
            road.signals.append(sign(town.id(), road, road.length - 8.0, False, "274.1", 30))


def furnish(town, plan):
    site = Site(town, generator(11))
    market(site, plan)
    town_wall(site, plan)
    for (a, b), road in plan.streets.items():
        is_square = road.name == "Markt"
        inner = a[0] in "miq" and b[0] in "miq"
        is_boulevard = road.name in ("Westwall", "Suedwall")
        for right in (True, False):
            if is_square and not right:
                continue
            is_walled = (a, b) in WALLED and right
            lamps(site, road, right, 34.0 if inner else 28.0)
            bins(site, road, right)
            if is_boulevard:
                trees(site, road, right, 9.0)
            if not is_walled:
                houses(site, road, right, inner, 3.0 if is_boulevard else 0.0)
            trees(site, road, right, 12.0, site.between(5.0, 8.0) if is_walled else 1.5)
            trees(site, road, right, 11.0, 22.0)
        parked(site, road, 0.6)


def old_town():
    town = Town("old_town")
    plan = lay_out(town, PLACES, WAYS, height, radius=6.5)
    tracks(town, plan)
    junctions(town, plan)
    signs(town, plan)
    furnish(town, plan)
    return town
