"""The ball in a picture: guesses from regions of its colour, a measured outline, the evidence for and against it."""
