"""Exports recordings or cases as COCO, OpenLABEL and ROS 2, and reads them with what others read these with: pycocotools,
openlabel-checker (with ASAM's JSON schema) and rosbags (all PyPI). What the three say of the same ticks must agree.

    python format_readers.py PATH/TO/aeye FILE...
"""

import collections
import contextlib
import io
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy
import openlabel_checker.core
import PIL.Image
import pycocotools.coco
import pycocotools.cocoeval
import pycocotools.mask
import rosbags.highlevel
import rosbags.typesys

TICK_HZ = 60
SIZE = (128, 64)
CHECKPOINT = "early"
# CARLA 0.9.10's tags of people and vehicles, which are counted.
THINGS = {4: "Pedestrian", 10: "Vehicles"}
PER_TICK = ["/clock", "/tf", "/odom"]
MASKS = ["/camera/truth/compressed", f"/camera/predicted/{CHECKPOINT}/compressed"]
PER_PICTURE = ["/actors", "/camera/camera_info", "/camera/image_raw/compressed", *MASKS]
# Parked cars are numbered from here on.
FIRST_PARKED = 1 << 16
ONCE = ["/tf_static", "/camera/label_info"]


def export(aeye, file, how, out, *options):
    size = "x".join(map(str, SIZE))
    command = [aeye, "--json", "export", str(file), "--format", how, "--size", size, "--out", str(out), *options]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(done.stdout.splitlines()[0])["exports"][0]


def same(a, b, tolerance, what):
    assert numpy.allclose(a, b, rtol=0, atol=tolerance), f"{what}: {a} and {b}"


def segment_ids(path):
    """Ids of a panoptic picture, as panopticapi computes them."""
    colours = numpy.asarray(PIL.Image.open(path).convert("RGB"), dtype=numpy.uint32)
    return colours[..., 0] + 256 * colours[..., 1] + 256**2 * colours[..., 2]


def box(mask):
    rows, columns = numpy.nonzero(mask)
    return [columns.min(), rows.min(), columns.max() - columns.min() + 1, rows.max() - rows.min() + 1]


def check_panoptic(folder):
    """Ids of each picture by tick."""
    table = json.loads((folder / "panoptic.json").read_text())
    assert [category["id"] for category in table["categories"]] == list(range(23))
    assert {c["id"]: c["name"] for c in table["categories"] if c["isthing"]} == THINGS
    pictures, segments = {}, 0
    for image, annotation in zip(table["images"], table["annotations"], strict=True):
        assert image["id"] == annotation["image_id"]
        assert PIL.Image.open(folder / "images" / image["file_name"]).size == (image["width"], image["height"]) == SIZE
        ids = segment_ids(folder / "panoptic" / annotation["file_name"])
        found, areas = numpy.unique(ids[ids != 0], return_counts=True)
        told = {segment["id"]: segment for segment in annotation["segments_info"]}
        assert sorted(told) == found.tolist(), f"{annotation['file_name']}: other ids than in segments_info"
        for number, area in zip(found.tolist(), areas.tolist()):
            segment = told[number]
            assert (segment["area"], segment["category_id"], segment["iscrowd"]) == (area, number >> 16, 0)
            assert segment["bbox"] == box(ids == number)
        stuff = [s["category_id"] for s in told.values() if s["category_id"] not in THINGS]
        assert len(stuff) == len(set(stuff)), "all stuff of a class is one segment"
        pictures[image["id"]] = ids
        segments += len(told)
    return pictures, segments


def check_instances(folder, pictures):
    with contextlib.redirect_stdout(io.StringIO()):
        coco = pycocotools.coco.COCO(str(folder / "instances.json"))
    assert sorted(coco.getImgIds()) == sorted(pictures)
    assert {c["id"]: c["name"] for c in coco.loadCats(coco.getCatIds())} == THINGS
    annotations = coco.loadAnns(coco.getAnnIds())
    for annotation in annotations:
        mask = coco.annToMask(annotation)
        assert mask.sum() == annotation["area"] == pycocotools.mask.area(coco.annToRLE(annotation))
        assert pycocotools.mask.toBbox(coco.annToRLE(annotation)).tolist() == annotation["bbox"]
        number = annotation["segment_id"]
        assert (mask == (pictures[annotation["image_id"]] == number)).all(), "another mask than in the panoptic picture"
    counted = sum((number >> 16) in THINGS for ids in pictures.values() for number in numpy.unique(ids).tolist())
    assert counted == len(annotations)
    return annotations, precision(coco, annotations)


