"""What the scope sends to the browser."""

from itertools import pairwise

import charts
import numpy as np

from ir50p_lab.course.draw.scope import Scope


def motion(n, start=0):
    t = (start + np.arange(n)) * 0.01
    q = np.column_stack([t, 2 * t, -t])
    return t, q, q + 0.1, 100 * q


def test_a_picture_has_time_angle_set_point_and_pwm():
    scope = Scope(window=5, badge="simulated")
    t, q, r, u = motion(200)
    scope.show(t, q, r, u)
    assert scope.frames == 2  # the first has no curves
    panels = charts.panels(scope.value)
    assert len(panels) == 6
    for i in range(3):
        angle, wanted = panels[2 * i].curves
        (command,) = panels[2 * i + 1].curves
        for curve, values, within in ((angle, np.degrees(q), 0.2), (wanted, np.degrees(r), 0.2), (command, u, 0.5)):
            np.testing.assert_allclose(curve.t, t, atol=0.002)
            np.testing.assert_allclose(curve.values, values[:, i], atol=within)
        assert wanted.dashed and not angle.dashed and not command.dashed
    assert "joint 1, simulated" in panels[0].words and f"deg: {np.degrees(q[-1, 0]):.4g}" in panels[0].words
    assert "last 5 s simulated" in scope.value and len({panel.curves[0].colour for panel in panels}) == 3


def test_long_windows_are_thinned_always_to_the_same_samples():
    scope = Scope()
    kept = []
    for start in range(5):
        scope.show(*motion(1001, start))
        kept.append(np.round(charts.panels(scope.value)[1].curves[0].t, 2))
        assert 150 < len(kept[-1]) <= 302
    for one, next_one in pairwise(kept):
        assert len(np.setdiff1d(next_one, one)) <= 1  # moves on, no flicker between odd and even samples


def test_what_is_unknown_or_beyond_all_bounds_leaves_the_rest():
    scope = Scope(window=5)
    t, q, r, u = motion(200)
    r[:100], u[50] = np.nan, (np.inf, 1e12, 0)
    scope.show(t, q, r, u)
    panels = charts.panels(scope.value)
    np.testing.assert_allclose(panels[0].curves[1].t, t[100:], atol=0.002)
    np.testing.assert_allclose(panels[0].curves[0].values, np.degrees(q[:, 0]), atol=0.2)
    assert len(panels[1].curves[0].t) == 199 and len(panels[3].curves[0].t) == 200
    assert "nan" not in scope.value and "inf" not in scope.value


def test_cuts_of_the_drive_are_marked():
    scope = Scope()
    scope.show(*motion(200), marks=np.array([0.5, 1.25]))
    for panel in charts.panels(scope.value):
        np.testing.assert_allclose(panel.marks, [0.5, 1.25], atol=0.01)
