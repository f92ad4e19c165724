"""Notebooks 10 and 11: the bench, calibrated and driven."""
