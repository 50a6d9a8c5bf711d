"""Builds OpenDRIVE 1.6 text from roads and junctions.

A map is a graph: nodes where roads meet, edges that are roads. Every junction is built from its
arms alone, so a map is described by little more than where its nodes are.
"""

import math
import re
from dataclasses import dataclass, field

# --- geometry -----------------------------------------------------------------------------------


def unit(heading):
    return math.cos(heading), math.sin(heading)


def wrap(angle):
    return math.remainder(angle, math.tau)


def beside(point, heading, right):
    """The point `right` metres to the right of `point` when facing `heading`."""
    c, s = unit(heading)
    return point[0] + right * s, point[1] - right * c


@dataclass
class Piece:
    """One <geometry> record; `curve` is its inner element."""

    x: float
    y: float
    hdg: float
    length: float
    curve: str = "<line/>"


class Path2:
    """A reference line under construction."""

    def __init__(self, point, heading):
        self.point, self.heading, self.pieces, self.length = point, heading, [], 0.0

    def _add(self, length, curve, point, heading):
        self.pieces.append(Piece(*self.point, self.heading, length, curve))
        self.length += length
        self.point, self.heading = point, heading
        return self

    def line(self, length):
        if length < 1e-6:
            return self
        c, s = unit(self.heading)
        return self._add(length, "<line/>", (self.point[0] + length * c, self.point[1] + length * s), self.heading)

    def arc(self, radius, turn):
        """Turns by `turn` radians (left positive) on a circle."""
        if abs(turn) < 1e-9:
            return self
        side = math.copysign(1.0, turn)
        centre = beside(self.point, self.heading, -side * radius)
        heading = self.heading + turn
        end = beside(centre, heading, side * radius)
        return self._add(radius * abs(turn), f'<arc curvature="{num(side / radius)}"/>', end, heading)

    def spiral(self, length, k0, k1):
        """A clothoid from curvature `k0` to `k1`, integrated by Simpson's rule."""
        n, (x, y), h = 200, self.point, self.heading
        at = lambda s: h + k0 * s + (k1 - k0) * s * s / (2 * length)
        step = length / n
        for i in range(n):
            a, b, c = (at(step * (i + f)) for f in (0, 0.5, 1))
            x += step / 6 * (math.cos(a) + 4 * math.cos(b) + math.cos(c))
            y += step / 6 * (math.sin(a) + 4 * math.sin(b) + math.sin(c))
        return self._add(length, f'<spiral curvStart="{num(k0)}" curvEnd="{num(k1)}"/>', (x, y), at(length))

    def bend(self, radius, turn, ease):
        """A road's bend: spiral in, arc, spiral out; `turn` radians in all."""
        k = math.copysign(1 / radius, turn)
        arc = abs(turn) - ease / radius
        return self.spiral(ease, 0, k).arc(radius, math.copysign(arc, turn)).spiral(ease, k, 0)

    def to(self, point, heading):
        """Reaches `point` with `heading`: straight, an S of two arcs, or a corner."""
        c, s = unit(self.heading)
        dx, dy = point[0] - self.point[0], point[1] - self.point[1]
        ahead, left, turn = dx * c + dy * s, dy * c - dx * s, wrap(heading - self.heading)
        if abs(turn) < 1e-6:
            return self._shift(ahead, left)
        # Legs from both ends to where the two tangents meet.
        out = left / math.sin(turn)
        into = ahead - out * math.cos(turn)
        if into < 0.5 or out < 0.5:
            return self.hermite(point, heading)
        leg = min(into, out)
        return self.line(into - leg).arc(leg / math.tan(abs(turn) / 2), turn).line(out - leg)

    def _shift(self, ahead, left):
        if abs(left) < 1e-6:
            return self.line(ahead)
        turn = 2 * math.atan2(left, ahead)
        radius = ahead / (2 * math.sin(abs(turn)))
        return self.arc(radius, turn).arc(radius, -turn)

    def hermite(self, point, heading):
        """A cubic to `point` with `heading`, as paramPoly3."""
        c, s = unit(self.heading)
        dx, dy = point[0] - self.point[0], point[1] - self.point[1]
        u, v = dx * c + dy * s, dy * c - dx * s
        pull = math.hypot(u, v)
        eu, ev = (pull * w for w in unit(heading - self.heading))
        cu, du = 3 * u - 2 * pull - eu, pull + eu - 2 * u
        cv, dv = 3 * v - ev, ev - 2 * v
        speed = lambda p: math.hypot(pull + 2 * cu * p + 3 * du * p * p, 2 * cv * p + 3 * dv * p * p)
        n = 500
        length = sum(speed(i / n) + 4 * speed((i + 0.5) / n) + speed((i + 1) / n) for i in range(n)) / 6 / n
        curve = (
            f'<paramPoly3 aU="0" bU="{num(pull)}" cU="{num(cu)}" dU="{num(du)}" '
            f'aV="0" bV="0" cV="{num(cv)}" dV="{num(dv)}" pRange="normalized"/>'
        )
        return self._add(length, curve, point, heading)


