"""The library of cases is that of `aeye cases`, and what it finds is what datasets take."""

import json
import shutil
from pathlib import Path

import aeye
import pytest
from aeye.datasets import CornerCases


@pytest.fixture
def library(drive: Path, case: Path, tmp_path: Path) -> Path:
    """A case, a copy of it below, and a drive."""
    (tmp_path / "below").mkdir()
    shutil.copy(drive, tmp_path / "drive.mcap")
    for name in ("a.case.mcap", "below/b.case.mcap"):
        shutil.copy(case, tmp_path / name)
    return tmp_path


def test_rows_are_those_of_the_command(library, program):
    rows = aeye.cases(library)
    lines = [json.loads(line) for line in program("--json", "cases", library).stdout.splitlines()]
    assert isinstance(rows, aeye.Table)
    assert rows == lines[:-1] and len(rows) == 1, "a copy counts once"
    assert [row["file"] for row in rows] == [str(library / "a.case.mcap")]
    copy = library / "below" / "b.case.mcap"
    assert [row["file"] for row in aeye.cases([library, copy])] == [str(copy)], "a copy that is named stands for itself"


def test_what_is_asked_for_holds(library):
    (row,) = aeye.cases(library)
    others = {"walker", "vehicle", "rules", "boredom"} - {row["label"]}
    assert aeye.cases(library, label=row["label"], map=[row["map"]], checkpoint="early", scan=False) == [row]
    assert aeye.cases(library, label=sorted(others)) == []
    assert aeye.cases(library, near=library / "a.case.mcap", sort="distance") == [], "itself is not near itself"


def test_reviews_stay_when_a_file_is_moved(library):
    (row,) = aeye.cases(library, checkpoint="early")
    assert row["review"] is None
    (row,) = aeye.cases(library, checkpoint="early", set_review="accepted", add_tag=["odd", "night"])
    assert (row["review"], row["tags"]) == ("accepted", ["night", "odd"])
    (library / "a.case.mcap").rename(library / "c.case.mcap")
    shutil.rmtree(library / "below")
    (row,) = aeye.cases(library, reviewed="accepted", tag="odd")
    assert Path(row["file"]).name == "c.case.mcap"


def test_a_file_that_cannot_be_read_is_a_warning(library):
    (library / "cut.case.mcap").write_bytes((library / "a.case.mcap").read_bytes()[:1000])
    with pytest.warns(UserWarning, match=r"cut\.case\.mcap: damaged"):
        assert len(aeye.cases(library)) == 1


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"label": "dog"}, "label"),
        ({"verdict": "late"}, "expected one of in-vain, necessary, near-miss"),
        ({"weather": "snow"}, "expected rain, wet"),
        ({"hazards": "many"}, "expected one of"),
        ({"overlooked": "dog"}, "no road user"),
        ({"ttc_below": 0.0}, "more than 0"),
        ({"sort": "size"}, "expected one of file"),
        ({"sort": "distance"}, "expected --near"),
        ({"limit": 0}, "1 or more"),
        ({"limit": -1}, "limit=-1; expected 1 or more"),
        ({"perception_caused": "perhaps"}, "perception_caused"),
        ({"set_review": "accepted"}, "every case"),
        ({"add_tag": "a b", "label": "walker"}, "without blanks"),
    ],
)
def test_what_cannot_be_is_refused(library, wrong, sentence):
    with pytest.raises(aeye.InputError, match=sentence):
        aeye.cases(library, **wrong)


def test_whether_perception_caused_it_may_be_a_bool(library):
    by_word = [aeye.cases(library, perception_caused=word) for word in ("yes", "no", ["yes", "no"])]
    assert [aeye.cases(library, perception_caused=caused) for caused in (True, False, [True, "no"])] == by_word


def test_arguments_of_another_type_are_named(library):
    for asked, words in (
        ({"label": 3}, "label: expected a string, or a list of such, got int"),
        ({"tag": ["odd", 3]}, "tag: expected a string, or a list of such, got int"),
        ({"perception_caused": 3}, "perception_caused: expected a string or a bool, or a list of such, got int"),
        ({"ttc_below": "1"}, "ttc_below: expected a number, got str"),
        ({"limit": "3"}, "limit: expected a whole number, got str"),
    ):
        with pytest.raises(TypeError) as caught:
            aeye.cases(library, **asked)
        assert str(caught.value) == words


def test_places_that_are_not_there_are_no_empty_answer(library, tmp_path):
    gone = library / "gone.case.mcap"
    for places, index in ((gone, None), ([gone], None), ([library, gone], tmp_path / "index.sqlite")):
        with pytest.raises(aeye.FileError, match="gone.case.mcap: no such file or folder"):
            aeye.cases(places, index=index)


def test_a_dataset_takes_what_was_found(library):
    found = [row["file"] for row in aeye.cases(library)]
    listed = CornerCases(found, size=(64, 32), last=1.0)
    assert [str(path) for path in listed.paths] == found
    assert len(listed) == len(aeye.open(found[0]).frames(last=1.0, fps=10, size=(64, 32)))
    assert listed[0][0].shape == (32, 64, 3)
    assert CornerCases([library / "below", *found], size=(64, 32), last=1.0).paths[0].name == "b.case.mcap"
    with pytest.raises(aeye.InputError, match="empty list"):
        CornerCases([])
    with pytest.raises(aeye.InputError, match="a recording; expected a case"):
        CornerCases([library / "drive.mcap"])
