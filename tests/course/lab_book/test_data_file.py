"""The course's files are found from any folder."""

import pytest

from ir50p_lab.bench import Recording
from ir50p_lab.course import data_file
from ir50p_lab.errors import InputError
from ir50p_lab.home import PROJECT


def test_found_from_any_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert len(Recording.load(data_file("first_reach.csv"))) > 100
    assert data_file("calibration/flat/board_01.jpg").is_file()
    assert data_file("scenes").is_dir()


@pytest.mark.parametrize(
    ("name", "there"),
    [
        ("first_reach.cvs", "first_reach.csv"),
        ("calibration/flat/board_99.jpg", "board_01.jpg"),
        ("calibration/round/board_01.jpg", "bent, flat, table"),
        ("first_reach.csv/row", "first_reach.jpg"),
        (None, "drawings"),
    ],
)
def test_the_error_names_what_is_there(name, there):
    with pytest.raises(InputError, match=f"{name}.* is not there.*{there}"):
        data_file(name)


def test_what_ships_is_found_by_its_name():
    for path in (PROJECT / "data").rglob("*"):
        assert data_file(path.relative_to(PROJECT / "data").as_posix()) == path
