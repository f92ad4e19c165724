"""From counts of the converter to joint angles: a straight line per joint, from an experiment (4.1.2)."""

import tomllib
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ir50p_lab.errors import InputError, SuspiciousArmWarning
from ir50p_lab.inputs import numbers, vector3
from ir50p_lab.modelling.chain import lengths

_HEAD = "counts = zero + slope q, joints 1 to 3: counts of the 10-bit converter, slope in counts/rad, q in rad"
_JOINTS = ("joint1", "joint2", "joint3")
_PLAUSIBLE = (20.0, 1023 / np.radians(60))  # counts/rad: a potentiometer of many turns; of 60 deg over the full range


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
    points       what was measured: for each joint (angles, counts), or ()        rad, counts
    remarks      what the fit found suspicious, sentences
    ============ ================================================================ =====================

    Counts are those of a 10-bit converter, 0..1023. Make one with `fit_calibration`, keep it with
    `course.save_result`: then `connect()` takes it for the bench it was measured on.

    Raises InputError if a number is not finite, a slope is 0 or a standard error negative. Warns SuspiciousArmWarning
    for a negative slope (then the joint runs away from its set point) and for one that no potentiometer has.
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
        known = [name for name in ("stderr_slope", "stderr_zero") if getattr(self, name) is not None]
        for name in ("slope", "zero", *known):
            array = vector3(name, getattr(self, name), unit="counts/rad" if "slope" in name else "counts")
            if name in known and (array < 0).any():
                raise InputError(f"{name} = {array.tolist()}: a standard error cannot be negative")
            object.__setattr__(self, name, tuple(array.tolist()))
        if 0.0 in self.slope:
            raise InputError(
                f"slope of joint {self.slope.index(0.0) + 1} is 0 counts/rad: counts would say nothing about the "
                "angle; is the potentiometer connected and turning with the joint?"
            )
        object.__setattr__(self, "_slope", np.array(self.slope))
        object.__setattr__(self, "_zero", np.array(self.zero))
        for text in self._suspicions():
            warnings.warn(text, SuspiciousArmWarning, stacklevel=3)

    def _suspicions(self):
        for joint, slope in enumerate(self.slope, 1):
            if slope < 0:
                yield (
                    f"joint {joint}: slope = {slope:.4g} counts/rad is negative. The controllers and the board want "
                    "counts that rise with q: swap the two outer wires of the potentiometer and calibrate again; "
                    "driven as it is, the joint would run away"
                )
            elif not _PLAUSIBLE[0] <= slope <= _PLAUSIBLE[1]:
                yield (
                    f"joint {joint}: slope = {slope:.4g} counts/rad; {_PLAUSIBLE[0]:.0f} to {_PLAUSIBLE[1]:.0f} is "
                    "usual (the sister arm has 122 to 192). Were the angles in degrees? Give rad"
                )

    def radians(self, counts):
        """Angles of counts; both (3,) or (n, 3)."""
        return (np.asarray(counts, dtype=float) - self._zero) / self._slope

    def counts(self, q):
        """Counts at angles; both (3,) or (n, 3), not rounded."""
        return self._zero + self._slope * np.asarray(q, dtype=float)

    @property
    def residuals(self):
        """For each joint with points, measured angle minus angle of the counts, (m,) rad; a list of three arrays."""
        if not self.points:
            return []
        return [
            np.array(q) - (np.array(counts) - zero) / slope
            for (q, counts), slope, zero in zip(self.points, self.slope, self.zero, strict=True)
        ]

    def header(self):
        """Lines for the head of a recording."""
        return {
            "counts_per_rad": " ".join(f"{x:.6g}" for x in self.slope),
            "counts_at_zero": " ".join(f"{x:.6g}" for x in self.zero),
            "calibration": self.source,
        }

    def save(self, path):
        """Write it as a readable file (TOML). Returns the Path. Raises InputError if it cannot be written."""
        import tomlkit

        document = tomlkit.document().add(tomlkit.comment(_HEAD))
        for name in ("arm", "source", "slope", "zero", "stderr_slope", "stderr_zero", "remarks"):
            if (value := getattr(self, name)) is not None:
                document[name] = list(value) if isinstance(value, tuple) else value
        points = [{"q": list(q), "counts": list(counts)} for q, counts in self.points]
        document.update(zip(_JOINTS, points, strict=False))
        path = Path(path)
        try:
            path.write_text(tomlkit.dumps(document), encoding="utf-8")
        except OSError as error:
            raise InputError(f"cannot write the calibration to {path}: {error.strerror}; give another path") from None
        return path

    @classmethod
    def load(cls, path):
        """Read a file that `save` wrote (or a person). Raises InputError that names the file and what is wrong."""
        try:
            return cls(**_fields(tomllib.loads(Path(path).read_text(encoding="utf-8"))))
        except OSError as error:
            raise InputError(f"cannot read {path}: {error.strerror}; check it, or calibrate (notebook 10)") from None
        except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
            raise InputError(f"{path} is not a TOML file: {error}. Write one with JointCalibration.save") from None
        except (InputError, TypeError) as error:
            raise InputError(f"{path}: {error}") from None

    def _repr_html_(self):
        """Slopes, zeros, standard errors and residuals as a table, then the remarks, as a notebook shows it."""
        from html import escape

        below = "".join(f"<p>{escape(text)}</p>" for text in (f"source: {self.source}", *self.remarks))
        return self._frame().to_html(index=False) + below

    def _frame(self):
        import pandas as pd

        columns = {"joint": [1, 2, 3]}
        for name, values, errors in (
            ("counts/rad", self.slope, self.stderr_slope),
            ("counts at q = 0", self.zero, self.stderr_zero),
        ):
            pairs = zip(values, errors or (0.0, 0.0, 0.0), strict=True)
            columns[name] = [f"{value:.2f}" + (f" ± {error:.2f}" if error else "") for value, error in pairs]
        residuals = self.residuals or [np.empty(0)] * 3
        rms = [np.degrees(np.sqrt(np.mean(one**2))) if one.size else np.nan for one in residuals]
        columns["rms residual"] = [f"{x:.2f} deg" if x == x else "not measured" for x in rms]
        return pd.DataFrame(columns | {"points": [one.size for one in residuals]})


