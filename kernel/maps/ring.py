"""The map `ring`: the ring road of a middle-sized town, with four roundabouts, two junctions with lights, and bus stops.

Streets lead from the ring to the middle of the town, and two roads run outside of it from one roundabout to another.
"""

import math

from crossing import board, crossing, kerb
from network import Arm, Network, Path, Section, Strip
from opendrive import beside, wrap, zebra
from roundabout import Roundabout
from scenery import area, block, generator, over, rail, row, tree, wall
from site_plan import pose

LANE, GRASS, WALK = 3.5, 2.5, 2.5
VERGE = Strip("none", 3.0)
# The ring and the roads outside have grass on both sides of their pavements, which keeps houses off.
RING = [Strip("driving", LANE), Strip("shoulder", 0.5), Strip("none", GRASS), Strip("sidewalk", WALK), VERGE]
STREET = [Strip("driving", LANE), Strip("shoulder", 2.3), Strip("sidewalk", 3.0)]
CIRCLE = [Strip("shoulder", 0.5), Strip("none", GRASS), Strip("sidewalk", WALK), VERGE]

RADIUS = 24.0  # of the roundabouts, at the middle of the lane
ACROSS, UP = 520.0, 400.0  # half axes of the ring
# Nodes of the ring by their angle from the middle of the town, and their heights.
NODES = {"east": (0, 2.0), "light_1": (62, 5.0), "north": (118, 8.0), "west": (180, 5.5), "light_2": (242, 2.5), "south": (300, 0.0)}
ROUNDABOUTS = ("east", "north", "west", "south")
MIDDLE, MIDDLE_HEIGHT = (-30.0, 20.0), 4.5
# Stretches of the ring: limit in km/h, height above the mean in between, and what is beside them.
STRETCHES = {
    ("east", "light_1"): (50, 0.8, "ponds"),
    ("light_1", "north"): (50, -0.6, "bus"),
    ("north", "west"): (70, -2.0, "walls"),
    ("west", "light_2"): (50, 0.7, "bus"),
    ("light_2", "south"): (50, 0.5, "ponds"),
    ("south", "east"): (70, 1.6, "walls"),
}
STREETS = ("east", "light_1", "west", "light_2")  # from here to the middle
OUTSIDE = {("north", "west"): (60, 1.5), ("south", "east"): (60, -1.0)}
PONDS = (70.0, 150.0), (185.0, 260.0), (340.0, 440.0)  # from and to, along the outside of some bends that are long enough
BACK = 18.0  # from the middle of a junction with lights to the mouths of its roads
BEFORE_CIRCLE = 30.0  # from the mouth of a roundabout to the crosswalk on its arm
AT_LIGHTS = 6.5  # paved for those who cross before a junction with lights


def place(name):
    angle = math.radians(NODES[name][0])
    return ACROSS * math.cos(angle), UP * math.sin(angle)


def onward(name):
    """The heading of the ring, driven round to the left."""
    angle = math.radians(NODES[name][0])
    return math.atan2(UP * math.cos(angle), -ACROSS * math.sin(angle))


def inward(name):
    x, y = place(name)
    return math.atan2(MIDDLE[1] - y, MIDDLE[0] - x)


def headings(name):
    """How roads leave a node: onward, backward, to the middle, and outside."""
    # The ring comes in aslant, so that arms are apart.
    found = {"onward": onward(name), "backward": wrap(onward(name) + math.pi)}
    if name in STREETS:
        found["middle"] = inward(name)
    if any(name in pair for pair in OUTSIDE):
        found["outside"] = wrap(onward(name) - math.pi / 2)
    return found


class Node:
    """A node of the ring, with what its roads begin at."""

    def __init__(self, name):
        self.name, self.z, self.headings = name, NODES[name][1], headings(name)
        self.is_round = name in ROUNDABOUTS
        self.circle = Roundabout(place(name), RADIUS, self.headings.values(), self.z) if self.is_round else None
        self.arms = []

    def mouth(self, way):
        heading = self.headings[way]
        if self.is_round:
            return self.circle.mouth(heading), heading
        x, y = place(self.name)
        return (x + BACK * math.cos(heading), y + BACK * math.sin(heading)), heading

    def build(self, net, rng):
        if self.is_round:
            island(net, self.circle.join(net, self.arms, CIRCLE), rng)
        else:
            crossing(net, self.arms, "lights", z=self.z)


