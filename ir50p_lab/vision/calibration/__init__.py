"""Camera calibration: corners, views and why they are refused, the lens by evidence, errors, coverage, file."""
