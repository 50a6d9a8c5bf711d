"""Small maps that the tests bake: four arms of 60 m, one rule each."""

import math
from dataclasses import replace

from opendrive import Arm, Map, Path2, Profile

ARM = Profile(lanes=1, width=3.5, edge=0.5, parking=False, sidewalk=2.5, kmh=50)
BACK, LENGTH = 12.0, 60.0


def cross(name, control, zebras=False, height=0.0):
    """A crossroads; the arms to the east and west have right of way where signs say so."""
    m, arms = Map(name), []
    for k in range(4):
        heading = k * math.pi / 2
        mouth = (BACK * math.cos(heading), BACK * math.sin(heading))
        road = m.road(Path2(mouth, heading).line(LENGTH), replace(ARM, lanes=2) if name == "cross_wide" else ARM)
        road.elevation = [(0.0, 0.0, 0.0, 3 * height / LENGTH**2, -2 * height / LENGTH**3)]
        arms.append(Arm(road, "start", mouth, heading))
    level = [arms[0].road, arms[2].road]
    major = level if control in ("stop", "yield") else ()
    m.junction(arms, control, major, zebras=[a.road for a in arms] if zebras else ())
    return m


SMALL = [
    lambda: cross("cross_lights", "lights", zebras=True),
    lambda: cross("cross_references", "references"),
    lambda: cross("cross_stop", "stop"),
    lambda: cross("cross_yield", "yield"),
    lambda: cross("cross_none", "none"),
    lambda: cross("cross_wide", "lights", zebras=True),
    lambda: cross("cross_hill", "none", height=6.0),
]
