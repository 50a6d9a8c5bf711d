"""The map `lakeside`: a few blocks of a town, a street that leaves it through a tunnel, a road along a lake, and an expressway
back around the lake, on bridges over its outlet and over the railway, which the road along the lake crosses on the level.

Beside that road lies a branch of the railway, at the kerbs of the main street of the town lie tracks of a tramway, and
behind its pavement basins of water. A country road leads over a hill, up to 10 % steep, to a hamlet and back to the town.
"""

import math

from crossing import crossing, kerb
from network import Arm, Network, Path, Strip
from opendrive import beside, zebra
from ring import height, limits, park, parked, stops
from scenery import area, block, bridge, generator, levels, over, rail, row, tree, tunnel, wall
from site_plan import pose, to_street

STREET = [Strip("driving", 3.5), Strip("shoulder", 2.3), Strip("sidewalk", 3.0)]
TUNNEL = [Strip("driving", 3.5), Strip("shoulder", 0.5), Strip("sidewalk", 2.0)]
COUNTRY = [Strip("driving", 3.5), Strip("shoulder", 0.6)]
PROMENADE = [Strip("driving", 3.5), Strip("shoulder", 0.6), Strip("sidewalk", 3.5)]
EXPRESSWAY = [Strip("driving", 3.75), Strip("driving", 3.75), Strip("shoulder", 1.5)]
PROMENADE_EDGE = sum(strip.width for strip in PROMENADE)
TRACK = Strip("rail", 3.2)
TRAM, GAUGE = 4.65, 1.5  # from the middle of a street to that of a track in its shoulder, and between the middles of rails

# Corners of the town by column and row, and the heights of its columns.
COLUMNS, ROWS, HEIGHTS = (-600.0, -480.0, -360.0), (-100.0, 40.0, 180.0), (7.0, 5.6, 4.5)
FREE = 16.0  # of parked cars before a junction
BACK, WIDE = 18.0, 26.0  # from the middle of a junction to the mouths of its roads
SHORE, EAST, NORTH, HAMLET = (-40.0, 0.0), (620.0, 60.0), (-300.0, 420.0), (80.0, -330.0)
LOW, TOP = 3.0, 24.0  # of the shore and the railway, and of the hill
NORTH_Z, HAMLET_Z = 5.0, 12.0
LAKE = 2.3  # height of its water: were it lower, its banks would hide it from the road
LIGHTS = {(1, 1), (2, 1)}
RAILWAY = 570.0  # how far east it runs
APART, TURN = 4.6, 430.0  # of the tracks of railway and branch, and where this turns away from the road along the lake
CLEAR = 7.4  # of a road over the railway


def mouth(place, heading, back=BACK):
    return (place[0] + back * math.cos(heading), place[1] + back * math.sin(heading)), heading


class Junctions:
    """The arms of each junction, by its name."""

    def __init__(self):
        self.arms = {}

    def add(self, name, road, contact):
        self.arms.setdefault(name, []).append(Arm(road, contact))
        return self.arms[name][-1]


def lakeside():
    net, rng, joins = Network("lakeside"), generator(31), Junctions()
    town(net, rng, joins)
    shore(net, rng, joins)
    expressway(net, rng, joins)
    country(net, rng, joins)
    railway(net, rng)
    for (column, line), arms in ((name, arms) for name, arms in joins.arms.items() if isinstance(name, tuple)):
        control = "lights" if (column, line) in LIGHTS else "yield"
        major = [arm.road for arm in arms if abs(math.sin(arm.heading)) < 0.5] if control == "yield" else ()
        junction = crossing(net, arms, control, major, z=HEIGHTS[column], zebras=False)
        cross(net, arms)
        if (column, line) == (1, 1):
            tramway(net, junction, arms)
    for name, control, z in (("shore", "yield", LOW), ("east", "lights", LOW), ("north", "lights", NORTH_Z), ("hamlet", "yield", HAMLET_Z)):
        arms = joins.arms[name]
        major = [arm.road for arm in arms if abs(math.sin(arm.heading)) < 0.5] if control == "yield" else ()
        crossing(net, arms, control, major, z=z, zebras=False)
        cross(net, arms)
    branch(net, joins.arms["shore"])
    return net


