"""Take an arm home: as a MuJoCo model (arm.xml) or as a URDF (arm.urdf)."""

from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from ir50p_lab.errors import ArmError, InputError
from ir50p_lab.inputs import vector3
from ir50p_lab.modelling.arm import Arm
from ir50p_lab.modelling.friction import Friction

_NAMES = "waist", "shoulder", "elbow"
_AXES = "0 0 1", "0 -1 0", "0 -1 0"  # shoulder and elbow lift for positive angles


def export_arm(arm, path, *, gain=None):
    """Write an arm for another program, with its friction and, in MJCF, its rotors and motors.

        export_arm(arm, "arm.xml")
        export_arm(estimate, "arm.urdf", gain=arm.actuators.gain)

    Args: arm: Arm, or an Estimate of a rigid body in PWM counts; path: ends in .xml (MuJoCo's MJCF) or .urdf;
    gain: N m per count (3,) of the motors of an Estimate: without them counts are no torques.
    What the format cannot hold stands in it as a comment. An Estimate fixes no masses: it becomes two point masses
    and rotors that move alike; where its joints disagree on a number, their mean is taken.

    Returns: the Path. Raises InputError for another ending, an Estimate without gains or in N m with gains; ArmError
    for numbers that no rigid body has.
    """
    path = Path(path)
    if path.suffix not in (".xml", ".urdf"):
        raise InputError(f"path = {str(path)!r}: end it in .xml (MuJoCo) or .urdf")
    notes, rotor = [], np.zeros(3)
    if not isinstance(arm, Arm):
        arm, rotor = _of_estimate(arm, gain)
        notes += ["from an estimate: masses are one choice of many that move alike; damping holds the back-EMF"]
        notes += ["no recording tells the height of the column and where the forearm ends: both are made up"]
    elif arm.actuators is not None:
        rotor = np.array(arm.actuators.reflected_inertia)
    if arm.friction.fs != arm.friction.fc or any(arm.friction.Tf):
        notes.append(f"left out: breakaway fs = {arm.friction.fs} N m, offset Tf = {arm.friction.Tf} N m")
    write = _mjcf if path.suffix == ".xml" else _urdf
    path.write_text(write(arm, rotor, notes), encoding="utf-8")
    return path


def _of_estimate(estimate, gain):
    """An Arm without motors that moves as an Estimate says, and its rotors (3,) kg m^2."""
    if not hasattr(estimate, "theta") or getattr(estimate, "unit", "") not in ("PWM", "N m"):
        raise InputError(f"arm = {estimate!r:.60}: give an Arm, or an Estimate of one")
    if (estimate.unit == "PWM") != (gain is not None):
        raise InputError(f"the estimate is in {estimate.unit}: give gain= (N m per count of each motor) for PWM alone")
    rows = np.array(estimate.theta) * (1 if gain is None else vector3("gain", gain, unit="N m")[:, None])
    fitted = np.where(rows == 0, np.nan, rows)
    t = np.array([np.nanmean(column) if np.isfinite(column).any() else 0.0 for column in fitted.T])
    t1, t2, t3, t4, t5, t6, _, _, t9, t10 = t[:10]
    if min(t4, t5, t6) <= 0 or t2 <= t4 * t6**2 / (t5 * t4) or min(t1, t9, t10, t[19]) < 0:
        raise ArmError(
            f"no rigid body has theta1 to 6, 9, 10, j3 = {t[[0, 1, 2, 3, 4, 5, 8, 9, 19]].round(4)}: "
            "identify(recording, l2=...) bounds them to one that can exist"
        )
    l2, m3 = t6 / t4, t4**2 / t5
    first = t3 - m3 * l2
    m2 = max(first**2 / (t2 - m3 * l2**2), first / l2)  # its centre within the link
    rest = t2 - m3 * l2**2 - first**2 / m2
    friction = Friction(fv=np.maximum(t[[10, 12, 14]], 0), fc=np.maximum(t[[11, 13, 15]], 0), Tf=t[16:19])
    bodies = {"m": (0, m2, m3), "lc": (0, first / m2, t5 / t4), "Ixx": (0, 0, t10 / 2)}
    bodies |= {"Iyy": (0, rest, t10 / 2), "Izz": (0, rest, t10)}
    return Arm(name="estimate", l=(0, l2, t5 / t4), friction=friction, **bodies), np.array([t1 - t10 / 2, t9, t[19]])