def draw(net, a, way_a, b, way_b, strips, kmh, bump):
    """The road from a node to another."""
    (start, heading), (end, back) = a.mouth(way_a), b.mouth(way_b)
    path = Path(start, heading).hermite(end, wrap(back + math.pi))
    road = net.road(path, strips, strips, kmh)
    road.elevation = over(path.length, a.z, b.z, bump)
    a.arms.append(Arm(road, "start"))
    b.arms.append(Arm(road, "end"))
    limits(net, road, kmh)
    return road


def limits(net, road, kmh):
    """A sign where the road begins, for either direction."""
    road.signals += [board(net.id(), road, 6.0, True, "274", kmh), board(net.id(), road, road.length - 6.0, False, "274", kmh)]


def paved(strips):
    """Strips with paving instead of the grass before the pavement."""
    walk = [s.kind for s in strips].index("sidewalk")
    return [Strip("curb", s.width) if s.kind == "none" and k < walk else s for k, s in enumerate(strips)]


def cross(net, road, start, end):
    """Crosswalks near the start and end of a road: before roundabouts here, before lights by the junction."""
    grass, crossed = road.sections[0].right, paved(road.sections[0].right)
    section = lambda s, strips: Section(s, strips, strips)
    sections = [section(0.0, grass)]
    for node, s in ((start, BEFORE_CIRCLE), (end, road.length - BEFORE_CIRCLE)):
        if node.is_round:
            road.objects.append(zebra(net.id(), s, kerb(Arm(road, "start"))))
            sections += [section(s - 2.5, crossed), section(s + 2.5, grass)]
        elif s < road.length / 2:
            sections = [section(0.0, crossed), section(AT_LIGHTS, grass)]
        else:
            sections.append(section(road.length - AT_LIGHTS, crossed))
    if crossed != grass:
        road.sections = sections


def park(road, free=48.0):
    """Lets cars park along a street, but not so near where it begins and ends."""
    strips = road.sections[0].right
    bays = [Strip("parking", s.width) if s.kind == "shoulder" else s for s in strips]
    road.sections += [Section(free, bays, bays), Section(road.length - free, strips, strips)]


def parked(net, road, rng, free=48.0, halt=30.0):
    edge = road.width("driving")
    for side in (-1, 1):
        s = free + 4.0
        while s < road.length - free - 6.0:
            # Buses halt in the middle.
            if rng() < 0.5 and abs(s - road.length / 2) > halt:
                hdg = 0.0 if side < 0 else math.pi
                road.objects.append(
                    f'<object id="{net.id()}" type="none" name="parkedCar" s="{s:.2f}" t="{side * (edge + 1.15):.2f}" '
                    f'zOffset="0" hdg="{hdg:.6f}" orientation="none" length="4.4" width="1.8" height="1.5"/>'
                )
            s += 6.5


def stops(net, road, s):
    """A bus stop in each direction, the one behind the other."""
    road.signals += [board(net.id(), road, s + 12.0, True, "224"), board(net.id(), road, s - 12.0, False, "224")]
    behind = road.width("sidewalk") + 1.2
    for at, side in ((s + 8.0, -1), (s - 8.0, 1)):
        block(net, road, "obstacle", "busShelter", at, side * behind, (3.6, 1.4, 2.5), 0.0 if side > 0 else math.pi)
        block(net, road, "none", "bin", at + 3.0, side * behind, (0.5, 0.5, 1.0))


def furnish(net, road, rng, beside):
    """What stands along the ring: trees on the grass, and behind the pavement trees or walls against noise."""
    grass, behind = road.width("shoulder") + GRASS / 2, road.width("sidewalk") + 1.6
    away = behind + 5.0
    if beside == "ponds":
        ponds(net, road)
    for side in (-1, 1):
        if beside != "walls":
            row(net, road, rng, 40.0, road.length - 36.0, side * grass, 13.0, 6.0, 1.3, 0.85)
        if beside == "walls" and side < 0:
            wall(net, road, "soundBarrier", "noiseWall", 45.0, road.length - 45.0, side * behind, 3.5)
            row(net, road, rng, 40.0, road.length - 40.0, side * away, 9.0, 9.0, 2.2, 0.8, 4.0)
        else:
            # Nothing hides the ponds.
            start = shores(road)[-1][1] + 10.0 if beside == "ponds" and side < 0 else 30.0
            row(net, road, rng, start, road.length - 30.0, side * away, 8.0, 9.0, 2.5, 0.7, 7.0)
            hedges(net, road, rng, start + 15.0, side * behind)


