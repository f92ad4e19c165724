"""The bench: one interface to the arm on the table, a simulated one, or a recording."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "base": ["Bench", "Sample"],
        "calibration": ["JointCalibration", "fit_calibration", "nominal_calibration"],
        "connect": ["connect"],
        "recording": ["Recording"],
        "replay": ["ReplayBench"],
        "serial_bench": ["SerialBench"],
        "simulated": ["SimulatedBench"],
        "simulated_arm": ["SimulatedArm"],
        "arm_instance": ["UNIT", "ArmInstance"],
    },
)