def cross(net, arms):
    """Crosswalks where there are pavements on both sides."""
    for arm in arms:
        both = all(any(s.kind == "sidewalk" for s in strips) for strips in (arm.strips_in(), arm.strips_out()))
        if both:
            arm.road.objects.append(zebra(net.id(), arm.s(3.6), kerb(arm)))


# --- the town -------------------------------------------------------------------------------------


def town(net, rng, joins):
    for column in range(3):
        for line in range(3):
            here = COLUMNS[column], ROWS[line]
            for other, heading in (((column + 1, line), 0.0), ((column, line + 1), math.pi / 2)):
                if max(other) > 2:
                    continue
                (start, _), (end, _) = mouth(here, heading), mouth((COLUMNS[other[0]], ROWS[other[1]]), heading + math.pi)
                path = Path(start, heading).line(math.dist(start, end))
                road = net.road(path, STREET, STREET, 50 if line == 1 else 30)
                road.elevation = over(path.length, HEIGHTS[column], HEIGHTS[other[0]], 0.0)
                joins.add((column, line), road, "start")
                joins.add(other, road, "end")
                is_main = line == other[1] == 1
                furnish(net, road, rng, -1 if is_main else 0)
                if is_main:
                    basin(net, road)
                    stops(net, road, road.length / 2)
                else:
                    bays(net, road, rng, (column, line) == (1, 2))


def bays(net, road, rng, works):
    """Parked cars on both sides, or roadworks."""
    if works:
        roadworks(net, road, 30.0, road.length - 30.0)
    else:
        park(road, FREE)
        parked(net, road, rng, FREE, 0.0)


def furnish(net, road, rng, free=0):
    """Houses, with fences in gaps between them, but on a side that is `free` of them, lamps, trees, and bins."""
    edge = road.width("sidewalk")
    for side in (-1, 1):
        s = 4.0
        while s < road.length - 12.0:
            front, floors = 9.0 + 6.0 * rng(), 2 + int(3.5 * rng())
            depth = 10.0 + 3.0 * rng()
            if s + front > road.length - 4.0:
                break
            size = (depth, front, 3.1 * floors + 1.0)
            is_house = rng() < 0.88
            if side == free:
                pass
            elif is_house:
                block(net, road, "building", "house", s + front / 2, side * (edge + 1.6 + depth / 2), size, to_street(side < 0))
            else:
                tree(net, road, s + front / 2, side * (edge + 6.0), 8.0, 2.4)
            gap = 0.4 if rng() < 0.7 else 5.0
            if gap > 1.0 and side != free and s + front + gap < road.length:
                wall(net, road, "none", "gardenFence", s + front, s + front + gap, side * (edge + 1.8), 1.2, 0.1)
            s += front + gap
        lamps(net, road, side, 8.0, road.length - 6.0)
        s = 16.0 + 6.0 * rng()
        while s < road.length - 10.0:
            kind = rng()
            if kind < 0.6:
                block(net, road, "none", "bin", s, side * (edge + 0.6), (0.6, 0.6, 1.05))
            elif kind < 0.75:
                block(net, road, "none", "postbox", s, side * (edge + 0.6), (0.5, 0.6, 1.35))
            else:
                block(net, road, "obstacle", "bench", s, side * (edge + 0.6), (1.7, 0.6, 0.9))
            s += 11.0 + 8.0 * rng()


