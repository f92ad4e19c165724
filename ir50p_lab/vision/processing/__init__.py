"""Textbook image processing, step by step: hue, smoothing, edges, votes for circles."""
