"""The map `motorway`: ten kilometres round a village, two lanes each way, with two interchanges and roadworks.

It closes by symmetry, as it is one half driven twice, which turns by 180 degrees. A country road crosses it on two
bridges, at each of which ramps lead from one to the other, and runs through the village between them.
"""

import math

from carriageway import Carriageway, Heights, Line, frame
from crossing import board, crossing
from network import Arm, Network, Path, Strip
from opendrive import wrap, zebra
from scenery import block, bridge, generator, over, rail, row, smooth, tree, wall

LANE, SHOULDER = Strip("driving", 3.75), Strip("shoulder", 2.5)
# Land as high as the road, from which that around falls or rises: cells of land on a map of this size are longer
# than the road is wide, and would else cut into it.
VERGE = [Strip("none", 7.0), Strip("none", 7.0)]
INNER = [Strip("shoulder", 0.75), Strip("none", 1.25)]
ASIDE = 2.0  # from the middle of the median to a carriageway
TWO = [LANE, LANE, SHOULDER, *VERGE]
THREE = [LANE, LANE, LANE, SHOULDER, *VERGE]
CLOSED = [LANE, Strip("roadWorks", LANE.width), SHOULDER, *VERGE]
RAMP_LANE = 4.0
RAMP = [Strip("driving", RAMP_LANE), Strip("shoulder", 1.5), *VERGE]
COUNTRY = [Strip("driving", 3.5), Strip("shoulder", 0.5)]
BRIDGE = [Strip("driving", 3.5), Strip("shoulder", 0.75)]
VILLAGE = [Strip("driving", 3.5), Strip("shoulder", 0.5), Strip("sidewalk", 2.0)]

STRAIGHT = 1500.0  # at an interchange, which is in the middle
HALF = STRAIGHT / 2
EASE = 120.0  # of a bend with half of its curvature, at both ends
LIMIT = 120


def bend(radius, degrees):
    """(length, curvature) of a bend to the left that begins and ends gently."""
    turn, k = math.radians(abs(degrees)), math.copysign(1 / radius, degrees)
    return [(EASE, k / 2), ((turn - EASE / radius) * radius, k), (EASE, k / 2)]


WORKS = 620.0  # the straight with the roadworks
PARTS = [(STRAIGHT, 0.0), *bend(600, 100), (WORKS, 0.0), *bend(700, -40), (200.0, 0.0), *bend(600, 120)]

# Along a carriageway from the middle of an interchange: where lanes begin, part, join and end.
SPLIT, EXIT, ENTRY, MERGE = (-730.0, -660.0), (-440.0, -420.0), (420.0, 440.0), (680.0, 750.0)
GORE = 65.0  # behind an exit there is room for the shoulder again
APART = 125.0  # and for land between motorway and ramp
TERMINAL = 108.0  # from a carriageway to where its ramps meet the country road
BACK = 18.0  # from there to the mouths of ramps and country road
RISE, CREST = 8.7, 0.7  # of the country road at the ramps above the motorway, and on the bridge above that
SPAN = 84.0  # of the bridge
MEDIAN_RAIL, VERGE_RAIL = 1.3, 0.8  # from the inner edge, and beyond the shoulder
VILLAGE_LENGTH, VILLAGE_HEIGHT = 380.0, 6.0


def motorway():
    net, rng = Network("motorway"), generator(23)
    line = Line(PARTS * 2)
    half = line.length / 2
    heights = Heights(
        [(0, 4.0), (STRAIGHT, 4.0), (2900.0, 13.0), (half - 700.0, 0.5), (half, 4.0)]
        + [(half + STRAIGHT, 4.0), (half + 2700.0, 0.0), (2 * half - 900.0, 11.0)],
        line.length,
    )
    ways = [Carriageway(net, line, heights, forward, ASIDE, INNER) for forward in (True, False)]
    ends = [[], []]  # of the country road, by interchange: the terminals outside and inside of the ring
    for way in ways:
        build(net, way, rng, ends)
    country(net, line, ends, rng)
    return net


