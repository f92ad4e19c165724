"""Which compiled law a controller's number stands for: one function for every loop, so that loops stay cached."""

from ir50p_lab.controllers.adaptive_law import adaptive_step
from ir50p_lab.controllers.model_law import model_step
from ir50p_lab.controllers.pid_law import pid_step
from ir50p_lab.jit import jit

NONE, PID_KIND, MODEL_KIND, ADAPTIVE_KIND = 0, 1, 2, 3


@jit()
def control_step(kind, p, s, t, q, r, u):
    """One sample of the controller `kind`: parameters p, state s (changed), t, q (3,), r (3, 3), u (3,) (written)."""
    if kind == PID_KIND:
        pid_step(p, s, t, q, r, u)
    elif kind == MODEL_KIND:
        model_step(p, s, t, q, r, u)
    elif kind == ADAPTIVE_KIND:
        adaptive_step(p, s, t, q, r, u)
    else:
        u[0], u[1], u[2] = 0.0, 0.0, 0.0