# --- what a road is made of -----------------------------------------------------------------------


@dataclass(frozen=True)
class Profile:
    """One side of a road, from the middle outwards; both sides are alike."""

    lanes: int
    width: float
    edge: float  # width of the strip between lanes and kerb: parking, or a paved shoulder
    parking: bool
    sidewalk: float  # 0 for none
    kmh: int
    kind: str = "town"

    @property
    def kerb(self):
        return self.lanes * self.width + self.edge

    def ids(self):
        """(distance from the middle, type) of each lane outwards."""
        kinds = ["driving"] * self.lanes + ["edge"] + (["sidewalk"] if self.sidewalk else [])
        return list(enumerate(kinds, start=1))

    def width_of(self, kind):
        return {"driving": self.width, "edge": self.edge, "sidewalk": self.sidewalk}[kind]


@dataclass
class Road:
    id: int
    path: Path2
    profile: Profile
    ends: dict = field(default_factory=dict)  # "start"/"end" -> ("road"/"junction", id, contact)
    walk_on: dict = field(default_factory=dict)  # whether the road linked at an end has sidewalks too
    elevation: list = field(default_factory=list)  # (s, a, b, c, d)
    objects: list = field(default_factory=list)
    signals: list = field(default_factory=list)
    sections: list = None  # (s, edge type) where it changes

    @property
    def length(self):
        return self.path.length


@dataclass
class Arm:
    """Where a road touches a junction: `heading` leads out of the junction."""

    road: Road
    contact: str
    point: tuple
    heading: float

    @property
    def profile(self):
        return self.road.profile

    def lane_in(self, n):
        return -n if self.contact == "end" else n

    def lane_out(self, n):
        return n if self.contact == "end" else -n

    def s(self, before):
        """`s` that lies `before` metres ahead of the junction."""
        return self.road.length - before if self.contact == "end" else before

    def t(self, right):
        """`t` that lies `right` metres to the right of the middle for who drives in."""
        return -right if self.contact == "end" else right

    @property
    def orientation(self):
        return "+" if self.contact == "end" else "-"


@dataclass
class Connection:
    id: int
    source: Arm
    target: Arm
    lane_from: int
    lane_to: int
    kerbside: bool
    path: Path2
    z: float
    signals: str = ""


@dataclass
class Junction:
    id: int
    arms: list
    control: str  # "lights", "stop", "yield" (for the minor arms) or "none"
    major: set = field(default_factory=set)  # ids of roads with right of way
    z: float = 0.0
    connections: list = field(default_factory=list)
    controllers: list = field(default_factory=list)  # (id, id of its signal, place in the sequence)
    pairs: bool = False  # whether lights of opposing arms switch together


