"""An arm whose motors give what a function of the pose says: notebook 05 drives it with the student's torques."""

from types import SimpleNamespace

from ir50p_lab.simulation import simulate


def driven(arm, law, q, *, seconds, qd=(0.0, 0.0, 0.0)):
    """Return the motion of an arm from the pose q (3,) rad at the speeds qd (3,) rad/s: SimulationResult.

    law: function of the pose (3,) rad that returns the motors' torques (3,) N m; it is called every 10 ms.
    """
    motors = SimpleNamespace(step=lambda t, q, reference: law(q))
    return simulate(arm, motors, q0=q, qd0=qd, duration=seconds)
