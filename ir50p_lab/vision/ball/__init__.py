"""The ball in a picture: regions of its colour, edges, an outline, and the evidence for and against it."""
