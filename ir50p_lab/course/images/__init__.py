"""Notebook 16: images and the ball."""
