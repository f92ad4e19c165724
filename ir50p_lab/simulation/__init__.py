"""The arm as a plant, closed loops in simulated time, sweeps over gains. Everything here is simulated.

Names are loaded on first use.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "plant": ["make_plant"],
        "result": ["SimulationResult"],
        "simulate": ["simulate"],
        "sweep": ["Failure", "SweepResult", "sweep"],
    },
)