def basin(net, road):
    """Water behind the pavement on the right of a street, a little below its lower end."""
    edge, fall = road.width("sidewalk"), height(road, road.length) - height(road, 0.0)
    s0, s1, t0, t1 = 9.0, road.length - 9.0, edge + 3.0, edge + 19.0
    corners = [beyond(road, s, t)[0] for s, t in ((s0, t0), (s1, t0), (s1, t1), (s0, t1))]
    area(net, road, "waterBasin", corners, min(0.0, fall) - 0.4)


def tramway(net, junction, arms):
    """Tracks in the shoulders of the main street, and on through the junction in its middle."""
    street = [arm.road for arm in arms if abs(math.sin(arm.heading)) < 0.5]
    those = {road.id for road in street}
    through = [c.road for c in junction.connections if {end[1] for end in c.road.ends.values()} == those]
    for road, side in [(road, side) for road in street for side in (-1, 1)] + [(road, -1) for road in through]:
        for t in (TRAM - GAUGE / 2, TRAM + GAUGE / 2):
            wall(net, road, "none", "tramTrack", 0.0, road.length, side * t, 0.01, 0.07)


def lamps(net, road, side, s0, s1):
    s = s0
    while s < s1:
        block(net, road, "streetLamp", "lamp", s, side * (road.width("sidewalk") + 0.4), (0.2, 0.2, 6.0), to_street(side < 0))
        s += 27.0


def roadworks(net, road, s0, s1):
    """Cones and barricades on the paved edge of a street."""
    t = -(road.width("driving") + 0.45)
    s = s0
    while s < s1:
        block(net, road, "none", "trafficCone", s, t, (0.4, 0.4, 0.75))
        s += 4.0
    for s in (s0 - 1.5, s1 + 1.5):
        block(net, road, "barrier", "barricade", s, t - 0.9, (0.4, 1.6, 1.0))
    block(net, road, "none", "pallet", (s0 + s1) / 2, t - 1.0, (1.2, 0.8, 0.6))


# --- along the lake -------------------------------------------------------------------------------


def shore(net, rng, joins):
    """The street through the tunnel and the road along the lake, with a promenade on the side of the water."""
    (start, heading), (end, _) = mouth((COLUMNS[2], ROWS[1]), 0.0), mouth(SHORE, math.pi)
    path = Path(start, heading).to(end, 0.0)
    street = net.road(path, TUNNEL, TUNNEL, 50)
    street.elevation = levels([(0.0, HEIGHTS[2]), (60.0, HEIGHTS[2]), (path.length - 20.0, LOW), (path.length, LOW)])
    tunnel(net, street, 70.0, 190.0)
    joins.add((2, 1), street, "start")
    joins.add("shore", street, "end")
    castle(net, street, rng)

    (start, heading), (end, _) = mouth(SHORE, 0.0), mouth(EAST, math.pi, WIDE)
    path = Path(start, heading).hermite(end, 0.0)
    road = net.road(path, PROMENADE, COUNTRY, 70)
    road.elevation = [(0.0, LOW, 0.0, 0.0, 0.0)]
    joins.add("shore", road, "start")
    joins.add("east", road, "end")
    limits(net, road, 70)
    water(net, road)
    promenade(net, road, rng)
    for s0, s1, t in ((20.0, TURN, -16.0), (TURN + 70.0, path.length - 60.0, -9.0)):
        row(net, road, rng, s0, s1, t, 11.0, 9.0, 2.2, 0.8, 4.0)
    level_crossing(net, road)


def castle(net, road, rng):
    """Houses before the tunnel and behind it, and walls of rock and ivy beside it."""
    edge = road.width("sidewalk")
    for side in (-1, 1):
        for s in (14.0, 28.0, 42.0, 56.0, 206.0, 222.0):
            size = (11.0, 12.0, 6.0 + 3.1 * int(4 * rng()))
            block(net, road, "building", "house", s, side * (edge + 7.5), size, to_street(side < 0))
        s = 80.0
        while s < 184.0:
            block(net, road, "building", "castleBuilding", s, side * (edge + 6.5), (11.0, 10.0, 8.0 + 8.0 * rng()), to_street(side < 0))
            s += 12.0
        lamps(net, road, side, 20.0, 66.0)


