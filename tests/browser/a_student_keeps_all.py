"""A student in a browser: predicts, writes sixteen functions wrongly and rightly, drags, is cut off, goes on, reports."""

import ast
import html
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import nbformat
import numpy as np
import solutions
from conftest import KERNEL_IDLE, open_in_lab, running_lab
from test_live_arm_in_lab import VIEW, drag_tip, show

from ir50p_lab.course.lab_book import names

NOTEBOOKS = sorted((Path(__file__).parents[2] / "notebooks").glob("0[0-7]_*.ipynb"))
WRITTEN = solutions.ORDER[: solutions.ORDER.index("PID")]
RUN = """async ([number, source]) => {
  const cells = jupyterapp.shell.currentWidget.content;
  cells.activeCellIndex = number;
  if (source) cells.activeCell.model.sharedModel.setSource(source);
  await jupyterapp.commands.execute('notebook:run-cell');
  return JSON.stringify(cells.widgets[number].model.outputs.toJSON());
}"""


def run(page, number, source=None):
    """Run a cell, with another text if there is one; returns all that it shows."""
    said = page.evaluate(RUN, [number, source])
    assert '"output_type":"error"' not in said, said
    return said


OPEN = """async (name) => {
  const panel = await jupyterapp.commands.execute('docmanager:open', {path: name});
  await panel.context.ready;
  await panel.sessionContext.ready;
  jupyterapp.shell.activateById(panel.id);
}"""
THERE = "(name) => jupyterapp.shell.currentWidget?.context?.path === name"


def go_to(page, name):
    """Open a notebook beside those that are open."""
    page.evaluate(OPEN, name)
    page.wait_for_function(THERE, arg=name)
    page.wait_for_function(KERNEL_IDLE, timeout=90_000)


def spoilt(name):
    """A function that returns its first argument, twice."""
    arguments = [argument.arg for argument in ast.parse(solutions.source(name)).body[-1].args.args]
    return f"def {name}({', '.join(arguments)}):\n    return 2 * np.asarray({arguments[0]}, dtype=float)"


def go_through(page, path):
    """Predict and write as a notebook asks for it; returns the names of what was predicted."""
    go_to(page, path.name)
    predicted = []
    cells = nbformat.read(path, as_version=4).cells
    codes = [number for number, cell in enumerate(cells) if cell.cell_type == "code"]
    run(page, codes[0])
    for number in codes:
        source = cells[number].source
        if guess := re.match(r'predict\("([^"]+)", \.\.\.', source):
            predicted.append(guess[1])
            choices = re.search(r"choices=[({](.*?)[)}]", source)
            guessed = choices[1].split(",")[1].partition(":")[0].strip() if choices else "1.25"
            assert "your guess is" in run(page, number, source.replace("...", guessed, 1))
        if source.startswith("why("):
            assert "noted" in run(page, number, source.replace("...", "as it had to come", 1))
        for name in re.findall(r'^check\("(\w+)", \w+\)', source, re.M):
            check = f'\n\n\ncheck("{name}", {name})'
            assert "not yet" in run(page, number, spoilt(name) + check)
            assert "right, and yours" in run(page, number, solutions.source(name) + check)
        if "on_drag=follow" in source:
            run(page, number)
            page.wait_for_function("() => document.querySelector('.la')?.liveArm", timeout=30_000)
    return predicted


def test_nothing_of_a_student_is_lost(browser, tmp_path):
    for path in NOTEBOOKS:
        shutil.copy(path, tmp_path)
    home = {"IR50P_HOME": str(tmp_path / "mine")}
    context = browser.new_context(viewport={"width": 1300, "height": 1000})
    page = context.new_page()
    predicted = []
    with running_lab(tmp_path, **home) as (address, server):
        open_in_lab(page, address.format(NOTEBOOKS[0].name))
        for path in NOTEBOOKS:
            predicted += go_through(page, path)
            if path.name.startswith("02"):
                show(page, 0)
                assert page.locator(".la-badge").nth(0).text_content() == "yours"
                before = page.evaluate(f"() => {VIEW.format(0)}.q")
                missed, _ = drag_tip(page, 0, -40, 30)
                assert np.abs(missed).max() < 2
                assert page.evaluate(f"() => {VIEW.format(0)}.q") != before
        page.evaluate(
            "() => jupyterapp.shell.currentWidget.sessionContext.session.kernel.requestExecute("
            "{code: 'import os; os.kill(os.getpid(), 9)'})"
        )
        server.kill()
        server.wait(20)
    with running_lab(tmp_path, **home) as (address, _):
        open_in_lab(page, address.format(NOTEBOOKS[0].name))
        go_to(page, NOTEBOOKS[0].name)
        said = run(page, 1, "from ir50p_lab.course import my_robot\nmy_robot.done()")
        assert all(f"'{name}'" in said for name in WRITTEN)
    context.close()
    command = [sys.executable, "-m", "ir50p_lab.course.publishing.report", "--name", "Ada"]
    subprocess.run(command, env=os.environ | home, check=True, cwd=Path(__file__).parents[2])
    (report,) = (tmp_path / "mine" / "results").glob("report_*.html")
    text = report.read_text(encoding="utf-8")
    assert set(predicted) <= set(names.titles()), "names.txt"
    for words in (
        "Ada",
        "1.25",
        "as it had to come",
        *(html.escape(names.title(one)) for one in predicted),
        *(f"def {name}" for name in WRITTEN),
    ):
        assert words in text, words
    assert "on loan" not in text
