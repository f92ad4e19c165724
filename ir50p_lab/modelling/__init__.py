"""From a drawing to the equations of motion: pose, kinematics, symbolic derivation, dynamics, friction, motors.

Names are loaded on first use, so importing this package costs nothing.
"""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "actuators": ["Actuators"],
        "arm": ["Arm"],
        "chain": ["dh_matrix", "dh_table", "forward_kinematics", "frames", "transform"],
        "differential": ["jacobian"],
        "dynamics": ["coriolis_matrix", "energy", "forward_dynamics", "gravity", "inverse_dynamics", "mass_matrix"],
        "export": ["export_arm"],
        "friction": ["Friction", "friction_torque"],
        "ik": ["inverse_kinematics", "reachability"],
        "inertia": ["second_moment_tensor"],
        "named_arms": ["IR50P", "IR50P_WEAK_SHOULDER", "THESIS_A", "THESIS_C", "THESIS_RODS", "load_arm"],
        "symbolic": ["derive", "same_function"],
        "pose": ["rot_x", "rot_y", "rot_z"],
    },
)