def water(net, road):
    """The lake, whose southern shore follows the road, with its outlet to the north."""
    near = []
    s = 70.0
    while s < road.length - 110.0:
        point, heading = pose(road.path, s)
        near.append(beside(point, heading, -(13.0 + 1.5 * math.sin(s / 31.0))))
        s += 20.0
    far = [(528.0, 110.0), (512.0, 190.0), (470.0, 260.0), (400.0, 305.0), (310.0, 330.0), (230.0, 335.0), (190.0, 350.0)]
    outlet = [(182.0, 400.0), (186.0, 470.0), (146.0, 470.0), (142.0, 400.0), (132.0, 345.0)]
    west = [(90.0, 320.0), (30.0, 280.0), (-10.0, 210.0), (-22.0, 140.0), (0.0, 80.0)]
    area(net, road, "lakeWater", rounded(rounded(near + far + outlet + west)), LAKE - LOW)


def rounded(shore):
    """An outline with its corners cut, a quarter of each side from them."""
    between = lambda a, b, share: (a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]))
    return [between(a, b, share) for a, b in zip(shore, shore[1:] + shore[:1]) for share in (0.25, 0.75)]


def promenade(net, road, rng):
    """A square with kiosks, then lamps, benches and bins along the water."""
    edge = PROMENADE_EDGE
    corners = []
    for s, t in ((24.0, edge + 0.1), (60.0, edge + 0.1), (60.0, edge + 14.0), (24.0, edge + 14.0)):
        point, heading = pose(road.path, s)
        corners.append(beside(point, heading, -t))
    area(net, road, "plaza", corners, 0.0)
    for s, t in ((30.0, 7.0), (40.0, 9.0), (51.0, 7.5)):
        block(net, road, "obstacle", "kiosk", s, edge + t, (3.6, 2.6, 2.5), -math.pi / 2)
    for s, t in ((35.0, 3.0), (46.0, 3.0), (56.0, 3.0)):
        block(net, road, "none", "bin", s, edge + t, (0.6, 0.6, 1.05))
    block(net, road, "obstacle", "statue", 56.0, edge + 10.0, (1.2, 1.2, 2.6))
    s = 76.0
    while s < road.length - 120.0:
        block(net, road, "streetLamp", "lamp", s, edge + 0.6, (0.2, 0.2, 5.0), -math.pi / 2)
        block(net, road, "obstacle", "bench", s + 9.0, edge + 0.7, (1.8, 0.6, 0.9), math.pi)
        block(net, road, "none", "bin", s + 11.5, edge + 0.6, (0.55, 0.55, 1.0))
        if rng() < 0.5:
            tree(net, road, s + 17.0, edge + 3.0, 6.0 + 2.0 * rng(), 1.6)
        if rng() < 0.35:
            block(net, road, "none", "boat", s + 20.0, edge + 3.4, (4.2, 1.6, 1.1), 0.3, -0.2)
        s += 26.0


def level_crossing(net, road):
    """Posts and open barriers on both sides of the rails."""
    s = crossing_at(road)
    for before, t in ((-5.5, -(road.width("shoulder") + 0.6)), (5.5, PROMENADE_EDGE + 0.6)):
        block(net, road, "pole", "crossingPost", s + before, t, (0.25, 0.25, 3.4))
        block(net, road, "barrier", "barricade", s + before * 1.25, t * 1.2, (0.3, 0.6, 1.2))


def crossing_at(road):
    """Where a road that runs east meets the railway."""
    low, high = 0.0, road.length
    while high - low > 0.001:
        s = (low + high) / 2
        low, high = (s, high) if pose(road.path, s)[0][0] < RAILWAY else (low, s)
    return low


# --- around the lake ------------------------------------------------------------------------------


