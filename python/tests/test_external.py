"""Functions in the place of checkpoints."""

import os
import pickle
import signal
import threading
from pathlib import Path

import aeye
import numpy as np
import pytest
from aeye._shipped import Shipped

DRIVES = {"maps": "city", "runs": 2, "seed": 5, "max_time": 10, "hazards": "raised"}
NETWORK = aeye.Segmenter("early")


def external(function=NETWORK.predict, name="mine", **others) -> aeye.External:
    return aeye.External(function, name=name, version="2", **others)


def all_road(rgb):
    return np.full(rgb.shape[:2], 7, np.uint8)


def provenance(path: Path, said) -> dict[str, str]:
    return said("inspect", path)["provenance"]


@pytest.fixture
def episode():
    """An agent in the safety seat takes over after four seconds; gives the hashes of its steps, and the recording."""
    gymnasium = pytest.importorskip("gymnasium")
    import aeye.gym  # noqa: F401

    def drive(checkpoint, folder: Path) -> tuple[list[int], Path]:
        env = gymnasium.make("aeye/Drive-v0", seat="safety", checkpoint=checkpoint, record=folder, max_time=8)
        _, info = env.reset(seed=3)
        hashes, over = [info["hash"]], False
        while not over:
            brake = float(len(hashes) > 40)
            _, _, terminated, truncated, info = env.step(np.array([0.0, 0.0, brake], np.float32))
            hashes.append(info["hash"])
            over = terminated or truncated
        env.close()
        return hashes, Path(info["recording"])

    return drive


def test_a_function_drives_the_same_runs_as_the_checkpoint_that_it_calls(tmp_path, said):
    expected = aeye.campaign("early", tmp_path / "early", **DRIVES)
    found = aeye.campaign(external(), tmp_path / "mine", **DRIVES)
    assert [run["km"] for run in found["runs"]] == [run["km"] for run in expected["runs"]]
    for i in range(DRIVES["runs"]):
        mine, its = tmp_path / "mine" / f"mine-{i:04}.mcap", tmp_path / "early" / f"early-{i:04}.mcap"
        one, other = aeye.open(mine), aeye.open(its)
        assert np.array_equal(one.hashes, other.hashes)
        assert np.array_equal(one.masks["digest"], other.masks["digest"]) and one.masks["digest"].size
        for seat in ("semantic", "safety"):
            for name, column in one.controls[seat].items():
                assert np.array_equal(column, other.controls[seat][name]), name
        says, said_there = provenance(mine, said), provenance(its, said)
        assert (says.pop("checkpoint"), says.pop("external")) == ("mine", "2")
        assert (said_there.pop("checkpoint"), len(said_there.pop("checkpoint_digest"))) == ("early", 64)
        assert says == said_there
        assert one.verify()["ok"]
    told = said("statistics", tmp_path / "mine")["checkpoints"]
    assert [(each["checkpoint"], each["digest"]) for each in told] == [("mine", "external mine@2")]
    assert aeye.campaign(external(), tmp_path / "mine", **DRIVES) == found, "what is there is not driven again"
    with pytest.raises(aeye.EngineError, match="belongs to another campaign"):
        aeye.campaign(aeye.External(all_road, name="mine", version="3"), tmp_path / "mine", **DRIVES)


def test_shards_of_a_function_come_together(tmp_path):
    for i in (1, 2):
        aeye.campaign(external(all_road), tmp_path / "shards" / str(i), shard=(i, 2), **DRIVES)
    together = aeye.collect(tmp_path / "shards", tmp_path / "together")
    assert together == aeye.campaign(external(all_road), tmp_path / "alone", **DRIVES)


