"""From recordings to numbers: models of the plant, each with the uncertainty of what was found.

Names are loaded on first use, so importing this package costs nothing.
"""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "arm_regressor": ["regressor"],
        "estimate": ["Estimate"],
        "excitation": ["Excitation", "optimise_excitation"],
        "excitation_file": ["load_excitations"],
        "fitting": ["fit"],
        "output_error": ["OutputError", "output_error"],
        "processing": ["Motion", "causal_derivatives", "central_derivatives", "process"],
        "identify_arm": ["identify"],
        "response_fit": ["FOPDT", "fit_fopdt"],
        "regression": ["LeastSquares", "least_squares"],
        "single_joint": ["JointFit", "fit_joint"],
        "validation": ["Validation", "nrmse_fit", "validate"],
    },
)
