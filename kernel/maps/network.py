"""Roads of any lanes, and what joins them: for what `opendrive.py`, whose roads are alike on both sides, cannot draw.

A road is drawn from its middle outwards as strips; who keeps to the right drives in the strips on the right.
"""

import math
from dataclasses import dataclass, field
from difflib import SequenceMatcher

from opendrive import Path2, beside, constant, lane, link_text, mark, num, plan, wrap

# --- geometry -------------------------------------------------------------------------------------


class Path(Path2):
    """A reference line whose arcs are told so exactly that they hold for a kilometre."""

    def arc(self, radius, turn):
        super().arc(radius, turn)
        if abs(turn) >= 1e-9:
            self.pieces[-1].curve = f'<arc curvature="{math.copysign(1 / radius, turn):.13f}"/>'
        return self


# --- what a road is made of -----------------------------------------------------------------------


@dataclass(frozen=True)
class Strip:
    """A lane; its width changes evenly from the start of a section to the end."""

    kind: str
    width: float
    to: float = None  # width at the end of the section

    @property
    def end(self):
        return self.width if self.to is None else self.to


@dataclass
class Section:
    """What lies beside the middle from `s` on, outwards."""

    s: float
    left: list
    right: list


@dataclass
class Road:
    id: int
    path: Path
    sections: list
    kmh: float
    kind: str = "town"
    junction: int = -1
    is_lined: bool = True  # whether its edges are painted
    ends: dict = field(default_factory=dict)  # "start"/"end" -> ("road"/"junction", id, contact)
    lane_links: dict = field(default_factory=lambda: {"start": {}, "end": {}})  # own lane -> lane of the road there
    elevation: list = field(default_factory=list)
    objects: list = field(default_factory=list)
    signals: list = field(default_factory=list)
    structures: list = field(default_factory=list)  # bridges and tunnels

    @property
    def length(self):
        return self.path.length

    def width(self, until, contact="start"):
        """From the middle to the outer edge of the last strip on the right of kind `until`."""
        strips = self.strips(contact, -1)
        last = max(k for k, strip in enumerate(strips) if strip.kind == until)
        return sum(strip.width for strip in strips[: last + 1])

    def strips(self, contact, side):
        """The strips at an end, to the left (1) or to the right (-1), as wide as they are there."""
        section = self.sections[0 if contact == "start" else -1]
        strips = section.left if side > 0 else section.right
        return [Strip(s.kind, s.width if contact == "start" else s.end) for s in strips]


@dataclass
class Arm:
    """The end of a road at a junction."""

    road: Road
    contact: str

    def __post_init__(self):
        at_start = self.contact == "start"
        first = self.road.path.pieces[0]
        self.point = (first.x, first.y) if at_start else self.road.path.point
        # Out of the junction.
        self.heading = first.hdg if at_start else wrap(self.road.path.heading + math.pi)

    @property
    def sign_in(self):
        """The sign of the lanes that lead into the junction; those out of it have the other."""
        return -1 if self.contact == "end" else 1

    def strips_in(self):
        return self.road.strips(self.contact, self.sign_in)

    def strips_out(self):
        return self.road.strips(self.contact, -self.sign_in)

    def s(self, before):
        return self.road.length - before if self.contact == "end" else before

    def t(self, right):
        """`t` that lies `right` metres to the right of the middle for who drives in."""
        return right * self.sign_in

    @property
    def orientation(self):
        return "+" if self.contact == "end" else "-"


def driven(strips):
    """Indices of the lanes to drive on."""
    return [k for k, strip in enumerate(strips) if strip.kind == "driving"]


def left_of(strips, k):
    """From the middle to the inner edge of a strip."""
    return sum(strip.width for strip in strips[:k])


# --- what joins roads -----------------------------------------------------------------------------


@dataclass
class Row:
    """A lane through a junction; one that begins or ends there has no lane before or behind it."""

    kind: str
    before: int = None
    after: int = None
    widths: tuple = (0.0, 0.0)


@dataclass
class Connection:
    source: Arm
    road: Road
    links: list  # (lane of the source, own lane)


@dataclass
class Junction:
    id: int
    connections: list = field(default_factory=list)
    priorities: list = field(default_factory=list)  # (road that goes first, road that waits)
    controllers: list = field(default_factory=list)  # (id, id of its signal, place in the sequence)