def _links(arm):
    """(place in the link before, centre of mass, diagonal of inertia in x, y, z of the link's own box) of each link."""
    places = (0, 0, 0), (0, 0, arm.l[0]), (arm.l[1], 0, 0)
    centres = (0, 0, arm.lc[0]), (arm.lc[1], 0, 0), (arm.lc[2], 0, 0)
    for i in range(3):  # the z axis of links 2 and 3 is that of their joint, -y here
        about = (arm.Iyy[i], arm.Izz[i]) if i == 0 else (arm.Izz[i], arm.Iyy[i])
        yield places[i], centres[i], (arm.Ixx[i], *about)


def _text(values):
    return " ".join(repr(float(value)) for value in np.atleast_1d(values))


def _mjcf(arm, rotor, notes):
    lines = [f"<mujoco model={quoteattr(arm.name)}>", *(f"  <!-- {note} -->" for note in notes)]
    lines += ['  <compiler angle="radian" balanceinertia="false" boundmass="1e-9" boundinertia="1e-12"/>']
    lines += [f'  <option gravity="0 0 {-arm.g!r}"/>', "  <worldbody>"]
    for i, (place, centre, inertia) in enumerate(_links(arm)):
        bounded = np.isfinite([arm.q_min[i], arm.q_max[i]]).all()
        limits = f' limited="true" range="{_text((arm.q_min[i], arm.q_max[i]))}"' if bounded else ""
        rubs = f'damping="{arm.friction.fv[i]!r}" frictionloss="{arm.friction.fc[i]!r}"'
        body = f'mass="{arm.m[i]!r}" diaginertia="{_text(inertia)}"'
        lines += [f'  <body name="{_NAMES[i]}" pos="{_text(place)}">', f'    <inertial pos="{_text(centre)}" {body}/>']
        lines += [
            f'    <joint name="{_NAMES[i]}" axis="{_AXES[i]}" armature="{float(rotor[i])!r}" {rubs}{limits}/>',
        ]
    lines += [f'    <site name="tip" pos="{arm.l[2]!r} 0 0"/>', "  </body>" * 3, "  </worldbody>"]
    if arm.actuators is not None:
        lines += ["  <!-- ctrl: PWM counts; a motor brakes itself by its back-EMF -->", "  <actuator>"]
        for name, gain, brake in zip(_NAMES, arm.actuators.gain, arm.actuators.back_emf_damping, strict=True):
            motor = f'gainprm="{_text(gain)}" biastype="affine" biasprm="{_text((0, 0, -brake))}"'
            lines.append(f'    <general name="{name}" joint="{name}" {motor}/>')
        lines.append("  </actuator>")
    return "\n".join([*lines, "</mujoco>", ""])


def _urdf(arm, rotor, notes):
    notes = [*notes, f"left out: gravity {arm.g} m/s^2, rotors {rotor.tolist()} kg m^2, the motors"]
    lines = [f"<robot name={quoteattr(arm.name)}>", *(f"  <!-- {note} -->" for note in notes), '  <link name="base"/>']
    for i, (place, centre, (xx, yy, zz)) in enumerate(_links(arm)):
        inertia = f'ixx="{xx!r}" iyy="{yy!r}" izz="{zz!r}" ixy="0" ixz="0" iyz="0"'
        lines += [f'  <link name="{_NAMES[i]}_link"><inertial><origin xyz="{_text(centre)}"/>']
        lines += [f'    <mass value="{arm.m[i]!r}"/><inertia {inertia}/></inertial></link>']
        bounded = np.isfinite([arm.q_min[i], arm.q_max[i]]).all()
        kind = "revolute" if bounded else "continuous"
        limits = f'<limit lower="{arm.q_min[i]!r}" upper="{arm.q_max[i]!r}" effort="1000" velocity="100"/>'
        lines += [f'  <joint name="{_NAMES[i]}" type="{kind}"><origin xyz="{_text(place)}"/><axis xyz="{_AXES[i]}"/>']
        lines += [f'    <parent link="{("base", *(f"{name}_link" for name in _NAMES))[i]}"/>']
        lines += [f'    <child link="{_NAMES[i]}_link"/>{limits if bounded else ""}']
        lines += [f'    <dynamics damping="{arm.friction.fv[i]!r}" friction="{arm.friction.fc[i]!r}"/></joint>']
    return "\n".join([*lines, "</robot>", ""])