def shores(road):
    return [pond for pond in PONDS if pond[1] < road.length - 120.0]


def ponds(net, road):
    """Water behind the pavement, a little below the road."""
    t = road.width("sidewalk") + 2.0
    for s0, s1 in shores(road):
        low = min(height(road, s) for s in (s0, s1)) - height(road, 0.0) - 0.45
        middle, half = (s0 + s1) / 2, (s1 - s0) / 2
        shore = []
        for k in range(20):
            angle = math.tau * k / 20
            point, heading = pose(road.path, middle + half * math.cos(angle))
            shore.append(beside(point, heading, t + 15.0 + (13.0 + 2.0 * math.sin(3 * angle)) * math.sin(angle)))
        area(net, road, "pond", shore, low)


def height(road, s):
    start, *powers = [record for record in road.elevation if record[0] <= s][-1]
    return sum(a * (s - start) ** k for k, a in enumerate(powers))


def hedges(net, road, rng, s, t):
    """Hedges behind the pavement, with gaps, from `s` on."""
    while s < road.length - 50.0:
        if rng() < 0.4:
            block(net, road, "vegetation", "hedge", s, t, (5.6, 1.0, 1.3))
        s += 6.0


def island(net, rings, rng):
    """Trees in the middle of a roundabout, to the left of those who drive round."""
    for road in rings:
        for t in (7.0, 14.0):
            tree(net, road, road.length / 2, t + 2.0 * rng(), 5.0 + 4.0 * rng(), 2.0)


def ring():
    net, rng = Network("ring"), generator(11)
    nodes = {name: Node(name) for name in NODES}
    for (a, b), (kmh, bump, beside) in STRETCHES.items():
        road = draw(net, nodes[a], "onward", nodes[b], "backward", RING, kmh, bump)
        furnish(net, road, rng, beside)
        cross(net, road, nodes[a], nodes[b])
        if beside == "bus":
            stops(net, road, road.length / 2)
    for (a, b), (kmh, bump) in OUTSIDE.items():
        road = draw(net, nodes[a], "outside", nodes[b], "outside", RING, kmh, bump)
        furnish(net, road, rng, "ponds")
        # On the outside of the bends at both ends, which are to the left.
        for s in (55.0, road.length - 95.0):
            rail(net, road, s, s + 40.0, -(road.width("sidewalk") + 2.2))
        cross(net, road, nodes[a], nodes[b])
        stops(net, road, road.length / 2)
    middle(net, nodes, rng)
    for node in nodes.values():
        node.build(net, rng)
    return net


def middle(net, nodes, rng):
    """The streets that meet in the middle of the town, where who is on the one from east to west goes first."""
    arms = []
    for name in STREETS:
        node = nodes[name]
        start, heading = node.mouth("middle")
        outward = wrap(node.headings["middle"] + math.pi)
        end = (MIDDLE[0] + BACK * math.cos(outward), MIDDLE[1] + BACK * math.sin(outward))
        path = Path(start, heading).to(end, heading)
        road = net.road(path, STREET, STREET, 50)
        road.elevation = over(path.length, node.z, MIDDLE_HEIGHT, 0.4)
        park(road)
        parked(net, road, rng)
        if node.is_round:
            road.objects.append(zebra(net.id(), BEFORE_CIRCLE, kerb(Arm(road, "start"))))
        stops(net, road, road.length / 2)
        node.arms.append(Arm(road, "start"))
        arms.append(Arm(road, "end"))
    by_name = dict(zip(STREETS, arms))
    crossing(net, arms, "yield", [by_name["east"].road, by_name["west"].road], z=MIDDLE_HEIGHT)
