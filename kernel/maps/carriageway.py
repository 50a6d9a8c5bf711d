"""Carriageways of a motorway: a closed line, what lies along either side of it, and the junctions where lanes begin and end."""

import math
from dataclasses import dataclass

from network import Arm, Path, Row, Section, between, joined
from opendrive import beside, unit, wrap

class Line:
    """A closed line of straights and arcs, from (length, curvature) of each."""

    def __init__(self, parts):
        self.pieces, s = [], 0.0
        path = Path((0.0, 0.0), 0.0)
        for length, curvature in parts:
            self.pieces.append((s, length, curvature, path.point, path.heading))
            path.arc(1 / abs(curvature), length * curvature) if curvature else path.line(length)
            s += length
        self.length = s

    def piece(self, s):
        return max((p for p in self.pieces if p[0] <= s + 1e-9), key=lambda p: p[0])

    def at(self, s):
        """Place and heading at `s`."""
        start, _, curvature, point, heading = self.piece(s % self.length)
        path, ds = Path(point, heading), s % self.length - start
        path.arc(1 / abs(curvature), ds * curvature) if curvature and ds else path.line(ds)
        return path.point, path.heading

    def middle(self):
        """Of a line that is one half driven twice: between two opposite places."""
        (x0, y0), (x1, y1) = self.at(0.0)[0], self.at(self.length / 2)[0]
        return (x0 + x1) / 2, (y0 + y1) / 2

    def portions(self, s0, s1):
        """(start, length, curvature) of the pieces between two places, in either direction."""
        cuts = {s0, s1}
        for start, *_ in self.pieces:
            for turn in (-2, -1, 0, 1):
                cuts.add(start + turn * self.length)
        cuts = sorted(c for c in cuts if min(s0, s1) <= c <= max(s0, s1))
        out = []
        for a, b in zip(cuts, cuts[1:]):
            if b - a > 1e-6:
                curvature = self.piece((a + b) / 2 % self.length)[2]
                out.append((a, b - a, curvature) if s1 > s0 else (b, b - a, -curvature))
        return out if s1 > s0 else out[::-1]


@dataclass
class Heights:
    """Heights along a closed line: level at every node (s, z), and smooth between."""

    nodes: list
    length: float

    def at(self, s):
        """Height and slope."""
        s %= self.length
        nodes = [*self.nodes, (self.nodes[0][0] + self.length, self.nodes[0][1])]
        a, b = max((p for p in zip(nodes, nodes[1:]) if p[0][0] <= s), key=lambda p: p[0][0])
        p, rise, length = (s - a[0]) / (b[0] - a[0]), b[1] - a[1], b[0] - a[0]
        return a[1] + rise * p * p * (3 - 2 * p), rise * 6 * p * (1 - p) / length

    def cut(self, s0, s1):
        """Two places and the nodes between them, in order."""
        rounds = [z * self.length for z in range(-3, 3)]
        between = [s + turn for s, _ in self.nodes for turn in rounds if min(s0, s1) + 0.5 < s + turn < max(s0, s1) - 0.5]
        return [s0, *sorted(between, reverse=s1 < s0), s1]


class Carriageway:
    """One direction of a motorway; `u` is how far along the line one has come in it."""

    def __init__(self, net, line, heights, forward, aside, left):
        self.net, self.line, self.heights, self.forward = net, line, heights, forward
        self.aside, self.left = aside, left

    def s(self, u):
        return u if self.forward else -u

    def heading(self, u):
        heading = self.line.at(self.s(u))[1]
        return heading if self.forward else wrap(heading + math.pi)

    def place(self, u, right=0.0):
        """What lies beside the inner edge, with its heading."""
        point, _ = self.line.at(self.s(u))
        heading = self.heading(u)
        return beside(point, heading, self.aside + right), heading

    def height(self, u):
        return self.heights.at(self.s(u))[0]

    def span(self, u0, u1):
        """The inner edge between two places, and its heights."""
        path, records = Path(*self.place(u0)), []
        for start, length, curvature in self.line.portions(self.s(u0), self.s(u1)):
            # Farther out in a bend, a way is longer.
            stretch = 1 + self.aside * curvature
            records += self._records(path.length, start, length, stretch)
            if curvature:
                path.arc(stretch / abs(curvature), length * curvature)
            else:
                path.line(length)
        return path, records

    def _records(self, at, start, length, stretch):
        """Heights along a piece: a cubic between two nodes, as the heights of the line are."""
        sign = 1 if self.forward else -1
        places, out = self.heights.cut(start, start + sign * length), []
        for s0, s1 in zip(places, places[1:]):
            ds = abs(s1 - s0) * stretch
            (z0, m0), (z1, m1) = self.heights.at(s0), self.heights.at(s1)
            m0, m1 = m0 * sign / stretch, m1 * sign / stretch
            c = 3 * (z1 - z0) / ds**2 - (2 * m0 + m1) / ds
            d = (m0 + m1) / ds**2 - 2 * (z1 - z0) / ds**3
            out.append((at + abs(s0 - start) * stretch, z0, m0, c, d))
        return out

    def road(self, u0, u1, sections, kmh):
        """A road; `sections` are (from here on, strips to the right)."""
        path, records = self.span(u0, u1)
        road = self.net.road(path, self.left, sections[0][1], kmh, kind="motorway", elevation=records)
        road.sections = [Section(s if s >= 0 else path.length + s, self.left, strips) for s, strips in sections]
        return road

    def junction(self, u0, u1, before, after, ways, through):
        """Where lanes begin, end or part; `ways` are (arm, arm, lane from, lane to, whether it waits).

        Gives the road that leads straight on, and the others.
        """
        j = self.net.junction()
        source, target = Arm(before, "end"), Arm(after, "start")
        path, records = self.span(u0, u1)
        into, out = source.strips_in(), target.strips_out()
        rows = [Row("driving", -n, -n, (into[n - 1].width, out[n - 1].width)) for n in range(1, through + 1)]
        left = [Row(s.kind, n, n, (s.width, s.width)) for n, s in enumerate(self.left, start=1)]
        main = self.net.connect(j, source, target, path, rows, left, elevation=records, is_lined=True)
        others = []
        for a, b, n_in, n_out, waits in ways:
            a, b = a or source, b or target
            kerbside = joined(a, b, n_in - 1, n_out - 1, True)
            way = between(a, b, n_in - 1, n_out - 1)
            along = stretched(records, path.length, way.length)
            others.append(self.net.connect(j, a, b, way, kerbside, elevation=along, is_lined=True))
            if waits:
                j.priorities.append((main.id, others[-1].id))
        return main, others


def stretched(records, length, to):
    """Heights along a way beside another that is a little longer or shorter."""
    f = to / length
    return [(s * f, a, b / f, c / f**2, d / f**3) for s, a, b, c, d in records]


def frame(carriageway, u):
    """Places around a place of a carriageway: `ahead` and to the `right` of its inner edge."""
    point, heading = carriageway.place(u)
    c, s = unit(heading)

    def at(ahead, right):
        x, y = beside(point, heading, right)
        return x + ahead * c, y + ahead * s

    return at, heading
