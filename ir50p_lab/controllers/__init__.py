"""Controllers: one protocol for the notebook, the simulation, the sweep and the bench.

`controller.step(t, measured, reference) -> u`: `measured` is q (3,) rad, `reference` is (q, qd, qdd). The controller
keeps its own state and velocity filter. Names are loaded on first use.
"""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "base": ["Controller"],
        "computed_torque": ["ComputedTorque"],
        "continuous_pid": ["ContinuousPID"],
        "pid": ["PID"],
    },
)
