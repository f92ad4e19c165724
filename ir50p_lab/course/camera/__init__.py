"""Notebook 17: the camera calibrated, pixel to table."""
