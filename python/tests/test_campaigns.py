"""Campaigns and drives on are those of the command."""

import importlib.util

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


def test_a_drive_on_needs_a_question(case, tmp_path):
    with pytest.raises(aeye.InputError, match="either"):
        aeye.redrive(case, tmp_path)
