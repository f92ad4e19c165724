"""Camera calibration: corners of a board, why a picture is refused, the fit with its errors, its doubts, the file."""
