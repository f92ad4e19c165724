"""What the scope sends to the browser."""

from itertools import pairwise

import numpy as np

from ir50p_lab.course.scope import Scope


def frame(scope):
    return np.frombuffer(scope.samples, dtype="<f4").reshape(-1, 10)


def motion(n, start=0):
    t = (start + np.arange(n)) * 0.01
    q = np.column_stack([t, 2 * t, -t])
    return t, q, q + 0.1, 100 * q


def test_a_frame_holds_time_angle_set_point_and_pwm_as_float32():
    scope = Scope(window=5, badge="simulated")
    t, q, r, u = motion(200)
    scope.show(t, q, r, u)
    rows = frame(scope)
    np.testing.assert_allclose(rows[:, 0], t, rtol=1e-6)
    np.testing.assert_allclose(rows[:, 1:4], np.degrees(q), rtol=1e-6)
    np.testing.assert_allclose(rows[:, 4:7], np.degrees(r), rtol=1e-6)
    np.testing.assert_allclose(rows[:, 7:], u, rtol=1e-6)
    assert scope.frames == 1
    panels = scope.settings["panels"]
    assert scope.settings["window"] == 5.0 and "simulated" in panels[0]["title"]
    assert "simulated" in scope.settings["description"] and len({panel["colour"] for panel in panels}) == 3


def test_long_windows_are_thinned_always_to_the_same_samples():
    scope = Scope()
    kept = []
    for start in range(5):
        scope.show(*motion(1001, start))
        kept.append(frame(scope)[:, 0])
        assert 300 < len(kept[-1]) <= 502
    for one, next_one in pairwise(kept):
        assert len(np.setdiff1d(next_one, one)) <= 1  # moves on, no flicker between odd and even samples


def test_nothing_to_show_is_no_error():
    scope = Scope()
    scope.show(np.empty(0), np.empty((0, 3)), np.empty((0, 3)), np.empty((0, 3)))
    assert scope.samples == b""


def test_cuts_of_the_drive_are_marked():
    scope = Scope()
    scope.show(*motion(200), marks=np.array([0.5, 1.25]))
    assert scope.marks == [0.5, 1.25]
