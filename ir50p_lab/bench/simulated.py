"""The simulated bench: the board's contract without a board, as fast as the machine allows or at the arm's pace."""

from collections import deque, namedtuple

import numpy as np

from ir50p_lab.bench.arm_instance import UNIT
from ir50p_lab.bench.base import Bench, Sample
from ir50p_lab.bench.caps import FAULTS, Caps
from ir50p_lab.bench.limits import FARTHEST, NOBODY, NOISE, checked_push, checked_reference
from ir50p_lab.bench.pace import WATCHDOG, Pace, load_controllers
from ir50p_lab.bench.protocol import JOINTS, LIMIT_PWM
from ir50p_lab.bench.recorder import header_of
from ir50p_lab.bench.runaway import UNDER, UNDER_ALARM, push, tip_height, watch_step
from ir50p_lab.bench.simulated_arm import STEP, SimulatedArm, advance_unit, read_pots
from ir50p_lab.controllers.base import check_reference, is_compiled
from ir50p_lab.controllers.law import law_step
from ir50p_lab.errors import BenchError, InputError
from ir50p_lab.jit import jit

_BLOCK = 1000  # samples between two looks at the disk and at Ctrl-C in a compiled run
_KEPT = 100_000  # newest cycles whose true states are kept: a live run may last for hours
_HOLDS = 1.0  # s: a push that is not repeated ends by then (a closed browser, a busy kernel)
_SINK = 3.0  # time after which an arm without drive lies still, s


@jit()
def _compiled_cycles(theta, n, w, x, joint, slope, zero, low, high, queue, pwm, p, s, watch, t, r, noise, steps, out):
    """The loop of `run`, `step` and `drive`, many cycles at once; out (cycles, 15): counts, q, u, truth q and qd.

    Returns the number of cycles done, and the alarm of `watch_step`; fewer than asked for with an alarm, or if in the
    next one the reference is beyond the travel or too far from the arm (see `checked_reference`), or the command not
    finite.
    """
    command = np.empty(3)
    for k in range(t.size):
        counts, q, truth = out[k, :3], out[k, 3:6], out[k, 9:]
        if t[k] > 0.0:  # the first cycle of a run measures at once
            push(queue, pwm)
            advance_unit(theta, n, w, x, joint, queue[0], steps)
        read_pots(w, joint, noise[k], counts)
        q[:] = (counts - zero) / slope
        truth[:3], truth[3:] = joint, x[3:]
        alarm = watch_step(watch, t[k], q, pwm)
        if alarm > 0:
            return k, alarm
        for i in range(3):
            least, most = min(low[i], q[i] - NOISE) - 1e-9, max(high[i], q[i] + NOISE) + 1e-9
            if not (least <= r[k, 0, i] <= most and abs(r[k, 0, i] - q[i]) <= FARTHEST):
                return k, 0
        law_step(p, s, t[k], q, r[k], command)
        if not np.isfinite(command[0] + command[1] + command[2]):
            return k, 0
        for i in range(3):
            u = min(max(np.rint(command[i]), -LIMIT_PWM), LIMIT_PWM)
            if (q[i] <= low[i] and u < 0.0) or (q[i] >= high[i] and u > 0.0):
                u = 0.0
            pwm[i] = out[k, 6 + i] = u
        if t[k] == 0.0 and pwm.any() and tip_height(watch.numbers, q) < -UNDER:  # as `RunawayGuard.admit`
            return k, UNDER_ALARM
    return t.size, 0


class Truth(namedtuple("Truth", "t q qd")):
    """What the simulation knows and no student can know: t (n,) s; q (n, 3) rad of the links, qd (n, 3) rad/s."""


