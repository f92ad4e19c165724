"""Functions of notebook 17, with their checks."""
