"""The ball in a picture: regions of its colour, edges, an outline, a judge that decides, and the reasons in words."""
