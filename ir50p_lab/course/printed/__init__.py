"""The thesis's equations as it prints them, chapter by chapter, for the checks that show where it slips."""
