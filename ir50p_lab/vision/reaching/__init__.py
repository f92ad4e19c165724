"""From the ball in the picture to the arm above it: locator, plan, motion, looking again."""
