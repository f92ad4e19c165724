"""Notebooks 14 and 15: computed torque."""
