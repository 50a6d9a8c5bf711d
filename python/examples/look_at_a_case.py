"""Looks at a corner case: what happened, what the network saw, and where it was wrong.

Usage: python look_at_a_case.py CASE.mcap PICTURE.png (needs Pillow)
"""

import sys

import aeye
import numpy as np
from PIL import Image

case = aeye.open(sys.argv[1])
print(f"{case.kind} on {case.map}, seed {case.seed}, {case.first_tick / 60:.1f} s to {case.ticks[-1] / 60:.1f} s of its run")
for tick, kind, actor in zip(*(case.events[name] for name in ("tick", "kind", "actor")), strict=True):
    print(f"  {tick / 60:7.2f} s  {kind}" + (f" (actor {actor})" if actor else ""))

network = aeye.Segmenter("early")
frames = case.frames(last=3.0, fps=10, size=(256, 128))
wrong = [(network.predict(frame.rgb) != frame.class_ids).mean() for frame in frames]
for tick, share in zip(frames.ticks, wrong, strict=True):
    print(f"  {tick / 60:7.2f} s  {100 * share:5.1f} % of the pixels are another class")

worst = frames[int(np.argmax(wrong))]
differs = network.predict(worst.rgb) != worst.class_ids
picture = np.vstack([worst.rgb, np.where(differs[..., None], (255, 0, 0), worst.rgb // 3).astype(np.uint8)])
Image.fromarray(picture).save(sys.argv[2])
