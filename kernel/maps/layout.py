"""From a plan of a town (where streets meet, and which ones there are) to its streets and the arms of its junctions."""

import math
from dataclasses import dataclass, replace

from opendrive import Path2, unit, wrap
from streets import Arm, kerb

BAYS_FROM = 13.0  # parked cars stand at least so far from the mouth of a junction, metres


@dataclass(frozen=True)
class Way:
    """A street between two places: bowed (`bow` is how far it starts off to the left, in degrees), or bent at `via`."""

    a: str
    b: str
    profile: object
    name: str = ""
    bow: float = 0.0
    via: tuple = ()
    radius: float = 18.0
    bays: str = ""  # sides with parked cars: "r", "l" or "rl"


@dataclass
class Layout:
    streets: dict  # (a, b) -> Street
    arms: dict  # place -> its arms
    heights: object  # of a place

    def between(self, a, b):
        return self.streets.get((a, b)) or self.streets[b, a]

    def arm(self, place, other):
        street = self.between(place, other)
        return next(arm for arm in self.arms[place] if arm.road is street)


def lay_out(town, places, ways, height, radius, mouths_at=None):
    """Makes the streets of a plan; kerbs turn corners with a radius. Where a circle lies around a place, `mouths_at` says
    how far from it its streets begin."""
    headings = {way: ends(places, way) for way in ways}
    layout = Layout({}, {place: [] for place in places}, height)
    for way in ways:
        mouths = []
        for place, heading in zip((way.a, way.b), headings[way]):
            others = around(ways, headings, place, way)
            back = (mouths_at or {}).get(place) or setback(heading, half(way), others, radius)
            mouths.append(away(places[place], heading, back))
        street = make(town, way, mouths, headings[way], (height(*places[way.a]), height(*places[way.b])))
        layout.streets[way.a, way.b] = street
        for place, contact, mouth, heading in zip((way.a, way.b), ("start", "end"), mouths, headings[way]):
            layout.arms[place].append(Arm(street, contact, mouth, heading))
    return layout


def make(town, way, mouths, headings, levels):
    path = Path2(mouths[0], headings[0])
    if way.via:
        bend_through(path, [*way.via, mouths[1]], way.radius)
    else:
        path.to(mouths[1], headings[1] + math.pi)
    return town.street(path, sections(way.profile, path.length, way.bays), way.name, levels)


def ends(places, way):
    """The headings in which a street leaves its two places."""
    points = [places[way.a], *way.via, places[way.b]]
    towards = lambda p, q: math.atan2(q[1] - p[1], q[0] - p[0])
    bow = math.radians(way.bow)
    return towards(points[0], points[1]) + bow, wrap(towards(points[-1], points[-2]) - bow)


def around(ways, headings, place, but):
    """(heading, half width) of the other streets at a place."""
    found = []
    for way in ways:
        for end, heading in zip((way.a, way.b), headings[way]):
            if end == place and way is not but:
                found.append((heading, half(way)))
    return found


def half(way):
    return max(kerb(way.profile.left), kerb(way.profile.right))


def sections(profile, length, bays):
    """A street with parked cars on some sides, where junctions are far enough."""
    if not bays:
        return [(0.0, profile)]
    parked = replace(
        profile,
        right=with_bay(profile.right) if "r" in bays else profile.right,
        left=with_bay(profile.left) if "l" in bays else profile.left,
    )
    return [(0.0, profile), (BAYS_FROM, parked), (length - BAYS_FROM, profile)]


def with_bay(strips, width=2.3):
    """A side with room for parked cars, behind a line at the edge of the lane."""
    marked = lambda strip: replace(strip, mark="solid") if strip.kind == "driving" else strip
    return tuple(replace(s, kind="parking", bay=width) if s.kind == "shoulder" else marked(s) for s in strips)


def bend_through(path, points, radius):
    """Straight from point to point, round each but the last with a radius."""
    for here, then in zip(points, points[1:]):
        ahead = math.atan2(then[1] - here[1], then[0] - here[0])
        turn = wrap(ahead - path.heading)
        leg = radius * math.tan(abs(turn) / 2)
        path.line(math.dist(path.point, here) - leg).arc(radius, turn)
    return path.line(math.dist(path.point, points[-1]))


def setback(heading, half, others, radius):
    """From the middle of a junction to the mouth of a street that is `half` wide on each side; `others` are (heading,
    half width) of its other streets, and kerbs turn with a radius."""
    back = half + radius
    for other, wide in others:
        angle = abs(wrap(other - heading))
        if angle < math.radians(150):
            corner = (wide + half * math.cos(angle)) / math.sin(angle)
            back = max(back, corner + radius * math.tan((math.pi - angle) / 2))
    return back


def away(point, heading, distance):
    c, s = unit(heading)
    return point[0] + distance * c, point[1] + distance * s


# --- circles --------------------------------------------------------------------------------------


def ring(town, middle, radius, profile, legs, gap, z, name=""):
    """The streets of a roundabout between its legs (their headings, ascending), and for each leg the arms of the circle:
    `gap` is the angle on both sides of a leg that its junction takes."""
    streets = []
    for k, leg in enumerate(legs):
        after = legs[(k + 1) % len(legs)] + (math.tau if k + 1 == len(legs) else 0.0)
        start, turn = leg + gap, after - leg - 2 * gap
        path = Path2(away(middle, start, radius), start + math.pi / 2).arc(radius, turn)
        streets.append(town.street(path, [(0.0, profile)], name, (z, z)))
    arms = []
    for k, leg in enumerate(legs):
        before, behind = streets[k - 1], streets[k]
        into = Arm(before, "end", before.path.point, wrap(before.path.heading + math.pi))
        start = behind.path.pieces[0]
        out = Arm(behind, "start", (start.x, start.y), wrap(start.hdg))
        arms.append([into, out])
    return arms
