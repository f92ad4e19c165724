"""The first power-on finds what is wrong and says which wire it is: on the emulated board, behind it a faulty arm."""

import json

import pytest
from faulty_arm import FaultyArm

from ir50p_lab.bench import SerialBench, SimulatedBench, result_files
from ir50p_lab.bench.bench_test import Person, bench_test, main, write_report
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.bench.simulated_arm import SimulatedArm
from ir50p_lab.modelling import IR50P
from tests.emulator.virtual import VirtualBoard


@pytest.fixture(autouse=True)
def _home(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))


def board_test(joint=0, fault=None, joints=(1, 2, 3)):
    """Findings on the emulated board, the bench they are from, and the board."""
    arm = SimulatedArm(IR50P, q0=rest_pose(IR50P))
    board = VirtualBoard(FaultyArm(arm, joint, fault))
    bench = SerialBench(board, arm=IR50P, clock=board, record_to=False).open()
    findings = bench_test(bench, Person(arm), joints=joints, say=lambda text: None)
    return findings, bench, board


def test_a_sound_bench_passes_and_its_report_says_what_it_is():
    findings, bench, board = board_test()
    assert [(f.step, f.joint) for f in findings if not f.passed] == []
    assert len(findings) == 8
    assert not any(board.pins().pwm)
    friction = [f.values for f in findings if f.step == "drive"]
    assert 36 <= friction[0]["breakaway_up_pwm"] <= 60  # breaks away at 36 and 4 of offset, seen a little later
    assert -60 <= friction[0]["breakaway_down_pwm"] <= -32
    watchdog = findings[-1]
    assert "cut the drive 1 times" in watchdog.text
    bench.give_id()
    report = json.loads(write_report(bench, findings).read_text())
    assert (report["bench_id"], report["simulated"], report["passed"]) == (bench.bench_id, False, True)
    assert report["firmware"] == bench.firmware
    assert report["findings"][0]["values"]["noise_counts"] == findings[0].values["noise_counts"]


@pytest.mark.parametrize(
    ("fault", "joint", "step", "said"),
    [
        ("motor", 0, "drive", "swap its two motor wires"),
        ("motor", 1, "drive", "swap its two motor wires"),
        ("motor", 2, "drive", "swap its two motor wires"),
        ("bridges", 0, "drive", "their two bridges are swapped"),
        ("unpowered", 0, "drive", "has its motor no supply"),
        ("pot", 2, "potentiometer", "swap the two ends of its potentiometer"),
        ("stuck", 0, "potentiometer", "is the potentiometer coupled"),
        ("broken", 1, "potentiometer", "broken or shorted wire"),
        ("gap", 0, "potentiometer", "gap of the track"),
        ("channels", 1, "potentiometer", "moved the number of joint 3"),
        ("noisy", 2, "noise", "joint 3 is not steady"),
    ],
)
def test_a_fault_is_named(fault, joint, step, said):
    findings, _, board = board_test(joint, fault, joints=(joint + 1,))
    assert said in next(f.text for f in findings if f.step == step and not f.passed)
    if step == "potentiometer":  # then the joint is not driven
        assert any(f.step == "drive" and f.joint == joint + 1 and "was not driven" in f.text for f in findings)
    assert not any(board.pins().pwm)


def test_the_command_on_the_simulated_arm(tmp_path, capsys):
    assert main(["simulated"]) == 0
    (path,) = (tmp_path / "results").glob("bench-test-simulated-unit-0-*.json")
    report = json.loads(path.read_text())
    assert report["simulated"]
    assert report["passed"]
    assert str(path) in capsys.readouterr().out
    assert result_files.every() == []  # the report is none of the results that `connect` looks through


def test_a_simulated_arm_of_another_unit_is_tested_too():
    bench = SimulatedBench(seed=7, record_to=False).open()
    assert all(finding.passed for finding in bench_test(bench, Person(bench.plant), say=lambda text: None))
