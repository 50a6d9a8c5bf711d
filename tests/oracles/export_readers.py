"""Exports recordings or cases and reads them with two readers that are not ours: PyPI's mcap with
protobuf support, and Rerun's MCAP importer. Both must find the frames, poses and events that
`aeye inspect` tells of, and nothing that they cannot decode.

    python export_readers.py PATH/TO/aeye FILE...
"""

import collections
import io
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import mcap.reader
import mcap_protobuf.decoder
import PIL.Image
import pyarrow
import rerun.chunk

TICK_HZ = 60
CHECKPOINT = "early"
SIZE = (128, 64)
# Topics whose messages are ours; all others hold Foxglove's.
OWN = {"/telemetry", "/criticality"}
# What Rerun must make of a topic, instead of leaving its messages as they are.
ARCHETYPES = {
    "/tf": "Transform3D",
    "/ego/pose": "InstancePoses3D",
    "/ego/path": "InstancePoses3D",
    "/events": "TextLog",
    "/camera/calibration": "Pinhole",
    "/camera/rgb": "EncodedImage",
    "/camera/truth": "EncodedImage",
    f"/camera/predicted/{CHECKPOINT}": "EncodedImage",
}


def aeye_json(aeye, *arguments):
    done = subprocess.run([aeye, "--json", *map(str, arguments)], check=True, capture_output=True, text=True)
    return json.loads(done.stdout.splitlines()[0])


def expected(contents):
    """Messages by topic, from what the file holds."""
    first, last = contents["first_tick"], contents["last_tick"]
    window, intervention = contents["window"], contents["intervention"]
    decisive = window["to"] if window else intervention["tick"] if intervention else last
    frames = sum((tick - decisive) % (TICK_HZ // 10) == 0 for tick in range(first, last + 1))
    counts = dict.fromkeys(["/tf", "/actors", "/criticality", *(t for t in ARCHETYPES if t.startswith("/camera"))], frames)
    counts |= {"/ego/pose": last - first + 1, "/telemetry": last - first, "/ego/path": 1, "/map": 1}
    counts |= {"/events": len(contents["events"]) + len(contents["notes"])}
    return {topic: count for topic, count in counts.items() if count}


def same_trace(message, samples):
    """What is plotted is what `aeye inspect` tells of a case."""
    for sample in (sample for sample in samples if sample["tick"] == message.tick):
        assert message.encroachment == (sample["encroachment"] is not None)
        for name in ["ttc_s", "pret_s", "required_deceleration_mps2"]:
            told, plotted = sample[name], getattr(message, name)
            assert math.isnan(plotted) if told is None else math.isclose(plotted, told["value"]), (name, told)


def read_with_mcap(path, contents):
    counts = collections.Counter()
    with open(path, "rb") as file:
        reader = mcap.reader.make_reader(file, decoder_factories=[mcap_protobuf.decoder.DecoderFactory()])
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            counts[channel.topic] += 1
            assert schema.encoding == channel.message_encoding == "protobuf" and schema.data
            assert schema.name.startswith("foxglove.") or channel.topic in OWN, schema.name
            assert message.log_time == message.publish_time
            if channel.topic == "/telemetry":
                tick = -(-message.log_time * TICK_HZ // 10**9)
                assert decoded.tick == tick and {decoded.steering_by, decoded.pedals_by} <= {"semantic", "safety"}
            elif channel.topic == "/criticality":
                same_trace(decoded, (contents["criticality"] or {"samples": []})["samples"])
            elif channel.topic.startswith("/camera/") and channel.topic != "/camera/calibration":
                picture = PIL.Image.open(io.BytesIO(decoded.data))
                assert picture.size == SIZE and picture.mode == ("RGB" if channel.topic == "/camera/rgb" else "P")
                assert picture.mode == "RGB" or max(picture.tobytes()) < 23, "a tag of CARLA 0.9.10"
                assert decoded.timestamp.ToNanoseconds() == message.log_time
            elif channel.topic == "/events" and decoded.message.startswith("Intervention"):
                assert message.log_time == contents["intervention"]["tick"] * 10**9 // TICK_HZ
    return counts


def read_with_rerun(path):
    """Rows by topic; transforms are a row each, so the times are counted."""
    rows, transforms = collections.Counter(), set()
    for chunk in rerun.chunk.McapReader(str(path)).stream():
        batch = chunk.to_record_batch()
        columns = {field.name.split(":")[0] for field in batch.schema if ":" in field.name}
        if chunk.is_static or chunk.entity_path.startswith("/__mcap"):
            continue
        topic = chunk.entity_path
        assert topic not in ARCHETYPES or ARCHETYPES[topic] in columns, f"{topic}: only {columns}"
        rows[topic] += batch.num_rows
        if topic == "/tf":
            transforms.update(batch.column("message_log_time").cast(pyarrow.int64()).to_pylist())
    rows["/tf"] = len(transforms)
    return rows


def check(aeye, file, folder):
    contents = aeye_json(aeye, "inspect", file)
    out = folder / "export.mcap"
    size = "x".join(map(str, SIZE))
    export = aeye_json(aeye, "export", file, "--checkpoint", CHECKPOINT, "--size", size, "--out", out)["exports"][0]
    wanted = expected(contents)
    assert (export["frames"], export["poses"]) == (wanted["/camera/rgb"], wanted["/ego/pose"]), export
    for reader, found in [("mcap", read_with_mcap(out, contents)), ("rerun", read_with_rerun(out))]:
        assert dict(found) == wanted, f"{reader}: {dict(found)}, expected {wanted}"
        frames, poses, events = (wanted.get(t, 0) for t in ["/camera/rgb", "/ego/pose", "/events"])
        print(f"{pathlib.Path(file).name}: {reader} finds {frames} frames, {poses} poses, {events} events")
    checked = subprocess.run(["rerun", "mcap", "check", "--full", str(out)], capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout + checked.stderr


def main():
    aeye, *files = sys.argv[1:]
    assert files, __doc__
    with tempfile.TemporaryDirectory() as folder:
        for file in files:
            check(aeye, file, pathlib.Path(folder))


if __name__ == "__main__":
    main()
