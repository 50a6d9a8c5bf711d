"""Towns of streets: roads whose sides differ (one-way streets, tracks, bicycle lanes, squares), and their junctions.

A town is a graph as in `opendrive`, but each side of a street is a row of strips from the middle outwards. Every junction
is built from its arms: a connecting road for each way through it, and one around each corner for what lies beside the
lanes, so that people can walk on wherever there is a sidewalk on both streets.
"""

import math
from dataclasses import dataclass, field

from opendrive import (
    Path2, beside, constant, document, eased, elevation, lane, link_text, mark, num, plan, signal, wrap,
)

# --- cross-sections -------------------------------------------------------------------------------

TAPER = 5.0  # metres over which a kerb swings out to make room for parked cars
# What goes on around a corner, from the lane outwards.
AROUND_CORNERS = ("biking", "shoulder", "sidewalk")


@dataclass(frozen=True)
class Strip:
    """A lane; `bay` is its width between tapers where that is another than at its ends."""

    kind: str
    width: float
    material: str = ""
    bay: float = 0.0
    mark: str = "none"

    @property
    def broadest(self):
        return max(self.width, self.bay)


@dataclass(frozen=True)
class Profile:
    """What a street consists of, from the middle outwards; drivers keep to the right."""

    left: tuple
    right: tuple
    kmh: int
    middle: str = "none"  # kind of the mark in the middle
    kind: str = "town"

    def side(self, right):
        return self.right if right else self.left


def lanes_of(strips):
    return [k for k, strip in enumerate(strips) if strip.kind == "driving"]


def reach(strips, count=None):
    """Width of the first `count` strips."""
    return sum(strip.width for strip in strips[:count])


def kerb(strips):
    """Distance from the middle to the sidewalk, or to where the last strip ends."""
    return reach(strips, next((k for k, strip in enumerate(strips) if strip.kind == "sidewalk"), None))


def walk(strips):
    return next((strip.width for strip in strips if strip.kind == "sidewalk"), 0.0)


def verge(strips):
    """From the middle to the far edge of the sidewalk, where bays are widest."""
    last = max((k for k, strip in enumerate(strips) if strip.kind == "sidewalk"), default=len(strips) - 1)
    return sum(strip.broadest for strip in strips[: last + 1])


# --- the town -------------------------------------------------------------------------------------


@dataclass
class Street:
    id: int
    path: Path2
    sections: list  # (s, profile), each with the same number of strips
    name: str = ""
    ends: dict = field(default_factory=dict)
    elevation: list = field(default_factory=list)
    objects: list = field(default_factory=list)
    signals: list = field(default_factory=list)
    grounds: dict = field(default_factory=dict)  # side -> (s, material) of its last strip, from there on

    @property
    def length(self):
        return self.path.length

    def profile(self, contact):
        return self.sections[0 if contact == "start" else -1][1]

    def profile_at(self, s):
        return [profile for start, profile in self.sections if start <= s or start == 0.0][-1]

    def is_driven(self, forward):
        return bool(lanes_of(self.sections[0][1].side(forward)))


@dataclass(frozen=True)
class Edges:
    """What `opendrive.signal` asks of the side on which it puts one."""

    kerb: float
    sidewalk: float
    lanes: int = 1


@dataclass
class Arm:
    """Where a street touches a junction: `heading` leads out of the junction."""

    road: Street
    contact: str
    point: tuple
    heading: float

    def strips(self, inward):
        """The side on which one drives into the junction, or out of it."""
        return self.road.profile(self.contact).side(inward == (self.contact == "end"))

    @property
    def profile(self):
        strips = self.strips(True)
        return Edges(kerb(strips), walk(strips))

    def lane(self, index, inward):
        """The id of the strip with an index on the inward or outward side."""
        return -(index + 1) if inward == (self.contact == "end") else index + 1

    def lane_in(self, _):
        return self.lane(lanes_of(self.strips(True))[0], True)

    def s(self, before):
        return self.road.length - before if self.contact == "end" else before

    def t(self, right):
        return -right if self.contact == "end" else right

    @property
    def orientation(self):
        return "+" if self.contact == "end" else "-"

    @property
    def side(self):
        """The key of the sidewalk beside who drives in, and of the one across the street."""
        inner, outer = (True, False) if self.contact == "end" else (False, True)
        return (self.road.id, inner), (self.road.id, outer)


@dataclass
class Row:
    """A lane of a connecting road: ids on the streets that it joins, none where it peters out."""

    kind: str
    source: int | None
    target: int | None
    width: float
    width_end: float
    material: str


@dataclass
class Connection:
    id: int
    source: Arm
    target: Arm
    path: Path2
    rows: list
    is_driven: bool
    z: float
    objects: list = field(default_factory=list)