def precision(coco, annotations):
    """What COCO's own evaluation says of the annotations as predictions of themselves."""
    if not annotations:
        return None
    results = [
        {"image_id": a["image_id"], "category_id": a["category_id"], "segmentation": coco.annToRLE(a), "score": 1.0}
        for a in annotations
    ]
    with contextlib.redirect_stdout(io.StringIO()):
        evaluation = pycocotools.cocoeval.COCOeval(coco, coco.loadRes(results), "segm")
        evaluation.evaluate()
        evaluation.accumulate()
        evaluation.summarize()
    assert evaluation.stats[0] == 1.0, f"AP {evaluation.stats[0]}"
    return float(evaluation.stats[0])


def check_openlabel(path, file):
    """Labels, and how much is in them."""
    report = openlabel_checker.core.check_file(str(path))
    issues = [issue for outcome in report.outcomes for issue in outcome.issues]
    assert not issues, issues[:5]
    labels = json.loads(path.read_text())["openlabel"]
    assert sorted(map(int, labels["frames"])) == list(range(len(labels["frames"])))
    said = [event for event in labels.get("events", {}).values() if event["type"] == "CornerCase"]
    texts = {text["name"]: text["val"] for event in said for text in event["event_data"].get("text", [])}
    name = pathlib.Path(file).name.removesuffix(".mcap").removesuffix(".case")
    beside = pathlib.Path(file).with_name(f"{name}.counterfactual.json")
    verdict = json.loads(beside.read_text())["verdict"] if beside.is_file() and said else None
    assert texts.get("verdict") == verdict, f"verdict {texts.get('verdict')}, expected {verdict}"
    return labels, len(report.outcomes), verdict


def rotated(q, v):
    """A vector turned by a quaternion (x, y, z, w)."""
    axis, w = numpy.asarray(q[:3]), q[3]
    turned = 2.0 * numpy.cross(axis, v)
    return numpy.asarray(v) + w * turned + numpy.cross(axis, turned)


def numbers(message, names="xyz"):
    return [getattr(message, name) for name in names]


def check_types(reader, store):
    """Types of the bag that ROS has as well are its own."""
    for connection in reader.connections:
        own = rosbags.typesys.get_types_from_msg(connection.msgdef.data, connection.msgtype)
        assert connection.msgtype in own
        for name, (constants, fields) in own.items():
            if name in store.fielddefs:
                assert fields == store.fielddefs[name][1], f"{name}: other fields"
                assert set(constants) == set(store.fielddefs[name][0]), f"{name}: other constants"


def read_bag(folder):
    """Messages by topic, each with its time in nanoseconds."""
    store = rosbags.typesys.get_typestore(rosbags.typesys.Stores.ROS2_HUMBLE)
    messages = collections.defaultdict(list)
    with rosbags.highlevel.AnyReader([folder], default_typestore=store) as reader:
        check_types(reader, store)
        last = 0
        for connection, time, raw in reader.messages():
            assert time >= last, "times go back"
            last = time
            messages[connection.topic].append((time, reader.deserialize(raw, connection.msgtype)))
        for connection in reader.connections:
            assert connection.msgcount == len(messages[connection.topic]), connection.topic
        assert reader.message_count == sum(map(len, messages.values()))
        times = [time for of_topic in messages.values() for time, _ in of_topic]
        assert (reader.start_time, reader.end_time - 1) == (min(times), max(times))
    return messages


def check_motion(odometry):
    """The difference of places is what the velocities come to: within 5 cm in a tenth of a second."""
    worst, dt = 0.0, 1 / TICK_HZ
    for i in range(6, len(odometry)):
        way, turn = numpy.zeros(3), 0.0
        for _, message in odometry[i - 5 : i + 1]:
            q = numbers(message.pose.pose.orientation, "xyzw")
            same(numpy.linalg.norm(q), 1.0, 1e-6, "a rotation")
            way += dt * rotated(q, numbers(message.twist.twist.linear))
            turn += dt * message.twist.twist.angular.z
        (_, before), (_, now) = odometry[i - 6], odometry[i]
        moved = numpy.subtract(numbers(now.pose.pose.position), numbers(before.pose.pose.position))
        worst = max(worst, float(numpy.linalg.norm(moved - way)))
    assert worst < 0.05, f"places and velocities differ by {worst} m"
    return worst


