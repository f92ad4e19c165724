"""The ball in a picture: guesses from regions of its colour, a measured outline, and the evidence for and against it."""
