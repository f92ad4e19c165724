"""LiveArm's Python side: what the browser gets, what it may ask, and the bundle that draws."""

import base64
import io
import json
import os
import shutil
import subprocess
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from ipywidgets.embed import dependency_state, embed_data
from PIL import Image
from until import until

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.course import live_arm
from ir50p_lab.course.live_arm import LiveArm
from ir50p_lab.course.live_arm.view import pack, still_png
from ir50p_lab.errors import InputError
from ir50p_lab.modelling import IR50P, forward_kinematics, frames
from ir50p_lab.signals import hold, quintic
from ir50p_lab.simulation import simulate

FOLDER = Path(live_arm.__file__).parent
PID_OF_TABLES = {"kp": (289, 225, 270), "ki": (50, 10, 50), "kd": (40, 30, 30), "limit_pwm": 255}


@pytest.fixture(scope="module")
def run():
    target = quintic([0, 0.8, -1.2], [0.5, 1.0, -1.4], duration=2)
    return simulate(IR50P, PID(**PID_OF_TABLES), target, duration=8, period=0.01)


@pytest.fixture
def heard(monkeypatch):
    """What views send to the browser, beside their state."""
    sent = []
    monkeypatch.setattr(LiveArm, "send", lambda self, message, buffers=None: sent.append((message, buffers)))
    return sent


def test_the_bundle_is_what_npm_builds(tmp_path):
    npm = shutil.which("npm")
    if npm is None:
        pytest.skip("npm is not installed: the bundle cannot be built here")
    shutil.copytree(FOLDER / "src", tmp_path / "src")
    for name in ("package.json", "package-lock.json"):
        shutil.copy(FOLDER / name, tmp_path)
    environment = os.environ | {"npm_config_cache": str(tmp_path / "cache")}
    for command in (["ci", "--no-audit", "--no-fund"], ["run", "build"]):
        done = subprocess.run([npm, *command], cwd=tmp_path, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "static" / "live_arm.js").read_bytes() == (FOLDER / "static" / "live_arm.js").read_bytes(), (
        "run `npm ci && npm run build` in ir50p_lab/course/live_arm"
    )
    assert b"Three.js Authors" in (FOLDER / "static" / "live_arm.js").read_bytes()


def test_rows_of_a_run_keep_its_motion_within_a_milliradian(run):
    rows, shape = pack([run], ["one"])
    table = np.frombuffer(rows, "<f4").reshape(-1, shape["columns"])
    assert len(table) <= 600 and shape["source"] == "simulated" and shape["unit"] == "PWM"
    place = shape["runs"][0]
    for name, true in (("q", run.q), ("reference", run.reference[:, 0])):
        for joint in range(3):
            seen = np.interp(run.t, table[:, 0], table[:, place[name] + joint])
            assert np.abs(seen - true[:, joint]).max() < 1e-3
    held = np.searchsorted(run.t, table[:, 0].astype(float) + 1e-6, side="right") - 1
    np.testing.assert_allclose(table[:, place["u"] :][:, :3], run.u[held], rtol=1e-6)


def test_two_runs_share_a_clock_and_what_is_unknown_is_left_out(run):
    t = np.linspace(0, 3, 50)
    bare = SimpleNamespace(t=t, q=np.column_stack([t, -t, 0 * t]), reference=np.full((50, 3), np.nan))
    rows, shape = pack([bare, run], ["bare", "full"])
    table = np.frombuffer(rows, "<f4").reshape(-1, shape["columns"])
    first, second = shape["runs"]
    assert first["reference"] is None and first["u"] is None and second["u"] is not None
    assert table[-1, 0] == pytest.approx(run.t[-1]) and table[-1, first["q"]] == pytest.approx(3)


@pytest.mark.parametrize(("runs", "samples", "labels"), [(3, 5, 3), (1, 1, 1), (2, 5, 1)])
def test_one_or_two_runs_that_have_a_motion(runs, samples, labels):
    run = SimpleNamespace(t=np.arange(samples), q=np.zeros((samples, 3)))
    with pytest.raises(InputError, match="one or two runs of two samples"):
        pack([run] * runs, [""] * labels)