def build(net, way, rng, ends):
    """A carriageway all the way round."""
    half = way.line.length / 2
    centres = [HALF, half + HALF] if way.forward else [half - HALF, 2 * half - HALF]
    stretches = []  # (from, to, sections, limit, what joins it to the one before)
    for k, u in enumerate(centres):
        between_noses = [
            (0.0, [LANE, LANE]),
            (10.0, [LANE, LANE, Strip("shoulder", 0.0, SHOULDER.width)]),
            (GORE, [LANE, LANE, SHOULDER]),
            (APART, TWO),
            (-APART, [LANE, LANE, SHOULDER]),
            (-GORE, [LANE, LANE, Strip("shoulder", SHOULDER.width, 0.0)]),
            (-10.0, [LANE, LANE]),
        ]
        stretches += [
            (u + SPLIT[1], u + EXIT[0], [(0.0, THREE)], LIMIT, "split"),
            (u + EXIT[1], u + ENTRY[0], between_noses, LIMIT, "exit"),
            (u + ENTRY[1], u + MERGE[0], [(0.0, THREE)], LIMIT, "entry"),
        ]
        stretches += open_road(way, u + MERGE[1], centres[k + 1 - len(centres)] + SPLIT[0], k)
    roads = [(way.road(a, b, sections, kmh), a, b, how) for a, b, sections, kmh, how in stretches]
    for n, (road, start, _, how) in enumerate(roads):
        before, _, end, _ = roads[n - 1]
        if how == "follow":
            net.follow(before, road)
        else:
            u = centres[0] if start < centres[0] + half and n < len(roads) // 2 else centres[1]
            join(net, way, how, end % way.line.length, start, before, road, ends, u, rng)
        furnish(net, road, rng, how)
    signs(net, roads)


def open_road(way, start, end, k):
    """The road from an interchange to the next one, with its limits; one of the four has roadworks."""
    length = way.line.length
    if end < start:
        end += length
    if way.forward and k == 0:
        works = STRAIGHT + bend_length(600, 100) + 10.0
        return [
            (start, works - 540.0, [(0.0, TWO)], LIMIT, "merge"),
            (works - 540.0, works - 250.0, [(0.0, TWO)], 100, "follow"),
            (works - 250.0, works, [(0.0, TWO)], 80, "follow"),
            (works + 50.0, works + 530.0, [(0.0, CLOSED)], 60, "narrow"),
            (works + 590.0, end, [(0.0, TWO)], LIMIT, "widen"),
        ]
    return [(start, end, [(0.0, TWO)], LIMIT, "merge")]


def bend_length(radius, degrees):
    return sum(length for length, _ in bend(radius, degrees))


def join(net, way, how, u0, u1, before, road, ends, centre, rng):
    """The junction between two roads of a carriageway."""
    if u0 > u1:
        u0 -= way.line.length
    one = lambda n_in, n_out, waits, a=None, b=None: (a, b, n_in, n_out, waits)
    if how == "exit":
        ramp = ramps(net, way, centre, ends, rng)
        ways = one(3, 1, False, b=Arm(ramp, "start"))
    elif how == "entry":
        ways = one(1, 3, False, a=Arm(ends[which(way, centre)][-1].entry, "end"))
    else:
        ways = one(*{"split": (2, 3, False), "merge": (3, 2, True), "narrow": (2, 1, True), "widen": (1, 2, False)}[how])
    main, (aside,) = way.junction(u0, u1, before, road, [ways], 1 if how in ("narrow", "widen") else 2)
    rail(net, main, 0.0, main.length, MEDIAN_RAIL)
    rail(net, aside, 0.0, aside.length, -(aside.width("shoulder") + VERGE_RAIL), -(aside.width("shoulder", "end") + VERGE_RAIL))


def which(way, centre):
    """The interchange at a place of a carriageway: the first or second one along the line."""
    return int(way.s(centre) % way.line.length > way.line.length / 2)


# --- interchanges ---------------------------------------------------------------------------------


class Terminal:
    """Where the ramps of a carriageway meet the country road."""

    def __init__(self, way, centre, leave, entry):
        at, heading = frame(way, centre)
        self.outside, self.z, self.leave, self.entry = way.forward, way.height(centre) + RISE, leave, entry
        # Mouths of the country road towards the bridge and away from it.
        self.over = at(0.0, TERMINAL - BACK), wrap(heading + math.pi / 2)
        self.away = at(0.0, TERMINAL + BACK), wrap(heading - math.pi / 2)


