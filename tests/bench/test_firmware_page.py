"""The page for the student: what it says is what the sketch does, and its cells run on the emulated board."""

import re
from pathlib import Path

import matplotlib
import pytest

from ir50p_lab import bench
from ir50p_lab.bench import SerialBench
from ir50p_lab.bench.protocol import BROKEN_COUNTS, HIGH_COUNTS, LOW_COUNTS, MAX_COUNTS, SUBCOUNTS, WATCHDOG_MS
from ir50p_lab.bench.simulated_arm import SimulatedArm
from ir50p_lab.modelling.named_arms import IR50P
from tests.emulator.virtual import VirtualBoard

FOLDER = Path(bench.__file__).parent / "firmware"
PAGE = (FOLDER / "README.md").read_text()
SKETCH = (FOLDER / "ir50p_board/ir50p_board.ino").read_text()
CELLS = re.findall(r"```python\n(.*?)```", PAGE, re.S)


def pins(name):
    """The three numbers of one of the sketch's tables of pins."""
    return re.search(name + r"\[JOINTS\] = \{(.*?)\}", SKETCH)[1].split(", ")


@pytest.mark.parametrize(
    ("row", "table", "letter"),
    [
        ("PWM", "PWM_PIN", "D"),
        ("direction", "DIRECTION_PIN", "D"),
        ("enable", "ENABLE_PIN", "D"),
        ("potentiometer", "POT_CHANNEL", "A"),
    ],
)
def test_the_table_of_pins_is_that_of_the_sketch(row, table, letter):
    cells = [cell.strip() for cell in re.search(rf"^\| {row}.*$", PAGE, re.M)[0].split("|")]
    assert cells[2:5] == [letter + pin for pin in pins(table)]


def test_the_figure_shows_the_same_pins():
    figure = (FOLDER / "wiring.svg").read_text()
    for table, letter in (("PWM_PIN", "D"), ("DIRECTION_PIN", "D"), ("ENABLE_PIN", "D"), ("POT_CHANNEL", "A")):
        for pin in pins(table):
            assert re.search(rf"\b{letter}{pin}\b", figure)


def test_the_limits_are_those_of_the_wire():
    low, high, broken, top = (
        x / SUBCOUNTS for x in (LOW_COUNTS, HIGH_COUNTS, BROKEN_COUNTS, MAX_COUNTS - BROKEN_COUNTS)
    )
    assert f"below {low:g} and above {high:g} counts" in PAGE
    assert f"below {broken:g} or above {top:g}" in PAGE
    assert f"| {WATCHDOG_MS} ms |" in PAGE


def test_its_cells_run_on_the_emulated_board(monkeypatch, tmp_path):
    """In order, as a student would; the arm behind the board is the simulated one."""
    matplotlib.use("Agg")
    boards = []

    def connect():
        board = VirtualBoard(SimulatedArm(IR50P, seed=1), timeout=0.02)
        boards.append(board)
        return SerialBench(board, arm=IR50P, clock=board, record_to=tmp_path).open()

    monkeypatch.setattr(bench, "connect", connect, raising=False)
    assert len(CELLS) == 2
    names = {}
    for cell in CELLS:
        exec(cell.replace("seconds=5", "seconds=2"), names)
        assert any(changes.pwm[0] > 0 for _, changes in boards[-1].changes)
    turned = names["bench"].recording.q[-1] - names["bench"].recording.q[0]
    assert 0.05 < turned[0] < 0.3
    assert not any(boards[-1].pins().pwm)
