"""What came of the races of a hand-in, one on each arm."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.course.unknown.world import BALLS, END, MISSING, World

FAST = 3.6  # s: a median of at most this wins


@dataclass(frozen=True)
class Raced:
    """The race on one arm.

    world: that of the arm, with the arm's path in it; void: why the race does not count, or "".
    """

    world: World
    void: str = ""

    @property
    def touched(self):
        """How many balls were touched."""
        return 0 if self.void else int(BALLS - np.isnan(self.world.touched).sum())

    @property
    def seconds(self):
        """The time of the last touch, s, or more if a ball is missing; a void race counts as one without a touch."""
        return END + MISSING * BALLS if self.void else self.world.score

    def __str__(self):
        return f"void: {self.void}" if self.void else f"{self.touched} of {BALLS} balls, {self.seconds:.2f} s"


@dataclass(frozen=True)
class RaceDay:
    """races: a tuple of Raced, one of each arm; lent: names of the functions in it that are the course's."""

    races: tuple
    lent: tuple = ()

    @property
    def median(self):
        """The median of the races' times, s."""
        return float(np.median([one.seconds for one in self.races]))

    @property
    def complete(self):
        """On how many arms all balls were touched."""
        return sum(one.touched == BALLS for one in self.races)

    @property
    def won(self):
        """Whether the median is fast enough, and the race complete on at least 19 of 20 arms."""
        return self.median <= FAST and self.complete >= 0.95 * len(self.races)

    def __str__(self):
        rows = [f"arm {number}: {one}" for number, one in enumerate(self.races, 1)]
        rows.append(f"median {self.median:.2f} s, complete on {self.complete} of {len(self.races)} arms")
        rows += [f"the course's in it: {', '.join(self.lent)}"] if self.lent else []
        return "\n".join([*rows, "won" if self.won else f"not won: {FAST} s and 19 of 20 arms are wanted"])
