"""Figures of notebook 10: they draw what was recorded, and say where it is from."""

import numpy as np
import pytest

from ir50p_lab.bench import Recording, SimulatedBench, fit_calibration
from ir50p_lab.controllers import PID
from ir50p_lab.course.at_the_bench import views
from ir50p_lab.course.draw.painter import Painter
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import cartesian_circle, low_pass, path_error, through

TABLES = {"kp": (289, 225, 270), "ki": (50, 10, 50), "kd": (40, 30, 30), "limit_pwm": 255}


def texts(figure):
    return " ".join([*(t.get_text() for t in figure.texts), *(ax.get_title() for ax in figure.axes)])


@pytest.fixture(scope="module")
def motion():
    bench = SimulatedBench(IR50P, record_to=False).open()
    return bench.follow(PID(**TABLES), through([(0, 0, 0), (0, 0, 0), (0.8, 0, 0), (0, 0, 0)], durations=2), 7)


@pytest.fixture(scope="module")
def sinking():
    bench = SimulatedBench(IR50P, record_to=False).open()
    for _ in bench.run(1):
        pass
    return bench.recording


def test_origin():
    t, q = [0, 1], np.zeros((2, 3))
    assert views.origin(Recording.from_arrays(t, q)) == "origin unknown"
    assert views.origin(Recording.from_arrays(t, q, header={"simulated": "true"})) == "simulated arm"
    assert views.origin(Recording.from_arrays(t, q, header={"simulated": "false"})) == "the real arm"


def test_let_go_shows_the_fall_and_its_origin(sinking):
    figure = views.let_go_figure(IR50P, sinking)
    assert "the tip falls" in texts(figure) and "simulated arm" in texts(figure)
    curves = [line.get_ydata() for line in figure.axes[1].lines]
    assert all(np.array_equal(curve, sinking.q[:, joint]) for joint, curve in enumerate(curves))
    still = Recording.from_arrays(sinking.t, np.zeros((len(sinking), 3)), header=sinking.header)
    assert "It stays" in texts(views.let_go_figure(IR50P, still))


def test_calibration_by_hand_finds_the_unit_again():
    angles, counts, true_slope = views.calibrate_by_hand(IR50P, points=31)
    fit = fit_calibration(angles, counts, arm=IR50P)
    assert np.all(np.abs(fit.slope - true_slope) < 4 * np.array(fit.stderr_slope))
    assert angles.shape == counts.shape == (31, 3)
    figure = views.residual_figure(fit)
    assert len(figure.axes) == 3
    for joint, ax in enumerate(figure.axes):
        np.testing.assert_allclose(ax.lines[-1].get_ydata(), fit.residuals[joint] * fit.slope[joint])


def test_filter_view_moves_line_and_ring(motion):
    view = views.FilterView(motion, rest=(0.2, 2), moving=(2, 6.5))
    assert [one.noise for one in view.curve] == sorted(one.noise for one in view.curve)
    assert len(view.kalman) == 3 and len(view.figure.axes) == 2
    painter = Painter(view.figure)
    said, pictures = [], set()
    for cutoff in (1.0, 3.0, 20.0):
        said.append(view.update(low_pass(motion.q[:, 0], cutoff, 100), cutoff))
        pictures.add(painter.png())
    assert len(set(said)) == len(pictures) == 3
    assert said[1].startswith("angle: 53 ms late")  # 1/(2 pi 3 Hz)


def test_path_figure_tells_both_errors():
    path = cartesian_circle(IR50P, (0.45, 0, 0.38), 0.05, normal=(1, 0, 0))
    t = np.linspace(0, path.duration, 200)
    exact = path_error(IR50P, path.sample(t)[:, 0], path, t=t)
    off = path_error(IR50P, path.sample(t)[:, 0] + 0.05, path, t=t)
    figure = views.path_figure(IR50P, path, exact, off)
    assert "done, 0 mm rms" in texts(figure) and f"{off.rms_mm:.0f} mm rms" in texts(figure)
    curves = [line.get_ydata() for line in figure.axes[1].lines]
    assert np.array_equal(curves[1], exact.tip[:, 0]) and np.array_equal(curves[6], off.tip[:, 2])