def ramps(net, way, centre, ends, rng):
    """Both ramps of a carriageway at an interchange; gives the one that leaves it."""
    at, heading = frame(way, centre)
    base = way.height(centre)
    inner = 2 * LANE.width
    leave = Path(at(EXIT[1], inner), heading).to(at(-BACK, TERMINAL), heading)
    entry = Path(at(BACK, TERMINAL), heading).to(at(ENTRY[0], inner), heading)
    both = []
    for path, climbs in ((leave, True), (entry, False)):
        road = net.road(path, [Strip("shoulder", 0.5)], RAMP, 60, kind="motorway")
        climb = path.length - APART - 8.0
        if climbs:
            rise = smooth(climb - 10.0, base, base + RISE)[0]
            road.elevation = [(0.0, base, 0, 0, 0), (APART + 8.0, *rise[1:]), (path.length - 10.0, base + RISE, 0, 0, 0)]
        else:
            fall = smooth(climb - 10.0, base + RISE, base)[0]
            road.elevation = [(0.0, base + RISE, 0, 0, 0), (10.0, *fall[1:]), (climb, base, 0, 0, 0)]
        both.append(road)
        ends_at = (0.0, path.length - 25.0) if climbs else (25.0, path.length)
        rail(net, road, *ends_at, -(RAMP_LANE + 1.5 + VERGE_RAIL))
        row(net, road, rng, 40.0, path.length - 40.0, -13.0, 9.0, 9.0, 2.4, 0.6, 8.0)
    road = both[0]
    road.signals.append(board(net.id(), road, 20.0, True, "274", 60))
    ends[which(way, centre)].append(Terminal(way, centre, *both))
    return road


def country(net, line, ends, rng):
    """The country road: over a bridge, through the village, and over the other bridge."""
    inner = []
    for terminals in ends:
        outside, inside = sorted(terminals, key=lambda t: not t.outside)
        inner.append(inside)
        inside.road = crossover(net, outside, inside)
    roads = village(net, line, *inner, rng)
    for inside, (road, contact) in zip(inner, ((roads[0], "start"), (roads[-1], "end"))):
        arms = [Arm(inside.road, "end"), Arm(road, contact), Arm(inside.leave, "end"), Arm(inside.entry, "start")]
        barred = [inside.leave, inside.entry]
        crossing(net, arms, "yield", [inside.road, road], z=inside.z, zebras=False, barred=barred)


def crossover(net, outside, inside):
    """The country road over the motorway, and the ramps where it begins."""
    (start, heading), (end, _) = outside.over, inside.over
    path = Path(start, heading).to(end, heading)
    road = net.road(path, BRIDGE, BRIDGE, 70, kind="rural")
    road.elevation = over(path.length, outside.z, inside.z, CREST)
    arms = [Arm(road, "start"), Arm(outside.leave, "end"), Arm(outside.entry, "start")]
    crossing(net, arms, "yield", [road], z=outside.z, zebras=False, barred=[outside.leave, outside.entry])
    s0, s1 = (road.length - SPAN) / 2, (road.length + SPAN) / 2
    bridge(net, road, s0, s1)
    edge = road.width("shoulder") + 0.45
    for side in (-1, 1):
        rail(net, road, 12.0, s0 - 1.0, side * edge)
        rail(net, road, s1 + 1.0, road.length - 12.0, side * edge)
    return road


