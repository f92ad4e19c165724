"""What the student owns: which functions, in which order, where they are kept, and the arm they are about."""
