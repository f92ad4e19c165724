"""Which lens model the corners support: terms are dropped that the data do not need, each with its evidence."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.vision.calibration.fit import NAMES, fit

# Coefficients in the order in which they are given up, and the p-value below which they stay; k3 must earn its place:
# it is the term that runs wild beyond the outermost corner
_LIMIT = {"k3": 0.01, "p1 and p2": 0.05, "k2": 0.05, "k1": 0.05}


@dataclass(frozen=True)
class Evidence:
    """One question put to the data: does the term help more than chance would?

    term: "k1", "k2", "p1 and p2", "k3", "bent board", "fx/fy free" or "lens lacks k1"; p_value: chance of such an
    improvement if it were not needed, the larger of an F test of the sums of squares (corners independent) and of a
    Wald test with the covariance by views; gain: of the corrected Akaike criterion AICc, by which models are weighted,
    not chosen; kept: bool; limit: of the p-value, to be kept it must be below; why: what else decided, if anything.
    """

    term: str
    p_value: float
    gain: float
    kept: bool
    limit: float
    why: str = ""

    def __str__(self):
        answer = ("dropped", "kept") if self.term in _LIMIT else ("no", "yes")
        but = f"; but {self.why}" if self.why else ""
        return (
            f"{self.term}: {answer[self.kept]} (such an improvement by "
            f"chance: {in_percent(self.p_value)}; the limit is {100 * self.limit:g} %{but})"
        )


def in_percent(chance):
    """A probability in words: "4.6 %", "less than 0.01 %"."""
    return f"{100 * chance:.2g} %" if chance >= 1e-4 else "less than 0.01 %"


def aicc(fitted, cost=None, fewer=0):
    """Akaike's criterion with the correction for small samples: smaller is better.

    cost, fewer: sum of squares, and number of parameters less, of a model inside the one that was fitted.
    """
    n, p = 2 * fitted.points, fitted.parameters + 1 - fewer
    return n * np.log(max(fitted.cost if cost is None else cost, 1e-300) / n) + 2 * p * n / max(n - p - 1, 1)


def ask(term, fitted, contrast, limit):
    """(Evidence, camera (12,) without the term, its AICc): does a fit need what contrast (q, 12) @ camera = 0 denies?

    To first order: what the fit without it would find follows from the covariance.
    """
    from scipy.special import fdtrc  # chance that an F-distributed number is larger

    C = np.atleast_2d(contrast)
    theta, q, views = C @ fitted.camera, len(C), len(fitted.poses)
    to_term = fitted.by_corners @ C.T
    pull = np.linalg.solve(C @ to_term, theta)
    by_chance = fdtrc(q, 2 * fitted.points - fitted.parameters, theta @ pull / q)
    V = C @ fitted.by_views @ C.T
    scale = np.sqrt(np.diag(V))
    if views > q + 1 and (scale > 0).all() and np.linalg.cond(V / np.outer(scale, scale)) < 1e12:
        W = theta @ np.linalg.solve(V, theta) / q * (views - q) / (views - 1)
        by_chance = max(by_chance, fdtrc(q, views - q, W))
    score = aicc(fitted, fitted.cost + fitted.sigma**2 * theta @ pull, q)
    question = Evidence(term, float(by_chance), float(score - aicc(fitted)), bool(by_chance < limit), limit)
    return question, fitted.camera - to_term @ pull, score


def contrast_of(names):
    """Rows (q, 12) that pick these numbers out of `CameraFit.camera`."""
    return np.eye(12)[[NAMES.index(name) for name in names]]


def choose(corners, full):
    """The simplest lens that the corners do not object to: (CameraFit, evidence, models that were tried).

    From the full model k1, k2, p1, p2, k3 the terms are dropped one after the other, k3 first, as long as the data can
    do without: backwards, because a lens bends light more than it is regular. k2 stays if k3 does, k1 if k2 does.

    Args: corners: CornerSets; full: CameraFit with all the terms. Of each model that was tried the camera (12,) and
    AICc.
    """
    best, evidence, tried = full, [], [(full.camera, aicc(full))]
    for term, limit in _LIMIT.items():
        lens, names = best.model.lens, term.split(" and ")
        if (term == "k2" and "k3" in lens) or (term == "k1" and "k2" in lens):
            continue
        question, camera, score = ask(term, best, contrast_of(names), limit)
        if not question.kept:
            best = fit(corners, best.model.with_lens(name for name in lens if name not in names), best)
            camera, score = best.camera, aicc(best)
        evidence.append(question)
        tried.append((camera, score))
    return best, tuple(evidence), tuple(tried)


def total_covariance(best, tried, full):
    """Covariance (9, 9) of the camera's numbers: of the fit itself, and of the choice of the model.

    Of each parameter the larger standard error of the two routes counts; the correlations are those by corners. The
    centre is no surer than in full, a CameraFit with p1 and p2, which move it. The choice adds the spread of the models
    that were tried about the chosen one, each with its Akaike weight: where two models are about as likely, the
    difference between them is uncertainty, too (Burnham and Anderson's unconditional variance).
    """
    by_corners, own = best.by_corners[:9, :9], np.diag(best.by_corners)[:9]
    errors = best.stderr[:9]
    errors[2:4] = np.maximum(errors[2:4], full.stderr[2:4])
    factor = errors / np.sqrt(np.where(own > 0, own, 1.0))
    total = by_corners * np.outer(factor, factor)
    cameras, scores = zip(*tried, strict=True)
    weights = np.exp(-0.5 * (np.array(scores) - min(scores)))
    for camera, weight in zip(cameras, weights / weights.sum(), strict=True):
        move = np.where(own > 0, camera[:9] - best.camera[:9], 0.0)
        total = total + weight * np.outer(move, move)
    return total
