"""Objects beside roads, and the heights of roads."""

import math

from opendrive import num


def generator(seed):
    """A small linear congruential generator in [0, 1): the same map on every machine."""
    state = seed

    def draw():
        nonlocal state
        state = (state * 6364136223846793005 + 1442695040888963407) % 2**64
        return (state >> 33) / 2**31

    return draw


def smooth(length, z0, z1):
    """From one height to another, level at both ends."""
    rise = z1 - z0
    return [(0.0, z0, 0.0, 3 * rise / length**2, -2 * rise / length**3)]


def over(length, z0, z1, bump):
    """From one height to another by way of one that lies `bump` metres above the mean, level there and at both ends."""
    half, top = length / 2, (z0 + z1) / 2 + bump
    return smooth(half, z0, top) + [(half, *smooth(half, top, z1)[0][1:])]


def levels(knots):
    """Through heights at some places, (s, z), level at each."""
    return [(s, *smooth(t - s, z, w)[0][1:]) for (s, z), (t, w) in zip(knots, knots[1:])]


def bridge(net, road, s0, s1, kind="concrete"):
    """What carries a road from a place to another."""
    road.structures.append(f'<bridge id="{net.id()}" s="{num(s0)}" length="{num(s1 - s0)}" type="{kind}"/>')


def tunnel(net, road, s0, s1):
    road.structures.append(
        f'<tunnel id="{net.id()}" s="{num(s0)}" length="{num(s1 - s0)}" type="standard" lighting="0.8" daylight="0.2"/>'
    )


def area(net, road, name, places, z):
    """What lies on the ground: its corners east and north of zero, and its height above the start of a road."""
    start = road.path.pieces[0]
    c, s = math.cos(start.hdg), math.sin(start.hdg)
    at = lambda x, y: (c * (x - start.x) + s * (y - start.y), c * (y - start.y) - s * (x - start.x))
    corners = "".join(
        f'<cornerLocal id="{k}" u="{num(u)}" v="{num(v)}" z="{num(z)}" height="0"/>'
        for k, (u, v) in enumerate(at(*place) for place in places)
    )
    road.objects.append(
        f'<object id="{net.id()}" type="none" name="{name}" s="0" t="0" zOffset="0" hdg="0" orientation="none"><outlines>'
        f'<outline id="0" closed="true">{corners}</outline></outlines></object>'
    )


def tree(net, road, s, t, height, crown):
    road.objects.append(
        f'<object id="{net.id()}" type="tree" name="tree" s="{num(s)}" t="{num(t)}" zOffset="-0.3" hdg="0" '
        f'orientation="none" radius="{num(crown)}" height="{num(height)}"/>'
    )


def block(net, road, kind, name, s, t, size, hdg=0.0, z=0.0):
    """A box: length along the road, width, height."""
    length, width, height = (num(v) for v in size)
    road.objects.append(
        f'<object id="{net.id()}" type="{kind}" name="{name}" s="{num(s)}" t="{num(t)}" zOffset="{num(z)}" '
        f'hdg="{num(hdg)}" orientation="none" length="{length}" width="{width}" height="{height}"/>'
    )


def wall(net, road, kind, name, s0, s1, t, height, width=0.25, to=None):
    """What runs along a road, from `t` aside of its middle `to` another: a rail, a wall."""
    s, length, end, t, h, w = num(s0), num(s1 - s0), num(t if to is None else to), num(t), num(height), num(width)
    road.objects.append(
        f'<object id="{net.id()}" type="{kind}" name="{name}" s="{s}" t="{t}" zOffset="0" hdg="0" orientation="none" '
        f'length="{length}" width="{w}" height="{h}"><repeat s="{s}" length="{length}" distance="0" tStart="{t}" '
        f'tEnd="{end}" widthStart="{w}" widthEnd="{w}" heightStart="{h}" heightEnd="{h}" zOffsetStart="0" '
        f'zOffsetEnd="0"/></object>'
    )


def rail(net, road, s0, s1, t, to=None):
    wall(net, road, "barrier", "guardRail", s0, s1, t, 0.8, to=to)


def row(net, road, rng, s0, s1, t, pitch, height, crown, chance=1.0, stray=0.0):
    """Trees along a road: every `pitch` metres, some left out, none quite alike."""
    s = s0
    while s < s1:
        if rng() < chance:
            grown = 0.8 + 0.4 * rng()
            tree(net, road, s, t + stray * (rng() - 0.5), height * grown, crown * min(grown, 1.0))
        s += pitch
