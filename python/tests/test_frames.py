"""Pictures are those of the command, and their parts fit together."""

from pathlib import Path

import aeye
import numpy as np
import pytest
from PIL import Image


def picture(path: Path) -> np.ndarray:
    with Image.open(path) as image:
        return np.asarray(image)


@pytest.mark.parametrize("which", ["drive", "case"])
def test_arrays_are_the_files_of_rerender(which, request, program, tmp_path):
    path = request.getfixturevalue(which)
    program("rerender", path, "--checkpoint", "early", "--last", "2s", "--size", "192x96", "--out", tmp_path)
    (home,) = (folder.parent for folder in tmp_path.glob("*/rgb"))
    network = aeye.Segmenter("early")
    frames = aeye.open(path).frames(last=2.0, fps=10, size=(192, 96))
    names = [f"{tick:08}.png" for tick in frames.ticks]
    assert names == sorted(file.name for file in (home / "rgb").iterdir())
    for name, frame in zip(names, frames, strict=True):
        assert np.array_equal(frame.rgb, picture(home / "rgb" / name))
        assert np.array_equal(frame.class_ids, picture(home / "labels" / name))
        assert np.array_equal(network.predict(frame.rgb), picture(home / "predictions" / "early" / name))


def test_a_sensor_is_that_of_the_command(drive, program, tmp_path):
    sensor = "noise=6,k1=-0.1"
    options = ["--size", "96x48", "--quality", "plain", "--sensor", sensor]
    program("rerender", drive, "--checkpoint", "truth", "--last", "0.5s", *options, "--out", tmp_path)
    (home,) = (folder.parent for folder in tmp_path.glob("*/rgb"))
    recording = aeye.open(drive)
    frames = recording.frames(last=0.5, size=(96, 48), quality="plain", sensor=sensor)
    for tick, frame in zip(frames.ticks, frames, strict=True):
        assert np.array_equal(frame.rgb, picture(home / "rgb" / f"{tick:08}.png"))
        assert np.array_equal(frame.class_ids, picture(home / "labels" / f"{tick:08}.png"))
    assert np.allclose(frame.camera.distortion, [-0.1, 0, 0, 0, 0]) and frame.camera.distortion.shape == (5,)
    one = recording.frame(frame.tick, size=(96, 48), quality="plain", sensor=sensor)
    assert np.array_equal(one.rgb, frame.rgb)
    assert not recording.frame(60, size=(8, 8)).camera.distortion.any()
    with pytest.raises(aeye.InputError, match='sensor="noise=99"; .*expected a number from 0 to 32'):
        recording.frames(sensor="noise=99")


def test_every_plane_has_its_shape_and_is_the_renderers_memory(drive):
    frame = aeye.open(drive).frame(60, size=(64, 32))
    planes = {"rgb": (32, 64, 3), "class_ids": (32, 64), "instance_ids": (32, 64), "depth_m": (32, 64)}
    kinds = {"rgb": np.uint8, "class_ids": np.uint8, "instance_ids": np.uint16, "depth_m": np.float32}
    for name, shape in planes.items():
        plane = getattr(frame, name)
        assert (plane.shape, plane.dtype) == (shape, kinds[name])
        assert plane.flags.c_contiguous and plane.flags.writeable
        # Neither the array nor what it is a view of has memory that numpy made.
        assert not plane.flags.owndata and not plane.base.flags.owndata
        assert plane is getattr(frame, name)
    assert set(np.unique(frame.class_ids).tolist()) <= aeye.CLASSES.keys()
    assert np.isinf(frame.depth_m[frame.class_ids == 13]).all(), "sky"
    assert (frame.tick, frame.time_s) == (60, 1.0)


def test_what_is_seen_lies_where_camera_and_depth_say(drive):
    checked = 0
    for frame in aeye.open(drive).frames(last=None, fps=2, size=(256, 128)):
        camera, actors = frame.camera, frame.actors
        rows, columns = np.nonzero(frame.instance_ids)
        pixels = np.stack([columns + 0.5, rows + 0.5, np.ones(len(rows))])
        rays = np.linalg.inv(camera.intrinsics) @ pixels * frame.depth_m[rows, columns]
        world = (camera.world_from_camera @ np.vstack([rays, np.ones(len(rows))]))[:3].T
        for i, instance in enumerate(actors["instance_id"]):
            if instance >= 32768:
                continue  # An open door has the instance of its parked car, which is larger.
            points = world[frame.instance_ids[rows, columns] == instance]
            reach = np.linalg.norm(actors["size_m"][i])
            distances = np.linalg.norm(points - actors["position_m"][i], axis=1)
            assert (distances < reach + 0.5).all(), f"{actors['kind'][i]} {actors['id'][i]} at tick {frame.tick}"
            checked += len(points)
    assert checked > 100


def test_frames_are_a_sequence_and_any_order_gives_the_same(drive):
    frames = aeye.open(drive).frames(from_=1.0, to=8.0, fps=10, size=(32, 16))
    assert len(frames) == len(list(frames)) == len(frames.ticks) == 71
    forwards = [frame.rgb for frame in frames]
    for index in (70, 3, 40, 0):
        assert np.array_equal(frames[index].rgb, forwards[index])
        assert np.array_equal(frames[index - 71].rgb, forwards[index])
    with pytest.raises(IndexError):
        frames[71]
    with pytest.raises(IndexError):
        frames[-72]


def test_other_cameras_see_the_ego_car(drive):
    recording = aeye.open(drive)
    for camera in ("chase", "top"):
        frame = recording.frame(60, size=(64, 64), camera=camera)
        assert 65535 in frame.instance_ids, camera
    down = frame.camera.world_from_camera[:3, :3] @ [0, 0, 1]
    assert np.allclose(down, [0, 0, -1], atol=1e-5)
    assert frame.ego["position_m"].shape == (3,)
