"""A student in a browser does 11 on the emulated board: guesses, draws the circle wrongly, then rightly, and drives it;
pulls the cable, and plugs it in again; pushes the simulated arm by mouse.

CI runs this file by its name: it takes a minute or two, and `ir50p_lab test` is to be quick.
"""

import re

import circles
import pytest
from a_student_keeps_all import run
from a_student_measures import code_cells, opened
from a_student_tunes import PLUG_IN, ROOT
from test_live_arm_in_lab import VIEW, show

NOTEBOOK = ROOT / "notebooks" / "11_bench_drive.ipynb"
CONNECT = "views.connect().close()"
PATIENT = "import ir50p_lab.bench.run as cycles\ncycles.LONGEST_PAUSE = 60  # s: a slow machine ends no run\n"


def draw(page, number, cell):
    """As it stands, wrongly in each way, then rightly."""
    assert "not written yet" in run(page, number, cell)
    for old, new, words in circles.WRONG:
        said = run(page, number, circles.written(cell, old, new))
        assert words in said, said
    assert "circle: right, and yours" in run(page, number, circles.written(cell))


def plug_in_again(page, number):
    """Until then nobody drives this arm."""
    assert "Bench: simulated IR50P, unit 0 (no Arduino Mega found" in run(page, number, CONNECT)
    assert "Bench: board on emulated" in run(page, number, f"emulated_bench.plug_in_again(board)\n{CONNECT}")


def push(page):
    """The tip of the last arm on the page, sideways, until it gives way."""
    last = page.locator(".la").count() - 1
    view = VIEW.format(last)
    show(page, last)
    page.wait_for_function(f"() => {view}.hand.mostPush", timeout=60_000)
    (x, y), before = page.evaluate(f"() => [{view}.scene.onPage({view}.scene.tipAt), {view}.scene.tipAt]")
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 100, y, steps=4)
    text = page.locator(".la-note", has_text="you push").last.text_content(timeout=60_000)
    assert re.fullmatch(r"you push with \d+\.\d N at link 3", text), text
    page.wait_for_function(
        f"(old) => Math.hypot(...{view}.scene.tipAt.map((v, i) => v - old[i])) > 0.01", arg=before, timeout=60_000
    )
    page.mouse.up()
    assert page.locator(".la-note", has_text="you push").count() == 0


@pytest.mark.notebook
@pytest.mark.emulator
def test_a_student_drives(browser, tmp_path):
    said = {}
    with opened(browser, NOTEBOOK, tmp_path) as page:
        cells = list(code_cells(NOTEBOOK, first=f"{PLUG_IN}emulated_bench.allow_the_cable(board)\n"))
        for number, source in cells:
            if source.startswith("def circle("):
                draw(page, number, source)
                continue
            if "live_panel(" in source:
                source = PATIENT + source.replace("connect(q0=", 'connect("simulated", q0=')
            if "panel.stop()" in source:
                push(page)
            said[source] = run(page, number, source)
            if 'broken("cable")' in source:
                plug_in_again(page, number)
    everything = "".join(said.values())
    assert "The simulated arm instead" not in everything
    (driven,) = [text for source, text in said.items() if ".play(round_once)" in source]
    assert "Bench: board on emulated" in driven and "The arm in 3-D, the course's" in driven  # its reach and PID
    (record,) = [text for source, text in said.items() if "round_once.path.read_text" in source]
    assert re.search(r"# bench_id: board-\w+\\n# simulated: false", record), record
    (lost,) = [text for source, text in said.items() if 'broken("cable")' in source]
    assert "Now, by hand: cable" in lost and "it brakes by itself 0.1 s after the last command" in lost
    assert "Look at the USB cable and the board's lamp, then connect() again" in lost
    assert len(re.findall(r"(?:circle\.rms|replay\.past): [^\\]*not written down", everything)) == 2
