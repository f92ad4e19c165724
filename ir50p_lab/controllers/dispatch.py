"""Which compiled law a controller's number stands for: one function for every loop, so that loops stay cached."""

from ir50p_lab.controllers.adaptive_law import adaptive_step
from ir50p_lab.controllers.law import law_step
from ir50p_lab.jit import jit

LAW, ADAPTIVE = 1, 2  # 0: no controller


@jit()
def control_step(kind, p, s, t, q, r, u):
    """One sample of the controller `kind`: parameters p, state s (changed), t, q (3,), r (3, 3), u (3,) (written)."""
    if kind == LAW:
        law_step(p, s, t, q, r, u)
    elif kind == ADAPTIVE:
        adaptive_step(p, s, t, q, r, u)
    else:
        u[:] = 0.0
