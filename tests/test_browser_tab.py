"""What a browser tab cannot do is said in a sentence by what meets it; the student's folder is kept on the page's drive."""

import json
import subprocess
import sys

import pytest

from ir50p_lab.browser_tab import Drive, Lacking, NotInABrowserError
from ir50p_lab.home import PROJECT

IN_A_TAB = """
import importlib, sys, pathlib, os
for name in ("numba", "cv2", "serial", "loky"):
    sys.modules.pop(name, None)
import numpy, matplotlib.figure, anywidget, lazy_loader, cloudpickle, tomlkit, PIL.Image
class Gone:
    def find_spec(name, path=None, target=None):
        if name in ("numba", "cv2", "serial", "loky"):
            import ir50p_lab.browser_tab as tab
            return tab.Lacking.find_spec(name)
sys.meta_path.insert(0, Gone)
sys.platform = "emscripten"
os.chdir(sys.argv[1])
"""


@pytest.mark.parametrize("name", ["cv2", "serial", "loky", "numba"])
def test_what_is_not_loaded_is_named_with_its_use(name):
    with pytest.raises(NotInABrowserError, match=f"{name}, which .* On your machine"):
        Lacking.find_spec(name)
    with pytest.raises(NotInABrowserError, match="'import sympy' at the top"):
        Lacking.find_spec("sympy")  # a browser that cannot wait inside a cell
    assert Lacking.find_spec("textwrap") is None and issubclass(NotInABrowserError, ImportError)


_AFTER_THE_CELL = """
from ir50p_lab.browser_tab import Drive
from ir50p_lab.home import home, PROJECT
Drive(PROJECT / "notebooks", home()).keep()
"""


def test_two_notebooks_hear_of_each_other(tmp_path):
    first, second = (Drive(tmp_path / "drive", tmp_path / name) for name in ("first", "second"))
    for notebook, name in ((first, "_rot_z.py"), (second, "_frames.py"), (first, "_rot_z.py")):
        notebook.fetch()
        mine = notebook.memory / "my_robot" / name
        mine.parent.mkdir(parents=True, exist_ok=True)
        mine.write_text(f"# of {notebook.memory.name}, longer than {mine.stat().st_size if mine.exists() else 0}")
        notebook.keep()
    second.fetch()
    for name in ("_rot_z.py", "_frames.py"):
        texts = {(tmp_path / place / "my_robot" / name).read_text() for place in ("drive", "first", "second")}
        assert len(texts) == 1, texts


def run(code, folder, tmp_path):
    script = IN_A_TAB + code
    environment = {
        "HOME": str(tmp_path / "memory"),
        "PYTHONPATH": str(PROJECT),
        "PATH": "",
        "MPLCONFIGDIR": str(tmp_path),
    }
    (tmp_path / "memory").mkdir(exist_ok=True)
    return subprocess.run([sys.executable, "-c", script, str(folder)], env=environment, capture_output=True, text=True)


def test_what_is_written_survives_a_reload_and_the_rest_says_what_it_needs(tmp_path):
    (tmp_path / "notebooks").mkdir()
    write = f"from ir50p_lab.course import predict\npredict('fk.height', 0.3, 'm')\n{_AFTER_THE_CELL}"
    first = run(write, tmp_path / "notebooks", tmp_path)
    assert "your guess is 0.3 m" in first.stdout, first.stderr
    assert (tmp_path / "notebooks" / "results" / "lab_book.json").exists()
    for old in (tmp_path / "memory").rglob("*.json"):
        old.unlink()  # the memory of a tab is gone with it
    again = run("from ir50p_lab.course import measured\nmeasured('fk.height', 0.5)\n", tmp_path / "notebooks", tmp_path)
    assert "you guessed 0.3 m" in again.stdout, again.stderr
    refused = run(
        "from ir50p_lab.bench import SimulatedBench\nfrom ir50p_lab.controllers import PID\nfrom ir50p_lab.modelling import IR50P\n"
        "with SimulatedBench(IR50P) as bench: bench.start(PID(kp=100))\n",
        tmp_path / "notebooks",
        tmp_path,
    )
    assert "A browser tab cannot do this: a loop in the background needs threads" in refused.stderr, refused.stderr
    vision = run("from ir50p_lab.vision import find_balls", tmp_path / "notebooks", tmp_path)
    assert "NotInABrowserError: A browser tab cannot do this: cv2, which measures pictures" in vision.stderr


def test_a_push_by_hand_is_a_run_that_is_played(tmp_path):
    """Without threads no loop can be followed: the view of 08 plays the run in which the push was written down."""
    (notebook,) = (PROJECT / "notebooks").glob("08_*.ipynb")
    cells = {cell["id"]: "".join(cell["source"]) for cell in json.loads(notebook.read_text(encoding="utf-8"))["cells"]}
    hand = "\n".join(cells[f"parts-35{one}"] for one in "qst")
    code = f"{cells['parts-02']}\nmy_pi = my_robot.PID\n{hand}\nprint(type(shown).__name__, by_hand.is_open)"
    played = run(code, tmp_path, tmp_path)
    assert "Recording False" in played.stdout and "it dives by" in played.stdout, played.stderr
