"""From the ball in the picture to the arm over it: sight, plan, motion, looking again."""
