#!/usr/bin/env python3
"""Writes the bundled maps (`city.xodr` and so on) beside this file, and the small ones of the tests.

    python3 kernel/maps/author.py
"""

from pathlib import Path

import network
import streets
from city import city
from lakeside import lakeside
from motorway import motorway
from old_town import old_town
from opendrive import write
from ring import ring
from rural import rural
from small import SMALL
from suburb import suburb

HERE = Path(__file__).resolve().parent

if __name__ == "__main__":
    for build in (city, rural):
        write(build(), HERE)
    for build in (motorway, ring, lakeside):
        network.write(build(), HERE)
    for build in (old_town, suburb):
        streets.write(build(), HERE)
    for build in SMALL:
        write(build(), HERE.parent.parent / "tests" / "maps")
