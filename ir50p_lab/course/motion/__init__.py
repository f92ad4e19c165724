"""Notebooks 06 and 07: simulation, trajectories, friction and motors."""
