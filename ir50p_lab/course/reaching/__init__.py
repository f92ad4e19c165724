"""Notebook 18: reaching for what the camera sees."""
