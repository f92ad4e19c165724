"""The variables IR50P_*: dressed in any way, read from any folder, they mean one thing everywhere."""

import re
from pathlib import Path

import pytest

from ir50p_lab.bench import connect
from ir50p_lab.bench.arm_instance import chosen_copy
from ir50p_lab.bench.recorder import Recorder
from ir50p_lab.course.lab_book import claims
from ir50p_lab.course.lab_book.progress import progress_path, record
from ir50p_lab.course.publishing import report
from ir50p_lab.course.robot import student_package
from ir50p_lab.errors import WrongFolderError
from ir50p_lab.home import PROJECT, check_folder, home, path_setting, setting
from ir50p_lab.launcher.commands import _first_page
from ir50p_lab.modelling import IR50P, Arm, load_arm
from ir50p_lab.vision import open_camera

DRESSES = ["{}", '"{}"', "'{}'", "  {}\t", ' "{}" ', "\" '{}'\"", "{}\r"]
EXAMPLE = "data/arm_example.toml"


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    """A notebook may run in any student_package."""
    place = tmp_path / "elsewhere"
    place.mkdir()
    monkeypatch.chdir(place)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    return place


@pytest.mark.parametrize("dress", DRESSES)
def test_blanks_and_quotes_do_not_count(dress, elsewhere, tmp_path, monkeypatch):
    def says(name, value):
        monkeypatch.setenv(name, dress.format(value))

    for name in ("IR50P_HOME", "IR50P_ARM", "IR50P_PROGRESS", "IR50P_RECORDINGS", "IR50P_CLAIMS"):
        says(name, "my lab/it's mine")
        assert path_setting(name) == PROJECT / "my lab" / "it's mine"
        says(name, "~/my lab")
        assert path_setting(name) == tmp_path / "my lab"
        says(name, str(elsewhere))
        assert path_setting(name) == elsewhere
        says(name, "")
        assert path_setting(name) is None
    says("IR50P_UNIT", 3)
    says("IR50P_SEED", 4)
    assert chosen_copy(1) == (4, 4)
    says("IR50P_BENCH", "simulated")
    with connect(record_to=False) as bench:
        assert bench.simulated


def test_one_folder_for_all_that_is_the_students(elsewhere, tmp_path, monkeypatch, capsys):
    """A relative folder: notebooks, records, claims, the report and the launcher mean the same one."""
    monkeypatch.setattr("ir50p_lab.home.PROJECT", tmp_path)
    monkeypatch.setenv("IR50P_HOME", '"mylab"')
    monkeypatch.setenv("IR50P_CLAIMS", "said.jsonl")
    assert home() == progress_path().parent == tmp_path / "mylab"
    assert _first_page(PROJECT) == ["--LabApp.default_url=/lab/tree/00_start_here.ipynb"]
    record("start-1")
    assert _first_page(PROJECT) == []
    assert student_package.folder().parent == tmp_path / "mylab"
    assert Recorder({}).path.parent == tmp_path / "mylab" / "recordings"
    claims.claim("it is so", 1, above=0)
    assert (tmp_path / "said.jsonl").exists()
    report.main([])
    assert list((tmp_path / "mylab" / "results").glob("report_*.html"))
    assert list(elsewhere.iterdir()) == []


def test_files_to_read_count_from_the_project(elsewhere, monkeypatch, capsys):
    monkeypatch.setenv("IR50P_ARM", EXAMPLE)
    assert load_arm() == Arm.load(PROJECT / EXAMPLE) != IR50P
    monkeypatch.setenv("IR50P_ARM", " ")
    assert load_arm() is IR50P
    monkeypatch.setenv("IR50P_BENCH", "'replay: \"data/pid_default_unit.csv\"'")
    with connect() as bench:
        assert bench.name == "replay of pid_default_unit.csv"
    monkeypatch.setenv("IR50P_CAMERA", "folder:data/scenes")
    with open_camera() as camera:
        assert camera.simulated


def test_a_port_or_a_drive_is_no_path(monkeypatch):
    for text in ("COM3", "/dev/ttyACM0", r"C:\lab\my.toml", "replay:"):
        monkeypatch.setenv("IR50P_BENCH", text)
        assert setting("IR50P_BENCH") == text


def test_nothing_else_reads_the_variables():
    """A new variable goes through the reader, too."""
    for path in (PROJECT / "ir50p_lab").rglob("*.py"):
        read = re.findall(r"(?:environ(?:\.get\(|\[)|getenv\()([^)\]]+)", path.read_text(encoding="utf-8"))
        others = [name for name in read if not re.match(r"[\"'](?!IR50P_)", name)]
        assert others == [] or path.name == "home.py", f"{path}: {others}"


def test_a_user_without_a_home_directory(monkeypatch):
    monkeypatch.setenv("IR50P_HOME", "~nobody-of-this-name/lab")
    assert isinstance(home(), Path)


def test_a_notebook_in_a_copied_folder_does_not_write_into_the_old_one(tmp_path, monkeypatch):
    copy = tmp_path / "copy"
    (copy / "ir50p_lab").mkdir(parents=True)
    (copy / "notebooks").mkdir()
    monkeypatch.chdir(copy / "notebooks")
    check_folder()  # a folder that only looks alike is none of ours
    (copy / "environment.txt").touch()
    with pytest.raises(WrongFolderError, match=r"This notebook is in .*copy, but its Python belongs to "):
        check_folder()
    monkeypatch.chdir(PROJECT / "notebooks")
    check_folder()
