"""From counts of the converter to joint angles: a straight line per joint, from an experiment (4.1.2)."""

import tomllib
import warnings
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from ir50p_lab.errors import InputError, SuspiciousArmWarning
from ir50p_lab.inputs import vector3
from ir50p_lab.modelling.chain import lengths

_HEAD = "# counts = zero + slope q: counts of the 10-bit converter, slope in counts/rad, q in rad, joints 1 to 3\n"
_JOINTS = ("joint1", "joint2", "joint3")
_MEASURED = ("remarks", *_JOINTS)  # what older files hold beside the lines


@dataclass(frozen=True)
class JointCalibration:
    """counts = zero + slope q, for each joint.

    ============ ================================================================ =====================
    slope        how many counts a radian makes; > 0 by the wiring rule           (3,) counts/rad
    zero         reading at q = 0                                                 (3,) counts
    stderr_slope standard errors, or None if nobody has measured                  (3,) counts/rad
    stderr_zero                                                                   (3,) counts
    source       where it is from
    arm          name of the arm it belongs to ('' for any)
    ============ ================================================================ =====================

    Counts are those of a 10-bit converter, 0..1023. Keep one with `course.save_result`: then `connect()` takes it for
    the bench it was measured on. A protractor is read to about half a degree, one or two counts, and counts are
    averaged to a fraction of one: fit q = a + b counts, slope = 1/b, zero = -a/b. The other direction takes the errors
    of q for a wider spread of angles and makes the slope too small.

    Raises InputError if a number is not finite or a slope is 0. Warns SuspiciousArmWarning for a negative slope: then
    the joint runs away from its set point.
    """

    slope: tuple
    zero: tuple
    stderr_slope: tuple | None = None
    stderr_zero: tuple | None = None
    source: str = "assumed"
    arm: str = ""

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
        """Angles of counts; both (3,) or (n, 3)."""
        return (np.asarray(counts, dtype=float) - self.zero) / self.slope

    def counts(self, q):
        """Counts at angles; both (3,) or (n, 3), not rounded."""
        return self.zero + np.multiply(self.slope, q)

    def header(self):
        """Lines for the head of a recording."""
        lines = {"counts_per_rad": self.slope, "counts_at_zero": self.zero}
        return {name: " ".join(f"{x:.6g}" for x in row) for name, row in lines.items()} | {"calibration": self.source}

    def save(self, path):
        """Write it as a readable file (TOML). Returns the Path. Raises OSError if it cannot be written."""
        import tomlkit

        data = {name: value for name, value in asdict(self).items() if value is not None}
        Path(path).write_text(_HEAD + tomlkit.dumps(data), encoding="utf-8")
        return Path(path)

    @classmethod
    def load(cls, path):
        """Read a file that `save` wrote (or a person). Raises InputError that names the file and what is wrong."""
        try:
            data = tomllib.loads(Path(path).read_text(encoding="utf-8-sig"))
            return cls(**{name: value for name, value in data.items() if name not in _MEASURED})
        except (OSError, ValueError, TypeError, RecursionError) as error:
            said = f"{path} is no calibration ({error})"
            raise InputError(f"{said}: results(withdraw={Path(path).stem!r}), and calibrate again") from None

    def __repr__(self):
        """A table of slopes and zeros with their standard errors; then the source."""
        import pandas as pd

        columns = {"counts/rad": self.slope, "+- counts/rad": self.stderr_slope}
        columns |= {"counts at q = 0": self.zero, "+- counts": self.stderr_zero}
        table = pd.DataFrame(columns, index=_JOINTS).to_string(float_format="%.2f")
        return f"{table}\nsource: {self.source}"


# Bench data of an older ROB3 (public repository eurobtec/rob3): counts of a 10-bit converter per rad of axes 1-3.
_SISTER_SLOPE = np.array([189.1, 122.1, 191.7])
_LOWEST, _MIDDLE = 21.0, 512.0  # counts; below the lowest a potentiometer is at the end of its track


def nominal_calibration(arm):
    """What potentiometers of this arm would read, before anyone has measured them.

    Slopes of the sister arm, smaller where the travel of a joint would not fit into 21..1003 counts; the middle of the
    travel reads 512. A joint without limits is taken to turn from -pi to pi.
    Args: arm: Arm. Returns: JointCalibration, without standard errors.
    """
    lengths(arm)  # refuses what is no Arm
    low, high = np.clip((arm.q_min, arm.q_max), -np.pi, np.pi)
    slope = np.minimum(_SISTER_SLOPE, 2 * (_MIDDLE - _LOWEST) / (high - low))
    return JointCalibration(slope, _MIDDLE - slope * 0.5 * (low + high), source="nominal, not measured")