class Network:
    def __init__(self, name):
        self.name, self.roads, self.junctions, self.last = name, [], [], 0

    def id(self):
        self.last += 1
        return self.last

    def road(self, path, left, right, kmh, **more):
        self.roads.append(Road(self.id(), path, [Section(0.0, list(left), list(right))], kmh, **more))
        return self.roads[-1]

    def follow(self, a, b):
        """Lets road `b` follow road `a`, lane by lane."""
        a.ends["end"], b.ends["start"] = ("road", b.id, "start"), ("road", a.id, "end")
        for side in (1, -1):
            before, after = a.strips("end", side), b.strips("start", side)
            for i, k in same(before, after):
                a.lane_links["end"][side * (i + 1)] = side * (k + 1)
                b.lane_links["start"][side * (k + 1)] = side * (i + 1)

    def junction(self):
        self.junctions.append(Junction(self.id()))
        return self.junctions[-1]

    def connect(self, j, source, target, path, rows, left=(), kmh=None, elevation=(), is_lined=False):
        """A road through a junction along `path`: `rows` to its right, `left` to its left, from the middle outwards."""
        kmh, elevation = kmh or source.road.kmh, list(elevation)
        road = Road(self.id(), path, [], kmh, source.road.kind, j.id, is_lined, elevation=elevation)
        road.sections = [Section(0.0, [strip(row) for row in left], [strip(row) for row in rows])]
        road.ends = {
            "start": ("road", source.road.id, source.contact),
            "end": ("road", target.road.id, target.contact),
        }
        links = []
        for side, those in ((1, left), (-1, rows)):
            for k, row in enumerate(those):
                lid = side * (k + 1)
                if row.before is not None:
                    road.lane_links["start"][lid] = row.before
                    links += [(row.before, lid)] if side < 0 else []
                if row.after is not None:
                    road.lane_links["end"][lid] = row.after
        source.road.ends[source.contact] = target.road.ends[target.contact] = ("junction", j.id, None)
        self.roads.append(road)
        j.connections.append(Connection(source, road, links))
        return road


def strip(row):
    return Strip(row.kind, *row.widths)


def same(before, after):
    """Indices of strips that go on, before and behind: those driven in only in others driven in."""
    those = [k for k, strip in enumerate(before) if strip.end], [k for k, strip in enumerate(after) if strip.width]
    return [(i, k) for i, k in zip(*those) if (before[i].kind == "driving") == (after[k].kind == "driving")]


def joined(source, target, n_in, n_out, kerbside):
    """The rows of a way from the lane `n_in` to the lane `n_out`, with what lies at the kerb."""
    into, out = source.strips_in(), target.strips_out()
    lane_in = lambda k: source.sign_in * (k + 1)
    lane_out = lambda k: -target.sign_in * (k + 1)
    row = lambda kind, a, b: Row(
        kind,
        None if a is None else lane_in(a),
        None if b is None else lane_out(b),
        (0.0 if a is None else into[a].width, 0.0 if b is None else out[b].width),
    )
    rows = [row("driving", n_in, n_out)]
    if kerbside:
        rows += [row(kind, a, b) for kind, a, b in aligned(into, n_in + 1, out, n_out + 1)]
    return rows


def aligned(into, a, out, b):
    """(kind, index before, index behind) of what lies beyond lanes, those of one kind joined."""
    name = lambda strip: "shoulder" if strip.kind == "parking" else strip.kind
    before, after = [name(s) for s in into[a:]], [name(s) for s in out[b:]]
    rows, i, k = [], 0, 0
    for match in SequenceMatcher(None, before, after, autojunk=False).get_matching_blocks():
        rows += [(before[n], a + n, None) for n in range(i, match.a)]
        rows += [(after[n], None, b + n) for n in range(k, match.b)]
        rows += [(before[match.a + n], a + match.a + n, b + match.b + n) for n in range(match.size)]
        i, k = match.a + match.size, match.b + match.size
    return rows


def between(source, target, n_in, n_out):
    """The path along the inner edges of two lanes."""
    inward = wrap(source.heading + math.pi)
    path = Path(beside(source.point, inward, left_of(source.strips_in(), n_in)), inward)
    end = beside(target.point, target.heading, left_of(target.strips_out(), n_out))
    return path.to(end, target.heading)


# --- writing ---------------------------------------------------------------------------------------


def cubic(a, b, c, d):
    """Coefficients with so many digits that they hold for a kilometre."""
    return f'a="{num(a)}" b="{b:.10f}" c="{c:.13f}" d="{d:.16f}"'


def eased(w0, w1, length):
    """A width that does not change at its ends."""
    rise = w1 - w0
    return f'<width sOffset="0" {cubic(w0, 0.0, 3 * rise / length**2, -2 * rise / length**3)}/>'


def elevation(records):
    # A level record that goes on where another ends tells nothing.
    told = [r for k, r in enumerate(records) if k == 0 or any(r[2:]) or any(records[k - 1][2:])]
    rows = "".join(f'<elevation s="{num(s)}" {cubic(a, b, c, d)}/>' for s, a, b, c, d in told)
    return f"<elevationProfile>{rows}</elevationProfile>" if any(any(r[1:]) for r in records) else ""


