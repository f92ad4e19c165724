"""An arm whose motors give what a function of the pose says: notebook 05 pushes it by the student's torques."""

from types import SimpleNamespace

from ir50p_lab.simulation import simulate


def driven(arm, law, q, *, seconds, qd=(0.0, 0.0, 0.0)):
    """The motion of an arm from the pose q (3,) rad at the speeds qd (3,) rad/s: SimulationResult.

    law: function of the pose (3,) rad; the torques (3,) N m of the motors, asked every 10 ms.
    """
    motors = SimpleNamespace(step=lambda t, q, reference: law(q))
    return simulate(arm, motors, q0=q, qd0=qd, duration=seconds)
