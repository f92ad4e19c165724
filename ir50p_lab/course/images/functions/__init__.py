"""What a student writes in notebook 16, with its checks."""
