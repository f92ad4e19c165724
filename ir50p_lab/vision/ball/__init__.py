"""The ball in a picture: regions of its colour, edges, an outline, a classifier, and the reasons in words."""
