"""What a fit found: the 20 parameters of each joint, their errors, and which of them the data do not determine."""

from dataclasses import dataclass, field

import numpy as np

from ir50p_lab.identification.fit_input import blocks
from ir50p_lab.identification.parameters import FREE_OF_SIGN, NAMES
from ir50p_lab.identification.validation import validate
from ir50p_lab.modelling.dynamics import mass_matrix


@dataclass(frozen=True, kw_only=True, eq=False)
class Estimate:
    """Parameters of the model y = Phi theta, one row per joint. It can be used wherever a theta (3, 20) can.

    ============== ================================================================================ ==============
    field          meaning                                                                          shape
    ============== ================================================================================ ==============
    theta          the parameters; 0 where a column was not fitted                                  (3, 20) unit
    stderr         standard errors; inf: not determined by the data; nan: not part of the fit       (3, 20) unit
    covariance     of each joint's parameters; 0 where not fitted                                   (3, 20, 20)
    condition      condition number of the joint's columns, each scaled to length 1                 (3,)
    residuals      y - Phi theta                                                                    (n, 3) unit
    sigma          standard deviation of the residuals: rms, over the degrees of freedom            (3,) unit
    columns        names of the parameters that were fitted, one tuple per joint                    3 tuples
    unidentifiable parameters that the data do not determine, such as "joint 2: theta8"             tuple of str
    warnings       doubts about this fit, as sentences                                              tuple of str
    unit           of y: "PWM" or "N m"
    method, rows   how it was fitted; rows: "joint" or "shared"
    processing     options of `process` that `score` repeats; set by `identify`, else empty         dict
    ============== ================================================================================ ==============
    """

    theta: np.ndarray
    stderr: np.ndarray
    covariance: np.ndarray
    condition: np.ndarray
    residuals: np.ndarray
    sigma: np.ndarray
    columns: tuple
    unidentifiable: tuple
    warnings: tuple
    unit: str = "PWM"
    method: str = "ls"
    rows: str = "joint"
    processing: dict = field(default_factory=dict)

    def predict(self, Phi):
        """Return the torque or PWM counts Phi theta, (n, 3), for a regressor Phi (n, 3, 20).

        Raises InputError on another shape.
        """
        return np.einsum("nij,ij->ni", blocks("Phi", Phi), self.theta)

    def score(self, recording, q=None, u=None):
        """Return the Validation of "u" on another recording    (Table 4.4), processed as the training recording was.

        Args: recording, q, u and errors: as in `validate`; the options are those in `processing`.
        """
        return validate(self, recording, q, u, **self.processing)

    @property
    def summary(self):
        """The result as a tuple of sentences: sizes and residuals, parameters that may be zero, warnings."""
        sentences = []
        for row, who in _rows(self.rows).items():
            counts = f"{len(self.columns[row])} parameters from {len(self.residuals)} samples"
            left = f"residual {self.sigma[row]:.3g} {self.unit} rms, condition {self.condition[row]:.3g}"
            sentences.append(f"{who}: {counts}, {left}")
            values = zip(NAMES, self.theta[row], self.stderr[row], strict=True)
            unsure = [f"{name} = {x:.3g} +- {stderr:.2g}" for name, x, stderr in values if abs(x) < 2 * stderr < np.inf]
            if unsure:
                sentences.append(f"{who}: cannot be told from zero: {', '.join(unsure)}")
        return (*sentences, *self.warnings)

    def __str__(self):
        lines = [f"parameters in {self.unit} and SI units, method {self.method}, rows {self.rows}"]
        for row, who in _rows(self.rows).items():
            values = zip(NAMES, self.theta[row], self.stderr[row], strict=True)
            lines += [f"  {who}  {name:8}{x:12.4g} +- {s:.2g}" for name, x, s in values if np.isfinite(s)]
        return "\n".join([*lines, *self.summary])


def _rows(rows):
    """{row of theta: its name in a sentence}, only the first row if all joints share theta."""
    return {0: "all joints"} if rows == "shared" else {row: f"joint {row + 1}" for row in range(3)}


def impossible_values(theta, stderr, rows):
    """Return sentences about inertial and friction parameters that are below zero by more than two standard errors."""
    return [
        f"{who}: {name} = {x:.3g} +- {error:.2g} is hardly possible below 0: noise, a delay? Or use method='bounded'"
        for row, who in _rows(rows).items()
        for name, x, error in zip(NAMES, theta[row], stderr[row], strict=True)
        if name not in FREE_OF_SIGN and x < -2 * error
    ]


def indefinite_mass(theta):
    """Return a sentence, as a list, if the mass matrix of theta is not positive definite somewhere; else an empty list.

    The signs of its leading minors do not change when each row is divided by its motor's gain, so this holds for
    parameters in PWM counts, too. The poses are a grid of q2 and q3 over the whole circle.
    """
    angles = np.linspace(-np.pi, np.pi, 25)
    q2, q3 = (x.ravel() for x in np.meshgrid(angles, angles))
    M = mass_matrix(theta, np.column_stack([0 * q2, q2, q3]))
    wrong = np.any([np.linalg.det(M[:, :k, :k]) <= 0 for k in (1, 2, 3)], axis=0)
    without_inertia = not M[:, range(3), range(3)].any(axis=0).all()  # it was not fitted for some joint: no check
    if without_inertia or not wrong.any():
        return []
    k = int(np.argmax(wrong))
    where = f"q2 = {q2[k]:.2f}, q3 = {q3[k]:.2f} rad: use method='bounded' or richer data"
    return [f"the mass matrix of these parameters is not positive definite at {where}"]