class Map:
    def __init__(self, name):
        self.name, self.roads, self.junctions, self.last = name, [], [], 0

    def id(self):
        self.last += 1
        return self.last

    def road(self, path, profile, **more):
        self.roads.append(Road(self.id(), path, profile, **more))
        return self.roads[-1]

    def join(self, a, b):
        """Lets road `b` follow road `a`."""
        a.ends["end"], b.ends["start"] = ("road", b.id, "start"), ("road", a.id, "end")
        both = bool(a.profile.sidewalk and b.profile.sidewalk)
        a.walk_on["end"] = b.walk_on["start"] = both

    def junction(self, arms, control, major=(), z=0.0, zebras=(), pairs=False):
        j = Junction(self.id(), sorted(arms, key=lambda a: wrap(a.heading)), control, {r.id for r in major}, z)
        j.pairs = pairs
        for arm in j.arms:
            arm.road.ends[arm.contact] = ("junction", j.id, None)
        for k, arm in enumerate(j.arms):
            self._movements(j, arm, j.arms[k + 1 :] + j.arms[:k])
        for arm in j.arms:
            if arm.road.id in {r.id for r in zebras}:
                self._zebra(arm)
            self._control(j, arm)
        self.junctions.append(j)
        return j

    def _movements(self, j, source, others):
        """Connections from `source`; `others` start with the arm to its right."""
        turns = {id(a): wrap(a.heading - source.heading - math.pi) for a in others}
        leftmost = max(turns.values())
        n = source.profile.lanes
        for target in others:
            turn, m = turns[id(target)], target.profile.lanes
            if turn < -math.pi / 4:
                pairs = [(n, m)]
            elif turn > math.pi / 4:
                pairs = [(1, 1)]
            elif n == m:
                pairs = [(i, i) for i in range(1, n + 1)]
            elif n < m:
                pairs = [(1, i) for i in range(1, m + 1)]
            else:
                pairs = [(n, m)] + ([(1, m)] if leftmost <= math.pi / 4 else [])
            for a, b in pairs:
                kerbside = target is others[0] and a == n and b == m
                self._connect(j, source, target, a, b, kerbside)

    def _connect(self, j, source, target, a, b, kerbside):
        inward = source.heading + math.pi
        p, q = source.profile, target.profile
        path = Path2(beside(source.point, inward, (a - 1) * p.width), inward)
        path.to(beside(target.point, target.heading, (b - 1) * q.width), target.heading)
        j.connections.append(Connection(self.id(), source, target, a, b, kerbside, path, j.z))

    def _zebra(self, arm, before=3.6):
        arm.road.objects.append(zebra(self.id(), arm.s(before), arm.profile.kerb))

    def _control(self, j, arm):
        minor = arm.road.id not in j.major
        if j.control == "lights":
            sign = self.id()
            arm.road.signals.append(signal(sign, arm, "1000001", 0.6, 3.2))
            controller = self.id()
            j.controllers.append((controller, sign, sequence(j, arm)))
        elif j.control == "references":
            self._referenced_light(j, arm)
        elif j.control in ("stop", "yield") and minor:
            arm.road.signals.append(signal(self.id(), arm, {"stop": "206", "yield": "205"}[j.control], 6.5, 2.2))


    def _referenced_light(self, j, arm):
        """A light as other editors write it: for no lane itself, referred to by the lanes inside."""
        sid = self.id()
        own = signal(sid, arm, "1000001", 0.6, 3.2)
        arm.road.signals.append(re.sub(r'fromLane="[^"]*" toLane="[^"]*"', 'fromLane="0" toLane="0"', own))
        for c in j.connections:
            if c.source is arm:
                c.signals += (
                    f'<signalReference id="{sid}" s="0" t="0" orientation="+">'
                    f'<validity fromLane="-1" toLane="-1"/></signalReference>'
                )


def sequence(j, arm):
    """The place of an arm's light among those of its junction: one after the other, or those of an axis together."""
    axes = [round(math.cos(2 * a.heading) * 1e3) if j.pairs else a.heading for a in j.arms]
    return list(dict.fromkeys(axes)).index(axes[j.arms.index(arm)])


def signal(sid, arm, kind, before, z):
    p = arm.profile
    is_light = kind == "1000001"
    right = p.kerb + (0.35 if is_light and p.sidewalk else p.sidewalk + 0.8)
    dynamic = "yes" if is_light else "no"
    lanes = sorted(arm.lane_in(n) for n in range(1, p.lanes + 1))
    return (
        f'<signal id="{sid}" name="" s="{num(arm.s(before))}" t="{num(arm.t(right))}" zOffset="{num(z)}" '
        f'orientation="{arm.orientation}" dynamic="{dynamic}" country="OpenDRIVE" type="{kind}" subtype="-1" '
        f'value="-1" height="1" width="0.6"><validity fromLane="{lanes[0]}" toLane="{lanes[-1]}"/></signal>'
    )


def speed_sign(sid, road, s, kmh, forward):
    p = road.profile
    right = p.kerb + p.sidewalk + 0.5
    t, orientation = (-right, "+") if forward else (right, "-")
    return (
        f'<signal id="{sid}" name="" s="{num(s)}" t="{num(t)}" zOffset="2" orientation="{orientation}" dynamic="no" '
        f'country="DE" type="274" subtype="{kmh}" value="{kmh}" unit="km/h" height="0.6" width="0.6"/>'
    )


