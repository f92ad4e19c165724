"""Notebook 00: one angle, one matrix, and the arm turns."""
