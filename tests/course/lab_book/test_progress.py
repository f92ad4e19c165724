"""The progress file: the first success stays, a damaged file is not lost, and where it lies."""

import json
import os

import pytest

from ir50p_lab import home
from ir50p_lab.course.lab_book import LabBookError
from ir50p_lab.course.lab_book.progress import progress_path, read_progress, record


@pytest.fixture
def path(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_PROGRESS", str(tmp_path / "progress.json"))
    return tmp_path / "progress.json"


def test_first_success_stays(path):
    path.write_text('{"done": {"start-1": "2020-01-01T00:00+00:00", "of earlier": "2019-01-01T00:00+00:00"}}')
    record("start-5")
    record("start-1")
    done = json.loads(path.read_text())["done"]
    assert list(done) == ["of earlier", "start-1", "start-5"] and done["start-1"] == "2020-01-01T00:00+00:00"
    assert [p.name for p in path.parent.iterdir()] == ["progress.json"]  # no scratch files


@pytest.mark.parametrize(
    "content", ["", "{", "[]", "[" * 100_000, '{"done": 3}', '{"done": {"start-1": 1}}', "{}", "\xff\xfe"]
)
def test_a_damaged_file_is_left_as_it_is(content, path):
    path.write_bytes(content.encode("latin1"))
    with pytest.raises(LabBookError, match=r"cannot be read .* rename it"):
        record("start-1")
    assert path.read_bytes() == content.encode("latin1")


def test_unreadable_file(path):
    path.mkdir()
    with pytest.raises(LabBookError, match="cannot be read"):
        read_progress()


def test_unwritable_place(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_PROGRESS", str(tmp_path / "no" / "such" / "folder.json"))
    with pytest.raises(LabBookError, match=r"cannot be written \(No such file"):
        record("start-1")


def test_failed_swap_leaves_the_old_file(path, monkeypatch):
    record("start-1")
    before = path.read_text()
    monkeypatch.setattr(os, "replace", lambda *_: (_ for _ in ()).throw(PermissionError(13, "Permission denied")))
    with pytest.raises(LabBookError, match="Permission denied"):
        record("start-5")
    assert path.read_text() == before and len(list(path.parent.iterdir())) == 1


def test_the_file_lies_in_the_students_folder(monkeypatch, tmp_path):
    monkeypatch.delenv("IR50P_PROGRESS", raising=False)
    monkeypatch.delenv("IR50P_HOME", raising=False)
    assert progress_path() == home.PROJECT / "notebooks" / "progress.json"
    monkeypatch.setenv("IR50P_HOME", str(tmp_path / "new" / "folder"))
    record("start-1")
    assert list(json.loads((tmp_path / "new" / "folder" / "progress.json").read_text())["done"]) == ["start-1"]
