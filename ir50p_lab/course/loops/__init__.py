"""Notebooks 08, 09 and A2: a controller from its parts, broken, tuned, and further on."""
