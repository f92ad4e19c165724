"""The strip chart: what reaches the browser, and how often."""

from types import SimpleNamespace

import charts
import numpy as np
import pytest

from ir50p_lab.course.draw import strip_chart
from ir50p_lab.course.draw.strip_chart import StripChart


def chart(**options):
    return StripChart(("a", "b"), duration=10, ylim=(-1, 1), ylabel="x [m]", title="test", **options)


def panel(one):
    (found,) = charts.panels(one.value)
    return found


def test_what_was_added_is_shown_in_the_end():
    one = chart(levels=(0.1, 0.2))
    for k in range(50):
        one.add(0.1 * k, (k / 50, -k / 50))
    one.flush()
    for curve, values in zip(panel(one).curves, one.values.T, strict=True):
        np.testing.assert_allclose(curve.t[:-1], 0.1 * np.arange(50), atol=0.01)  # the last comes twice
        np.testing.assert_allclose(curve.values[:-1], values, atol=0.002)
    np.testing.assert_array_equal(one.values[:, 0], np.arange(50) / 50)
    np.testing.assert_allclose(panel(one).levels, [0.1, 0.2], atol=0.002)
    assert "test: a, b over 10 s" in one.value and "x [m]" in one.value and "a: 0.98" in panel(one).words
    one.close()


def test_at_most_twenty_pictures_a_second(monkeypatch):
    now = [0.0]
    monkeypatch.setattr(strip_chart, "time", SimpleNamespace(monotonic=lambda: now[0]))
    one = chart()
    for k in range(1000):
        now[0] = 0.01 * k
        one.add(now[0], (0, 0))
    assert 160 <= one.frames <= 200
    one.close()


def test_a_long_run_keeps_its_last_point_and_a_bounded_frame():
    one = chart()
    for k in range(5000):
        one._rows.append((0.01 * k, k / 5000, 0))
    one.flush()
    curve = panel(one).curves[0]
    assert len(curve.t) <= 602 and curve.values[-1] == pytest.approx(0.9998, abs=0.002)
    assert curve.t[-1] == pytest.approx(49.99, abs=0.01)
    one.close()


def test_names_stand_before_the_first_number_and_late_times_differ():
    one = StripChart(("height",), duration=4, ylim=(-1, 1), ylabel="x [m]", title="t")
    assert ">height<" in one.value
    one.add(123_456.0, [0.5])
    assert ">height: 0.5<" in one.value
    assert all(f">{t}<" in one.value for t in range(123_452, 123_457))
