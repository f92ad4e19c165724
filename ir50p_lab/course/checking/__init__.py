"""check(name, answer): what a student wrote is tried, graded, and kept if it is right."""
