"""The map `rural`: a loop of country road over gentle hills, two lanes across it, and a hamlet.

The loop is one half driven twice: a half that turns by 180 degrees in all closes by symmetry.
"""

import math
from dataclasses import replace

from opendrive import Arm, Map, Path2, Profile, num, speed_sign, wrap, zebra

COUNTRY = Profile(lanes=1, width=3.5, edge=0.5, parking=False, sidewalk=0, kmh=100, kind="rural")
WINDING = replace(COUNTRY, kmh=80)
LANE = replace(COUNTRY, width=3.1, kmh=70)
HAMLET = replace(COUNTRY, sidewalk=2.0, kmh=50, kind="town")
BACK = 15.0  # from the middle of a junction to the mouths of its roads, metres
HEIGHTS = {"T1": 0.0, "T2": 5.0, "T3": 1.0, "T4": 6.5, "centre": 3.5}
RAIL_RADIUS = 130.0  # bends tighter than this have a guard rail on the outside


def turn(path, radius, degrees, ease):
    return path.bend(radius, math.radians(degrees), ease)


def winding(path):
    """The first part of a half; turns by 90 degrees in all."""
    turn(path.line(150), 140, 60, 40)
    turn(path.line(100), 90, -50, 30)
    turn(path.line(120), 120, 80, 40)
    path.line(100)


def open_country(path):
    turn(path.line(140), 220, 55, 60).line(120)


def hamlet(path):
    turn(path.line(110), 160, 20, 30).line(90)


def homewards(path):
    turn(path.line(80), 100, -35, 30)
    turn(path.line(60), 110, 50, 35).line(120)


def hills(length, z0, z1, bump):
    """Two smooth steps: level at both ends, `bump` metres above the mean in the middle."""
    top, half, out = (z0 + z1) / 2 + bump, length / 2, []
    for s, a, b in ((0.0, z0, top), (half, top, z1)):
        out.append((s, a, 0.0, 3 * (b - a) / half**2, -2 * (b - a) / half**3))
    return out


def guard_rails(m, road):
    s = 0.0
    for piece in road.path.pieces:
        if piece.curve.startswith("<arc"):
            curvature = float(piece.curve.split('"')[1])
            if abs(curvature) > 1 / RAIL_RADIUS:
                t = -math.copysign(road.profile.kerb + 1.0, curvature)
                road.objects.append(
                    f'<object id="{m.id()}" type="barrier" name="guardRail" s="{num(s)}" t="{num(t)}" zOffset="0" '
                    f'hdg="0" orientation="none" length="{num(piece.length)}" width="0.25" height="0.8">'
                    f'<repeat s="{num(s)}" length="{num(piece.length)}" distance="0" tStart="{num(t)}" tEnd="{num(t)}" '
                    f'widthStart="0.25" widthEnd="0.25" heightStart="0.8" heightEnd="0.8" zOffsetStart="0" '
                    f'zOffsetEnd="0"/></object>'
                )
        s += piece.length


def chain(m, path, parts, z0, z1):
    """Roads one after another from a junction to the next; `parts` are (what to add, profile, bump)."""
    roads, z = [], z0
    for k, (draw, profile, bump) in enumerate(parts):
        part = Path2(path.point, path.heading)
        draw(part)
        path.point, path.heading = part.point, part.heading
        road = m.road(part, profile)
        z_next = z0 + (z1 - z0) * (k + 1) / len(parts)
        road.elevation = hills(part.length, z, z_next, bump)
        z = z_next
        if roads:
            m.join(roads[-1], road)
        roads.append(road)
    return roads


def furnish(m, first, village, last):
    """Zebra crossings in the hamlet, and the limits before and behind it."""
    for s in (70.0, village.length - 60.0):
        village.objects.append(zebra(m.id(), s, village.profile.kerb))
    for road, s, kmh, forward in (
        (village, 2.0, 50, True),
        (village, village.length - 2.0, 50, False),
        (last, 4.0, 100, True),
        (first, first.length - 4.0, 100, False),
    ):
        road.signals.append(speed_sign(m.id(), road, s, kmh, forward))


def halves(m):
    """The loop: (name, junction's middle, heading there, road before, road behind)."""
    path, stops, before = Path2((0.0, 0.0), 0.0), [], []
    names = ["T1", "T2", "T3", "T4"]
    for k, name in enumerate(names):
        middle = (path.point[0] + BACK * math.cos(path.heading), path.point[1] + BACK * math.sin(path.heading))
        heading = path.heading
        path.line(2 * BACK)
        z0, z1 = HEIGHTS[name], HEIGHTS[names[(k + 1) % 4]]
        if k % 2 == 0:
            roads = chain(m, path, [(winding, WINDING, 2.5 if k else -2.0)], z0, z1)
        else:
            bumps = (3.0, 0.6, -1.5) if k == 1 else (-2.5, -0.6, 2.0)
            parts = [open_country, hamlet, homewards]
            profiles = [COUNTRY, HAMLET if k == 1 else COUNTRY, COUNTRY]
            roads = chain(m, path, list(zip(parts, profiles, bumps)), z0, z1)
            if k == 1:
                furnish(m, *roads)
        stops.append((name, middle, heading, roads))
    return stops


def rural():
    m = Map("rural")
    loop = halves(m)
    centre = tuple(sum(stop[1][axis] for stop in loop) / 4 for axis in (0, 1))
    inner = []
    for k, (name, middle, heading, roads) in enumerate(loop):
        behind, ahead = loop[k - 1][3][-1], roads[0]
        side = heading + math.pi / 2
        at = lambda h, p=middle: (p[0] + BACK * math.cos(h), p[1] + BACK * math.sin(h))
        outward = math.atan2(middle[1] - centre[1], middle[0] - centre[0])
        near = (centre[0] + BACK * math.cos(outward), centre[1] + BACK * math.sin(outward))
        path = Path2(at(side), side).hermite(near, outward + math.pi)
        cross = m.road(path, LANE)
        cross.elevation = hills(path.length, HEIGHTS[name], HEIGHTS["centre"], 1.0 if k % 2 else -1.0)
        arms = [
            Arm(behind, "end", at(heading + math.pi), wrap(heading + math.pi)),
            Arm(ahead, "start", at(heading), heading),
            Arm(cross, "start", at(side), wrap(side)),
        ]
        m.junction(arms, "stop" if k == 2 else "yield", [behind, ahead], z=HEIGHTS[name])
        inner.append(Arm(cross, "end", near, wrap(outward)))
    m.junction(inner, "yield", [inner[0].road, inner[2].road], z=HEIGHTS["centre"])
    for road in m.roads:
        guard_rails(m, road)
    return m
