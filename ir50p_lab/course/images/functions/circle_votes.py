"""circle_votes: each edge point votes for the one middle that is `radius` away, inwards."""

import numpy as np

from ir50p_lab.course.checking.task import sentences, task_of


def circle_votes(points, inwards, radius, shape):
    """Return the votes (h, w) of points (n, 2), (x, y) px, `radius` px along unit vectors inwards (n, 2)    (3.3)."""
    votes = np.zeros(shape, dtype=int)
    for point, direction in zip(points, inwards, strict=True):
        column, row = np.round(point + radius * direction).astype(int)
        if 0 <= row < shape[0] and 0 <= column < shape[1]:
            votes[row, column] = votes[row, column] + 1
    return votes


_SMALL = np.array([[3, 2], [7, 2], [5, 0], [5, 4], [4, 2]])  # a small circle about (5, 2), and one for its middle
_INTO_IT = np.array([[1.0, 0], [-1, 0], [0, 1], [0, -1], [1, 0]])
_SIZES = ((8, 12), 4, 9), ((12, 7), 3, 9), ((9, 9), 9.5, 12), ((6, 10), 2, 0), ((7, 11), 5, 8)


def _edges():
    rng, cases = np.random.default_rng(162), []
    for (h, w), radius, count in _SIZES:
        points, turns = rng.integers(0, (w, h), (count, 2)), rng.uniform(-np.pi, np.pi, count)
        inwards = np.column_stack([np.cos(turns), np.sin(turns)])
        if count:  # several for one place in a corner, and one for each side outside
            middles = np.array([(w - 1, 0)] * 3 + [(-1, 2), (w, 2), (2, -1), (2, h)])
            points[:7] = np.clip(middles + rng.integers(-3, 4, middles.shape), 0, (w - 1, h - 1))
            away = middles + 0.2 - points[:7]
            inwards[:7] = away / np.linalg.norm(away, axis=1)[:, None]
        clear = (np.abs((points + radius * inwards) % 1 - 0.5) > 0.02).all(axis=1)  # no half is rounded
        cases.append((points[clear], inwards[clear], float(radius), (h, w)))
    small = [(_SMALL + k, _INTO_IT, 2, shape) for k, shape in enumerate(((6, 9), (8, 10)))]
    return [*cases, *small, (_SMALL, _INTO_IT, 2, (7, 8))]


_SAYS = sentences("circle_votes", __file__)


def _symptom(case, returned, expected):
    votes, points = np.asarray(returned, dtype=float), len(case[0])
    if not np.array_equal(votes, np.round(votes)):
        return _SAYS["weighed"]
    found, right = int(votes.sum()), int(expected.sum())
    if found > points:
        return _SAYS["many"].format(found, points)
    which = "elsewhere" if found == right else "all" if found == points else "others"
    return _SAYS[which].format(found, right)


TASK = task_of(circle_votes, cases=_edges, symptom=_symptom)
