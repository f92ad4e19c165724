"""The line through measured angles and counts: least squares, its standard errors, and what looks wrong in the data."""

import numpy as np

from ir50p_lab.bench.calibration import JointCalibration
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import vectors3

_FULL = 1023.0
_STEP_BACK = 300.0  # counts between two neighbouring angles: more than a misread angle, less than a wrap makes


def fit_calibration(q, counts, *, arm="", source="measured"):
    """Fit counts = zero + slope q to an experiment: the joint stands at angles q, the converter shows counts (4.1.2).

    Which of the two carries the error decides how to fit. A protractor is read to about half a degree, which is one or
    two counts; counts are averaged to a fraction of one. So the angle is the uncertain number, and q is regressed on
    counts: q = a + b counts, slope = 1/b, zero = -a/b. The usual way round (counts on q) would take the errors of q for
    a wider spread of angles and make the slope too small, by the factor var(q)/(var(q) + var(error)). With ten points
    over a wide range the two differ by less than their standard errors; with a narrow one they do not.

    Args:
        q, counts: (m, 3), m poses of the whole arm. Angles in rad, counts of the 10-bit converter.
        arm: Arm or its name, saved with it. source: kept with it (who measured, when).

    Returns: JointCalibration with standard errors, points and residuals; its
    `remarks` name what looks wrong: a bow that a line cannot follow (F test against a cubic), a point that lies far
    off, few points, a narrow range, a reading at the end of the track.
    Raises: InputError for what no line fits: fewer than 3 points, angles in degrees, counts outside 0..1023, a reading
    that does not change or does not follow its angle (a potentiometer that wraps, cables of two joints swapped).
    """
    q, counts = vectors3("q", q), vectors3("counts", counts, unit="counts")
    if q.ndim != 2 or len(q) < 3:
        raise InputError(f"q has shape {q.shape}: give a row per pose; two make a line, a third shows its error")
    if q.shape != counts.shape:
        raise InputError(f"{len(q)} poses but counts of the shape {counts.shape}; they belong together in pairs")
    if np.abs(q).max() > 2 * np.pi:
        raise InputError(f"q holds {np.abs(q).max():g} rad, more than a turn: in degrees? Use np.radians")
    if counts.min() < 0 or counts.max() > _FULL:
        raise InputError(
            f"counts are {counts.min():g} to {counts.max():g}; the 10-bit converter gives 0 to {_FULL:.0f}"
        )
    fits = [_line(joint, *pair) for joint, pair in enumerate(zip(q.T, counts.T, strict=True), 1)]
    slope, zero, stderr_slope, stderr_zero, points, remarks = zip(*fits, strict=True)
    arm = getattr(arm, "name", arm)
    return JointCalibration(slope, zero, stderr_slope, stderr_zero, source, arm, points, sum(remarks, ()))


def _line(joint, q, counts):
    """(slope, zero, stderr_slope, stderr_zero, points, remarks) of one joint."""
    for name, values in (("angle", q), ("reading", counts)):
        if np.ptp(values) == 0:
            raise InputError(
                f"joint {joint}: every {name} is {values[0]:g}: nothing moved. Is this the potentiometer "
                "of that joint, and is it connected?"
            )
    (b, a), cov = np.polyfit(counts, q, 1, cov=True)
    r2 = np.corrcoef(q, counts)[0, 1] ** 2
    back = -(np.sign(b) * np.diff(counts[np.argsort(q)])).min()
    if r2 < 0.5 or back > _STEP_BACK:
        raise InputError(
            f"joint {joint}: the counts do not follow the angle (correlation squared {r2:.2f}, largest step back "
            f"{max(back, 0.0):.0f} counts): are they of the same poses and the same joint, are cables swapped, is the "
            "gap of its track in the travel? bench-test finds out"
        )
    slope, zero = 1 / b, -a / b
    # errors of a and b carried over to first order
    variances = cov[0, 0] / b**4, (cov[1, 1] + zero**2 * cov[0, 0] + 2 * zero * cov[0, 1]) / b**2
    errors = [float(np.sqrt(max(0.0, v))) for v in variances]
    remarks = tuple(f"joint {joint}: {text}" for text in _remarks(q, counts, slope, zero, errors[0]))
    return float(slope), float(zero), *errors, (tuple(q.tolist()), tuple(counts.tolist())), remarks


def _remarks(q, counts, slope, zero, stderr_slope):
    residual = q - (counts - zero) / slope
    if len(q) < 6:
        yield f"only {len(q)} points: a bow or a misread point would not show; measure 10"
    if np.ptp(q) < 0.5:
        yield (
            f"the angles span {np.degrees(np.ptp(q)):.0f} deg only: outside them the line is a guess; use the whole "
            "travel"
        )
    if stderr_slope > 0.02 * abs(slope):
        yield (
            f"the slope is known to {100 * stderr_slope / abs(slope):.0f} % only: over 1 rad that is "
            f"{57.3 * stderr_slope / abs(slope):.1f} deg"
        )
    if counts.min() <= 2 or counts.max() >= _FULL - 2:
        yield "a reading lies at the end of the converter's range: the potentiometer may turn on without it"
    far = _far_off(counts, residual)
    if far is not None:
        yield (
            f"point {far + 1} (q = {np.degrees(q[far]):.1f} deg, {counts[far]:.1f} counts) lies "
            f"{np.degrees(abs(residual[far])):.1f} deg off the line, far more than the others: misread?"
        )
    elif (bow := _bow(counts, q)) is not None:
        yield (
            f"the line leaves a bow of {np.degrees(bow):.1f} deg that is no noise: the potentiometer is not quite "
            "linear there; angles are that much off"
        )


def _far_off(x, residual):
    """Number of the point that does not belong to the others (studentised, 1 in 1000), or None."""
    from scipy.special import stdtr

    m = len(x)
    rss = residual @ residual
    if m < 6 or np.sqrt(rss / m) < 1e-6:
        return None
    leverage = 1 / m + (x - x.mean()) ** 2 / ((x - x.mean()) ** 2).sum()
    i = int((np.abs(residual) / np.sqrt(1 - leverage)).argmax())
    rest = max((rss - residual[i] ** 2 / (1 - leverage[i])) / (m - 3), 1e-30)
    t = abs(residual[i]) / np.sqrt(rest * (1 - leverage[i]))
    return i if m * 2 * stdtr(m - 3, -t) < 1e-3 else None


def _bow(x, y):
    """Largest distance of the best cubic from the best line, if the F test calls it real (1 in 100), else None."""
    from scipy.special import fdtrc

    m = len(x)
    if m < 6:
        return None
    z = (x - x.mean()) / np.ptp(x)
    line, cubic = (np.vander(z, n) @ np.linalg.lstsq(np.vander(z, n), y)[0] for n in (2, 4))
    rss, left = ((y - line) ** 2).sum(), ((y - cubic) ** 2).sum()
    if np.sqrt(rss / m) < 1e-6:
        return None  # rounding
    F = (rss - left) / 2 / max(left / (m - 4), 1e-30)
    return float(np.abs(cubic - line).max()) if fdtrc(2, m - 4, F) < 0.01 else None
