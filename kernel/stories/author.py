#!/usr/bin/env python3
"""Writes the bundled stories (`cut_out.xosc` and so on) beside this file.

    python3 kernel/stories/author.py
"""

from pathlib import Path

from conflicts import ALL

HERE = Path(__file__).resolve().parent

if __name__ == "__main__":
    for story in ALL:
        (HERE / f"{story.name}.xosc").write_text(story.text(), encoding="utf-8")