def bus_stop(sid, road, s, forward):
    p = road.profile
    right = p.kerb + p.sidewalk + 0.5
    t, orientation = (-right, "+") if forward else (right, "-")
    return (
        f'<signal id="{sid}" name="" s="{num(s)}" t="{num(t)}" zOffset="2" orientation="{orientation}" dynamic="no" '
        f'country="DE" type="224" subtype="-1" value="-1" height="0.5" width="0.5"/>'
    )


def zebra(oid, s, kerb, half=2.0):
    corners = [(s - half, -kerb), (s + half, -kerb), (s + half, kerb), (s - half, kerb)]
    points = "".join(
        f'<cornerRoad id="{i}" s="{num(cs)}" t="{num(ct)}" dz="0" height="0"/>' for i, (cs, ct) in enumerate(corners)
    )
    return (
        f'<object id="{oid}" type="crosswalk" name="zebra" s="{num(s)}" t="0" zOffset="0" hdg="0" orientation="none" '
        f'length="{num(2 * half)}" width="{num(2 * kerb)}"><outlines><outline id="0" closed="true">{points}</outline>'
        f"</outlines></object>"
    )


# --- writing ---------------------------------------------------------------------------------------


def num(value):
    text = f"{value:.7f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def mark(kind, change="none", width=0.12):
    return "" if kind == "none" else f'<roadMark sOffset="0" type="{kind}" weight="standard" color="white" width="{num(width)}" laneChange="{change}"/>'


def lane(lid, kind, widths, mark_text="", link=""):
    return f'<lane id="{lid}" type="{kind}" level="false">{link and f"<link>{link}</link>"}{widths}{mark_text}</lane>'


def constant(width):
    return f'<width sOffset="0" a="{num(width)}" b="0" c="0" d="0"/>'


def eased(w0, w1, length):
    d = w1 - w0
    if abs(d) < 1e-9:
        return constant(w0)
    return f'<width sOffset="0" a="{num(w0)}" b="0" c="{num(3 * d / length**2)}" d="{num(-2 * d / length**3)}"/>'


def side_lanes(road, sign, edge, link):
    p, out = road.profile, []
    for n, kind in p.ids():
        if kind == "driving":
            m = mark("broken", "both") if n < p.lanes else mark("solid")
        else:
            m = mark("curb") if kind == "edge" and p.sidewalk else ""
        out.append(lane(sign * n, edge if kind == "edge" else kind, constant(p.width_of(kind)), m, link(sign * n)))
    return out


def road_sections(road):
    text = ""
    sections = road.sections or [(0.0, "shoulder")]
    for k, (s, edge) in enumerate(sections):

        def link(lid):
            before = lid if k > 0 else other(road, "start", lid)
            after = lid if k + 1 < len(sections) else other(road, "end", lid)
            out = "" if before is None else f'<predecessor id="{before}"/>'
            return out + ("" if after is None else f'<successor id="{after}"/>')

        left = "".join(reversed(side_lanes(road, 1, edge, link)))
        right = "".join(side_lanes(road, -1, edge, link))
        middle = mark("broken", "both") if road.profile.lanes == 1 else mark("solid solid")
        text += (
            f'<laneSection s="{num(s)}"><left>{left}</left><center>{lane(0, "none", "", middle)}</center>'
            f"<right>{right}</right></laneSection>"
        )
    return text


def other(road, end, lid):
    """The lane that continues `lid` on the road linked at `end`, if there is one."""
    kind, _, contact = road.ends.get(end, ("junction", None, None))
    is_walk = abs(lid) == road.profile.lanes + 2
    if kind == "junction" or (is_walk and not road.walk_on.get(end, True)):
        return None
    return lid if contact != end else -lid


def link_text(ends):
    out = ""
    for end, name in (("start", "predecessor"), ("end", "successor")):
        if end in ends:
            kind, target, contact = ends[end]
            at = f' contactPoint="{contact}"' if contact else ""
            out += f'<{name} elementType="{kind}" elementId="{target}"{at}/>'
    return f"<link>{out}</link>"


def plan(path):
    out, s = "", 0.0
    for p in path.pieces:
        out += (
            f'<geometry s="{num(s)}" x="{num(p.x)}" y="{num(p.y)}" hdg="{num(p.hdg)}" length="{num(p.length)}">'
            f"{p.curve}</geometry>"
        )
        s += p.length
    return f"<planView>{out}</planView>"


