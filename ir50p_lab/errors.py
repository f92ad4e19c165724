"""Typed errors of the package: each names the value, the limit and what to do next.

    LabError                       every error raised on purpose; those marked * are ValueErrors, too
    ├─ InputError *                an argument
    ├─ ArmError *                  parameters of an arm
    ├─ UnreachableError *          a place
    ├─ IdentificationError *       data that say too little
    ├─ RecordingError *            a file of a run
    ├─ BenchError                  PortError, BoardError, BoardLostError, NotMeasuredError, RunawayError, PauseError
    ├─ VisionError                 ImageError *, CameraError, CalibrationError *
    ├─ DependencyError             a package that the lab book uses cannot be loaded
    └─ WrongFolderError            the kernel runs in another copy of the course
    UserWarning                    SuspiciousArmWarning, SuspiciousAngleWarning, UnstableLoopWarning

Defined beside what raises them: LabBookError, RehearsalError and NotInABrowserError, all LabErrors, ClaimError (an
AssertionError) and RecordingWarning (a UserWarning).
"""


class LabError(Exception):
    """Base class of every error the lab book raises on purpose."""


class DependencyError(LabError, ImportError):
    """A package that the lab book uses cannot be loaded; the cause is kept."""


class WrongFolderError(LabError, ImportError):
    """The notebook is in one copy of the course, and the package that it imports is in another."""


class InputError(LabError, ValueError):
    """An argument has the wrong shape, is not finite, or is out of range."""


class ArmError(LabError, ValueError):
    """Arm parameters that belong to no rigid body, or that the 20 parameters cannot express."""


class UnreachableError(LabError, ValueError):
    """A point that the arm cannot reach, or only outside its joint limits."""


class IdentificationError(LabError, ValueError):
    """Data from which the parameters cannot be found: the model is wrong for them, or they say too little."""


class SuspiciousArmWarning(UserWarning):
    """Arm parameters that are possible but hardly meant (a unit slip, a misprint)."""


class SuspiciousAngleWarning(UserWarning):
    """Angles more than a turn beyond the arm's limits: they may be in degrees."""


class UnstableLoopWarning(UserWarning):
    """A simulated loop that looks unstable although its numbers stay finite: a drive at its limits hides it."""


class BenchError(LabError):
    """Something between computer and arm fails; when this is raised the drive is off, or the board about to brake."""


class PortError(BenchError):
    """The serial port cannot be opened: missing, busy or not permitted."""


class BoardError(BenchError):
    """What answers on the port is not our board, or runs another firmware."""


class BoardLostError(BenchError):
    """The board answered before but no longer does (cable pulled), or has reset in the middle of a run."""


class NotMeasuredError(BenchError):
    """A real arm needs what nobody has measured on it: calibration, model or camera."""


class RunawayError(BenchError):
    """A joint does not do what its motor makes it do: wires swapped, a potentiometer loose or torn, a joint blocked."""


class PauseError(BenchError):
    """The program left the arm without a command for too long in a run; it can drive again only in a new run."""


class RecordingError(LabError, ValueError):
    """A recording that cannot be continued, or a file that is not a recording (the message names the line)."""


class VisionError(LabError):
    """Something is wrong with a picture, a camera or its calibration; base class of the three below."""


class ImageError(VisionError, ValueError):
    """A picture that is missing, empty, corrupt or of the wrong kind (one channel, wrong type)."""


class CameraError(VisionError):
    """There is no camera where one was asked for, or it stopped answering while streaming."""


class CalibrationError(VisionError, ValueError):
    """Pictures from which the camera cannot be calibrated, or a calibration that belongs to another camera or size."""
