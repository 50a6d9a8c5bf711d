"""Campaigns and drives on are those of the command."""

import importlib.util
import shutil
from pathlib import Path

import aeye
import pytest


def test_a_campaign_is_that_of_the_command(said, tmp_path):
    asked = "campaign --checkpoint early,truth --maps city --runs 2 --seed 5 --max-time 10s --hazards raised --out"
    expected = said(*asked.split(), tmp_path / "command")
    found = aeye.campaign(
        ["early", "truth"], tmp_path / "python", maps="city", runs=2, seed=5, max_time=10, hazards="raised"
    )
    assert found == expected
    mine, its = (tmp_path / who / "campaign.json" for who in ("python", "command"))
    assert mine.read_bytes() == its.read_bytes()
    assert [run["checkpoint"] for run in found["runs"]] == ["early", "early", "truth", "truth"]
    recording = aeye.open(tmp_path / "python" / found["runs"][0]["file"])
    assert recording.map == "city" and recording.finished


def test_a_drive_on_is_that_of_the_command(said, case, tmp_path):
    expected = said("redrive", case, "--without-intervention", "--after", "2s", "--out", tmp_path / "command")
    found = aeye.redrive(case, tmp_path / "python", without_intervention=True, after=2)
    assert {**found, "out": ""} == {**expected, "out": ""}
    assert (tmp_path / "python" / found["forks"][0]["recording"]).exists()


def test_rows_are_a_table(tmp_path):
    table = aeye.Table([{"km": 1.0, "harm": {"tick": 3}}])
    if importlib.util.find_spec("pandas") is None:
        with pytest.raises(aeye.EngineError, match="pandas"):
            table.to_pandas()
    else:
        assert list(table.to_pandas().columns) == ["km", "harm.tick"]


@pytest.mark.parametrize(
    "asked",
    [
        {},
        {"runs": 0},
        {"runs": -1},
        {"runs": 1, "seed": -1},
        {"runs": 1, "shard": (1, -2)},
        {"km": 0.0},
        {"km": 1.0, "cases": 2},
        {"runs": 1, "hazards": "some"},
        {"runs": 1, "weather": "Sunny"},
        {"runs": 1, "max_time": 2.5},
        {"runs": 1, "maps": "gone.xodr"},
        {"runs": 1, "pedestrians": 501},
        {"runs": 1, "jobs": 0},
        {"runs": 1, "jobs": 257},
        {"pedestrian_cases": 1, "pedestrians": 0},
    ],
)
def test_what_cannot_be_is_refused(asked, tmp_path):
    with pytest.raises((aeye.InputError, aeye.FileError)):
        aeye.campaign("early", tmp_path / "out", **asked)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("checkpoint", "asked", "words"),
    [
        (["early", 3], {}, "checkpoint: expected a name, a file or an aeye.External, or a list of such, got int"),
        ("early", {"maps": 3}, "maps: expected a string or a path, or a list of such, got int"),
        ("early", {"max_time": "10s"}, "max_time: expected a number, got str"),
        ("early", {"runs": "1"}, "runs: expected a whole number, got str"),
        ("early", {"hazards": 3}, "hazards: expected a string, got int"),
        ("early", {"shard": 3}, "shard: expected two whole numbers, got int"),
    ],
)
def test_arguments_of_another_type_are_named(checkpoint, asked, words, tmp_path):
    with pytest.raises(TypeError) as caught:
        aeye.campaign(checkpoint, tmp_path / "out", **{"runs": 1, **asked})
    assert str(caught.value) == words and not (tmp_path / "out").exists()


def test_files_that_are_not_there_are_said_at_once(case, tmp_path):
    gone = tmp_path / "gone"
    for call in (
        lambda: aeye.redrive([case, gone], tmp_path / "out", without_intervention=True),
        lambda: aeye.compare(gone, ["early", "truth"], tmp_path / "out"),
        lambda: aeye.compare([gone, case], ["early", "truth"], tmp_path / "out", shard=(1, 2)),
    ):
        with pytest.raises(aeye.FileError, match="gone: no such file or folder"):
            call()
    assert not (tmp_path / "out").exists()
    with pytest.raises(aeye.InputError, match="two or more checkpoints"):
        aeye.compare(case, "early", tmp_path / "out")


def test_cases_without_the_verdict_that_is_asked_for_are_said_to_be_none(case, tmp_path):
    """A copy without its `.counterfactual.json` has no verdict at all."""
    alone = Path(shutil.copy(case, tmp_path))
    with pytest.raises(aeye.EngineError, match="on none of the corner cases the verdict is near miss"):
        aeye.compare(alone, ["early", "truth"], tmp_path / "judged", verdict="near-miss")


def test_a_drive_on_needs_a_question(case, tmp_path):
    with pytest.raises(aeye.InputError, match="either"):
        aeye.redrive(case, tmp_path)
