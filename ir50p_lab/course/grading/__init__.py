"""What a class hands in, checked by the engine of `check`, each student in a process with limits: a table, a page."""