@dataclass
class Junction:
    id: int
    arms: list
    control: str
    major: set
    z: float
    connections: list = field(default_factory=list)
    controllers: list = field(default_factory=list)


class Town:
    def __init__(self, name):
        self.name, self.roads, self.junctions, self.last = name, [], [], 0
        self.walks = {}  # sidewalk -> one that hangs together with it

    def id(self):
        self.last += 1
        return self.last

    def street(self, path, sections, name="", levels=(0.0, 0.0)):
        road = Street(self.id(), path, sections, name)
        road.elevation = slope(path.length, *levels)
        self.roads.append(road)
        return road

    def junction(self, arms, control, major=(), z=0.0, banned=()):
        """A junction of streets; `banned` has pairs of streets from one of which nobody turns into the other."""
        arms = sorted(arms, key=lambda a: wrap(a.heading))
        j = Junction(self.id(), arms, control, {r.id for r in major}, z)
        paved = {strip.material for a in arms for strip in a.strips(True) + a.strips(False) if strip.kind == "driving"}
        material = paved.pop() if len(paved) == 1 else ""
        for arm in arms:
            arm.road.ends[arm.contact] = ("junction", j.id, None)
        for k, arm in enumerate(arms):
            self._ways(j, arm, arms[k + 1 :] + arms[:k], material, {(a.id, b.id) for a, b in banned})
        for arm in arms:
            self._control(j, arm)
        self.junctions.append(j)
        return j

    def _ways(self, j, source, others, material, banned):
        """The ways from `source`, and the corner to its right: `others` start with the arm there."""
        corner = corner_rows(source, others[0])
        for target in others:
            a, b = lanes_of(source.strips(True)), lanes_of(target.strips(False))
            if not a or not b or (source.road.id, target.road.id) in banned:
                continue
            ways = source.strips(True)[a[0]], target.strips(False)[b[0]]
            row = Row("driving", source.lane(a[0], True), target.lane(b[0], False), ways[0].width, ways[1].width, material)
            beside_it = corner if target is others[0] else []
            offsets = reach(source.strips(True), a[0]), reach(target.strips(False), b[0])
            self._connect(j, source, target, offsets, [row] + beside_it, True)
            corner = [] if beside_it else corner
        if corner:
            offsets = inner_edge(source.strips(True)), inner_edge(others[0].strips(False))
            self._connect(j, source, others[0], offsets, corner, False)
        if walk(source.strips(True)) and walk(others[0].strips(False)):
            self.hang_together(source.side[0], others[0].side[1])

    def _connect(self, j, source, target, offsets, rows, is_driven):
        inward = source.heading + math.pi
        path = Path2(beside(source.point, inward, offsets[0]), inward)
        path.to(beside(target.point, target.heading, offsets[1]), target.heading)
        j.connections.append(Connection(self.id(), source, target, path, rows, is_driven, j.z))

    def _control(self, j, arm):
        if not lanes_of(arm.strips(True)):
            return
        if j.control == "lights":
            light, controller = self.id(), self.id()
            arm.road.signals.append(signal(light, arm, "1000001", 0.6, 3.2))
            j.controllers.append((controller, light, phase(j.arms, arm)))
        elif j.control in ("stop", "yield") and arm.road.id not in j.major:
            arm.road.signals.append(signal(self.id(), arm, {"stop": "206", "yield": "205"}[j.control], 6.5, 2.2))

    # Who can walk where.

    def hang_together(self, a, b):
        self.walks[self.part(a)] = self.part(b)

    def part(self, sidewalk):
        while self.walks.get(sidewalk, sidewalk) != sidewalk:
            sidewalk = self.walks[sidewalk]
        return sidewalk

    def zebra(self, road, s, half=1.75):
        profile = road.profile_at(s)
        road.objects.append(zebra(self.id(), s, (kerb(profile.right), kerb(profile.left)), half))
        self.hang_together((road.id, True), (road.id, False))

    def zebra_at(self, arm, before=3.4):
        self.zebra(arm.road, arm.s(before))

    def bridge_the_walks(self):
        """Adds the crosswalks without which people could not get everywhere."""
        for arm in (arm for j in self.junctions for arm in j.arms):
            one, other = arm.side
            both = walk(arm.strips(True)) and walk(arm.strips(False))
            if both and self.part(one) != self.part(other):
                self.zebra_at(arm)

    def check(self):
        """Everybody can drive and walk from everywhere to everywhere."""
        ways = {}
        for c in (c for j in self.junctions for c in j.connections if c.is_driven):
            ways.setdefault((c.source.road.id, c.source.contact == "end"), []).append(
                (c.target.road.id, c.target.contact == "start")
            )
        driven = [(r.id, forward) for r in self.roads for forward in (True, False) if r.is_driven(forward)]
        back = {}
        for a, targets in ways.items():
            for b in targets:
                back.setdefault(b, []).append(a)
        for graph in (ways, back):
            lost = set(driven) - reached(graph, driven[0])
            assert not lost, f"{self.name}: cut off: {lost}"
        sides = [(r.id, right) for r in self.roads for right in (True, False) if walk(r.sections[0][1].side(right))]
        assert len({self.part(side) for side in sides}) == 1, f"{self.name}: a sidewalk is cut off"

    def driven_m(self):
        """Length of all lanes to drive on outside junctions, metres."""
        return sum(r.length * sum(r.is_driven(forward) for forward in (True, False)) for r in self.roads)


