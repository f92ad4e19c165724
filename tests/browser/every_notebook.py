"""A third of the notebooks in JupyterLab, another one for each commit, and one in Notebook 7: all cells, then every slider.

CI runs this file by its name. The notebooks run with their dots, as somebody opens them who has written nothing.
"""

import shutil
import subprocess
from pathlib import Path

import pytest
from conftest import KERNEL_IDLE, running_lab

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("[0-9A][0-9]_*.ipynb"))
COMMIT = subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout.strip() or "0"
THIRD = NOTEBOOKS[int(COMMIT, 16) % 3 :: 3]
SECONDS = 300  # a notebook, on a machine that others use too
RUN_ALL = """() => { window.done = false;
  jupyterapp.commands.execute('notebook:run-all-cells').then(() => { window.done = true; }); }"""
OUTPUTS = """() => JSON.stringify(jupyterapp.shell.currentWidget.content.widgets.map((one) => one.model.outputs?.toJSON() ?? []))"""
#: What is seen beside a slider: the first picture in the nearest box that has one, and the words there.
PIXELS = """(handle) => {
  let box = handle, picture = null;
  while (!(picture = box.querySelector('img, canvas'))) box = box.parentElement;
  const words = [...box.querySelectorAll('.widget-html')].map((one) => one.textContent);
  return (picture.src || picture.toDataURL()) + words;
}"""
#: What callbacks say in red under a panel; a cell may print the name of an error on purpose.
SAID = """() => [...document.querySelectorAll('.jp-OutputArea [style*="8E1B0E"], .jp-OutputArea [style*="142, 27, 14"]')]
  .map((one) => one.textContent).filter((text) => /(?:Error|Warning)\\b/.test(text))"""


@pytest.fixture
def opened(browser, tmp_path):
    """Opens a notebook in a lab of its own, runs all its cells, and returns the page."""
    context = browser.new_context(viewport={"width": 1366, "height": 900})
    page = context.new_page()
    page.set_default_timeout(1000 * SECONDS)
    labs = []

    def run(path, app="jupyterlab"):
        (tmp_path / "notebooks").mkdir()
        shutil.copy(path, tmp_path / "notebooks")
        (tmp_path / "data").symlink_to(ROOT / "data")
        labs.append(running_lab(tmp_path / "notebooks", app=app, IR50P_HOME=str(tmp_path / "mine")))
        address, _ = labs[0].__enter__()
        page.goto(address.format(path.name), wait_until="commit")
        page.wait_for_function(KERNEL_IDLE)
        page.evaluate(RUN_ALL)
        page.wait_for_function("() => window.done")
        return page

    yield run
    context.close()
    for lab in labs:
        lab.__exit__(None, None, None)


def push(page):
    """Move each slider by keys; returns the names of those under which no pixel changes, and of all.

    A bench's panel speaks to a run, which a_student_drives.py starts.
    """
    page.wait_for_timeout(1000)
    handles = page.locator(".jp-OutputArea-output:not(:has-text('CUT THE DRIVE')) .noUi-handle").all()
    names = [one.evaluate("(one) => one.closest('.widget-hslider').textContent.trim()") for one in handles]
    return [name for name, one in zip(names, handles, strict=True) if not moves(page, one)], names


def moves(page, handle):
    """Whether a pixel changes when the slider goes one step, and back again, or to an end."""
    handle.scroll_into_view_if_needed()
    before = handle.evaluate(PIXELS)
    for key, back in {"ArrowRight": "ArrowLeft", "ArrowLeft": "ArrowRight", "Home": "Home", "End": "End"}.items():
        handle.focus()
        page.keyboard.press(key)
        for _ in range(30):
            if handle.evaluate(PIXELS) != before:
                page.keyboard.press(back)
                return True
            page.wait_for_timeout(100)
    return False


def assert_sound(page):
    """No cell and no callback failed, and every slider moves its picture."""
    assert '"output_type":"error"' not in page.evaluate(OUTPUTS)
    still, names = push(page)
    assert not still, f"of {names}"
    assert page.evaluate(SAID) == []
    return names


@pytest.mark.notebook
@pytest.mark.parametrize("path", THIRD, ids=lambda path: path.stem)
def test_all_cells_and_sliders_in_jupyterlab(opened, path):
    assert_sound(opened(path))


@pytest.mark.notebook
def test_one_with_sliders_in_notebook_7(opened):
    (path,) = (one for one in NOTEBOOKS if one.name.startswith("04"))
    assert assert_sound(opened(path, "notebook"))
