"""The arm behind the wires, simulated: PWM counts go in, counts of the converter come out."""

import math

import numpy as np

from ir50p_lab.bench.arm_instance import UNIT, chosen_copy
from ir50p_lab.bench.calibration import nominal_calibration
from ir50p_lab.bench.limits import checked_pose
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.errors import ArmError, InputError
from ir50p_lab.jit import jit, on_floats
from ir50p_lab.modelling import closed_form as cf
from ir50p_lab.modelling.chain import forward_kinematics, frames, lengths
from ir50p_lab.simulation.integrators import dry_step
from ir50p_lab.simulation.plant import FC, FORCE_SCALE, FS, GRAVITY, LIMIT, TF, make_plant

STEP = 0.001  # s; Moreau's step is of first order, and 1 ms is far below the time constants of the drives
HIGHEST_COUNT = 1023.0
_SETTLE = 2e-4  # largest motion of a link within the play in one step, rad: 2 mrad take 10 ms

# rows of the array of the unit's numbers, (9, 3): a number for each joint
GAIN, DEAD, PLAY, SLOPE, ZERO, BOW, LOW, SPAN, DRAG = range(9)


@jit()
def _at_motor(n, w, i, pwm):
    """What the motor of joint i sees of a command: supply saturation, dead zone, its own gain."""
    top = n[LIMIT + i] / w[GAIN, i]
    pwm = min(max(pwm, -top), top)
    return w[GAIN, i] * pwm if abs(pwm) >= w[DEAD, i] else 0.0


@jit()
def _in_play(joint, drive, half, side):
    """Angle of the link behind a gear with play: dragged along, or (side 1, -1) resting on a flank."""
    if side != 0.0:
        joint += min(max(drive + side * half - joint, -_SETTLE), _SETTLE)
    return min(max(joint, drive - half), drive + half)


@on_floats
@jit()
def advance_unit(theta, n, w, x, joint, pwm, steps):
    """Advance the drive side x = (q, qd) (6,) and the links joint (3,) by `steps` steps with pwm (3,) held."""
    q1, q2, q3, a, b, c = x[0], x[1], x[2], x[3], x[4], x[5]
    u1, u2, u3 = _at_motor(n, w, 0, pwm[0]), _at_motor(n, w, 1, pwm[1]), _at_motor(n, w, 2, pwm[2])
    # gravity presses the teeth of joints 2 and 3 together; only where it is small do they have play
    g2, g3 = cf.gravity_torques(theta, n[GRAVITY], math.cos(q2), math.cos(q2 + q3))
    side2 = -cf.sign(g2) if abs(g2) > w[DRAG, 1] else 0.0
    side3 = -cf.sign(g3) if abs(g3) > w[DRAG, 2] else 0.0
    j1, j2, j3 = joint[0], joint[1], joint[2]
    p1, p2, p3 = w[PLAY, 0], w[PLAY, 1], w[PLAY, 2]
    for _ in range(steps):
        q1, q2, q3, a, b, c = dry_step(theta, n, q1, q2, q3, a, b, c, u1, u2, u3, STEP)
        j1, j2, j3 = _in_play(j1, q1, p1, 0.0), _in_play(j2, q2, p2, side2), _in_play(j3, q3, p3, side3)
    x[0], x[1], x[2] = q1, q2, q3
    x[3], x[4], x[5] = cf.not_denormal(a), cf.not_denormal(b), cf.not_denormal(c)
    joint[0], joint[1], joint[2] = j1, j2, j3


@jit()
def read_pots(w, joint, noise, counts):
    """Fill counts (3,) with what a 10-bit converter reads at the links (3,) rad, 0..1023: a bowed line and noise."""
    for i in range(3):
        along = (joint[i] - w[LOW, i]) / w[SPAN, i]
        voltage = w[ZERO, i] + w[SLOPE, i] * joint[i] + 4 * w[BOW, i] * along * (1 - along) + noise[i]
        counts[i] = min(max(np.rint(voltage), 0.0), HIGHEST_COUNT)


