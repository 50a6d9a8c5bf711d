"""What stands beside streets: put where there is room, never on a lane and never into something else."""

import math
import re

from opendrive import beside, unit
from streets import thing, verge

CELL = 0.25  # side of the squares that are free or taken, metres
MARGIN = 0.2  # kept free beside lanes, metres
INSET = 0.2  # what touches another thing, or a lane's margin, by less still fits, metres


def pose(path, s):
    """Place and heading `s` metres along a path."""
    for piece in path.pieces:
        if s <= piece.length or piece is path.pieces[-1]:
            return along(piece, s)
        s -= piece.length
    raise ValueError("a path without pieces")


def along(piece, s):
    values = dict(re.findall(r'(\w+)="([^"]*)"', piece.curve))
    if "curvature" in values:
        k = float(values["curvature"])
        turn = k * s
        u, v = math.sin(turn) / k, (1 - math.cos(turn)) / k
    elif "bU" in values:
        p = s / piece.length
        of = lambda axis, power: float(values["abcd"[power] + axis])
        u, v = (sum(of(axis, n) * p**n for n in range(4)) for axis in "UV")
        du, dv = (sum(n * of(axis, n) * p ** (n - 1) for n in range(1, 4)) for axis in "UV")
        turn = math.atan2(dv, du)
    else:
        u, v, turn = s, 0.0, 0.0
    c, n = unit(piece.hdg)
    return (piece.x + u * c - v * n, piece.y + u * n + v * c), piece.hdg + turn


class Site:
    """The ground of a town: which of its squares are taken."""

    def __init__(self, town, rng):
        self.town, self.rng, self.taken = town, rng, set()
        for road in town.roads:
            profile = max((p for _, p in road.sections), key=lambda p: verge(p.right) + verge(p.left))
            self._pave(road.path, verge(profile.right), verge(profile.left))
        for c in (c for j in town.junctions for c in j.connections):
            self._pave(c.path, sum(max(row.width, row.width_end) for row in c.rows), 0.0)

    def _pave(self, path, right, left):
        steps = int(path.length / CELL) + 2
        across = int((right + left + 2 * MARGIN) / CELL) + 2
        for k in range(steps + 1):
            point, heading = pose(path, path.length * k / steps)
            for n in range(across + 1):
                t = right + MARGIN - (right + left + 2 * MARGIN) * n / across
                x, y = beside(point, heading, t)
                self.taken.add((int(x // CELL), int(y // CELL)))

    def _squares(self, point, heading, length, width):
        length, width = (max(0.0, extent - 2 * INSET) for extent in (length, width))
        n, m = int(length / CELL) + 1, int(width / CELL) + 1
        c, s = unit(heading)
        for i in range(n + 1):
            for k in range(m + 1):
                u, v = length * (i / n - 0.5), width * (k / m - 0.5)
                yield int((point[0] + u * c - v * s) // CELL), int((point[1] + u * s + v * c) // CELL)

    def put(self, road, kind, name, place, size, hdg=0.0, room=0.0, lift=0.0):
        """A box beside a street, with so much room around it; says whether it fits."""
        s, t = place
        centre, heading = pose(road.path, s)
        point = beside(centre, heading, -t)
        squares = set(self._squares(point, heading + hdg, size[0] + 2 * room, size[1] + 2 * room))
        if squares & self.taken:
            return False
        self.taken |= squares
        road.objects.append(thing(self.town.id(), kind, name, place, size, hdg, lift))
        return True

    def keep_free(self, road, place, size, hdg=0.0):
        """Nothing else is put here."""
        centre, heading = pose(road.path, place[0])
        self.taken |= set(self._squares(beside(centre, heading, -place[1]), heading + hdg, *size))

    def between(self, low, high):
        return low + (high - low) * self.rng()


def out(road, s, right, beyond):
    """`t` that lies `beyond` metres beyond the sidewalk of a side, where bays are widest."""
    profile = max((p for _, p in road.sections), key=lambda p: verge(p.side(right)))
    t = verge(profile.side(right)) + beyond
    return -t if right else t


def to_street(right):
    """The heading, seen from the street, of what faces it."""
    return math.pi / 2 if right else -math.pi / 2


def lamps(site, road, right, pitch=30.0, beyond=0.6):
    s = pitch / 2
    while s < road.length - 4:
        site.put(road, "streetLamp", "lamp", (s, out(road, s, right, beyond)), (0.2, 0.2, 5.0), to_street(right))
        s += pitch


def parked(site, road, share, skip=()):
    """Cars in the bays of a street, but not where `skip` (right, from, to) keeps a gate free."""
    for (start, profile), (end, _) in zip(road.sections, road.sections[1:]):
        for right in (True, False):
            strips = profile.side(right)
            bay = next((k for k, strip in enumerate(strips) if strip.kind == "parking"), None)
            if bay is None:
                continue
            t = sum(strip.width for strip in strips[:bay]) + strips[bay].bay / 2 + 0.15
            s = start + 8.0
            while s < end - 8.0:
                is_gate = any(side == right and a - 2.6 < s < b + 2.6 for side, a, b in skip)
                if not is_gate and site.rng() < share:
                    hdg = 0.0 if right else math.pi
                    place = (s + site.between(-0.3, 0.3), -t if right else t)
                    road.objects.append(thing(site.town.id(), "none", "parkedCar", place, (4.4, 1.8, 1.5), hdg))
                s += 6.0
