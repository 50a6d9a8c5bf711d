"""Exports recordings and cases as traces of OSI and reads them with programs that are not ours: ASAM's OSI utilities, and omega-prime of ika
(RWTH Aachen), which computes measures of criticality of its own. Where both define the same, both must say the same.

    python osi_readers.py PATH/TO/aeye FILE...
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

import mcap.reader
import mcap_protobuf.decoder
import omega_prime.map
import polars as pl
from omega_prime.metrics.metric_manager import MetricManager
from osi_utilities.tracefile._config import OSI_CHANNEL_REQUIRED_METADATA_KEYS, OSI_TRACE_REQUIRED_METADATA_KEYS
from osi_utilities.tracefile.readers.multi import MultiTraceReader

TICK_HZ = 60
EGO = 0
# Places that both are at within this time are looked at: the program's horizon.
HORIZON_S = 10.0
# Who turns less against the ego car goes the same way, radians.
ALONG_RAD = math.radians(15)
# The ego car comes to a place when its middle comes nearer to it than this, metres.
NEAR_M = 0.8
# Two computations of the same from rounded speeds and places; a gap is told to the tick.
SAME_TTC = 0.03
SAME_GAP_S = 2.5 / TICK_HZ


def aeye_json(aeye, *arguments):
    done = subprocess.run([aeye, "--json", *map(str, arguments)], check=True, capture_output=True, text=True)
    return json.loads(done.stdout.splitlines()[0])


def nanoseconds(tick):
    return tick * 10**9 // TICK_HZ


def read_with_asam(path, mode):
    """Every message, by the classes of ASAM or by the schema in the file; nothing that the reader calls incompatible."""
    reader = MultiTraceReader(decoder_mode=mode, skip_incompatible_messages=False)
    assert reader.open(path), path
    of_standard = [record["data"] for record in reader.get_file_metadata() if record["name"] == "net.asam.osi.trace"]
    assert len(of_standard) == 1 and OSI_TRACE_REQUIRED_METADATA_KEYS <= of_standard[0].keys(), of_standard
    (channel,) = reader.list_channel_specifications()
    assert OSI_CHANNEL_REQUIRED_METADATA_KEYS <= channel.metadata.keys(), channel
    messages = []
    while reader.has_next():
        result = reader.read_message()
        assert result.status.name == "OK", result.error_message
        messages.append(result.message)
    reader.close()
    # The first one holds the map as well.
    assert not any(unknown(message) for message in [messages[0], messages[-1]]), "what the schema does not know"
    return messages


def unknown(message):
    from google.protobuf.unknown_fields import UnknownFieldSet

    parts = [part for _, value in message.ListFields() for part in (value if hasattr(value, "add") else [value])]
    inner = [part for part in parts if hasattr(part, "ListFields")]
    return len(UnknownFieldSet(message)) > 0 or any(unknown(part) for part in inner)


def is_trace(path, ticks):
    """What the standard asks of the container, and of each message."""
    with open(path, "rb") as file:
        reader = mcap.reader.make_reader(file)
        summary = reader.get_summary()
        assert summary.chunk_indexes and {index.compression for index in summary.chunk_indexes} <= {"", "lz4", "zstd"}
        times = [(message.log_time, message.publish_time) for _, _, message in reader.iter_messages()]
    assert times == [(nanoseconds(tick), nanoseconds(tick)) for tick in ticks]
    by_class, by_schema = (read_with_asam(path, mode) for mode in ["precompiled", "mcap-contained"])
    assert [m.SerializeToString(deterministic=True) for m in by_class] == [
        m.SerializeToString(deterministic=True) for m in by_schema
    ]
    for message, (time, _) in zip(by_class, times, strict=True):
        assert message.timestamp.seconds * 10**9 + message.timestamp.nanos == time
        numbers = [thing.id.value for kind in THINGS for thing in getattr(message, kind)]
        assert len(set(numbers)) == len(numbers), "two with one number"
        assert message.host_vehicle_id.value in {object.id.value for object in message.moving_object}
    return by_class


THINGS = ["moving_object", "stationary_object", "traffic_sign", "traffic_light", "lane", "lane_boundary"]


def measured(path, others):
    """What omega-prime measures between the ego car and some others."""
    recording = omega_prime.Recording.from_file(path, validate=True, apply_proj=False)
    recording._df = recording._df.filter(pl.col("idx").is_in([EGO, *others]))
    yaws = {(row["idx"], row["total_nanos"]): row for row in recording._df.iter_rows(named=True)}
    _, properties = MetricManager().compute(recording, ego_id=EGO, time_buffer=int(HORIZON_S * 1e9))
    return yaws, properties


def plotted(aeye, file, out):
    """The samples of a recording, of which `inspect` tells none: what an export for viewers plots."""
    aeye_json(aeye, "export", file, "--size", "16x8", "--out", out)
    with open(out, "rb") as read:
        reader = mcap.reader.make_reader(read, decoder_factories=[mcap_protobuf.decoder.DecoderFactory()])
        messages = [decoded for *_, decoded in reader.iter_decoded_messages(topics=["/criticality"])]
    told = lambda m: None if math.isnan(m.ttc_s) else {"value": m.ttc_s, "with": m.ttc_with}
    return [{"tick": message.tick, "ttc_s": told(message)} for message in messages]


def number(name):
    return int(name.rsplit(" ", 1)[1])


def same_ttc(samples, states, ttc):
    """Time to collision with whoever goes the same way ahead. omega-prime measures from middle to middle along the way that
    the ego car drove, the program from box to box straight ahead: half the lengths are what lies between. Beyond the end of that
    way omega-prime takes its end instead, so that only who is where the ego car comes to later is compared."""
    way = [(row["x"], row["y"]) for (idx, _), row in states.items() if idx == EGO]
    told = {(number(s["ttc_s"]["with"]), nanoseconds(s["tick"])): s["ttc_s"]["value"] for s in samples if s["ttc_s"]}
    compared = []
    for row in ttc.iter_rows(named=True):
        key = (row["idx"], row["total_nanos_ego"])
        if row["TTC"] is None or row["THW"] is None or key not in told or key not in states:
            continue
        ego, other = states[EGO, key[1]], states[key]
        near = [math.dist(place, (other["x"], other["y"])) < NEAR_M for place in way]
        if near[-1] or not any(near):
            continue
        turned_rad = math.remainder(other["yaw"] - ego["yaw"], math.tau)
        between_m = row["THW"] * math.hypot(ego["vel_x"], ego["vel_y"])
        closing_mps = between_m / row["TTC"]
        box_s = (between_m - (ego["length"] + other["length"]) / 2) / closing_mps
        if abs(turned_rad) < ALONG_RAD and box_s > 0.5:
            compared.append((told[key], box_s, row["TTC"], key))
    return compared


def check(aeye, file, folder):
    criticality = aeye_json(aeye, "inspect", file)["criticality"]
    samples = criticality["samples"] if criticality else plotted(aeye, file, folder / "viewers.mcap")
    pet = criticality["pet_s"] if criticality else None
    # A gap is told to the tick; time to collision ten times a second.
    fps, out = TICK_HZ if pet else 10, folder / "osi.mcap"
    exported = aeye_json(aeye, "export", file, "--format", "osi", "--fps", fps, "--out", out)["exports"][0]
    messages = is_trace(out, range(exported["from"], exported["to"] + 1, TICK_HZ // fps))
    name = pathlib.Path(file).name
    print(f"{name}: {len(messages)} messages, {len(messages[0].lane)} lanes, {out.stat().st_size / 1e6:.1f} MB")
    map_ = omega_prime.map.MapOsi.from_file(out)
    assert len(map_.lanes) == len(messages[0].lane)
    others = {number(s["ttc_s"]["with"]) for s in samples if s["ttc_s"]}
    others |= {number(pet["with"])} if pet else set()
    states, properties = measured(out, others)
    return same_ttc(samples, states, properties["ttc_and_thw"]), same_pet(pet, properties["min_timegaps"])


def same_pet(pet, gaps):
    """Time between the ways that were driven, of the pair for which it is least where ways cross. omega-prime takes any place
    that both were at, so that its time can be less."""
    if not pet:
        return None
    (row,) = gaps.filter(pl.col("idx") == number(pet["with"])).iter_rows(named=True)
    return pet["value"], abs(row["min_timegap"])


def main():
    aeye, *files = sys.argv[1:]
    assert files, __doc__
    pairs = []
    with tempfile.TemporaryDirectory() as folder:
        for file in files:
            ttc, pet = check(aeye, file, pathlib.Path(folder))
            pairs += ttc
            if pet:
                told, least = pet
                assert least < told + SAME_GAP_S, pet
                print(f"  PET {told:.2f} s, omega-prime {least:.2f} s")
            for told, box_s, middle_s, (other, time_ns) in ttc:
                print(f"  {time_ns / 1e9:.1f} s, {other}: TTC {told:.2f} s, omega-prime {box_s:.2f} s ({middle_s:.2f} s from middle to middle)")
    off = sorted(abs(box_s - told) / told for told, box_s, *_ in pairs)
    assert off and off[-1] < SAME_TTC, off
    print(f"TTC at {len(off)} times: median difference {off[len(off) // 2]:.2%}, largest {off[-1]:.2%}")


if __name__ == "__main__":
    main()
