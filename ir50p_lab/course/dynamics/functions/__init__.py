"""The functions of notebooks 04 and 05, one file each."""

TORQUES = ("torque 1", "torque 2", "torque 3")
