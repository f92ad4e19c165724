"""What the student owns: which functions, in which order, where they lie, and the arm they are about."""