def test_the_students_function_moves_the_arm_and_its_errors_are_shown(heard):
    asked = []

    def mine(p, q_now):
        asked.append((p, q_now))
        return {0: [0.1, 0.2, 0.3], 1: None}[len(asked) - 1]

    view = LiveArm(IR50P, [0, 0.5, -1], on_drag=mine)
    assert view.options["badge"] == "yours" and LiveArm(IR50P).options["badge"] == "the course's"
    for _ in range(3):
        view._handle_custom_msg({"drag": [0.4, 0.1, 0.2], "q": [0, 0.5, -1]}, [])
    np.testing.assert_array_equal(asked[0][0], [0.4, 0.1, 0.2])
    answers = [message for message, _ in heard]
    assert [answer["drag"] for answer in answers] == [[0.1, 0.2, 0.3], None, None]
    assert view.q == [0.1, 0.2, 0.3] and "KeyError: 2" in answers[2]["error"]


def test_any_frames_draw_the_arm_wrong_ones_too(heard, monkeypatch):
    def wrong(q):
        T = frames(IR50P, q).copy()
        T[2, :3, 3] += 0.3
        T[3, 0, 0] = np.nan
        return T

    view = LiveArm(IR50P, [0, 0.5, -1], frames=wrong)
    view._handle_custom_msg({"frames": [0.4, 0.5, -1]}, [])
    assert ({"frames": None}, []) in heard
    np.testing.assert_allclose(view.poses[1], frames(IR50P, [0.4, 0.5, -1])[1])
    assert view.poses[3][0][0] is None  # what JSON has for NaN
    monkeypatch.setattr(view, "_frames", lambda q: np.eye(4))
    view._handle_custom_msg({"frames": [0.4, 0.5, -1]}, [])
    assert "(4, 4, 4)" in heard[-1][0]["error"]


def test_a_saved_notebook_of_twenty_views_has_less_than_a_megabyte(run):
    views = [LiveArm(IR50P, [0.1 * k, 0.5, -1]).play(run) for k in range(20)]
    assert len(json.dumps(embed_data(views, state=dependency_state(views))["manager_state"])) < 1e6


def still(view):
    data, _ = view._repr_mimebundle_()
    assert "application/vnd.jupyter.widget-view+json" in data
    return np.asarray(Image.open(io.BytesIO(base64.b64decode(data["image/png"]))).convert("RGB")).astype(int)


def test_the_still_picture_shows_pose_frames_and_ellipsoids():
    view = LiveArm(IR50P, [0, 0.5, -1])
    first = still(view)
    view.q = [1, 0.5, -1]
    assert (first != still(view)).any(axis=-1).mean() > 0.01
    own = still(LiveArm(IR50P, [0, 0.5, -1], frames=lambda q: frames(IR50P, -q)))
    mirrored = still(LiveArm(IR50P, [0, -0.5, 1], badge="yours"))
    assert differ(own, mirrored) < 0.003 < 0.01 < differ(own, first)
    layers = ["frames", "velocity ellipsoid", "force ellipsoid"]
    assert all((first != still(LiveArm(IR50P, [0, 0.5, -1], layers=[one]))).any() for one in layers)
    still(LiveArm(IR50P, [0, 0.5, 0], layers=layers))  # stretched out, the forces have no end


def differ(one, other):
    """Share of the pixels that differ by more than the smoothing of edges."""
    return (np.abs(one - other) > 60).any(axis=-1).mean()


@pytest.mark.timing
def test_a_loop_in_the_background_feeds_the_view_and_can_be_played_afterwards(heard, tmp_path, request):
    with SimulatedBench(IR50P, q0=[0, 0.8, -1.2], realtime=True, record_to=tmp_path) as bench:
        live = bench.start(PID(**PID_OF_TABLES), hold([0.4, 0.8, -1.2]))
        view = LiveArm(IR50P).play(live)
        live.join(2)
        live.cut()
    until(lambda: view.track)
    frames_sent = [buffers[0] for message, buffers in heard if "live" in message]
    measured = request.config.getoption("benchmark_enable")  # else a guard only: machines of CI are shared
    assert len(frames_sent) > (20 if measured else 5)  # a second at least, at 25 a second
    last = np.frombuffer(frames_sent[-1], "<f4").reshape(-1, view.shape["columns"])
    np.testing.assert_allclose(
        np.frombuffer(view.track, "<f4").reshape(-1, last.shape[1])[-1, 1:4], last[-1, 1:4], atol=0.1
    )
    assert view.shape["source"] == "simulated"


