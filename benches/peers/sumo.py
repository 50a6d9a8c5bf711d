"""How fast the kernel is beside SUMO: the same map, the same counts, 1/60 s, one core, in one run.

Usage: sumo.py WORLD_SPEED FOLDER [SECONDS]

WORLD_SPEED is the program of that name of `benches`; the map and what SUMO makes of it go to FOLDER. Both are
driven for 20 s before anything is timed, then for SECONDS (60); each figure is the median of three turns, which
alternate. Road users of SUMO walk or drive at random: at each end of a road they take any way on, no U-turns.
"""

import json
import random
import statistics
import subprocess
import sys
import time
from pathlib import Path

import libsumo
import sumolib

STEP_S = 1 / 60
WARM_UP_S = 20
TURNS = 3
# Road users, and junctions from west to east and from south to north of the town that has room for them.
SIZES = [(50, 6, 5), (150, 6, 5), (500, 11, 9), (1000, 16, 13)]
KINDS = {"motorcycle": "motorcycle", "bicycle": "bicycle", "car": "passenger"}


def counts(actors):
    """Cars, motorcycles, bicycles and people as scenarios have them by default."""
    motorcycles, bicycles, people = actors * 5 // 100, actors * 10 // 100, actors * 40 // 100
    return [actors - motorcycles - bicycles - people, motorcycles, bicycles, people]


def walk(rng, net, kind, drive_s):
    """Edges of a random way that takes longer than the drive."""
    allowed = [e for e in net.getEdges() if e.allows(kind)]
    way, length_m = [rng.choice(allowed)], 0.0
    while length_m < drive_s * 20:
        last = way[-1]
        onward = [e for e in last.getOutgoing() if e.allows(kind) and e.getToNode() is not last.getFromNode()]
        if not onward:
            break
        way.append(rng.choice(onward))
        length_m += way[-1].getLength()
    return way


def demand(path, net, numbers, drive_s, rng):
    cars, motorcycles, bicycles, people = numbers
    lines = ["<routes>"]
    lines += [f'<vType id="{kind}" vClass="{vclass}"/>' for kind, vclass in KINDS.items()]
    for kind, count in zip(KINDS, [motorcycles, bicycles, cars]):
        for n in range(count):
            edges = " ".join(e.getID() for e in walk(rng, net, KINDS[kind], drive_s))
            lines.append(
                f'<vehicle id="{kind}{n}" type="{kind}" depart="0" departPos="random_free" departLane="best">'
                f'<route edges="{edges}"/></vehicle>'
            )
    for n in range(people):
        edges = " ".join(e.getID() for e in walk(rng, net, "pedestrian", drive_s // 10))
        lines.append(f'<person id="person{n}" depart="0" departPos="random"><walk edges="{edges}"/></person>')
    path.write_text("\n".join(lines + ["</routes>"]))


def drive_sumo(net, routes, drive_s):
    """(road users there at the end, simulated seconds a second)."""
    libsumo.start(
        ["sumo", "-n", str(net), "-r", str(routes), "--step-length", f"{STEP_S:.6f}", "--no-step-log", "--no-warnings"]
        + ["--threads", "1", "--seed", "1", "--ignore-route-errors"]
    )
    try:
        for _ in range(round(WARM_UP_S / STEP_S)):
            libsumo.simulationStep()
        begin = time.perf_counter()
        for _ in range(round(drive_s / STEP_S)):
            libsumo.simulationStep()
        factor = drive_s / (time.perf_counter() - begin)
        return libsumo.vehicle.getIDCount() + libsumo.person.getIDCount(), factor
    finally:
        libsumo.close()


def drive_kernel(program, town, numbers, drive_s):
    command = [program, "drive", str(town), *map(str, numbers), str(drive_s)]
    told = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    return told["placed"], told["real_time_factor"]


def main():
    program, folder = sys.argv[1], Path(sys.argv[2])
    drive_s = int(sys.argv[3]) if len(sys.argv) > 3 else 60
    folder.mkdir(parents=True, exist_ok=True)
    print("asked  kernel: there  times real time  SUMO: there  times real time  ratio")
    for actors, columns, rows in SIZES:
        town, net, routes = (folder / f"town_{actors}.{end}" for end in ("xodr", "net.xml", "rou.xml"))
        text = subprocess.run([program, "town", str(columns), str(rows)], check=True, capture_output=True, text=True)
        town.write_text(text.stdout)
        netconvert = Path(sys.executable).parent / "netconvert"
        convert = ["--opendrive", str(town), "-o", str(net), "--no-warnings", "--opendrive.import-all-lanes"]
        convert += ["--crossings.guess", "--walkingareas", "--no-turnarounds"]
        subprocess.run([netconvert, *convert], check=True, capture_output=True)
        numbers = counts(actors)
        demand(routes, sumolib.net.readNet(str(net)), numbers, drive_s + WARM_UP_S, random.Random(actors))
        turns = [(drive_kernel(program, town, numbers, drive_s), drive_sumo(net, routes, drive_s)) for _ in range(TURNS)]
        (there, ours), (there_sumo, sumos) = ([statistics.median(f) for f in zip(*peer)] for peer in zip(*turns))
        print(f"{actors:5} {there:14} {ours:16.0f} {there_sumo:12} {sumos:16.0f} {ours / sumos:6.1f}", flush=True)


if __name__ == "__main__":
    main()