def test_what_a_function_drove_is_driven_on_by_whoever_has_it(episode, tmp_path, program, said):
    """All commands cope with its recordings; what looks again needs the function."""
    own = episode(external(), tmp_path / "mine")[1]
    program("verify", own)
    program("rerender", own, "--checkpoint", "early", "--last", "1s", "--out", tmp_path / "pictures")

    on = {"without_intervention": True, "after": 1}
    with pytest.raises(aeye.EngineError, match='"mine", version 2, a function outside of this program, which cannot be'):
        aeye.redrive(own, tmp_path / "nobody", **on)
    with pytest.raises(aeye.EngineError, match="cannot be opened again"):
        aeye.redrive(own, tmp_path / "another", recorded=external(name="yours"), **on)
    mine = aeye.redrive(own, tmp_path / "forks", recorded=external(), **on)
    its = aeye.redrive(episode("early", tmp_path / "early")[1], tmp_path / "its", **on)
    assert mine["verdicts"] == its["verdicts"]
    assert [fork["checkpoint"] for fork in (*mine["forks"], *its["forks"])] == ["mine", "early"]
    other = aeye.redrive(own, tmp_path / "other", checkpoint="early", after=1)
    says = provenance(tmp_path / "other" / other["forks"][0]["recording"], said)
    assert says["checkpoint"] == "early" and "external" not in says


def test_a_function_is_compared_as_a_checkpoint_is(case, tmp_path, said):
    command = said("compare", case, "--checkpoint", "early,truth", "--out", tmp_path / "command")
    assert aeye.compare(case, ["early", "truth"], tmp_path / "same") | {"speed": None} == command | {"speed": None}
    found = aeye.compare(
        case, ["early", external(), external(all_road, "road")], tmp_path / "out", gates=["miou>=0.9"], no_worse_than="early"
    )
    early, mine, road = found["checkpoints"]
    assert (mine["name"], mine["digest"], road["digest"]) == ("mine", "external mine@2", "external road@2")
    assert (mine["iou"], mine["miou"]) == (early["iou"], early["miou"]) and road["miou"] < early["miou"]
    assert isinstance(found["cases"], aeye.Table) and (tmp_path / "out" / "report.html").exists()
    assert {gate["passed"] for gate in found["gates"]} == {True, False}
    for wrong in ({"gates": ["beauty>=1"]}, {"no_worse_than": "full"}, {"size": (4, 4)}):
        with pytest.raises(aeye.InputError):
            aeye.compare(case, ["early", "truth"], tmp_path / "wrong", **wrong)
    with pytest.raises(aeye.InputError, match="two or more"):
        aeye.compare(case, ["early"], tmp_path / "wrong")


def test_a_function_is_measured_as_a_checkpoint_is(dataset):
    found, expected = (aeye.evaluate(each, dataset, split="train") for each in (external(), "early"))
    assert (found["iou"], found["confusion"]) == (expected["iou"], expected["confusion"])
    assert found["digest"] == "external mine@2"


def test_an_agent_drives_with_a_function_beside_it(episode, tmp_path, said):
    hashes, recording = episode(external(), tmp_path / "mine")
    assert hashes == episode("early", tmp_path / "early")[0]
    says = provenance(recording, said)
    assert (says["semantic"], says["checkpoint"], says["external"]) == ("bot", "mine", "2")
    assert aeye.open(recording).verify()["ok"]


class Broken(Exception):
    """Of somebody's own program."""


def fails_at(call: int):
    calls = iter(range(10_000))

    def function(rgb):
        if next(calls) >= call:
            raise Broken("no memory left on the device")
        return all_road(rgb)

    return function


def test_an_exception_comes_through_as_it_is(tmp_path, case, dataset):
    with pytest.raises(Broken, match="no memory left on the device") as caught:
        aeye.campaign(external(fails_at(20)), tmp_path / "out", **DRIVES)
    assert caught.traceback[-1].name == "function" and caught.traceback[-1].path == Path(__file__)
    assert not list((tmp_path / "out").glob("*.mcap"))
    with pytest.raises(Broken):
        aeye.compare(case, ["early", external(fails_at(3))], tmp_path / "compared")
    with pytest.raises(Broken):
        aeye.redrive([case, case], tmp_path / "forks", checkpoint=external(fails_at(3)), after=1)
    with pytest.raises(Broken):
        aeye.evaluate(external(fails_at(0)), dataset, split="train")