def elevation(records):
    if not any(any(r[1:]) for r in records):
        return ""
    rows = "".join(
        f'<elevation s="{num(s)}" a="{num(a)}" b="{num(b)}" c="{num(c)}" d="{d:.12f}"/>' for s, a, b, c, d in records
    )
    return f"<elevationProfile>{rows}</elevationProfile>"


def road_text(road):
    p = road.profile
    types = f'<type s="0" type="{p.kind}"><speed max="{p.kmh}" unit="km/h"/></type>'
    return (
        f'<road length="{num(road.length)}" id="{road.id}" junction="-1">{link_text(road.ends)}{types}'
        f"{plan(road.path)}{elevation(road.elevation or [(0, 0, 0, 0, 0)])}"
        f"<lanes>{road_sections(road)}</lanes><objects>{''.join(road.objects)}</objects>"
        f"<signals>{''.join(road.signals)}</signals></road>\n"
    )


def connection_lanes(c):
    """(lane id, id on the source, id on the target, type, width there, width here) of a connection."""
    p, q = c.source.profile, c.target.profile
    rows = [(-1, c.lane_from, c.lane_to, "driving", p.width, q.width)]
    if c.kerbside:
        rows.append((-2, p.lanes + 1, q.lanes + 1, "shoulder", p.edge, q.edge))
        if p.sidewalk and q.sidewalk:
            rows.append((-3, p.lanes + 2, q.lanes + 2, "sidewalk", p.sidewalk, q.sidewalk))
    return rows


def connection_text(c, junction):
    lanes = ""
    for lid, a, b, kind, w0, w1 in connection_lanes(c):
        link = f'<predecessor id="{c.source.lane_in(a)}"/><successor id="{c.target.lane_out(b)}"/>'
        m = mark("curb") if kind == "shoulder" and c.source.profile.sidewalk else mark("none")
        lanes += lane(lid, kind, eased(w0, w1, c.path.length), m, link)
    ends = {"start": ("road", c.source.road.id, c.source.contact), "end": ("road", c.target.road.id, c.target.contact)}
    return (
        f'<road length="{num(c.path.length)}" id="{c.id}" junction="{junction.id}">{link_text(ends)}'
        f"{plan(c.path)}{elevation([(0, c.z, 0, 0, 0)])}"
        f'<lanes><laneSection s="0"><center>{lane(0, "none", "", mark("none"))}</center><right>{lanes}</right>'
        f"</laneSection></lanes>{c.signals and f'<signals>{c.signals}</signals>'}</road>\n"
    )


def junction_text(j):
    out = ""
    for n, c in enumerate(j.connections):
        links = "".join(f'<laneLink from="{c.source.lane_in(a)}" to="{lid}"/>' for lid, a, *_ in connection_lanes(c))
        out += (
            f'<connection id="{n}" incomingRoad="{c.source.road.id}" connectingRoad="{c.id}" contactPoint="start">'
            f"{links}</connection>"
        )
    if j.major:
        major = [c for c in j.connections if c.source.road.id in j.major]
        minor = [c for c in j.connections if c.source.road.id not in j.major]
        out += "".join(f'<priority high="{h.id}" low="{l.id}"/>' for h in major for l in minor)
    out += "".join(f'<controller id="{c}" type="0" sequence="{n}"/>' for c, _, n in j.controllers)
    return f'<junction id="{j.id}" name="" type="default">{out}</junction>\n'


def document(m, roads, junctions):
    """The whole file of a map, whose lights hang on controllers."""
    controllers = "".join(
        f'<controller id="{c}" name="" sequence="{n}"><control signalId="{s}" type="0"/></controller>\n'
        for j in m.junctions
        for c, s, n in j.controllers
    )
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<!-- Written by author.py; change that instead. -->\n'
        f'<OpenDRIVE><header revMajor="1" revMinor="6" name="{m.name}" version="1" north="0" south="0" east="0" west="0"/>\n'
        + "".join(roads)
        + controllers
        + "".join(junctions)
        + "</OpenDRIVE>\n"
    )


def write(m, folder):
    roads = [road_text(r) for r in m.roads] + [connection_text(c, j) for j in m.junctions for c in j.connections]
    text = document(m, roads, [junction_text(j) for j in m.junctions])
    (folder / f"{m.name}.xodr").write_text(text)
    print(f"{m.name}: {len(m.roads)} roads, {len(m.junctions)} junctions, {len(text)} bytes")