def village(net, line, first, last, rng):
    """The roads from an interchange to the other, through a village in the middle."""
    (start, heading), (end, back) = first.away, last.away
    mx, my = line.middle()
    turn = wrap(math.atan2(end[1] - start[1], end[0] - start[0]))
    at = lambda ahead: (mx + ahead * math.cos(turn), my + ahead * math.sin(turn))
    half = VILLAGE_LENGTH / 2
    paths = [
        (Path(start, heading).hermite(at(-half), turn), COUNTRY, 100, first.z, VILLAGE_HEIGHT),
        (Path(at(-half), turn).line(VILLAGE_LENGTH), VILLAGE, 50, VILLAGE_HEIGHT, VILLAGE_HEIGHT),
        (Path(at(half), turn).hermite(end, wrap(back + math.pi)), COUNTRY, 100, VILLAGE_HEIGHT, last.z),
    ]
    roads = []
    for path, strips, kmh, z0, z1 in paths:
        road = net.road(path, strips, strips, kmh, kind="town" if kmh == 50 else "rural")
        road.elevation = smooth(path.length, z0, z1) if z0 != z1 else over(path.length, z0, z1, 0.8)
        if roads:
            net.follow(roads[-1], road)
        roads.append(road)
        road.signals += [
            board(net.id(), road, 3.0, True, "274", kmh),
            board(net.id(), road, road.length - 3.0, False, "274", kmh),
        ]
        if kmh != 50:
            for side in (-1, 1):
                row(net, road, rng, 30.0, road.length - 20.0, side * 8.0, 11.0, 9.0, 2.4, 0.6, 3.0)
    for k in range(18):
        side = -1 if k % 2 else 1
        block(net, roads[1], "none", "bin", 20.0 + 19.0 * k, side * (roads[1].width("sidewalk") + 0.5), (0.6, 0.6, 1.05))
    for s in (70.0, VILLAGE_LENGTH - 70.0):
        roads[1].objects.append(zebra(net.id(), s, 4.0))
    return roads


# --- what stands along the motorway ---------------------------------------------------------------


def furnish(net, road, rng, how):
    """Rails, trees, and what closes a lane."""
    length = road.length
    rail(net, road, 0.0, length, MEDIAN_RAIL)
    lanes = 3 if how in ("split", "entry") else 2
    edge = lanes * LANE.width + SHOULDER.width
    # Between the ramps of an interchange there is land beside the motorway only where they are away from it.
    free = [(APART, length / 2 - 30.0), (length / 2 + 30.0, length - APART)] if how == "exit" else [(0.0, length)]
    rail(net, road, free[0][0], free[-1][1], -(edge + VERGE_RAIL))
    for s0, s1 in free:
        woods(net, road, rng, edge, s0, s1)
    if how == "narrow":
        works(net, road)
    if how == "split":
        gantry(net, road, 20.0, edge)


def woods(net, road, rng, edge, start, end):
    """Trees on the land beside the motorway, denser here and thinner there."""
    s = start + 10.0
    while s < end - 10.0:
        thick = 0.15 + 0.75 * (0.5 + 0.5 * math.sin(s / 97.0 + road.id))
        if rng() < thick:
            height = 7.0 + 6.0 * rng()
            tree(net, road, s, -(edge + 4.5 + 8.0 * rng()), height, 0.25 * height)
        s += 9.0


def works(net, road):
    """Boards and a wall along the lane that is closed."""
    wall(net, road, "barrier", "guardRail", 30.0, road.length - 30.0, -(LANE.width + 0.5), 0.8)
    s = 8.0
    while s < road.length - 8.0:
        block(net, road, "obstacle", "beacon", s, -(LANE.width + 0.25), (0.2, 0.4, 1.1))
        s += 9.0
    s = 20.0
    while s < road.length - 20.0:
        block(net, road, "none", "trafficCone", s, -(LANE.width + 1.6), (0.45, 0.45, 0.9))
        s += 12.0
    for s in (120.0, 190.0, 260.0):
        block(net, road, "obstacle", "siteContainer", s, -(1.5 * LANE.width + 0.6), (2.5, 1.8, 1.4))


def gantry(net, road, s, edge):
    """A frame over the carriageway; what it carries counts as above the lanes, not on them."""
    for t in (1.0, -(edge + 0.5)):
        block(net, road, "pole", "gantry post", s, t, (0.35, 0.35, 6.4))
    block(net, road, "obstacle", "gantry", s, -edge / 2 + 0.25, (0.3, edge + 1.4, 1.6), z=5.0)


def signs(net, roads):
    """A sign wherever the limit changes."""
    for n, (road, *_) in enumerate(roads):
        if road.kmh != roads[n - 1][0].kmh or roads[n][3] in ("entry", "merge"):
            road.signals.append(board(net.id(), road, 8.0, True, "274", road.kmh))
