"""Exported pages: every picture is there, formulas are drawn, and nothing is fetched from anywhere."""

import os
import re
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
import yaml
from accessibility import fits, violations

from ir50p_lab.course.publishing.__main__ import main
from ir50p_lab.course.publishing.export import export
from ir50p_lab.course.publishing.formulas import mathml
from ir50p_lab.errors import InputError, LabError

ROOT = Path(__file__).parents[2]
CELLS = [
    "from ir50p_lab.course.draw.style import new_figure\nfigure = new_figure(3, 2)\nfigure",
    "import ipywidgets\nfrom ir50p_lab.course.draw.widgets import live\nlive(new_figure(3, 2), lambda a: None, a=(0, 1, 0.1, 0))",
    "import numpy as np\nfrom ir50p_lab.course.draw.scope import Scope\n"
    "scope, rows = Scope(), np.arange(33).reshape(11, 3) / 30\n"
    "scope.show(np.arange(11) / 10, rows, rows, 100 * rows)\nscope",
    "from tqdm.auto import tqdm\nfor _ in tqdm(range(3)): pass",
    "from ir50p_lab.course.live_arm import LiveArm\nfrom ir50p_lab.modelling import IR50P\nLiveArm(IR50P, [0, 0.5, -1])",
    "import sympy\nsympy.sqrt(sympy.Symbol('x')) / 2",
]
PICTURES = 3  # figure, panel, arm; the chart is of lines


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("export")
    text = "# Title\n\nInline $\\tau = M\\ddot q$, displayed\n\n$$\\begin{pmatrix}1 & 0\\\\ 0 & 1\\end{pmatrix}$$\n\n`cost: $5 and $6`"
    cells = [nbformat.v4.new_markdown_cell(text), *map(nbformat.v4.new_code_cell, CELLS)]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), folder / "small.ipynb")
    return export(folder / "small.ipynb", folder / "pages")


def test_a_page_has_as_many_pictures_as_the_notebook_has_figures(pages):
    page = pages[0].read_text(encoding="utf-8")
    assert len(re.findall(r'<img[^>]*src="data:image/png;base64,[A-Za-z0-9+/]{500,}', page)) == PICTURES
    assert (
        len(re.findall(r'<svg [^>]*aria-label="Angle in deg.*?<polyline [^>]*points="[0-9. ]{40,}"', page, re.S)) == 1
    )
    assert len(re.findall("<div data-live-arm", page)) == 1 and page.count("<math") == 3
    assert not re.search(r'<img (?![^>]*alt="[^"]+")|No description', page)
    assert "cost: $5 and $6" in page and "widget-view" not in page
    assert not re.search(r"""(?:src|href)=["']https?:""", page)


def test_a_browser_asks_for_nothing_and_shows_the_arm(pages, page):
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    page.context.set_offline(True)
    page.goto(pages[0].as_uri())
    page.wait_for_function("() => document.querySelector('.la')?.liveArm", timeout=60_000)
    page.wait_for_function("() => [...document.images].every((image) => image.complete && image.naturalWidth > 0)")
    assert [url for url in asked if not url.startswith(("data:", "blob:"))] == [pages[0].as_uri()]
    box = page.locator(".la input[aria-label='joint 1 in degrees']")
    box.focus()
    page.keyboard.press("ArrowRight")
    assert page.evaluate("() => document.querySelector('.la').liveArm.q[0]") == pytest.approx(0.01745, abs=1e-4)
    assert pages[1].suffix == ".pdf" and pages[1].read_bytes().startswith(b"%PDF")


def test_a_page_fits_a_phone_and_can_be_read_by_everybody(tmp_path, page):
    long = "a_name_that_is_longer_than_any_screen_of_a_phone_is_wide = forward_kinematics"
    wide = ["| " + " | ".join(["`forward_kinematics`"] * 6) + " |", "|" + "---|" * 6, "| " + "1 |" * 6]
    formula = "$$" + " + ".join(f"\\dot q_{{{k}}}" for k in range(30)) + "$$"
    text = nbformat.v4.new_markdown_cell("\n\n".join(["# Wide", "\n".join(wide), formula, f"`{long}`"]))
    code = nbformat.v4.new_code_cell(f"{long} = '{'x' * 200}'")
    nbformat.write(nbformat.v4.new_notebook(cells=[text, code]), tmp_path / "wide.ipynb")
    (written,) = export(tmp_path / "wide.ipynb", tmp_path, pdf=False, run=False)
    page.set_viewport_size({"width": 420, "height": 900})
    page.goto(written.as_uri())
    fits(page, 420)
    assert page.evaluate("() => document.querySelector('table').scrollWidth") > 420
    assert violations(page) == {}


