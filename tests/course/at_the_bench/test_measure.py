"""Notebook 10: what check says of wrong lines and filters, which right ones it takes, and what a hand reads."""

import re

import numpy as np
import pytest
from cells import cell
from scipy.signal import lfilter
from told import told

from ir50p_lab.bench import SimulatedBench, fit_calibration
from ir50p_lab.course import my_robot
from ir50p_lab.course.at_the_bench import measure_views as views
from ir50p_lab.course.checking.grade import grade
from ir50p_lab.course.robot.catalogue import task
from ir50p_lab.modelling import IR50P

END = "return slope, offset, covariance"
VARIANCE = "variance = np.sum(rest**2) / (len(x) - 2)"
SPREAD = "covariance = variance * np.linalg.solve(N, np.eye(2))"
SHARE = "share = 1 - np.exp(-2 * np.pi * cutoff_hz / rate_hz)"
STEP = "y[k] = y[k - 1] + share * (x[k] - y[k - 1])"
LAST = 'if cutoff_hz > rate_hz / 2: raise ValueError("no")\n    return y'
BACK = "z = np.zeros(len(x)); z[-1] = y[-1]\n    for k in range(len(x) - 2, -1, -1): z[k] = z[k + 1] + share * (y[k] - z[k + 1])\n    return z"
MINE = "slope, offset = np.linalg.solve(N, A.T @ y)"


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    my_robot._said.clear()


WRONG = [
    ("fit_line", MINE, "offset, slope = np.linalg.solve(N, A.T @ y)", "changed places"),
    ("fit_line", END, "return slope, offset", "3 results are asked for"),
    ("fit_line", END, "return slope, offset, np.sqrt(np.diag(covariance))", "a matrix is asked for"),
    ("fit_line", END, "return slope, offset, np.diag(np.diag(covariance))", "know nothing of each other"),
    ("fit_line", END, "return slope, offset, np.abs(covariance)", "rise together"),
    ("fit_line", END, "return slope, offset, np.cov(x, y)", "not how sure the line is"),
    ("fit_line", END, "return slope, offset, variance / N", "vary the wrong way together"),
    ("fit_line", VARIANCE, "variance = np.sum(rest**2) / 8", "its size is not"),
    ("fit_line", END, "return slope, offset - 1, covariance", "offset: .*off by the same"),
    ("fit_line", VARIANCE, "variance = np.sum(rest**2) / (len(x) - 1)", "divide by n - 1"),
    ("fit_line", VARIANCE, "variance = np.mean(rest**2)", "divide by n\\.$"),
    ("fit_line", VARIANCE, "variance = np.std(rest, ddof=2)", "halves, and should be a quarter"),
    ("fit_line", VARIANCE, "variance = np.sum((y - np.mean(y))**2) / (len(x) - 2)", "exactly on a line"),
    ("fit_line", SPREAD, "covariance = variance * N", "more points would make you less sure"),
    ("fit_line", SPREAD, "covariance = np.linalg.solve(N, np.eye(2))", "scatter of the points is missing"),
    ("fit_line", MINE, "slope, offset = (x @ y) / (x @ x), 0.0", "through the origin"),
    ("low_pass", "y[0] = x[0]", "", "begins at 0"),
    ("low_pass", SHARE, "share = 1 - np.exp(-cutoff_hz / rate_hz)", "2 pi is missing"),
    ("low_pass", SHARE, "share = np.exp(-2 * np.pi * cutoff_hz / rate_hz)", "the share is the rest of it"),
    ("low_pass", SHARE, "share = 1 - np.exp(-2 * np.pi * cutoff_hz * 0.01)", "100 samples a second are built in"),
    ("low_pass", SHARE, "share = 1 - np.exp(-2 * np.pi * cutoff_hz * rate_hz)", "changes nothing"),
    ("low_pass", SHARE, "share = cutoff_hz / (cutoff_hz + rate_hz)", "closes 0.0291 of the gap to x, where 0.172"),
    ("low_pass", STEP, "y[k] = y[k - 1] + share * (x[k - 1] - y[k - 1])", "one sample late"),
    ("low_pass", STEP, "y[k] = y[k - 1] + share * x[k]", "grows without an end"),
    ("low_pass", STEP, "y[k] = np.mean(x[max(0, k - 4) : k + 1])", "forgets a jump completely"),
    ("low_pass", "y = np.zeros(len(x))", "y = np.zeros_like(x)", "whole numbers"),
    ("low_pass", "y = np.zeros(len(x))", "y = x", "changes what it was given"),
    ("low_pass", "return y", LAST, "it stops in `if cutoff_hz"),
    ("low_pass", "return y", BACK, "runs back and forth"),
    ("low_pass", "return y", "return x - y", "takes the motion"),
]


@pytest.mark.parametrize(("name", "old", "new", "words"), WRONG, ids=range(len(WRONG)))
def test_a_wrong_answer_is_told_by_its_symptom(capsys, name, old, new, words):
    says = told(capsys, name, old, new)
    assert "not yet" in says and re.search(words, says), says


@pytest.mark.parametrize("name", ["fit_line", "low_pass"])
def test_right_answers_are_taken(capsys, name):
    assert "right, and yours" in told(capsys, name)
    for route in task(name).routes:
        assert grade(task(name), cell(route, name)).state == "right"


def test_a_filter_of_any_library_is_taken():
    def low_pass(x, cutoff_hz, rate_hz):
        stays = np.exp(-2 * np.pi * cutoff_hz / rate_hz)
        return lfilter([1 - stays], [1, -stays], x, zi=[stays * x[0]])[0]

    assert grade(task("low_pass"), low_pass).state == "right"


def test_lines_of_a_hand_are_those_of_the_course():
    """The judge of the package finds the same slopes, zeros and errors."""
    low, high = np.array([IR50P.q_min, IR50P.q_max])
    angles, counts = views.moved_by_hand(IR50P, np.linspace(0.95 * low, 0.95 * high, 12))
    np.testing.assert_allclose(2 * np.degrees(angles), np.rint(2 * np.degrees(angles)), atol=1e-9)
    assert not np.array_equal(counts, views.moved_by_hand(IR50P, np.linspace(0.95 * low, 0.95 * high, 12))[1])  # again
    judged = fit_calibration(angles, counts)
    for joint in range(3):
        slope, offset, covariance = my_robot.fit_line(counts[:, joint], angles[:, joint])
        np.testing.assert_allclose([1 / slope, -offset / slope], [judged.slope[joint], judged.zero[joint]], rtol=1e-6)
        assert np.sqrt(covariance[0, 0]) / slope**2 == pytest.approx(judged.stderr_slope[joint], rel=1e-6)


def test_pictures_name_their_axes_and_a_hand_reads_counts(capsys, monkeypatch):
    angles, counts = views.moved_by_hand(IR50P, np.linspace([-1, 0, -1], [1, 1, 0], 8))
    fit = my_robot.fit_line(counts[:, 1], angles[:, 1])
    for figure in (views.error_bands(counts[:, 1], fit, 500.0), views.residuals(angles, 1000 * angles)):
        assert all(ax.get_xlabel() for ax in figure.axes) and "[mrad]" in figure.axes[0].get_ylabel()
    monkeypatch.setenv("IR50P_BENCH", "simulated")
    read = views.counts_by_hand()
    at_rest = SimulatedBench(IR50P, record_to=False).calibration.counts(np.zeros(3))
    assert read.shape == (3,) and np.abs(read - at_rest)[[0, 2]].max() < 60