def reached(graph, start):
    seen, open_ = {start}, [start]
    while open_:
        for b in graph.get(open_.pop(), []):
            if b not in seen:
                seen.add(b)
                open_.append(b)
    return seen


def slope(length, z0, z1):
    """From one height to another, level at both ends."""
    return [(0.0, z0, 0.0, 3 * (z1 - z0) / length**2, -2 * (z1 - z0) / length**3)]


def inner_edge(strips):
    """Distance from the middle to what goes around a corner."""
    lanes = lanes_of(strips)
    return reach(strips, lanes[-1] + 1) if lanes else 0.0


def corner_rows(source, target):
    """What lies beside the lanes around the corner from one arm to the next."""
    rows = []
    a_side, b_side = source.strips(True), target.strips(False)
    for kind in AROUND_CORNERS:
        a = next((k for k, strip in enumerate(a_side) if strip.kind == kind), None)
        b = next((k for k, strip in enumerate(b_side) if strip.kind == kind), None)
        if a is None and b is None:
            continue
        rows.append(
            Row(
                kind,
                None if a is None else source.lane(a, True),
                None if b is None else target.lane(b, False),
                0.0 if a is None else a_side[a].width,
                0.0 if b is None else b_side[b].width,
                "" if a is None or kind == "sidewalk" else a_side[a].material,
            )
        )
    return rows


def phase(arms, arm):
    """The place of an arm's light: those that face each other are green together."""
    phases = []
    for k, one in enumerate(arms):
        if any(k in phase for phase in phases):
            continue
        off = lambda n: abs(wrap(arms[n].heading - one.heading - math.pi))
        facing = min((n for n in range(k + 1, len(arms))), key=off, default=None)
        phases.append([k] if facing is None or off(facing) > 0.8 else [k, facing])
    return next(n for n, phase in enumerate(phases) if arms.index(arm) in phase)


# --- signs and objects ----------------------------------------------------------------------------


def sign(sid, road, s, forward, kind, value=-1):
    """A German sign at the outer edge of the sidewalk."""
    right = verge(road.profile_at(s).side(forward)) + 0.3
    t, orientation = (-right, "+") if forward else (right, "-")
    unit_text = ' unit="km/h"' if value > 0 else ""
    return (
        f'<signal id="{sid}" name="" s="{num(s)}" t="{num(t)}" zOffset="2" orientation="{orientation}" dynamic="no" '
        f'country="DE" type="{kind}" subtype="-1" value="{value}"{unit_text} height="0.6" width="0.6"/>'
    )


def zebra(oid, s, edges, half):
    right, left = edges
    corners = [(s - half, -right), (s + half, -right), (s + half, left), (s - half, left)]
    points = "".join(
        f'<cornerRoad id="{i}" s="{num(cs)}" t="{num(ct)}" dz="0" height="0"/>' for i, (cs, ct) in enumerate(corners)
    )
    return (
        f'<object id="{oid}" type="crosswalk" name="zebra" s="{num(s)}" t="{num((left - right) / 2)}" zOffset="0" hdg="0" '
        f'orientation="none" length="{num(2 * half)}" width="{num(left + right)}"><outlines>'
        f'<outline id="0" closed="true">{points}</outline></outlines></object>'
    )


def thing(oid, kind, name, place, size, hdg=0.0, lift=0.0):
    """A box at `place` (s, t) that is `size` (long, wide, high)."""
    (s, t), (length, width, height) = place, size
    return (
        f'<object id="{oid}" type="{kind}" name="{name}" s="{s:.2f}" t="{t:.2f}" zOffset="{num(lift)}" hdg="{hdg:.4f}" '
        f'orientation="none" length="{length:.2f}" width="{width:.2f}" height="{height:.2f}"/>'
    )


# --- writing --------------------------------------------------------------------------------------


def widths(strip, length):
    if not strip.bay:
        return constant(strip.width)
    d = strip.bay - strip.width
    a, b = 3 * d / TAPER**2, -2 * d / TAPER**3
    row = '<width sOffset="{}" a="{}" b="0" c="{}" d="{}"/>'
    return (
        row.format(0, num(strip.width), num(a), num(b))
        + row.format(num(TAPER), num(strip.bay), 0, 0)
        + row.format(num(length - TAPER), num(strip.bay), num(-a), num(-b))
    )


