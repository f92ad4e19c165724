"""Files that came by mail: whatever stands in them, the package answers with an error of its own, which names the file."""

import pytest

from ir50p_lab.bench import JointCalibration, Recording, SimulatedBench
from ir50p_lab.bench.limits import checked_pose
from ir50p_lab.bench.set_point import SetPoint
from ir50p_lab.errors import ArmError, CalibrationError, InputError, RecordingError
from ir50p_lab.identification import load_excitations
from ir50p_lab.modelling import IR50P, Arm, load_arm
from ir50p_lab.vision import Calibration

MANY = 200_000
CAMERA = "%YAML:1.0\n---\nimage_width: "
ROWS = "t,q1,q2,q3,counts1,counts2,counts3,u1,u2,u3,r1,r2,r3,gripper,missed\n0,0,0,0,,,,,,,,,,,\n"


@pytest.mark.parametrize(
    ("load", "text", "error"),
    [
        (Recording.load, ROWS + "# event: 1.2.3 s: x\n", RecordingError),
        (JointCalibration.load, "slope = [1, 1, 1]\nzero = [0, 0, 0]\nremarks = 5", InputError),
        (JointCalibration.load, "slope = " + "[" * MANY, InputError),
        (load_arm, "l = " + "[" * MANY, ArmError),
        (load_excitations, '{"motions": ' + "[" * MANY, InputError),
        (Calibration.load, CAMERA + "[" * MANY, CalibrationError),
        (Calibration.load, CAMERA + "{a: " * MANY, CalibrationError),
        (Calibration.load, CAMERA + "\n  " + "- " * MANY, CalibrationError),
        (Calibration.load, '<?xml version="1.0"?>\n<opencv_storage>' + "<a>" * MANY, CalibrationError),
        (Calibration.load, '{"image_width": ' + "[" * MANY, CalibrationError),
    ],
    ids=lambda value: value[:40] if isinstance(value, str) else value.__name__,
)
def test_what_cannot_be_is_refused_by_name(load, text, error, tmp_path):
    path = tmp_path / "from_a_friend"
    path.write_text(text)
    with pytest.raises(error, match="from_a_friend"):
        load(path)


def test_a_name_is_no_formula(tmp_path):
    path = tmp_path / "arm.toml"
    IR50P.save(path)
    path.write_text(path.read_text().replace('"IR50P"', r"'$\frac{$'"))
    with pytest.raises(ArmError, match="mathematics"):
        Arm.load(path)
    with SimulatedBench(IR50P, record_to=False, name=r"$\frac{$") as bench:
        list(bench.run(0.05))
    assert bench.recording.plot()._repr_png_()[0].startswith(b"\x89PNG")


def test_a_set_point_is_three_numbers():
    for move in (lambda q: checked_pose("set point", IR50P, q), SetPoint((0, 0, 0)).move_to):
        with pytest.raises(InputError, match="set point"):
            move(["a", 0, 0])
