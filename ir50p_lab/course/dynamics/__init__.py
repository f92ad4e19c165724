"""Notebooks 04 and 05: the mass matrix and the equation of motion."""