def material(name, s=0.0):
    return f'<material sOffset="{num(s)}" surface="{name}" friction="0.7" roughness="0.01"/>' if name else ""


def grounds(records, start, length):
    """The materials of a stretch of a strip."""
    text = material(next((name for s, name in reversed(records) if s <= start), ""))
    return text + "".join(material(name, s - start) for s, name in records if start < s < start + length)


def side_lanes(road, right, start, length, link):
    strips = road.profile_at(start).side(right)
    rows, step = [], -1 if right else 1
    for n, strip in enumerate(strips, start=1):
        is_last = n == len(strips) and right in road.grounds
        made_of = grounds(road.grounds[right], start, length) if is_last else material(strip.material)
        rows.append(lane(step * n, strip.kind, widths(strip, length), mark(strip.mark) + made_of, link(step * n)))
    return rows


def sections_text(road):
    text = ""
    for k, (s, profile) in enumerate(road.sections):
        first, last = k == 0, k + 1 == len(road.sections)
        length = (road.length if last else road.sections[k + 1][0]) - s

        def link(lid):
            return ("" if first else f'<predecessor id="{lid}"/>') + ("" if last else f'<successor id="{lid}"/>')

        left = "".join(reversed(side_lanes(road, False, s, length, link)))
        right = "".join(side_lanes(road, True, s, length, link))
        text += (
            f'<laneSection s="{num(s)}"><left>{left}</left><center>{lane(0, "none", "", mark(profile.middle))}</center>'
            f"<right>{right}</right></laneSection>"
        )
    return text


def street_text(road):
    profile = road.sections[0][1]
    return (
        f'<road name="{road.name}" length="{num(road.length)}" id="{road.id}" junction="-1">{link_text(road.ends)}'
        f'<type s="0" type="{profile.kind}"><speed max="{profile.kmh}" unit="km/h"/></type>{plan(road.path)}'
        f"{elevation(road.elevation)}<lanes>{sections_text(road)}</lanes><objects>{''.join(road.objects)}</objects>"
        f"<signals>{''.join(road.signals)}</signals></road>\n"
    )


def connection_text(c, junction):
    lanes = ""
    for n, row in enumerate(c.rows, start=1):
        link = "" if row.source is None else f'<predecessor id="{row.source}"/>'
        link += "" if row.target is None else f'<successor id="{row.target}"/>'
        m = mark("curb") if row.kind == "shoulder" else ""
        lanes += lane(-n, row.kind, eased(row.width, row.width_end, c.path.length), m + material(row.material), link)
    ends = {"start": ("road", c.source.road.id, c.source.contact), "end": ("road", c.target.road.id, c.target.contact)}
    return (
        f'<road length="{num(c.path.length)}" id="{c.id}" junction="{junction.id}">{link_text(ends)}{plan(c.path)}'
        f'{elevation([(0, c.z, 0, 0, 0)])}<lanes><laneSection s="0"><center>{lane(0, "none", "")}</center>'
        f"<right>{lanes}</right></laneSection></lanes><objects>{''.join(c.objects)}</objects></road>\n"
    )


def junction_text(j):
    out = ""
    for n, c in enumerate(j.connections):
        linked = [(row.source, -k) for k, row in enumerate(c.rows, start=1) if row.source is not None]
        links = "".join(f'<laneLink from="{a}" to="{b}"/>' for a, b in linked)
        out += (
            f'<connection id="{n}" incomingRoad="{c.source.road.id}" connectingRoad="{c.id}" contactPoint="start">'
            f"{links}</connection>"
        )
    if j.major:
        driven = [c for c in j.connections if c.is_driven]
        major = [c for c in driven if c.source.road.id in j.major]
        minor = [c for c in driven if c.source.road.id not in j.major]
        out += "".join(f'<priority high="{h.id}" low="{l.id}"/>' for h in major for l in minor)
    out += "".join(f'<controller id="{c}" type="0" sequence="{n}"/>' for c, _, n in j.controllers)
    return f'<junction id="{j.id}" name="" type="default">{out}</junction>\n'


def write(town, folder):
    town.check()
    roads = [street_text(r) for r in town.roads]
    roads += [connection_text(c, j) for j in town.junctions for c in j.connections]
    text = document(town, roads, [junction_text(j) for j in town.junctions])
    (folder / f"{town.name}.xodr").write_text(text)
    print(
        f"{town.name}: {len(town.roads)} roads, {len(town.junctions)} junctions, {town.driven_m() / 1000:.1f} km to drive, "
        f"{len(text)} bytes"
    )
