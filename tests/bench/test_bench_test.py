"""The first power-on finds what is wrong and says which wire it is: on the emulated board, behind it a faulty arm."""

import builtins
import json
import re

import numpy as np
import pytest
from faulty_arm import FaultyArm

from ir50p_lab.bench import SerialBench, bench_test, result_files
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.bench.simulated_arm import SimulatedArm
from ir50p_lab.errors import InputError
from ir50p_lab.modelling import IR50P
from tests.emulator.virtual import VirtualBoard


class HandledArm(SimulatedArm):
    """An arm beside which a person stands: `input` tells what to do."""

    turning = None

    def asked(self, text):
        if text.startswith("Lay the arm down"):
            self.place(rest_pose(self.arm))
        found = re.search(r"turn joint (\d)", text)
        self.turning, self.since = (int(found[1]) - 1, 0.0) if found else (None, 0.0)

    def advance(self, pwm, seconds):
        """`turning` goes to its upper end, its lower end, and back; the table stops the hand, too."""
        super().advance(pwm, seconds)
        if self.turning is None:
            return
        self.since += seconds
        q, j = rest_pose(self.arm).copy(), self.turning
        low, high = np.clip((self.arm.q_min[j], self.arm.q_max[j]), -np.pi, np.pi)
        q[j] = np.interp(self.since / bench_test.TURN, [0, 0.25, 0.75, 1], [q[j], high, low, q[j]])
        try:
            self.place(q)
        except InputError:
            pass


@pytest.fixture(autouse=True)
def _home(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    monkeypatch.setattr(bench_test, "TURN", 2.0)


def board_test(monkeypatch, joint=0, fault=None):
    """Findings on the emulated board, the bench they are from, and the board."""
    arm = HandledArm(IR50P, q0=rest_pose(IR50P))
    monkeypatch.setattr(builtins, "input", arm.asked)
    board = VirtualBoard(FaultyArm(arm, joint, fault))
    bench = SerialBench(board, arm=IR50P, clock=board, record_to=False).open()
    return bench_test.bench_test(bench), bench, board


def test_a_sound_bench_passes_and_its_report_says_what_it_is(monkeypatch):
    findings, bench, board = board_test(monkeypatch)
    assert [(f.step, f.joint) for f in findings if not f.passed] == []
    assert len(findings) == 8
    assert not any(board.pins().pwm)
    first = next(f.text for f in findings if f.step == "drive")
    low, high = sorted(map(int, re.findall(r"[+-]\d+", first)))
    assert 36 <= high <= 60  # breaks away at 36 and 4 of offset, seen a little later
    assert -60 <= low <= -32
    watchdog = findings[-1]
    assert "cut the drive 1 times" in watchdog.text
    bench.give_id()
    report = json.loads(bench_test.write_report(bench, findings).read_text())
    assert (report["bench_id"], report["simulated"], report["firmware"]) == (bench.bench_id, "false", bench.firmware)
    assert report["findings"][0] == findings[0]._asdict()


@pytest.mark.parametrize(
    ("fault", "joint", "step", "said"),
    [
        ("motor", 0, "drive", "swap its two motor wires"),
        ("motor", 2, "drive", "swap its two motor wires"),
        ("bridges", 0, "drive", "their two bridges are swapped"),
        ("unpowered", 0, "drive", "does its motor lack supply"),
        ("pot", 2, "potentiometer", "swap the two ends of its potentiometer"),
        ("stuck", 0, "potentiometer", "is the potentiometer coupled"),
        ("broken", 1, "potentiometer", "broken or shorted wire"),
        ("gap", 0, "potentiometer", "gap of the track"),
        ("channels", 1, "potentiometer", "moved the number of joint 3"),
        ("noisy", 2, "noise", "joint 3 is not steady"),
    ],
)
def test_a_fault_is_named(fault, joint, step, said, monkeypatch):
    monkeypatch.setattr(bench_test, "JOINTS", (joint + 1,))
    findings, _, board = board_test(monkeypatch, joint, fault)
    assert said in next(f.text for f in findings if f.step == step and not f.passed)
    if step == "potentiometer":  # then the joint is not driven
        assert any(f.step == "drive" and f.joint == joint + 1 and "was not driven" in f.text for f in findings)
    assert not any(board.pins().pwm)


@pytest.mark.parametrize("unit", ["0", "7"])
def test_the_command_on_a_simulated_arm(unit, tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("IR50P_UNIT", unit)
    asked = []
    monkeypatch.setattr(builtins, "input", asked.append)
    assert bench_test.main(["simulated"]) == 0
    (path,) = (tmp_path / "results").glob(f"bench-test-simulated-unit-{unit}-*.json")
    report = json.loads(path.read_text())
    assert [f["step"] for f in report["findings"]] == ["noise", "drive", "drive", "drive"]  # no hand, no board
    assert report["simulated"] == "true" and len(asked) == 4
    assert str(path) in capsys.readouterr().out
    assert result_files.every() == []  # the report is none of the results that `connect` looks through