class SimulatedArm:
    """One unit of an arm: PWM counts -> motion -> converter counts, reproducible from its seed.

    The drive side (motor and gear, which carry the inertia) moves with dry friction, back-EMF, end stops at the joint
    limits and a table under the tip. The links, with the potentiometers on them, follow within the play of the gear.

    Args:
        arm: Arm with actuators. unit: ArmInstance, of which copy number `seed` is drawn. seed: of the unit and of the
        noise, counted from IR50P_UNIT (`chosen_copy`).
        q0: (3,) rad, where it stands; default the zero pose, or the rest pose if zero is not possible.

    Attributes: arm; unit: the drawn ArmInstance; pushed: whether a hand pushes; seed: number of the unit; noise_seed:
    None, or what IR50P_SEED says; nominal: the JointCalibration that a maker would state (the unit differs from it).
    `q_true`, `qd_true`, `tip_true` are for tests, and for plots that say 'truth of the simulation'.
    Raises: ArmError if the arm has no actuators, InputError if q0 is not possible.
    """

    def __init__(self, arm, unit=UNIT, seed=0, *, q0=None):
        lengths(arm)  # refuses what is not an Arm
        if arm.actuators is None:
            remedy = "add [actuators] to its file, or Actuators.from_joint_data(...) to the Arm"
            raise ArmError(f"{arm.name} has no actuators, so nobody knows what a PWM count does to it: {remedy}")
        self.seed, self.noise_seed = chosen_copy(seed)
        self.arm, self.unit = arm, unit.drawn(self.seed)
        self.nominal = nominal_calibration(arm)
        plant = make_plant(arm, unit="PWM", stops=True, table=self.unit.table)
        self._numbers, self._w = plant.numbers, self._unit_numbers()
        for place, factor in ((FC, self.unit.friction), (FS, self.unit.friction), (LIMIT, self.unit.motor_gain)):
            self._numbers[place : place + 3] *= factor
        self._offset, self._hand, self.pushed = self._numbers[TF : TF + 3].copy(), None, False
        noise = [self.seed, 1] if self.noise_seed is None else [self.seed, 1, self.noise_seed]
        self._rng = np.random.default_rng(noise)
        self._x, self._joint, self._late = np.zeros(6), np.zeros(3), 0.0
        self.arrays = plant.theta, self._numbers, self._w, self._x, self._joint  # as the compiled functions take them
        try:
            self.place(np.zeros(3) if q0 is None else q0)
        except InputError:
            if q0 is not None:
                raise
            self.place(rest_pose(arm))

    def _unit_numbers(self):
        unit = self.unit
        low, high = (np.clip(limit, -np.pi, np.pi) for limit in (self.arm.q_min, self.arm.q_max))
        middle = 0.5 * (low + high)
        slope = np.array(self.nominal.slope) * unit.pot_slope
        zero = self.nominal.counts(middle) - slope * middle + unit.pot_shift
        play, drag = 0.5 * np.array(unit.backlash), np.full(3, unit.link_drag)
        return np.array([unit.motor_gain, unit.dead_zone, play, slope, zero, unit.pot_bow, low, high - low, drag])

    def place(self, q):
        """Put the arm at rest at q (3,) rad, as by hand. Raises InputError if it cannot stand there."""
        q = checked_pose("q0", self.arm, q, self.unit.table)
        self._x[:3], self._x[3:], self._joint[:] = q, 0.0, q

    def push(self, link, point, force):
        """Let a hand push from now on with force (3,) N in base coordinates at point (3,) m of frame `link`; or let go.

        With a force of zeros the hand lets go.
        """
        self._hand, self.pushed = (link, point, force), bool(np.any(force))
        self._lean()

    def _lean(self):
        """The hand's torque J(point)^T F acts as a lopsided friction does, with the other sign."""
        link, point, force = self._hand
        T = frames(self.arm, self._joint)
        levers = T[link, :3, :3] @ point + T[link, :3, 3] - T[:3, :3, 3]
        torque = (np.cross(levers, force) * T[:3, :3, 2]).sum(axis=1)
        torque[link:] = 0.0  # the joints behind the link feel nothing
        self._numbers[TF : TF + 3] = self._offset - torque * self._numbers[FORCE_SCALE : FORCE_SCALE + 3]

    def advance(self, pwm, seconds):
        """Let `seconds` pass with pwm (3,) counts at the bridges; the rest of a 1 ms step is kept for the next call."""
        if self.pushed:
            self._lean()
        self._late += seconds
        steps = int(self._late / STEP + 1e-6)
        self._late -= steps * STEP
        advance_unit(*self.arrays, np.asarray(pwm, dtype=float), steps)

    def counts(self):
        """Return what the 10-bit converter reads now, (3,) whole counts. Each call takes the next noise of the seed."""
        counts = np.empty(3)
        read_pots(self._w, self._joint, self.noise(1)[0], counts)
        return counts

    def noise(self, n):
        """Return the next n rows of noise, (n, 3) counts: the same sequence, in whatever portions it is taken."""
        return self._rng.normal(0.0, self.unit.noise, (n, 3))

    @property
    def q_true(self):
        """Angles of the links behind the play, (3,) rad."""
        return self._joint.copy()

    @property
    def qd_true(self):
        """Velocities of the drive side, (3,) rad/s."""
        return self._x[3:].copy()

    @property
    def tip_true(self):
        """Position of the tip, (3,) m."""
        return forward_kinematics(self.arm, self._joint)
