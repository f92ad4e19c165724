"""The arm as a plant, closed loops in simulated time, and sweeps over gains. Everything here is simulated.

Names are loaded on first use.
"""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "plant": ["make_plant"],
        "simulation_result": ["SimulationResult"],
        "simulate": ["simulate"],
        "sweep": ["Failure", "SweepResult", "sweep"],
    },
)
