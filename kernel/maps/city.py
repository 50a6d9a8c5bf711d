"""The map `city`: five by four blocks with lights, stops, yields, parking and a few bent streets."""

import math

from opendrive import Arm, Map, Path2, Profile, bus_stop

STREET = Profile(lanes=1, width=3.5, edge=2.3, parking=True, sidewalk=3.0, kmh=50)
QUIET = Profile(lanes=1, width=3.25, edge=2.3, parking=True, sidewalk=2.5, kmh=30)
AVENUE = Profile(lanes=2, width=3.25, edge=0.5, parking=False, sidewalk=3.5, kmh=50)

COLUMNS, ROWS = 6, 5
DX, DY = 142.0, 128.0
CORNER = 6.0  # radius of a kerb at a corner, metres
# Nodes moved off the grid, which bends the streets between them.
MOVED = {(1, 3): (22, 0), (3, 1): (-26, 8), (4, 3): (0, -20), (2, 1): (0, 10), (4, 1): (18, 0)}
LIGHTS = {(1, 2), (2, 2), (3, 2), (4, 2), (2, 3), (3, 1), (0, 2), (5, 2), (2, 0)}
STOPS = {(1, 1), (3, 3), (4, 0), (1, 4)}
# Streets with a bus stop in each direction.
BUSES = [((1, 2), (2, 2)), ((3, 2), (4, 2)), ((2, 0), (2, 1)), ((3, 3), (3, 4)), ((0, 1), (1, 1)), ((4, 3), (5, 3))]
EAST, NORTH, WEST, SOUTH = 0.0, math.pi / 2, math.pi, -math.pi / 2


def profile(a, b):
    """The profile of the street between two neighbouring nodes."""
    if a[1] == b[1]:
        return AVENUE if a[1] == 2 else STREET
    return QUIET if a[0] in (1, 4) else STREET


def place(node):
    dx, dy = MOVED.get(node, (0, 0))
    return node[0] * DX + dx, node[1] * DY + dy


def neighbours(node):
    i, j = node
    around = {EAST: (i + 1, j), NORTH: (i, j + 1), WEST: (i - 1, j), SOUTH: (i, j - 1)}
    return {h: n for h, n in around.items() if 0 <= n[0] < COLUMNS and 0 <= n[1] < ROWS}


def setback(node):
    """Distance from a node's middle to the mouths of its roads."""
    return max(profile(*sorted((node, n))).kerb for n in neighbours(node).values()) + CORNER


def mouth(node, heading):
    x, y = place(node)
    back = 26.0 if len(neighbours(node)) == 2 else setback(node)
    return x + back * math.cos(heading), y + back * math.sin(heading)


def parked(m, road, rng):
    """Cars along both kerbs, with gaps."""
    p = road.profile
    for side in (-1, 1):
        s = 24.0
        while s < road.length - 26.0:
            if rng() < 0.55:
                t = side * (p.kerb - 1.15)
                hdg = 0.0 if side < 0 else math.pi
                road.objects.append(
                    f'<object id="{m.id()}" type="none" name="parkedCar" s="{s:.2f}" t="{t:.2f}" zOffset="0" '
                    f'hdg="{hdg:.6f}" orientation="none" length="4.4" width="1.8" height="1.5"/>'
                )
            s += 6.5


def generator(seed):
    """A small linear congruential generator in [0, 1): the same map on every machine."""
    state = seed

    def draw():
        nonlocal state
        state = (state * 6364136223846793005 + 1442695040888963407) % 2**64
        return (state >> 33) / 2**31

    return draw


def streets(m):
    """Every street, by its (lower, upper) node."""
    roads = {}
    for i in range(COLUMNS):
        for j in range(ROWS):
            for heading in (EAST, NORTH):
                a, b = (i, j), (i + 1, j) if heading == EAST else (i, j + 1)
                if b[0] == COLUMNS or b[1] == ROWS:
                    continue
                path = Path2(mouth(a, heading), heading).to(mouth(b, heading + math.pi), heading)
                road = m.road(path, profile(a, b))
                if road.profile.parking:
                    road.sections = [(0.0, "shoulder"), (18.0, "parking"), (path.length - 18.0, "shoulder")]
                roads[a, b] = road
    return roads


def arms(node, roads):
    out = []
    for heading, n in neighbours(node).items():
        a, b = sorted((node, n))
        contact = "start" if a == node else "end"
        out.append(Arm(roads[a, b], contact, mouth(node, heading), heading))
    return out


def corner(m, node, roads):
    """The bend that joins the two streets of a corner of the town."""
    a, b = sorted(arms(node, roads), key=lambda arm: arm.heading)
    path = Path2(a.point, a.heading + math.pi).to(b.point, b.heading)
    bend = m.road(path, a.profile)
    for arm, end in ((a, "start"), (b, "end")):
        arm.road.ends[arm.contact] = ("road", bend.id, end)
        bend.ends[end] = ("road", arm.road.id, arm.contact)


def crossing(m, node, roads):
    around = arms(node, roads)
    through = [arm.road for arm in around if any(math.isclose(abs(arm.heading - o.heading), math.pi) for o in around)]
    level = [r for r in through if roads_level(r, roads)]
    major = level if len(level) == 2 else through[:2]
    minor = [arm.road for arm in around if arm.road not in major]
    zebras = [arm.road for arm in around] if node in LIGHTS else major[:1] + minor[:1]
    control = "lights" if node in LIGHTS else "stop" if node in STOPS else "yield"
    if (node[0] + 2 * node[1]) % 7 == 3 and node not in LIGHTS and node not in STOPS:
        control, major = "none", []
    m.junction(around, control, major if control != "lights" else (), zebras=zebras, pairs=True)


def roads_level(road, roads):
    """Whether a street runs east."""
    (a, b), = [k for k, r in roads.items() if r is road]
    return a[1] == b[1]


def city():
    m, rng = Map("city"), generator(7)
    roads = streets(m)
    for i in range(COLUMNS):
        for j in range(ROWS):
            build = corner if len(neighbours((i, j))) == 2 else crossing
            build(m, (i, j), roads)
    for road in roads.values():
        if road.profile.parking:
            parked(m, road, rng)
    for street in BUSES:
        road = roads[street]
        for forward in (True, False):
            road.signals.append(bus_stop(m.id(), road, road.length / 2 + (8 if forward else -8), forward))
    return m