class SimulatedBench(Bench):
    """A simulated arm on the bench. Its time is a counter of periods, and no time passes between two runs.

    Args:
        arm: Arm with actuators; default `load_arm()`. unit: table of what is not ideal; seed: number of the copy and of
        its noise, counted from IR50P_UNIT (IR50P_SEED: other noise). q0: (3,) rad, where the arm stands when first
        opened (default zero). realtime: whether the clock paces the cycles. name: by default made of arm and seed.
        options: calibration: default the nominal one, from which the unit differs a little, as a real one does; period:
        s, whole milliseconds; record_to: folder for recordings, or False for none on disk.

    Attributes: plant: the SimulatedArm; truth: the Truth of the last run, also of the motion to rest (a recording keeps
    its own). They are for tests, and for plots that say so.

    Raises: ArmError without actuators, InputError for a period or q0 that is not possible.
    """

    kind = "simulated"
    simulated = True
    caps = Caps(faults=FAULTS)

    def __init__(self, arm=None, *, unit=UNIT, seed=0, q0=None, realtime=False, name=None, **options):
        super().__init__(arm, **options)
        self.plant, self.table = SimulatedArm(self.arm, unit, seed, q0=q0), unit.table
        noise = "" if self.plant.noise_seed is None else f", noise {self.plant.noise_seed}"
        self.name = name or f"simulated {self.arm.name}, unit {self.plant.seed}{noise}"
        self._steps = round(self.period / STEP)
        if abs(self._steps * STEP - self.period) > 1e-9:
            raise InputError(f"period = {self.period} s: the simulated bench needs whole milliseconds")
        self.realtime = realtime
        self._queue = np.zeros((self.plant.unit.delay + 1, JOINTS))  # commands; the first of them acts
        self._truth, self._cycle = deque(maxlen=_KEPT), 0
        self.bench_id = f"simulated-unit-{self.plant.seed}"

    # ---- what Bench asks for

    def _begin(self):
        self._queue[:], self._cycle = 0.0, 0
        self._truth.clear()
        if self.plant.pushed:
            self.plant.push(*NOBODY)  # the hand of the run before has let go
        self._push_ends, self._told, self._strongest = 0.0, None, 0.0  # what the recording knows of a hand
        if self.realtime:
            load_controllers()
            push(self._queue, self.command)
            self.plant.advance(self.command, 0.0)  # compiled before the clock starts

    def _make_pace(self):
        return Pace(self._clock, self.period) if self.realtime else super()._make_pace()

    def measure(self, cycle, drive):
        """Advance to this cycle and measure; after a silence longer than the watchdog allows, the drive is off."""
        for late in range(cycle - self._cycle):
            if self.realtime and late * self.period >= WATCHDOG:
                self._cut()
            push(self._queue, self.command)
            self.plant.advance(self._queue[0], self.period)
        self._cycle = cycle
        if not drive:
            self._cut()
        t = cycle * self.period
        if self.plant.pushed and t > self._push_ends:
            self.push(*NOBODY)
        if self.plant.pushed and self._run.guard is not None:
            self._run.guard.begin_anew()
        self._truth.append((t, self.plant.q_true, self.plant.qd_true))
        return t, self.plant.counts(), False

    def _cut(self):
        self._queue[:], self.command = 0.0, np.zeros(JOINTS)
        return True

    def _close(self):
        self.plant.advance(np.zeros(JOINTS), _SINK)

    def _end_run(self):
        if self._run is not None and self._run.recorder is not None and self._truth:
            self.recording.truth = self.truth  # the drive to rest is a run of its own
        super()._end_run()

    def _header(self):
        noise = {} if self.plant.noise_seed is None else {"noise_seed": str(self.plant.noise_seed)}
        return {"seed": str(self.plant.seed), **noise, "delay_periods": str(self.plant.unit.delay)}

    # ---- and what only a simulation can

    def push(self, link, point, force):
        """Let a hand push at `link` during a run, until the next push but at most for a second; zeros let go.

        The runaway guard is told of it, and so are the events of the recording, at each whole newton of a component.

        Args: link: 1, 2 or 3; point: (3,) m in frame `link`, whose origin is the far end of the link; force: (3,) N in
        base coordinates, reduced to 10 N if it is more. Raises InputError for anything else, BenchError outside a run.
        """
        link, point, force = checked_push(link, point, force)
        if self._run is None:
            raise BenchError("push() works only inside a run: outside nobody holds the arm")
        self.plant.push(link, point, force)
        self._push_ends = self._cycle * self.period + _HOLDS
        told, newtons = (link, *force.round()) if self.plant.pushed else None, np.linalg.norm(force)
        self._strongest = max(newtons, self._strongest if self._told else 0.0)
        if told != self._told:
            self._told, parts = told, " ".join(f"{x:.1f}" for x in force)
            pushes = f"a hand pushes at link {link} with {newtons:.1f} N (x y z: {parts})"
            self.note(pushes if told else f"the hand has let go; it pushed with {self._strongest:.1f} N at most")

    def follow(self, controller, reference, seconds, *, record=True, **header):
        """Run `controller` on `reference` for `seconds`; compiled as a whole if the controller is.

        The numbers are those of the loop in Python, to the last bit. Returns the Recording (None with record=False).
        """
        if self.realtime or not is_compiled(controller):
            return super().follow(controller, reference, seconds, record=record, **header)
        check_reference(reference, sampled=True)
        controller.reset()
        cycles = self._number_of_cycles(seconds)
        with self._running(reference, record, header_of(controller) | header) as run:
            for first in range(0, cycles, _BLOCK):
                self._block(controller, run, np.arange(first, min(first + _BLOCK, cycles)))
        return self.recording if record else None

    def _block(self, controller, run, k):
        t, reference = k * self.period, run.reference
        rows = reference.sample(t) if hasattr(reference, "sample") else [reference(time) for time in t]
        r, out = np.ascontiguousarray(rows, dtype=float), np.empty((len(t), 15))
        line = (np.array(self.calibration.slope), np.array(self.calibration.zero))
        fixed = (*self.plant.arrays, *line, *np.array(self._travel).T.copy())
        law = (controller.parameters, controller.state)
        state, noise = (self._queue, self.command, *law, run.guard.watch), self.plant.noise(len(t))
        done, alarm = _compiled_cycles(*fixed, *state, t, r, noise, self._steps, out)
        rows = out[:done]
        if run.recorder is not None and done:
            run.recorder.write_block(t[:done], rows[:, 3:6], rows[:, :3], rows[:, 6:9], r[:done, 0], self.gripper, 0)
        self._truth.append((t[:done], rows[:, 9:12], rows[:, 12:15]))
        if done:
            self.last = Sample(float(t[done - 1]), rows[-1, 3:6].copy(), rows[-1, :3].copy(), 0)
        run.guard.refuse(alarm, t[min(done, len(t) - 1)])
        if done < len(t):
            checked_reference(self.arm, t[done], r[done], out[done, 3:6])
            raise InputError(f"the command at t = {t[done]:.6g} s is not finite (drive cut): reset the controller")

    @property
    def truth(self):
        """The Truth of the last run (of its last 1000 s if it was longer)."""
        t, q, qd = zip(*self._truth, strict=True)
        return Truth(np.hstack(t), np.vstack(q), np.vstack(qd))
