"""From the ball in the picture to the arm over it: locator, plan, motion, looking again."""