def test_an_episode_ends_with_the_exception_and_the_next_begins():
    gymnasium = pytest.importorskip("gymnasium")
    import aeye.gym  # noqa: F401

    broken = [True]

    def function(rgb):
        if broken[0]:
            raise Broken
        return all_road(rgb)

    env = gymnasium.make("aeye/Drive-v0", seat="safety", checkpoint=external(function), max_time=5)
    with pytest.raises(Broken):
        env.reset(seed=1)
    broken[0] = False
    env.reset(seed=1)
    env.close()


@pytest.mark.parametrize(
    ("function", "said"),
    [
        (lambda rgb: all_road(rgb).astype(np.int64), "mine: gave int64 of shape (128, 256); expected an array of uint8"),
        (lambda rgb: rgb, "mine: gave uint8 of shape (128, 256, 3); expected an array of uint8 of shape (height, width)"),
        (lambda rgb: None, "mine: gave <class 'NoneType'>; expected an array of uint8"),
        (lambda rgb: all_road(rgb)[::2, ::2], "mine: gave a mask of 128x64 pixels; expected the picture's 256x128"),
        (lambda rgb: all_road(rgb) + 16, "mine: gave class 23 in row 0, column 0; expected 0 to 22"),
    ],
)
def test_a_mask_that_is_none_is_refused_in_a_sentence(function, said, tmp_path):
    with pytest.raises(aeye.InputError) as caught:
        aeye.campaign(external(function), tmp_path / "out", **DRIVES)
    assert str(caught.value).startswith(said) and "\n" not in str(caught.value)


def test_masks_may_lie_in_memory_as_they_like_and_pictures_have_the_size(tmp_path):
    shapes = set()

    def function(rgb):
        shapes.add((rgb.shape, rgb.dtype))
        return np.asfortranarray(NETWORK.predict(rgb))[:]

    found = aeye.campaign(external(function, size=(128, 64)), tmp_path / "out", **(DRIVES | {"runs": 1}))
    assert shapes == {((64, 128, 3), np.dtype(np.uint8))}
    assert aeye.open(tmp_path / "out" / found["runs"][0]["file"]).verify()["ok"]


def test_ctrl_c_ends_a_campaign_of_a_function(tmp_path):
    driving = threading.Event()

    def function(rgb):
        driving.set()
        return all_road(rgb)

    def press():
        driving.wait(60)
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=press).start()
    with pytest.raises(KeyboardInterrupt):
        aeye.campaign(external(function), tmp_path / "out", maps="city", runs=1000)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"name": "early"}, "that of a checkpoint of this program"),
        ({"name": "a/b"}, "cannot be a file's"),
        ({"version": ""}, "expected 1 to 100 bytes"),
        ({"size": (4, 4)}, "expected sides of 8 to 8192"),
        ({"function": 3}, "expected something to call"),
    ],
)
def test_what_cannot_stand_in_is_refused(wrong, said):
    asked = {"function": all_road, "name": "mine", "version": "1"} | wrong
    with pytest.raises(aeye.InputError, match=said):
        aeye.External(asked.pop("function"), **asked)


def test_two_of_one_name_are_refused(tmp_path):
    with pytest.raises(aeye.InputError, match="two checkpoints have the name mine"):
        aeye.campaign([external(), external(all_road)], tmp_path / "out", **DRIVES)


def test_it_travels_with_its_function():
    mine = external(all_road, size=(64, 32))
    there = pickle.loads(pickle.dumps(mine))
    assert (there.function, there.name, there.version, there.size) == (all_road, "mine", "2", (64, 32))
    assert repr(there) == "External(mine, version 2, 64x32)"
    shipped = Shipped.pack({"checkpoint": ["early", mine], "maps": None, "scenario": None})
    with shipped.unpack() as (here, _):
        assert here["checkpoint"] == ["early", mine]
    assert shipped.identity()["checkpoint"] == ["early", repr(mine)]
