"""A third of the notebooks in JupyterLab, another one for each commit, and one in Notebook 7: all cells, then every slider.

CI runs this file by its name. The notebooks run with their dots, as somebody opens them who has written nothing.
"""

import shutil
import subprocess
from pathlib import Path

import pytest
from conftest import running_lab
from test_live_arm_in_lab import KERNEL_IDLE

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("[0-9A][0-9]_*.ipynb"))
COMMIT = subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout.strip() or "0"
THIRD = NOTEBOOKS[int(COMMIT, 16) % 3 :: 3]
SECONDS = 300  # a notebook, on a machine that others use too
RUN_ALL = """() => { window.done = false;
  jupyterapp.commands.execute('notebook:run-all-cells').then(() => { window.done = true; }); }"""
OUTPUTS = """() => JSON.stringify(jupyterapp.shell.currentWidget.content.widgets.map((one) => one.model.outputs?.toJSON() ?? []))"""
#: The picture under a slider: the first one in the nearest box that has one.
PIXELS = """(handle) => {
  let box = handle, picture = null;
  while (!(picture = box.querySelector('img, canvas'))) box = box.parentElement;
  return picture.src || picture.toDataURL();
}"""
SAID = """() => [...document.querySelectorAll('.jp-OutputArea-output')].map((one) => one.textContent)
  .filter((text) => /(?:Error|Warning)\\b/.test(text))"""


@pytest.fixture
def opened(browser, tmp_path):
    """Opens a notebook in a lab of its own, runs all its cells, and returns the page."""
    context = browser.new_context(viewport={"width": 1366, "height": 900})
    page = context.new_page()
    page.set_default_timeout(1000 * SECONDS)
    labs = []

    def run(path, app="jupyterlab"):
        shutil.copy(path, tmp_path)
        labs.append(running_lab(tmp_path, app=app, IR50P_HOME=str(tmp_path / "mine")))
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
    """Move each slider by keys to an end; returns the names of those under which no pixel changes, and of all."""
    still, names = [], []
    page.wait_for_timeout(1000)
    for handle in page.locator(".jp-OutputArea .noUi-handle").all():
        handle.scroll_into_view_if_needed()
        name = handle.evaluate("(one) => one.closest('.widget-hslider').textContent.trim()")
        before = handle.evaluate(PIXELS)
        names.append(name)
        for key in ("Home", "End"):
            handle.focus()
            page.keyboard.press(key)
            for _ in range(50):
                if handle.evaluate(PIXELS) != before:
                    break
                page.wait_for_timeout(100)
            else:
                continue
            break
        else:
            still.append(name)
    return still, names


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
