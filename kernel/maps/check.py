#!/usr/bin/env python3
"""Checks the maps beside this file: that roads join, and that one can drive from every lane to every other.

    python3 kernel/maps/check.py [FILE...]
"""

import math
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

GAP = 0.01  # greatest distance between the ends of two lanes that follow each other, metres


def curve(piece, s):
    """Place and heading on a <geometry>, in its own axes."""
    shape = piece[0]
    of = lambda name: float(shape.get(name))
    if shape.tag == "line":
        return s, 0.0, 0.0
    if shape.tag == "arc":
        k = of("curvature")
        return math.sin(k * s) / k, (1 - math.cos(k * s)) / k, k * s
    if shape.tag == "spiral":
        k0, slope = of("curvStart"), (of("curvEnd") - of("curvStart")) / float(piece.get("length"))
        heading = lambda w: k0 * w + slope * w * w / 2
        n = 200
        at = [(k + 0.5) * s / n for k in range(n)]
        return sum(math.cos(heading(w)) for w in at) * s / n, sum(math.sin(heading(w)) for w in at) * s / n, heading(s)
    p = s / float(piece.get("length"))
    u = [of(f"{c}U") for c in "abcd"]
    v = [of(f"{c}V") for c in "abcd"]
    value = lambda c: c[0] + p * (c[1] + p * (c[2] + p * c[3]))
    slope = lambda c: c[1] + p * (2 * c[2] + p * 3 * c[3])
    return value(u), value(v), math.atan2(slope(v), slope(u))


def last(records, s, name="s"):
    """The record that holds at `s`, and how far behind its start that is."""
    found = [r for r in records if float(r.get(name)) <= s + 1e-9]
    return (found[-1], s - float(found[-1].get(name))) if found else (None, 0.0)


def cubic(record, ds):
    return 0.0 if record is None else sum(float(record.get(c)) * ds**k for k, c in enumerate("abcd"))


def lane_place(road, section, lid, s):
    """The middle of a lane, its width, and the heading of its road."""
    piece, ds = last(road.findall("planView/geometry"), s)
    u, v, turn = curve(piece, ds)
    x, y, hdg = (float(piece.get(name)) for name in ("x", "y", "hdg"))
    z = cubic(*last(road.findall("elevationProfile/elevation"), s))
    side = math.copysign(1, lid)
    lanes = {int(lane.get("id")): lane for lane in section.iter("lane")}
    width = lambda k: cubic(*last(lanes[k].findall("width"), s - float(section.get("s")), "sOffset"))
    t = side * (sum(width(int(side * k)) for k in range(1, abs(lid))) + width(lid) / 2)
    px, py = x + u * math.cos(hdg) - v * math.sin(hdg), y + u * math.sin(hdg) + v * math.cos(hdg)
    heading = hdg + turn
    return (px - t * math.sin(heading), py + t * math.cos(heading), z), width(lid), heading


