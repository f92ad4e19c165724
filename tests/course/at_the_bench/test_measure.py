"""Notebook 10: what check says of wrong lines and filters, which right ones it takes, and what a hand reads."""

import numpy as np
import pytest
from scipy.signal import lfilter

from ir50p_lab.bench import SimulatedBench, fit_calibration
from ir50p_lab.course import my_robot
from ir50p_lab.course.at_the_bench import measure_views as views
from ir50p_lab.course.checking.grade import grade
from ir50p_lab.course.checking.tasks import task
from ir50p_lab.modelling import IR50P


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
