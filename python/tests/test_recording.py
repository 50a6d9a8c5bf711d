"""Recordings and cases: tables, and what the commands say of them."""

import shutil
from pathlib import Path

import aeye
import numpy as np
import pytest

OLD = Path(__file__).parents[2] / "tests" / "old_recordings" / "1-corner.case.mcap"


def test_rows_are_ticks(drive):
    recording = aeye.open(str(drive))
    assert (recording.kind, recording.map, recording.finished) == ("recording", "city", True)
    assert recording.first_tick == 0 and recording.path == drive
    ticks = recording.ticks
    assert ticks.dtype == np.uint64 and np.array_equal(ticks, np.arange(1, len(ticks) + 1))
    assert recording.hashes.shape == ticks.shape and recording.hashes.dtype == np.uint32
    for seat in ("semantic", "safety"):
        columns = recording.controls[seat]
        assert all(column.shape == ticks.shape for column in columns.values())
        assert {columns[name].dtype for name in ("steering", "throttle", "brake")} == {np.dtype(np.float32)}
        assert np.abs(columns["steering"]).max() <= 1 and 0 <= columns["throttle"].min()
        assert columns["hand_brake"].dtype == np.bool_
    assert recording.controls["semantic"]["throttle"].max() > 0, "somebody drives"
    assert recording.labels is None
    assert len(recording.masks["digest"]) > 0 and recording.masks["digest"].dtype == np.uint64


@pytest.mark.parametrize("which", ["drive", "case"])
def test_inspect_and_verify_say_what_the_commands_say(which, request, said):
    path = request.getfixturevalue(which)
    recording = aeye.open(path)
    told = said("inspect", path)
    assert recording.inspect() == told
    assert recording.verify() == said("verify", path)
    assert recording.verify(rewind=30)["ok"] is True
    events = recording.events
    assert events["tick"].tolist() == [event["tick"] for event in told["events"]]
    assert events["kind"].tolist() == [event["kind"] for event in told["events"]]
    assert events["actor"].tolist() == [event["actor"] for event in told["events"]]
    assert recording.scenario == told["scenario"]


def test_a_case_has_a_window_and_labels(case):
    recording = aeye.open(case)
    assert recording.kind == "case"
    assert recording.labels is not None and recording.labels["label"] in ("walker", "vehicle", "rules", "boredom")
    assert recording.ticks[0] == recording.first_tick + 1
    frames = recording.frames()
    assert (len(frames), frames.ticks[-1]) == (30, recording.inspect()["window"]["to"])


def test_a_case_of_another_version_is_read_but_not_replayed():
    recording = aeye.open(OLD)
    assert recording.kind == "case" and recording.labels is not None
    assert recording.labels["label"] == recording.inspect()["label"]
    with pytest.raises(aeye.Error, match=r"made on the map|made by kernel"):
        recording.verify()


def test_errors_are_one_sentence_of_the_kind_that_fits(drive, tmp_path):
    recording = aeye.open(drive)
    gone, damaged = tmp_path / "gone.mcap", tmp_path / "damaged.mcap"
    shutil.copy(drive, damaged)
    with damaged.open("r+b") as file:
        file.seek(5000)
        file.write(b"damage")
    refused = [
        (aeye.FileError, OSError, lambda: aeye.open(gone), "gone.mcap: "),
        (aeye.InputError, ValueError, lambda: aeye.open(damaged), "damaged.mcap: damaged at "),
        (aeye.InputError, ValueError, lambda: recording.frames(fps=7), "fps=7; expected a divisor of 60"),
        (aeye.InputError, ValueError, lambda: recording.frames(fps=0), "fps=0; expected a divisor of 60"),
        (aeye.InputError, ValueError, lambda: recording.frames(fps=-1), "fps=-1; expected a divisor of 60"),
        (aeye.InputError, ValueError, lambda: recording.frames(size=(4, 4)), "size 4x4; expected sides of 8 to 8192"),
        (aeye.InputError, ValueError, lambda: recording.frames(size=(-5, 10)), "size -5x10; expected sides of 8"),
        (aeye.InputError, ValueError, lambda: recording.frames(size=(8192, 8192)), "at most 16777216 pixels"),
        (aeye.InputError, ValueError, lambda: recording.frames(size=(10**40, 8)), "expected sides of 8 to 8192"),
        (aeye.InputError, ValueError, lambda: recording.frames(last=float("nan")), "expected a time of the run"),
        (aeye.InputError, ValueError, lambda: recording.frames(from_=500.0), "nothing of that window"),
        (aeye.InputError, ValueError, lambda: recording.frames(camera="side"), "expected driver, chase or top"),
        (aeye.InputError, ValueError, lambda: recording.frames(last=1.0, from_=2.0), "last with from_ or to"),
        (aeye.InputError, ValueError, lambda: recording.frames(from_=-1), "from_=-1; expected a time of the run"),
        (aeye.InputError, ValueError, lambda: recording.frame(10**6), "tick=1000000; expected 0 to "),
        (aeye.InputError, ValueError, lambda: recording.frame(-1), "tick=-1; expected 0 to "),
        (aeye.InputError, ValueError, lambda: recording.frame(60, camera="side"), "expected driver, chase or top"),
        (aeye.InputError, ValueError, lambda: recording.verify(rewind=0), "rewind=0; expected 1 to 600"),
    ]
    for kind, builtin, call, words in refused:
        with pytest.raises(kind) as caught:
            call()
        said = str(caught.value)
        assert words in said and "\n" not in said
        assert isinstance(caught.value, builtin) and isinstance(caught.value, aeye.Error)


def test_arguments_of_another_type_are_named(drive):
    recording = aeye.open(drive)
    refused = [
        ({"fps": 10.0}, "fps: expected a whole number, got float"),
        ({"size": 512}, "size: expected two whole numbers, got int"),
        ({"size": (512.0, 256)}, "size: expected two whole numbers, got float"),
        ({"size": (1, 2, 3)}, "size: expected two whole numbers, got tuple"),
        ({"last": "3"}, "last: expected a number or None, got str"),
        ({"from_": "3"}, "from_: expected a number, got str"),
        ({"camera": 3}, "camera: expected a string, got int"),
    ]
    for asked, words in refused:
        with pytest.raises(TypeError) as caught:
            recording.frames(**asked)
        assert str(caught.value) == words
    assert len(recording.frames(fps=np.int64(1), size=np.array([64, 32]), last=np.float64(2))) == 2


def test_a_window_is_cut_to_what_the_file_holds(case):
    recording = aeye.open(case)
    first, last = recording.first_tick, int(recording.ticks[-1])
    everything = recording.frames(last=None, fps=60).ticks
    assert (everything[0], everything[-1]) == (first, last)
    assert np.array_equal(recording.frames(from_=0.0, to=1e4, fps=60).ticks, everything)
    assert np.array_equal(recording.frames(last=1e4, fps=60).ticks, everything[everything <= recording.frames().ticks[-1]])