def test_all_kinds_of_outputs_can_be_read_by_everybody(pages, page):
    page.set_viewport_size({"width": 420, "height": 900})
    page.goto(pages[0].as_uri())
    page.wait_for_function("() => document.querySelector('.la')?.liveArm", timeout=60_000)
    fits(page, 420)
    assert violations(page) == {}


def test_a_browser_without_webgl_keeps_the_picture(pages, chromium, browser_path):
    options = ["--no-sandbox", "--disable-gpu", "--disable-software-rasterizer", "--disable-3d-apis"]
    browser = chromium.launch(executable_path=browser_path, args=options)
    page = browser.new_page()
    page.goto(pages[0].as_uri())
    page.wait_for_timeout(500)
    assert page.locator("[data-live-arm] img").is_visible() and page.locator(".la").count() == 0
    browser.close()


def test_a_cell_that_fails_is_named(tmp_path):
    nbformat.write(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("1 / 0")]), tmp_path / "bad.ipynb")
    with pytest.raises(LabError, match="ZeroDivisionError"):
        export(tmp_path / "bad.ipynb", tmp_path)
    with pytest.raises(InputError, match="there is no notebook"):
        export(tmp_path / "none.ipynb")
    assert main([str(tmp_path / "none.ipynb")]) == 1


def test_stored_outputs_are_taken_as_they_are(tmp_path):
    output = nbformat.v4.new_output("display_data", {"text/plain": "kept as it is"})
    cell = nbformat.v4.new_code_cell("1 / 0", outputs=[output])
    nbformat.write(nbformat.v4.new_notebook(cells=[cell]), tmp_path / "stored.ipynb")
    assert main([str(tmp_path / "stored.ipynb"), "--to", str(tmp_path), "--as-it-is", "--no-pdf"]) == 0
    assert "kept as it is" in (tmp_path / "stored.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("latex", [r"\dot q", r"T^i_j", r"\frac{a}{b}", r"\begin{aligned}a&=b\\c&=d\end{aligned}"])
def test_formulas_become_mathml_with_their_latex_beside_it(latex):
    found = mathml(latex)
    assert found.startswith("<math") and "alttext=" in found


def test_a_release_carries_the_page_for_the_wall_on_one_sheet(tmp_path, browser):
    """By the workflow's own commands, but for pip; gh says what it was told."""
    steps = yaml.safe_load((ROOT / ".github/workflows/release.yml").read_text("utf-8"))["jobs"]["wall"]["steps"]
    here = f'pip() {{ :; }}; python() {{ "{sys.executable}" "$@"; }}; gh() {{ echo gh "$@"; }}'
    script = "\n".join(["set -e", here, *(step["run"] for step in steps if "run" in step)])
    places = os.environ | {"RUNNER_TEMP": str(tmp_path), "GITHUB_REF_NAME": "v1"}
    told = subprocess.run(["bash", "-c", script], cwd=ROOT, env=places, capture_output=True, text=True, check=True)
    paper = tmp_path / "on_the_wall.pdf"
    assert told.stdout.splitlines()[-1] == f"gh release upload v1 {paper}"
    assert "In an emergency" in paper.with_suffix(".html").read_text(encoding="utf-8")
    assert len(re.findall(rb"/Type\s*/Page\b", paper.read_bytes())) == 1
    (sheet,) = re.findall(rb"/MediaBox\s*\[0 0 (\S+) (\S+)\]", paper.read_bytes())
    assert [float(side) / 72 * 25.4 for side in sheet] == pytest.approx([210, 297], abs=0.5)  # A4, mm


def test_on_paper_the_hints_are_open(tmp_path, browser):
    hint = "<details><summary>Hint</summary>" + 90 * "The law of cosines.<br>" + "</details>"
    nbformat.write(nbformat.v4.new_notebook(cells=[nbformat.v4.new_markdown_cell(hint)]), tmp_path / "a.ipynb")
    _, paper = export(tmp_path / "a.ipynb", tmp_path)
    assert len(re.findall(rb"/Type\s*/Page\b", paper.read_bytes())) > 1
