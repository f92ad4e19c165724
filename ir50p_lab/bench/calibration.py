"""From counts of the converter to joint angles: one straight line per joint, from an experiment (4.1.2)."""

import tomllib
import warnings
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from ir50p_lab.errors import InputError, SuspiciousArmWarning
from ir50p_lab.inputs import vector3, vectors3
from ir50p_lab.modelling.chain import lengths

_HEAD = "# counts = zero + slope q: counts of the 10-bit converter, slope in counts/rad, q in rad, joints 1 to 3\n"
_JOINTS = ("joint1", "joint2", "joint3")
_FULL = 1023.0
_STEP_BACK = 300.0  # counts: if they fall by more from one angle to the next, the potentiometer has wrapped round
_FAR = 5.0  # a point that lies as many times the scatter of the others off the line was misread


@dataclass(frozen=True)
class JointCalibration:
    """counts = zero + slope q, for each joint.

    ============ ================================================================ =====================
    slope        how many counts make a radian; > 0 by the wiring rule            (3,) counts/rad
    zero         reading at q = 0                                                 (3,) counts
    stderr_slope standard errors, or None if nobody has measured                  (3,) counts/rad
    stderr_zero                                                                   (3,) counts
    source       where it comes from
    arm          name of the arm it belongs to ('' for any)
    points       what was measured: for each joint (angles, counts), or ()        rad, counts
    remarks      what the fit found suspicious, as sentences
    ============ ================================================================ =====================

    The counts are those of a 10-bit converter, 0..1023. Make a calibration with `fit_calibration` and keep it with
    `course.save_result`: then `connect()` uses it for the bench on which it was measured.

    Raises InputError if a number is not finite or a slope is 0. Warns (SuspiciousArmWarning) of a negative slope,
    because then the joint runs away from its set point.
    """

    slope: tuple
    zero: tuple
    stderr_slope: tuple | None = None
    stderr_zero: tuple | None = None
    source: str = "assumed"
    arm: str = ""
    points: tuple = ()
    remarks: tuple = ()

    def __post_init__(self):
        for name in ("slope", "zero", "stderr_slope", "stderr_zero"):
            if (value := getattr(self, name)) is not None:
                unit = "counts/rad" if "slope" in name else "counts"
                object.__setattr__(self, name, tuple(vector3(name, value, unit=unit).tolist()))
        for joint, slope in enumerate(self.slope, 1):
            said = f"slope of joint {joint} is {slope:.4g} counts/rad"
            if slope == 0:
                raise InputError(f"{said}: is the potentiometer connected, and does it turn with the joint?")
            if slope < 0:
                said += ", negative: swap the outer wires of its potentiometer, or the joint will run away when driven"
                warnings.warn(said, SuspiciousArmWarning, stacklevel=3)

    def radians(self, counts):
        """Return the angles, rad, of counts; both (3,) or (n, 3)."""
        return (np.asarray(counts, dtype=float) - self.zero) / self.slope

    def counts(self, q):
        """Return the counts, not rounded, at angles q, rad; both (3,) or (n, 3)."""
        return self.zero + np.multiply(self.slope, q)

    @property
    def residuals(self):
        """A list with, for each joint that has points, the measured angle minus the angle of the counts, (m,) rad."""
        lines = zip(self.points, self.slope, self.zero, strict=False)
        return [np.array(q) - (np.array(counts) - zero) / slope for (q, counts), slope, zero in lines]

    def header(self):
        """Return the lines for the head of a recording: dict of str."""
        lines = {"counts_per_rad": self.slope, "counts_at_zero": self.zero}
        return {name: " ".join(f"{x:.6g}" for x in row) for name, row in lines.items()} | {"calibration": self.source}

    def save(self, path):
        """Write the calibration as a readable file (TOML). Returns the Path. Raises OSError if it cannot be written."""
        import tomlkit

        data = {name: value for name, value in asdict(self).items() if name != "points" and value is not None}
        for name, (q, counts) in zip(_JOINTS, self.points, strict=False):
            data[name] = {"q": q, "counts": counts}
        Path(path).write_text(_HEAD + tomlkit.dumps(data), encoding="utf-8")
        return Path(path)

    @classmethod
    def load(cls, path):
        """Read a file that `save`, or a person, wrote. Raises InputError, which names the file and what is wrong."""
        try:
            data = tomllib.loads(Path(path).read_text(encoding="utf-8-sig"))
            points = tuple(_pairs(**data.pop(name)) for name in _JOINTS if name in data)
            return cls(points=points, remarks=tuple(data.pop("remarks", ())), **data)
        except (OSError, ValueError, TypeError, RecursionError) as error:
            said = f"{path} is not a calibration ({error})"
            raise InputError(f"{said}: results(withdraw={Path(path).stem!r}), and calibrate again") from None

    def __repr__(self):
        """A table of slopes and zeros with their standard errors, and of residuals; then the source and the remarks."""
        import pandas as pd

        columns = {"counts/rad": self.slope, "+- counts/rad": self.stderr_slope}
        columns |= {"counts at q = 0": self.zero, "+- counts": self.stderr_zero}
        columns["rms residual, deg"] = [np.degrees(np.sqrt(np.mean(one**2))) for one in self.residuals] or None
        table = pd.DataFrame(columns, index=_JOINTS).to_string(float_format="%.2f")
        return "\n".join((table, f"source: {self.source}", *self.remarks))


def _pairs(q, counts):
    """Return the pairs (angles, counts) of one joint from its table in a file."""
    if np.shape(q) != np.shape(counts):
        raise InputError(f"{len(q)} angles q but {len(counts)} counts of a joint: they belong together in pairs")
    return tuple(q), tuple(counts)