def lanes_text(road, k, side):
    """The lanes of one side of a section, from the left to the right."""
    section = road.sections[k]
    strips = section.left if side > 0 else section.right
    until = road.sections[k + 1].s if k + 1 < len(road.sections) else road.length
    lanes = []
    for n, one in enumerate(strips):
        lid = side * (n + 1)
        beyond = strips[n + 1].kind if n + 1 < len(strips) else "none"
        widths = constant(one.width) if one.end == one.width else eased(one.width, one.end, until - section.s)
        lanes.append(lane(lid, one.kind, widths, edge(one.kind, beyond, road), links(road, k, lid)))
    return "".join(reversed(lanes) if side > 0 else lanes)


def edge(kind, beyond, road):
    """The mark between two strips."""
    if beyond == "sidewalk" and kind != "curb":
        return mark("curb")
    if kind != "driving":
        return ""
    if beyond == "driving":
        return mark("broken", "both")
    # Inside a junction, others may drive beyond the last strip.
    return mark("solid") if road.junction == -1 or road.is_lined and beyond != "none" else ""


def links(road, k, lid):
    """What a lane of a section follows, and what follows it."""
    out = ""
    for name, end, other in (("predecessor", "start", k - 1), ("successor", "end", k + 1)):
        if 0 <= other < len(road.sections):
            of = lambda section: section.left if lid > 0 else section.right
            pair = (k - 1, k) if end == "start" else (k, k + 1)
            found = dict(same(*(of(road.sections[i]) for i in pair)))
            found = {b: a for a, b in found.items()} if end == "start" else found
            to = found.get(abs(lid) - 1)
            to = None if to is None else int(math.copysign(to + 1, lid))
        else:
            to = road.lane_links[end].get(lid)
        out += "" if to is None else f'<{name} id="{to}"/>'
    return out


def middle(road, section):
    """The mark along the middle."""
    if driven(section.left):
        return mark("broken", "both") if road.junction == -1 else mark("none")
    is_edge = road.is_lined and (road.junction == -1 or section.left)
    return mark("solid") if is_edge else mark("none")


def road_text(road):
    sections = ""
    for k, section in enumerate(road.sections):
        left, right = lanes_text(road, k, 1), lanes_text(road, k, -1)
        sections += (
            f'<laneSection s="{num(section.s)}">{left and f"<left>{left}</left>"}'
            f'<center>{lane(0, "none", "", middle(road, section))}</center>{right and f"<right>{right}</right>"}'
            f"</laneSection>"
        )
    return (
        f'<road length="{num(road.length)}" id="{road.id}" junction="{road.junction}">{link_text(road.ends)}'
        f'<type s="0" type="{road.kind}"><speed max="{road.kmh}" unit="km/h"/></type>'
        f"{plan(road.path)}{elevation(road.elevation)}<lanes>{sections}</lanes>"
        f"<objects>{''.join(road.objects + road.structures)}</objects><signals>{''.join(road.signals)}</signals></road>\n"
    )


def junction_text(j):
    out = ""
    for n, c in enumerate(j.connections):
        pairs = "".join(f'<laneLink from="{a}" to="{b}"/>' for a, b in c.links)
        out += (
            f'<connection id="{n}" incomingRoad="{c.source.road.id}" connectingRoad="{c.road.id}" '
            f'contactPoint="start">{pairs}</connection>'
        )
    out += "".join(f'<priority high="{high}" low="{low}"/>' for high, low in j.priorities)
    out += "".join(f'<controller id="{c}" type="0" sequence="{n}"/>' for c, _, n in j.controllers)
    return f'<junction id="{j.id}" name="" type="default">{out}</junction>\n'


def write(net, folder):
    controllers = "".join(
        f'<controller id="{c}" name="" sequence="{n}"><control signalId="{s}" type="0"/></controller>\n'
        for j in net.junctions
        for c, s, n in j.controllers
    )
    text = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<!-- Written by author.py; change that instead. -->\n'
        f'<OpenDRIVE><header revMajor="1" revMinor="6" name="{net.name}" version="1" north="0" south="0" east="0" west="0"/>\n'
        + "".join(road_text(r) for r in net.roads)
        + controllers
        + "".join(junction_text(j) for j in net.junctions)
        + "</OpenDRIVE>\n"
    )
    (folder / f"{net.name}.xodr").write_text(text)
    print(f"{net.name}: {len(net.roads)} roads, {len(net.junctions)} junctions, {len(text)} bytes")
