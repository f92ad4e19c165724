"""The lab's own file: what it allows binds the host and the loop in the background; what is wrong in it is said."""

import numpy as np
import pytest
from fake_board import FakeBoard

from ir50p_lab.bench import SerialBench, SimulatedBench, caps, nominal_calibration
from ir50p_lab.errors import BenchError, InputError
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import hold, quintic

HERE = np.array([0.0, 0.8, -1.2])  # tip at x = 0.484, y = 0, z = 0.284 m
TABLE = "[board-00000a]\nlimit_pwm = [120, 200, 90]\nspeed = 0.5\nworkspace = [[0.2, -0.3, 0.1], [0.6, 0.3, 0.5]]\n"


@pytest.fixture
def bench_with(tmp_path, monkeypatch):
    """An open bench of board 00000a, whose lab has a file with this text."""

    def make(text):
        board = FakeBoard(nominal_calibration(IR50P), HERE)
        board.board_id = 10
        (tmp_path / "bench.toml").write_text(text, encoding="utf-8")
        monkeypatch.setenv("IR50P_BENCH_FILE", str(tmp_path / "bench.toml"))
        return SerialBench(board, arm=IR50P, clock=board, record_to=False).open()

    return make


def refused(bench, pwm=(0, 0, 0), reference=None, seconds=1.0):
    """What is said when it is driven so; the board has got no drive since."""
    with pytest.raises(InputError) as caught:
        for _ in bench.run(seconds, reference):
            bench.drive(pwm)
    assert not bench._given.pwm.any()
    assert "[board-00000a] of " in str(caught.value) and "bench.toml" in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("pwm", [(121, 0, 0), (0, -201, 0), (0, 0, 1000)])
def test_a_command_beyond_the_cap_is_refused_not_clipped(bench_with, pwm):
    bench = bench_with(TABLE)
    for _ in bench.run(0.02):
        assert bench.drive((120, 0, 90)).tolist() == [120, 0, 90]
    assert f"{np.clip(pwm, -255.0, 255.0).tolist()}; [board-00000a] of" in (said := refused(bench, pwm))
    assert "allows limit_pwm = [120.0, 200.0, 90.0]" in said and "the drive has been cut" in said
    assert not any(max(map(abs, command.pwm)) > 120 for _, command in bench._given.commands)


def test_a_reference_beyond_the_caps_is_refused(bench_with):
    bench = bench_with(TABLE)
    assert "the tip of the reference" in refused(bench, reference=hold([0.9, 0.8, -1.2]))
    assert "the speed of the reference" in refused(bench, reference=quintic(HERE, HERE / 2, duration=1.0))
    assert len(list(bench.run(0.1, hold(HERE)))) == 10


@pytest.mark.parametrize(("key", "said"), [("speed = 0.3", "the measured speed"), ("workspace", "the tip, m,")])
def test_a_motion_beyond_the_caps_is_cut(bench_with, key, said):
    """The board in Python turns at 0.004 rad/s a count, as told; by hand it may be moved anywhere."""
    bench = bench_with("[board-00000a]\n" + (key if "speed" in key else TABLE.splitlines()[3]))
    assert said in refused(bench, (150, 0, 0), seconds=5.0)
    bench._given.q = np.add(bench._given.q, [0.9, 0, 0])
    assert len(list(bench.run(0.1))) == 10


def test_the_way_to_rest_keeps_pwm_and_speed_and_may_leave_the_workspace(bench_with):
    bench = bench_with("[board-00000a]\nlimit_pwm = 100\nspeed = 0.3\nworkspace = [[0.45, -1, 0.2], [0.6, 1, 0.3]]\n")
    for _ in bench.run(0.05):
        bench.drive((0, 0, 0))
    bench.close()
    assert np.abs(bench._given.q - HERE).max() > 0.3 and not bench._given.pwm.any()
    assert max(max(map(abs, command.pwm)) for _, command in bench._given.commands) <= 100


@pytest.mark.timing
def test_the_loop_in_the_background_is_bound_too(bench_with):
    bench = bench_with(TABLE)
    run = bench.start(type("Strong", (), {"step": lambda self, *_: np.full(3, 250.0)})())
    with pytest.raises(InputError, match=r"the command is .*allows limit_pwm"):
        run.join(20)
    assert not bench._given.pwm.any()
    with pytest.raises(InputError, match=r"the tip of the set point.*\[board-00000a\] of"):
        run.set_point([0.9, 0.8, -1.2])


WRONG = {
    "limit_pwm": ("0", "-5", "256", "nan", "'120'", "[1, 2]", "true"),
    "speed": ("0", "-0.5", "inf", "[1, 2]", "1979-05-27"),
    "workspace": ("3", "[]", "[[0, 0, 0], [1, 1, -1]]", "[[0, 0, nan], [1, 1, 1]]"),
    "faults": ("3", "['fire']", "'cable'"),
    "pwm": ("100",),
}
TEXTS = [f"[board-00000a]\n{key} = {value}" for key, values in WRONG.items() for value in values]


@pytest.mark.parametrize("text", [*TEXTS, "[board-00000a", "limit_pwm = 100", "[bord-00000a]\nlimit_pwm = 100"])
def test_a_wrong_file_is_refused_with_its_name(bench_with, tmp_path, text):
    with pytest.raises(InputError, match="with_the_arm") as caught:
        bench_with(text)
    assert str(tmp_path / "bench.toml") in str(caught.value)


def test_faults_are_made_where_the_own_table_allows_them(bench_with):
    bench_with('[board-00000a]\nfaults = ["cable"]').caps.check_fault("cable")
    for text in ('[board-00000a]\nfaults = ["cable"]', "[board-00000b]\nfaults = ['motor']\nwhatever = 3", ""):
        with pytest.raises(BenchError, match=r"'motor'.*bench\.toml.*simulated arm"):
            bench_with(text).caps.check_fault("motor")
    SimulatedBench(IR50P, record_to=False).caps.check_fault("motor")


def test_the_file_lies_in_the_project_never_with_the_student(bench_with, monkeypatch, tmp_path):
    bench_with(TABLE)
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    monkeypatch.delenv("IR50P_BENCH_FILE")
    monkeypatch.setattr(caps, "PROJECT", tmp_path / "project")
    assert caps.caps_of("board-00000a").source == ""
    (tmp_path / "project").mkdir()
    (tmp_path / "project" / "bench.toml").write_text(TABLE)
    assert caps.caps_of("board-00000a").limit_pwm == (120, 200, 90)
    monkeypatch.setenv("IR50P_BENCH_FILE", "nowhere.toml")
    with pytest.raises(InputError, match=r"nowhere\.toml.*No such file"):
        caps.caps_of("board-00000a")
