"""Pictures of notebook 04."""

import numpy as np
import pytest

from ir50p_lab.course.dynamics import inertia_views as views
from ir50p_lab.modelling import IR50P, mass_matrix


def test_inertia_view_shows_the_pose():
    view = views.InertiaView(IR50P)
    q = np.array([0.4, 0.5, -1.0])
    view.update(q)
    M = mass_matrix(IR50P, q)
    side, waist, joints = view.figure.axes
    dot, loop = waist.lines[1], joints.lines[0]
    assert np.allclose(dot.get_xydata(), [[np.degrees(0.5), M[0, 0]]])
    assert np.allclose(np.interp(dot.get_xdata(), *waist.lines[0].get_data()), M[0, 0], rtol=1e-3)
    assert np.allclose(0.5 * np.einsum("ni,ij,nj->n", loop.get_xydata(), M[1:, 1:], loop.get_xydata()), 1.0)
    assert f"{M[1, 1]:.3f}" in side.get_title()
    for ax in view.figure.axes:  # nothing runs out of its axes
        assert ax.get_xlabel() and ax.get_ylabel()
    assert np.abs(loop.get_xydata()).max() < joints.get_xlim()[1] and M[0, 0] < waist.get_ylim()[1]


def test_centres_stand_where_they_are_said_to_be():
    figure = views.centres(IR50P, [0.5, 0.3, -0.6], np.array([[0, 0, 0.1], [0.1, 0.1 * np.tan(0.5), 0.3], [0, 0, 0.2]]))
    dots = figure.axes[0].lines[-1]
    assert np.allclose(dots.get_xydata(), [[0, 0.1], [0.1 / np.cos(0.5), 0.3], [0, 0.2]])


def test_the_heaviest_way_is_drawn_through_the_tip():
    angles = np.linspace(0, 2 * np.pi, 361)
    masses = {"long": 3 + 2 * np.cos(2 * (angles - 0.5)), "round": np.ones(361)}
    plane, ax = views.kilograms(IR50P, [0, 0.3, -0.6], angles, masses).axes
    way = plane.lines[-1].get_xydata()
    assert np.arctan2(*(way[1] - way[0])[::-1]) == pytest.approx(0.5, abs=0.02)
    assert np.linalg.norm(ax.lines[0].get_xydata(), axis=1).max() == pytest.approx(5, rel=0.01)
