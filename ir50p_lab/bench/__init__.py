"""The bench: one interface, whether the arm on the table answers, a simulated arm, or a recording."""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "base": ["Bench", "Sample"],
        "calibration": ["JointCalibration", "fit_calibration", "nominal_calibration"],
        "connect": ["connect"],
        "recording": ["Recording"],
        "replay": ["ReplayBench"],
        "rest": ["rest_pose"],
        "serial_bench": ["SerialBench"],
        "simulated": ["SimulatedBench"],
        "simulated_arm": ["SimulatedArm"],
        "arm_instance": ["UNIT", "ArmInstance"],
    },
)
