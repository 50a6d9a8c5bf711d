"""Roundabouts of one lane: a circle of roads with a junction at each arm, driven round to the left.

Ways in and out are arcs that touch the circle and the middle of the arm, wide enough for a bus.
"""

import math

from crossing import YIELD, signal
from network import Arm, Path, Row, Strip, aligned
from opendrive import unit, wrap

LANE = 5.0  # width of the lane that goes round
CORNER = 16.0  # radius of the ways in and out at their left edge; less where there is no room
BETWEEN = 2.0  # of circle between two arms at least
KMH = 30
SIGN_BEFORE = 1.0


class Roundabout:
    """One whose arms leave it at `headings`; draw roads from `mouth`, then `join` them."""

    def __init__(self, middle, radius, headings, z=0.0):
        self.middle, self.z = middle, z
        self.edge = radius - LANE / 2
        narrowest = min(gaps(headings))
        sine = math.sin(min((narrowest - BETWEEN / self.edge) / 2, math.pi / 4))
        self.corner = min(CORNER, self.edge * sine / (1 - sine))
        # Between an arm and where its ways in and out touch the circle.
        self.opening = math.asin(self.corner / (self.edge + self.corner))

    def mouth(self, heading):
        """Where the arm begins that leaves with `heading`."""
        away = math.sqrt((self.edge + self.corner) ** 2 - self.corner**2)
        c, s = unit(heading)
        return self.middle[0] + away * c, self.middle[1] + away * s

    def around(self, angle, by):
        """The circle from an angle on, for another."""
        c, s = unit(angle)
        start = (self.middle[0] + self.edge * c, self.middle[1] + self.edge * s)
        path = Path(start, wrap(angle + math.pi / 2))
        return path.arc(self.edge, by) if by else path

    def bend(self, point, heading):
        """A way in or out, which bends to the right."""
        return Path(point, heading).arc(self.corner, -(math.pi / 2 - self.opening))

    def join(self, net, arms, beyond, kmh=KMH):
        """Builds it; `beyond` are the strips to the right of its lane, outwards. Gives the roads from arm to arm."""
        arms = sorted(arms, key=lambda arm: arm.heading % math.tau)
        level = [(0, self.z, 0, 0, 0)]
        strips = [Strip("driving", LANE), *beyond]
        rings = [
            net.road(self.around(arm.heading + self.opening, gap - 2 * self.opening), [], strips, kmh, elevation=level)
            for arm, gap in zip(arms, gaps([arm.heading for arm in arms]))
        ]
        for k, arm in enumerate(arms):
            self._arm(net, arm, Arm(rings[k - 1], "end"), Arm(rings[k], "start"), level, kmh)
        return rings

    def _arm(self, net, arm, before, after, level, kmh):
        """The junction at an arm: past it, out and in."""
        j = net.junction()
        touches = arm.heading - self.opening
        past = self.around(touches, 2 * self.opening)
        start = self.around(touches, 0)
        out = self.bend(start.point, start.heading)
        into = self.bend(arm.point, wrap(arm.heading + math.pi))
        go = lambda source, target, path, rows: net.connect(j, source, target, path, rows, kmh=kmh, elevation=level)
        first = go(before, after, past, [Row("driving", -1, -1, (LANE, LANE))])
        go(before, arm, out, rows(before, arm))
        last = go(arm, after, into, rows(arm, after))
        j.priorities = [(first.id, last.id)]
        arm.road.signals.append(signal(net.id(), arm, YIELD, SIGN_BEFORE, 2.2))


def gaps(headings):
    """The angle from each arm to the next one, round to the left."""
    turned = sorted(h % math.tau for h in headings)
    return [after - before for before, after in zip(turned, [*turned[1:], turned[0] + math.tau])]


def rows(source, target):
    """The lane and all beyond it."""
    into, out = source.strips_in(), target.strips_out()
    found = []
    for kind, a, b in [("driving", 0, 0), *aligned(into, 1, out, 1)]:
        before = None if a is None else source.sign_in * (a + 1)
        after = None if b is None else -target.sign_in * (b + 1)
        widths = (0.0 if a is None else into[a].width, 0.0 if b is None else out[b].width)
        found.append(Row(kind, before, after, widths))
    return found
