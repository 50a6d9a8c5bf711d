#!/usr/bin/env python3
"""Writes the bundled maps `city.xodr` and `rural.xodr` beside this file.

    python3 kernel/maps/author.py
"""

from city import city
from opendrive import write
from rural import rural

if __name__ == "__main__":
    for build in (city, rural):
        write(build())