def expressway(net, rng, joins):
    (start, heading), (end, _) = mouth(EAST, math.pi / 2, WIDE), mouth(NORTH, 0.0, WIDE)
    path = Path(start, heading).line(60.0).arc(250.0, math.pi / 2).to(end, math.pi)
    road = net.road(path, EXPRESSWAY, EXPRESSWAY, 100, kind="rural")
    over_rails, over_outlet = 60.0 + 250.0 * 0.6435, 60.0 + 250.0 * math.pi / 2 + 206.0
    high = LOW + CLEAR + 0.3
    road.elevation = levels(
        [(0.0, LOW), (14.0, LOW), (over_rails - 30.0, high), (over_rails + 40.0, high), (over_outlet - 60.0, 8.0)]
        + [(over_outlet + 80.0, 8.0), (path.length - 20.0, NORTH_Z), (path.length, NORTH_Z)]
    )
    bridge(net, road, over_rails - 32.0, over_rails + 32.0)
    bridge(net, road, over_outlet - 60.0, over_outlet + 60.0, "steel")
    joins.add("east", road, "start")
    joins.add("north", road, "end")
    limits(net, road, 100)
    edge = road.width("shoulder") + 0.8
    free = [(20.0, over_rails - 36.0), (over_rails + 36.0, over_outlet - 64.0), (over_outlet + 64.0, path.length - 30.0)]
    for s0, s1 in free:
        for side in (-1, 1):
            rail(net, road, s0, s1, side * edge)
            row(net, road, rng, s0 + 5.0, s1, side * (edge + 9.0), 10.0, 10.0, 2.5, 0.6, 6.0)
    # Back to the town, in two streets.
    for heading, corner in ((-math.pi / 2, (2, 2)), (math.pi / 2, (0, 2))):
        (start, _), (end, _) = mouth(NORTH, heading, WIDE), mouth((COLUMNS[corner[0]], ROWS[2]), math.pi / 2)
        path = Path(start, heading)
        path = path.hermite(end, -math.pi / 2) if heading < 0 else path.line(10.0).arc(70.0, math.pi / 2).hermite(end, -math.pi / 2)
        back = net.road(path, COUNTRY, COUNTRY, 70, kind="rural")
        back.elevation = levels([(0.0, NORTH_Z), (20.0, NORTH_Z), (path.length - 20.0, HEIGHTS[corner[0]]), (path.length, HEIGHTS[corner[0]])])
        joins.add("north", back, "start")
        joins.add(corner, back, "end")
        limits(net, back, 70)
        for side in (-1, 1):
            row(net, back, rng, 20.0, path.length - 40.0, side * 9.0, 12.0, 9.0, 2.2, 0.7, 4.0)


# --- over the hill --------------------------------------------------------------------------------