def _fields(data):
    """The arguments of a JointCalibration in what stands in a file."""
    remarks = data.pop("remarks", [])
    texts = [data.get("arm", ""), data.get("source", "")]
    if not isinstance(remarks, list) or not all(isinstance(text, str) for text in texts + remarks):
        raise InputError("arm and source must be text in quotes, remarks a list of such texts")
    measured = [data.pop(name, None) for name in _JOINTS]
    points = ()
    if any(one is not None for one in measured):
        points = tuple(_pairs(*named) for named in zip(_JOINTS, measured, strict=True))
    return data | {"remarks": tuple(remarks), "points": points}


def _pairs(name, table):
    if table is None:
        return (), ()
    if not isinstance(table, dict) or not {"q", "counts"} <= set(table):
        raise InputError(f"[{name}] must hold two lists of numbers, q (rad) and counts")
    q, counts = (numbers(f"{key} of [{name}]", table[key]) for key in ("q", "counts"))
    if q.ndim != 1 or q.shape != counts.shape:
        raise InputError(f"[{name}] holds angles {q.shape} but counts {counts.shape}: they belong together in pairs")
    return tuple(q.tolist()), tuple(counts.tolist())


# Bench data of an older ROB3 (public repository eurobtec/rob3): counts of a 10-bit converter per rad of axes 1-3.
_SISTER_SLOPE = np.array([189.1, 122.1, 191.7])
_LOWEST, _MIDDLE, _HIGHEST = 20.0, 512.0, 1003.0  # counts; beyond, a potentiometer is at the end of its track


def nominal_calibration(arm):
    """What potentiometers of this arm would read, before anyone has measured them.

    Slopes of the sister arm, smaller where the travel of a joint would not fit into 20..1003 counts; the middle of the
    travel reads 512. A joint without limits is taken to turn from -pi to pi.
    Args: arm: Arm. Returns: JointCalibration, without standard errors.
    """
    lengths(arm)  # refuses what is no Arm
    low, high = (np.clip(limit, -np.pi, np.pi) for limit in (arm.q_min, arm.q_max))
    slope = np.minimum(_SISTER_SLOPE, 2 * min(_MIDDLE - _LOWEST, _HIGHEST - _MIDDLE) / (high - low))
    zero = _MIDDLE - slope * 0.5 * (low + high)
    return JointCalibration(slope=tuple(slope.tolist()), zero=tuple(zero.tolist()), source="nominal, not measured")
