"""Typed errors of the package: each names the value, the limit and what to do next."""


class LabError(Exception):
    """Base class of every error the lab book raises on purpose."""


class InputError(LabError, ValueError):
    """An argument has the wrong shape, is not finite, or is out of range."""


class ArmError(LabError, ValueError):
    """Arm parameters that belong to no rigid body, or that the 20 parameters cannot express."""


class UnreachableError(LabError, ValueError):
    """A point that the arm cannot reach, or only outside its joint limits."""


class IdentificationError(LabError, ValueError):
    """Data from which the parameters asked for cannot be found: the model is wrong for them, or they say too little."""


class SuspiciousArmWarning(UserWarning):
    """Arm parameters that are possible but hardly meant (a unit slip, a misprint)."""