# Bench data of an older ROB3 (public repository eurobtec/rob3): counts of a 10-bit converter per rad of axes 1-3.
_SISTER_SLOPE = np.array([189.1, 122.1, 191.7])
_LOWEST, _MIDDLE = 21.0, 512.0  # counts; below the lowest a potentiometer is at the end of its track


def nominal_calibration(arm):
    """Return what potentiometers of this arm would read before anyone has measured them.

    The slopes are those of the sister arm, or smaller where the travel of a joint would not fit into 21..1003 counts;
    the middle of the travel reads 512. A joint without limits is assumed to turn from -pi to pi.
    Args: arm: Arm. Returns: JointCalibration, without standard errors.

    >>> from ir50p_lab.bench import nominal_calibration
    >>> from ir50p_lab.modelling import IR50P
    >>> nominal_calibration(IR50P).counts([0, 0, 0]).round(1)
    array([512. , 448.1, 696. ])
    """
    lengths(arm)  # refuses what is not an Arm
    low, high = np.clip((arm.q_min, arm.q_max), -np.pi, np.pi)
    slope = np.minimum(_SISTER_SLOPE, 2 * (_MIDDLE - _LOWEST) / (high - low))
    return JointCalibration(slope, _MIDDLE - slope * 0.5 * (low + high), source="nominal, not measured")


def fit_calibration(q, counts, *, arm="", source="measured"):
    """Fit counts = zero + slope q to an experiment: the joint stands at angles q, the converter shows counts (4.1.2).

    How to fit depends on which of the two carries the error. A protractor is read to about half a degree, which is one
    or two counts; counts are averaged to a fraction of one. So the angle is the uncertain number, and q is regressed on
    counts: q = a + b counts, slope = 1/b, zero = -a/b. The usual direction (counts on q) would mistake the errors of q
    for a wider spread of angles and make the slope too small, by the factor var(q)/(var(q) + var(error)). With ten
    points over a wide range the two fits differ by less than their standard errors; over a narrow range they do not.

    Args:
        q, counts: (m, 3), m poses of the whole arm. Angles in rad, counts of the 10-bit converter.
        arm: Arm or its name, saved with the fit. source: saved with it, too (who measured, when).

    Returns: JointCalibration with standard errors, points and residuals. Its `remarks` name what looks wrong: a point
    that lies far off, few points, a narrow range, a reading at the end of the track.
    Raises: InputError for data that no line fits: fewer than 3 points, angles in degrees, counts outside 0..1023, a
    reading that does not change or does not follow its angle (a potentiometer that wraps, swapped cables of two
    joints).
    """
    q, counts = vectors3("q", q), vectors3("counts", counts, unit="counts")
    if q.ndim != 2 or q.shape != counts.shape or len(q) < 3:
        raise InputError(f"q has shape {q.shape}, counts have {counts.shape}: give a row per pose, in pairs, 3 or more")
    if np.abs(q).max() > 2 * np.pi:
        raise InputError(f"q holds {np.abs(q).max():g} rad, more than a turn: in degrees? Use np.radians")
    if counts.min() < 0 or counts.max() > _FULL:
        raise InputError(f"counts are {counts.min():g} to {counts.max():g}; the 10-bit converter gives 0 to 1023")
    fits = [_line(joint, *pair) for joint, pair in enumerate(zip(q.T, counts.T, strict=True), 1)]
    slope, zero, stderr_slope, stderr_zero, points, remarks = zip(*fits, strict=True)
    arm = getattr(arm, "name", arm)
    return JointCalibration(slope, zero, stderr_slope, stderr_zero, source, arm, points, sum(remarks, ()))


def _line(joint, q, counts):
    """(slope, zero, stderr_slope, stderr_zero, points, remarks) of one joint."""
    if np.ptp(q) == 0 or np.ptp(counts) == 0:
        raise InputError(f"joint {joint}: nothing moved. Is it the potentiometer of that joint, and is it connected?")
    (b, a), cov = np.polyfit(counts, q, 1, cov=True)
    r2 = np.corrcoef(q, counts)[0, 1] ** 2
    back = -(np.sign(b) * np.diff(counts[np.argsort(q)])).min()
    if r2 < 0.5 or back > _STEP_BACK:
        said = f"correlation squared {r2:.2f}, largest step back {max(back, 0.0):.0f} counts"
        asked = "other poses, cables swapped, the gap of its track in the travel? bench-test finds out"
        raise InputError(f"joint {joint}: the counts do not follow the angle ({said}): {asked}")
    slope, zero = 1 / b, -a / b
    # errors of a and b carried over to first order
    variances = cov[0, 0] / b**4, (cov[1, 1] + zero**2 * cov[0, 0] + 2 * zero * cov[0, 1]) / b**2
    errors = [float(np.sqrt(max(0.0, v))) for v in variances]
    remarks = tuple(f"joint {joint}: {text}" for text in _remarks(q, counts, slope, zero))
    return float(slope), float(zero), *errors, (tuple(q.tolist()), tuple(counts.tolist())), remarks


def _remarks(q, counts, slope, zero):
    if np.ptp(q) < 0.5:
        yield f"the angles span {np.degrees(np.ptp(q)):.0f} deg only: use the whole travel"
    if counts.min() <= 2 or counts.max() >= _FULL - 2:
        yield "a reading lies at the end of the converter's range: the potentiometer may turn on without it"
    if len(q) < 6:
        yield f"only {len(q)} points: a misread point would not show; measure 10"
        return
    off = q - (counts - zero) / slope
    far = np.abs(off).argmax()
    if abs(off[far]) > _FAR * np.delete(off, far).std():
        point = f"point {far + 1} (q = {np.degrees(q[far]):.1f} deg, {counts[far]:.1f} counts)"
        yield f"{point} lies {np.degrees(abs(off[far])):.1f} deg off the line, far more than the others: misread?"
