"""check(name, answer): what a student wrote is tried, graded, and kept when it is right."""