class Map:
    def __init__(self, path):
        self.root = ElementTree.parse(path).getroot()
        self.roads = {road.get("id"): road for road in self.root.findall("road")}
        self.errors = []
        self.edges = {}  # (road, section, lane) -> lanes that follow
        self.longest, self.gap, self.lines = 0.0, 0.0, 0.0
        for road in self.roads.values():
            self.road(road)

    def ends(self, road, k):
        sections = road.findall("lanes/laneSection")
        until = sections[k + 1].get("s") if k + 1 < len(sections) else road.get("length")
        return sections[k], float(sections[k].get("s")), float(until)

    def road(self, road):
        length = sum(float(piece.get("length")) for piece in road.findall("planView/geometry"))
        if abs(length - float(road.get("length"))) > 1e-4:
            self.errors.append(f"road {road.get('id')} is {road.get('length')} m long, its geometry {length} m")
        sections = road.findall("lanes/laneSection")
        for k, section in enumerate(sections):
            for lane in section.iter("lane"):
                if int(lane.get("id")):
                    self.lane(road, k, len(sections), section, lane)

    def lane(self, road, k, count, section, lane):
        lid = int(lane.get("id"))
        me = (road.get("id"), k, lid)
        for end, name in (("end", "successor"), ("start", "predecessor")):
            link = lane.find(f"link/{name}")
            onward = (end == "end") == (lid < 0)
            inner = k + 1 < count if end == "end" else k > 0
            for other in self.linked(road, k, end, inner, lid, link, lane.get("type")):
                self.compare(me, end, other)
                if onward and lane.get("type") == "driving":
                    self.edges.setdefault(me, set()).add(other[:3])
        if lane.get("type") == "driving":
            self.edges.setdefault(me, set())
            _, s0, s1 = self.ends(road, k)
            self.lines += s1 - s0
            # Where the paint lets one change lanes.
            for beside, inner in ((lid + int(math.copysign(1, lid)), lane), (lid - int(math.copysign(1, lid)), None)):
                other = next((o for o in section.iter("lane") if int(o.get("id")) == beside), None)
                if beside and other is not None and other.get("type") == "driving":
                    border = inner if inner is not None else other
                    if border.find("roadMark") is not None and border.find("roadMark").get("laneChange") == "both":
                        self.edges[me].add((me[0], k, beside))

    def linked(self, road, k, end, inner, lid, link, kind):
        """The lanes joined to an end of a lane, as (road, section, lane, end)."""
        rid = road.get("id")
        if inner:
            return [] if link is None else [(rid, k + 1 if end == "end" else k - 1, int(link.get("id")), "start" if end == "end" else "end")]
        to = road.find(f"link/{'successor' if end == 'end' else 'predecessor'}")
        if to is None:
            # Tracks may end.
            if kind not in ("rail", "none"):
                self.errors.append(f"road {rid} ends at its {end}")
            return []
        if to.get("elementType") == "road":
            return [] if link is None else [self.at(to.get("elementId"), to.get("contactPoint"), int(link.get("id")))]
        found = []
        junction = next(j for j in self.root.findall("junction") if j.get("id") == to.get("elementId"))
        for connection in junction.findall("connection"):
            inside = self.roads[connection.get("connectingRoad")]
            if connection.get("incomingRoad") == rid and (lid < 0) == (end == "end"):
                for pair in connection.findall("laneLink"):
                    if int(pair.get("from")) == lid:
                        found.append((inside.get("id"), 0, int(pair.get("to")), "start"))
            end_of = inside.find("link/successor")
            if end_of.get("elementId") == rid and end_of.get("contactPoint") == end:
                for lane in inside.iter("lane"):
                    after = lane.find("link/successor")
                    if after is not None and int(after.get("id")) == lid:
                        found.append((inside.get("id"), 0, int(lane.get("id")), "end"))
        return found

    def at(self, rid, contact, lid):
        count = len(self.roads[rid].findall("lanes/laneSection"))
        return rid, 0 if contact == "start" else count - 1, lid, contact

    def place(self, rid, k, lid, end):
        section, s0, s1 = self.ends(self.roads[rid], k)
        return lane_place(self.roads[rid], section, lid, s0 if end == "start" else s1)

    def compare(self, me, end, other):
        (a, wa, ha), (b, wb, hb) = self.place(*me, end), self.place(*other)
        gap = max(math.dist(a, b), abs(wa - wb) / 2)
        turn = abs(math.sin(ha - hb))
        self.gap = max(self.gap, gap)
        if gap > GAP or turn > 0.01:
            self.errors.append(f"{me} {end} and {other}: {gap:.3f} m, {math.degrees(turn):.2f} degrees apart")

    def check(self):
        back = {}
        for a, following in self.edges.items():
            for b in following:
                back.setdefault(b, set()).add(a)
        for lane in self.edges:
            for edges, what in ((self.edges, "leads nowhere"), (back, "follows nothing")):
                if not any(o[:2] != lane[:2] for o in edges.get(lane, ())):
                    self.errors.append(f"lane {lane} {what}")
        first = next(iter(self.edges))
        for edges, what in ((self.edges, "cannot be reached"), (back, "does not lead back")):
            for lane in self.edges.keys() - reached(first, edges):
                self.errors.append(f"lane {lane} {what}")


def reached(first, edges):
    seen, open_ = {first}, [first]
    while open_:
        for other in edges.get(open_.pop(), ()):
            if other not in seen:
                seen.add(other)
                open_.append(other)
    return seen


if __name__ == "__main__":
    files = sys.argv[1:] or sorted(map(str, Path(__file__).resolve().parent.glob("*.xodr")))
    wrong = 0
    for file in files:
        m = Map(file)
        m.check()
        wrong += len(m.errors)
        print(f"{file}: {m.lines / 1000:.1f} km of lanes, greatest gap {m.gap * 1000:.2f} mm, {len(m.errors)} errors")
        for error in m.errors[:20]:
            print(" ", error)
    sys.exit(wrong > 0)
