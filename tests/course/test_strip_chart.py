"""The strip chart: what reaches the browser, and how often."""

from types import SimpleNamespace

import numpy as np
import pytest

from ir50p_lab.course import strip_chart
from ir50p_lab.course.strip_chart import StripChart


def chart(**options):
    return StripChart(("a", "b"), duration=10, ylim=(-1, 1), ylabel="x [m]", title="test", **options)


def frame(one):
    return np.frombuffer(one.samples, dtype="<f4").reshape(-1, 3)


def test_what_was_added_is_shown_in_the_end():
    one = chart(levels=(0.1, 0.2))
    for k in range(50):
        one.add(0.01 * k, (k, -k))
    one.flush()
    np.testing.assert_allclose(frame(one)[:, 0], one.t, atol=1e-6)
    np.testing.assert_array_equal(frame(one)[:, 1:], one.values)
    lines = one.settings["panels"][0]["lines"]
    assert [line["level"] for line in lines] == [0.1, 0.2] and "a, b" in one.settings["description"]
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
        one._rows.append((0.01 * k, k, k))
    one.flush()
    assert len(frame(one)) <= 602 and frame(one)[-1, 1] == 4999
    one.close()


def test_nothing_yet():
    one = chart()
    one.flush()
    assert one.samples == b"" and one.values.shape == (0, 2)
    one.close()


@pytest.mark.parametrize("k", [1, 6])
def test_a_colour_for_each_curve(k):
    one = StripChart([str(i) for i in range(k)], duration=1, ylim=(0, 1), ylabel="x [m]", title="t")
    assert len({line["colour"] for line in one.settings["panels"][0]["lines"]}) == k
    one.close()
