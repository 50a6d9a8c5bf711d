"""Junctions of a `network`: crossroads, with lights, signs or nothing."""

import math

from network import between, driven, joined, left_of
from opendrive import num, wrap, zebra

LIGHT, STOP, YIELD = "1000001", "206", "205"
ZEBRA_BEFORE = 3.6  # from the mouth of a junction to the middle of a crosswalk, metres


def crossing(net, arms, control, major=(), z=0.0, zebras=True, barred=()):
    """Joins arms; `control` is "lights", "stop" or "yield" (for who is not on a `major` road), or "none".

    From a road of `barred` no way leads to another of them.
    """
    j = net.junction()
    arms = sorted(arms, key=lambda arm: wrap(arm.heading))
    major, barred = ({road.id for road in roads} for roads in (major, barred))
    ways = [way for k in range(len(arms)) for way in movements(net, j, arms, k, z, barred)]
    if major:
        first = [road.id for source, road in ways if source.road.id in major]
        last = [road.id for source, road in ways if source.road.id not in major]
        j.priorities = [(high, low) for high in first for low in last]
    for arm in arms:
        if zebras:
            arm.road.objects.append(zebra(net.id(), arm.s(ZEBRA_BEFORE), kerb(arm)))
        govern(net, j, arms, arm, control, arm.road.id in major)
    return j


def movements(net, j, arms, k, z, barred):
    """The ways from an arm to all others, beginning with the one to its right."""
    source, others = arms[k], arms[k + 1 :] + arms[:k]
    into = driven(source.strips_in())
    found = []
    for target in others:
        out = driven(target.strips_out())
        if not into or not out or {source.road.id, target.road.id} <= barred:
            continue
        turn = wrap(target.heading - source.heading - math.pi)
        kerbside = target is others[0]
        n_in, n_out = (into[0], out[0]) if turn > math.pi / 4 else (into[-1], out[-1])
        rows = joined(source, target, n_in, n_out, kerbside)
        path = between(source, target, n_in, n_out)
        found.append((source, net.connect(j, source, target, path, rows, elevation=[(0, z, 0, 0, 0)])))
    return found


def kerb(arm):
    """From the middle to the kerb."""
    strips = arm.strips_in()
    return left_of(strips, next((k for k, s in enumerate(strips) if s.kind in ("none", "curb", "sidewalk")), len(strips)))


def govern(net, j, arms, arm, control, is_major):
    """Puts up the light or sign of those who come in."""
    if not driven(arm.strips_in()):
        return
    if control == "lights":
        sid, cid = net.id(), net.id()
        arm.road.signals.append(signal(sid, arm, LIGHT, 0.6, 3.2))
        # Those of an axis are green together.
        axes = list(dict.fromkeys(round(math.cos(2 * (a.heading - arms[0].heading))) for a in arms))
        axis = round(math.cos(2 * (arm.heading - arms[0].heading)))
        j.controllers.append((cid, sid, axes.index(axis)))
    elif control in ("stop", "yield") and not is_major:
        arm.road.signals.append(signal(net.id(), arm, {"stop": STOP, "yield": YIELD}[control], 6.5, 2.2))


def signal(sid, arm, kind, before, z):
    """A light or sign for all who drive in."""
    lanes = sorted(arm.sign_in * (k + 1) for k in driven(arm.strips_in()))
    dynamic = "yes" if kind == LIGHT else "no"
    return (
        f'<signal id="{sid}" name="" s="{num(arm.s(before))}" t="{num(arm.t(roadside(arm.strips_in())))}" '
        f'zOffset="{num(z)}" orientation="{arm.orientation}" dynamic="{dynamic}" country="OpenDRIVE" type="{kind}" '
        f'subtype="-1" value="-1" height="1" width="0.6"><validity fromLane="{lanes[0]}" toLane="{lanes[-1]}"/></signal>'
    )


def roadside(strips):
    """How far from the middle a post stands: on the grass before the pavement, or where nobody walks behind it."""
    walks = [k for k, s in enumerate(strips) if s.kind == "sidewalk"]
    if not walks:
        return left_of(strips, driven(strips)[-1] + 1) + 2.5
    before = strips[walks[0] - 1]
    if before.kind in ("none", "curb") and before.width > 1.0:
        return left_of(strips, walks[0]) - before.width / 2
    return left_of(strips, walks[-1] + 1) + 0.8


def board(sid, road, s, forward, kind, value=None, height=0.6):
    """A sign beside the road for one direction; one of a limit shows `value`."""
    t = roadside(road.strips("start", -1 if forward else 1)) * (-1 if forward else 1)
    shown = 'subtype="-1" value="-1"' if value is None else f'subtype="{value}" value="{value}" unit="km/h"'
    return (
        f'<signal id="{sid}" name="" s="{num(s)}" t="{num(t)}" zOffset="2" orientation="{"+" if forward else "-"}" '
        f'dynamic="no" country="DE" type="{kind}" {shown} height="{num(height)}" width="{num(height)}"/>'
    )