@pytest.mark.timing
def test_after_the_whole_of_a_run_no_window_follows(heard, run):
    """The run ends while a window of it is put together; a window after the whole would stay for good."""

    class EndsMeanwhile:
        alive, recording, calls = True, run, 0

        def recent(self, seconds):
            self.alive, self.calls = False, self.calls + 1
            rows = slice(0, 100 if self.calls == 1 else 200)  # the last samples come after the first window
            return SimpleNamespace(t=run.t[rows], q=run.q[rows])

    bench = SimpleNamespace(is_open=True, live_run=EndsMeanwhile())
    view = LiveArm(IR50P)
    view.observe(lambda _: heard.append(({"whole": None}, None)), "track")
    view.play(bench)
    until(lambda: view.track and bench.live_run.calls > 4)
    bench.is_open = False
    assert "whole" in heard[-1][0]


@pytest.mark.timing
def test_the_browser_is_told_how_hard_it_may_push_and_a_push_reaches_the_arm(heard):
    with SimulatedBench(IR50P, q0=[0, 0.8, -1.2], realtime=True, record_to=False) as bench:
        view = LiveArm(IR50P).play(bench)
        live = bench.start(PID(**PID_OF_TABLES))
        until(lambda: "live" in heard[-1][0] if heard else False)
        assert heard[-1][0]["live"]["push"] == 10
        view._handle_custom_msg({"push": [2, [0.0, 0.0, 0.0], [0.0, 4.0, 0.0]]}, [])
        until(lambda: bench.recording.events)
        view._handle_custom_msg({"push": [4, [0.0, 0.0, 0.0], [0.0, 4.0, 0.0]]}, [])
        live.cut()
    assert "at link 2 with 4.0 N" in bench.recording.events[0][1]
    assert any("link = 4" in message.get("error", "") for message, _ in heard)


@pytest.mark.timing
def test_the_loop_of_nine_lines_feeds_the_view(heard, tmp_path):
    pid, target = PID(**PID_OF_TABLES), hold([0.4, 0.8, -1.2])
    with SimulatedBench(IR50P, q0=[0, 0.8, -1.2], realtime=True, record_to=tmp_path) as bench:
        view = LiveArm(IR50P).play(bench)
        for sample in bench.run(seconds=1):
            bench.drive(pid.step(sample.t, sample.q, target(sample.t)))
        run = bench.recording
        tail = run.recent(0.3)
        np.testing.assert_array_equal(tail.q, run.q[-len(tail) :])
        assert len(tail) == 31  # cycles; on a busy machine they last longer
    until(lambda: view.track)
    path = forward_kinematics(IR50P, run.q[-1])
    first = view.shape["runs"][0]["q"]
    shown = np.frombuffer(view.track, "<f4").reshape(-1, view.shape["columns"])[-1, first : first + 3]
    np.testing.assert_allclose(forward_kinematics(IR50P, shown), path, atol=1e-5)
    assert sum("live" in message for message, _ in heard) >= 10


@pytest.mark.parametrize("wrong", [None, np.zeros((3, 4, 4)), np.zeros((4, 16)), [[1, 2], [3]]])
def test_frames_of_another_shape_are_said_and_the_course_draws(wrong, capsys):
    view = LiveArm(IR50P, frames=lambda q: wrong)
    said = capsys.readouterr().out
    assert "of frames 0 to 3: " in said and "the arm below is the course's" in said
    assert view.poses == [] and view.options["badge"] == "the course's"
    still_png(view)


def test_a_function_that_stops_is_said_in_a_sentence(capsys):
    def stops(q):
        return q["no"]

    LiveArm(IR50P, frames=stops)
    assert "the arm below is the course's" in capsys.readouterr().out


def test_a_function_that_stops_later_is_said_in_the_same_sentence(heard):
    def stops(*_):
        raise ValueError("too late")

    view = LiveArm(IR50P, frames=lambda q: frames(IR50P, q), on_drag=stops)
    view._frames = stops
    for message in ({"frames": [0, 0, 0]}, {"drag": [0.4, 0, 0.1], "q": [0, 0, 0]}):
        view._heard(None, message, [])
        assert heard[-1][0]["error"] == "it stops. Python says ValueError: too late"
