"""What a controller is shown in notebook 08 in place of perfect angles."""

import numpy as np

from ir50p_lab.course.loops.functions.PID import PID
from ir50p_lab.course.loops.loop_views import Trembling
from ir50p_lab.modelling import IR50P
from ir50p_lab.simulation import simulate


def test_a_trembling_potentiometer_shakes_the_push_and_each_time_alike():
    target = np.array([0, 0.8, 0])
    calm = simulate(IR50P, PID(400, ki=20), target, duration=5)
    one = Trembling(PID(400, ki=20))
    shaken, again = (simulate(IR50P, one, target, duration=5) for _ in range(2))  # no memory of the run before
    np.testing.assert_array_equal(shaken.u, again.u)
    steps = 400 * np.array([0.005, 0.008, 0.005])  # counts
    rest = (shaken.u - calm.u)[-100:]
    assert (rest.std(axis=0) > 0.7 * steps).all() and (rest.std(axis=0) < 1.5 * steps).all()
