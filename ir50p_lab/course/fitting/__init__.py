"""Notebooks 12 and 13: parameters from recordings, and whether the model is good."""