def country(net, rng, joins):
    (start, heading), (end, _) = mouth(EAST, 0.0, WIDE), mouth(HAMLET, 0.0)
    path = Path(start, heading).line(40.0).arc(90.0, -math.pi).hermite(end, math.pi)
    road = net.road(path, COUNTRY, COUNTRY, 80, kind="rural")
    over_rails = 40.0 + 90.0 * math.pi + (EAST[0] + WIDE + 40.0 - RAILWAY)
    high = LOW + CLEAR
    road.elevation = levels(
        [(0.0, LOW), (20.0, LOW), (over_rails - 45.0, high), (over_rails + 40.0, high), (over_rails + 250.0, TOP)]
        + [(path.length - 25.0, HAMLET_Z), (path.length, HAMLET_Z)]
    )
    bridge(net, road, over_rails - 30.0, over_rails + 30.0)
    joins.add("east", road, "start")
    joins.add("hamlet", road, "end")
    limits(net, road, 80)
    edge = road.width("shoulder") + 0.8
    # On the outside of the bend, and up to the bridge.
    rail(net, road, 30.0, over_rails - 34.0, edge)
    rail(net, road, over_rails + 34.0, over_rails + 120.0, edge)
    for side in (-1, 1):
        row(net, road, rng, over_rails + 50.0, path.length - 60.0, side * 10.0, 9.0, 10.0, 2.6, 0.75, 6.0)
    hamlet(net, road, rng, path.length - 70.0, path.length - 22.0)

    for place, heading, name, arrive in ((SHORE, math.pi / 2, "shore", -math.pi / 2), ((COLUMNS[2], ROWS[0]), math.pi, (2, 0), -math.pi / 2)):
        (start, _), (end, _) = mouth(HAMLET, heading), mouth(place, arrive)
        path = Path(start, heading).hermite(end, math.pi / 2)
        way = net.road(path, COUNTRY, COUNTRY, 70, kind="rural")
        z = LOW if name == "shore" else HEIGHTS[2]
        way.elevation = levels([(0.0, HAMLET_Z), (25.0, HAMLET_Z), (path.length - 20.0, z), (path.length, z)])
        joins.add("hamlet", way, "start")
        joins.add(name, way, "end")
        limits(net, way, 70)
        hamlet(net, way, rng, 22.0, 60.0)
        for side in (-1, 1):
            t = 16.0 if name == "shore" and side < 0 else 9.0  # beyond the branch line
            row(net, way, rng, 80.0, path.length - 40.0, side * t, 12.0, 9.0, 2.3, 0.6, 5.0)


def hamlet(net, road, rng, s0, s1):
    """Farms on both sides, with a fence before them."""
    edge = road.width("shoulder")
    for side in (-1, 1):
        s = s0 + 8.0
        while s < s1:
            block(net, road, "building", "farmhouse", s, side * (edge + 10.0), (9.0, 11.0, 5.5 + 2.0 * rng()), to_street(side < 0))
            wall(net, road, "none", "gardenFence", s - 5.0, s + 5.0, side * (edge + 2.5), 1.1, 0.1)
            s += 19.0


def railway(net, rng):
    """A single track, which ends beyond what one sees."""
    path = Path((RAILWAY - TRACK.width / 2, -420.0), math.pi / 2).line(960.0)
    track = net.road(path, [], [TRACK], 100, kind="rural", is_lined=False)
    track.elevation = [(0.0, LOW, 0.0, 0.0, 0.0)]
    for side in (-1, 1):
        row(net, track, rng, 30.0, 300.0, side * 12.0, 14.0, 9.0, 2.2, 0.5, 5.0)


def branch(net, arms):
    """A track from a buffer stop beside the road from the hamlet, along that by the lake, to the railway."""
    _, road, way = (arm.road for arm in arms)
    t, halt, leave, join = way.width("shoulder") + 2.6, 80.0, way.length - 70.0, 75.0
    (start, heading), (corner, onward) = beyond(way, halt, t), beyond(road, join, t)
    path = follow(Path(start, heading), way, halt, leave, t)
    down = path.length
    follow(path.to(corner, onward), road, join, TURN, t).to((RAILWAY - APART + TRACK.width / 2, -420.0), -math.pi / 2)
    track = net.road(path, [], [TRACK], 60, kind="rural", is_lined=False)
    slope = [(s, height(way, halt + (leave - halt) * s / down)) for s in (down * k / 10 for k in range(11))]
    track.elevation = levels(slope + [(down + 50.0, LOW), (path.length, LOW)])
    block(net, track, "obstacle", "bufferStop", 0.5, -TRACK.width / 2, (0.8, 2.4, 1.2))


def beyond(road, s, right):
    point, heading = pose(road.path, s)
    return beside(point, heading, right), heading


def follow(path, road, s0, s1, right):
    """Leads a path on beside a road."""
    count = round((s1 - s0) / 40.0)
    for k in range(1, count + 1):
        path.hermite(*beyond(road, s0 + (s1 - s0) * k / count, right))
    return path
