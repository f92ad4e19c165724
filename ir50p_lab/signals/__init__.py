"""Reference signals, and filters for measured ones.

A reference says where the joints have to be, how fast they move there, and with what acceleration.
Every reference `target` is frozen and has two calls: `target(t)` returns (q, qd, qdd), three arrays (3,), and
`target.sample(t)` returns the same at many times as (n, 3, 3).
Names are loaded on first use, so importing this package costs nothing.
"""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "fourier": ["Fourier", "at_rest", "fourier"],
        "low_pass": ["alias", "low_pass"],
        "quintic": ["quintic", "through"],
        "reference": ["Reference"],
        "sinusoid": ["sinusoid"],
        "steps": ["hold", "steps"],
        "trapezoid": ["trapezoid"],
    },
)