def tick_of(time_ns):
    return -(-time_ns * TICK_HZ // 10**9)


def check_ros2(folder, expected, pictures, labels):
    messages = read_bag(folder)
    ticks = list(range(expected["from"], expected["to"] + 1))
    drawn = sorted(pictures)
    for topics, wanted in [(PER_TICK, ticks), (PER_PICTURE, drawn), (ONCE, ticks[:1])]:
        for topic in topics:
            assert [tick_of(time) for time, _ in messages[topic]] == wanted, topic
    assert len(messages["/events"]) == expected["events"]
    for topic, of_topic in messages.items():
        for time, message in of_topic:
            stamp = message.header.stamp if hasattr(message, "header") else getattr(message, "stamp", None)
            assert stamp is None or stamp.sec * 10**9 + stamp.nanosec == time, topic
    for topic in ["/camera/image_raw/compressed", *MASKS]:
        for time, message in messages[topic]:
            picture = PIL.Image.open(io.BytesIO(message.data.tobytes()))
            assert (picture.size, picture.mode) == (SIZE, "L" if topic in MASKS else "RGB")
            if topic == MASKS[0]:
                assert (numpy.asarray(picture) == pictures[tick_of(time)] >> 16).all(), "another mask than in COCO"
    check_labels(messages, labels)
    return sum(map(len, messages.values())), check_motion(messages["/odom"])


def check_labels(messages, labels):
    """Bag and labels have everybody at the same place, through the same camera."""
    frames = {frame["frame_properties"]["tick"]: frame for frame in labels["frames"].values()}
    odometry = {tick_of(time): message for time, message in messages["/odom"]}
    for tick, frame in frames.items():
        pose = frame["frame_properties"]["transforms"]["ego_to_world"]["transform_src_to_dst"]
        same(numbers(odometry[tick].pose.pose.position), pose["translation"], 1e-4, f"tick {tick}")
    for time, message in messages["/actors"]:
        objects = frames[tick_of(time)]["objects"]
        boxes = {str(marker.id): marker for marker in message.markers if marker.action == marker.ADD}
        assert message.markers[0].action == message.markers[0].DELETEALL and boxes.keys() == objects.keys()
        for uid, marker in boxes.items():
            val = objects[uid]["object_data"]["cuboid"][0]["val"]
            same(numbers(marker.pose.position) + numbers(marker.scale), val[:3] + val[7:], 1e-4, f"object {uid}")
    (_, info), (_, mounting) = messages["/camera/camera_info"][0], messages["/tf_static"][0]
    matrix = labels["streams"]["camera"]["stream_properties"]["intrinsics_pinhole"]["camera_matrix"]
    same(info.p, matrix, 1e-9, "the camera")
    assert math.isclose(2 * math.atan(info.k[2] / info.k[0]), math.pi / 2, rel_tol=1e-6), "it sees 90 degrees"
    pose, transform = labels["coordinate_systems"]["camera"]["pose_wrt_parent"], mounting.transforms[0].transform
    same(numbers(transform.translation), pose["translation"], 1e-6, "the camera's place")
    same(numbers(transform.rotation, "xyzw"), pose["quaternion"], 1e-6, "the camera's rotation")


def check_tracks(instances, labels):
    """Whoever is seen has the same number in both; the labels leave out parked cars that nobody moved."""
    groups = {uid: thing["type"] for uid, thing in labels["objects"].items()}
    for instance in instances:
        uid, person = str(instance["track_id"]), THINGS[instance["category_id"]] == "Pedestrian"
        assert uid in groups or instance["track_id"] >= FIRST_PARKED, f"{uid} is in no label"
        # What is ridden counts as a vehicle, who rides on it as a person.
        assert uid not in groups or not groups[uid].startswith("Human") or person, f"{uid}: {groups[uid]}"


def check(aeye, file, folder):
    name = pathlib.Path(file).name
    coco, labels_file, bag = folder / "coco", folder / "labels.json", folder / "bag"
    exported = export(aeye, file, "coco", coco)
    pictures, segments = check_panoptic(coco)
    assert len(pictures) == exported["frames"] and segments
    instances, ap = check_instances(coco, pictures)
    print(f"{name}: pycocotools finds {len(pictures)} pictures, {segments} segments, {len(instances)} instances, AP {ap}")
    assert export(aeye, file, "openlabel", labels_file)["frames"] == len(pictures)
    labels, checks, verdict = check_openlabel(labels_file, file)
    check_tracks(instances, labels)
    parts = ", ".join(f"{len(labels.get(part, {}))} {part}" for part in ["frames", "objects", "events", "actions"])
    print(f"{name}: openlabel-checker finds nothing in {checks} checks of {parts}; verdict {verdict}")
    expected = export(aeye, file, "ros2", bag, "--checkpoint", CHECKPOINT)
    messages, off_m = check_ros2(bag, expected, pictures, labels)
    print(f"{name}: rosbags reads {messages} messages; places and velocities differ by {1000 * off_m:.1f} mm at most")


def main():
    aeye, *files = sys.argv[1:]
    assert files, __doc__
    for file in files:
        with tempfile.TemporaryDirectory(dir=os.environ.get("TMPDIR")) as folder:
            check(aeye, file, pathlib.Path(folder))


if __name__ == "__main__":
    main()
