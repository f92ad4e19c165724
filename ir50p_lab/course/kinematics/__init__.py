"""Notebooks 01 to 03: pose, inverse kinematics, velocities."""
