"""What a student's PID is put through: runs that show one part of it each, and what a wrong one is told."""

import inspect

import numpy as np

from ir50p_lab.course.functions.grade import no_numbers
from ir50p_lab.course.functions.stops import why_it_stops
from ir50p_lab.course.functions.task import Failed, shown

_KP, _KI, _KD = np.array([40.0, 60.0, 80.0]), np.array([20.0, 30.0, 40.0]), np.array([10.0, 20.0, 30.0])
_PERIOD = 0.02  # s; not the 0.01 that a student may write down


def _make(cls, **settings):
    try:
        inspect.signature(cls).bind(**settings)
    except TypeError:
        names = ", ".join(inspect.signature(cls).parameters)
        raise Failed(f"it is made with PID({', '.join(settings)}); its __init__ takes ({names})") from None
    return _guarded(lambda: cls(**settings), lambda: f"PID({settings})")


def _guarded(do, what=str):
    """What `do` gives; what: function that names the case, called only when it fails."""
    try:
        with np.errstate(all="ignore"):
            return do()
    except KeyboardInterrupt:
        raise Failed("it was stopped: does a loop in it never end?", what()) from None
    except Exception as error:
        raise Failed(why_it_stops(error), what()) from None


def _run(pid, q, wanted=0.0, speed=0.0):
    """Commands (n, 3) of a controller that is shown q (n, 3) rad, one sample a period, and asked for wanted, speed."""
    try:
        inspect.signature(pid.step).bind(0.0, q, q)
    except TypeError:
        names = ", ".join(inspect.signature(type(pid).step).parameters)
        raise Failed(f"its step takes ({names}); begin it with `def step(self, t, q, reference):`") from None
    q = np.asarray(q, dtype=float)
    rows = np.zeros((len(q), 3, 3))
    rows[:, 0], rows[:, 1] = wanted, speed
    commands = np.empty((len(q), 3))
    for k in range(len(q)):

        def what(k=k):
            return f"step({k * _PERIOD:.2f}, {shown(q[k])}, reference), reference = {shown(rows[k])}"

        command = _guarded(lambda k=k: pid.step(k * _PERIOD, q[k].copy(), rows[k].copy()), what)
        if says := no_numbers(command, np.zeros(3)):
            raise Failed(says.replace("it returns", "step returns"), what())
        commands[k] = command
    return commands


def _motion(count=40):
    rng = np.random.default_rng(8)
    return rng.uniform(-0.5, 0.5, (count, 3)), rng.uniform(-0.5, 0.5, (count, 3))


def _constant(seconds, value):
    return np.full((round(seconds / _PERIOD), 3), value, dtype=float)


def _expect(u, right, slips, otherwise):
    """Fail with the sentence of the slip that gives these commands; slips: pairs (commands, sentence)."""
    if np.allclose(u, right, atol=1e-6, rtol=1e-9):
        return
    k = np.flatnonzero(~np.isclose(u, right, atol=1e-6, rtol=1e-9).all(axis=1))[0]
    example = f"sample {k} of a run, counts\nexpected: {shown(right[k])}\nyours: {shown(u[k])}"
    for wrong, says in slips:
        if np.allclose(u, wrong, atol=1e-6, rtol=1e-6):
            raise Failed(says, example)
    raise Failed(otherwise, example)


# --------------------------------------------------------------------------------------------------------- P
def _unit(cls):
    if getattr(cls, "unit", None) != "PWM":
        raise Failed('it does not say its unit: without `unit = "PWM"` its counts are taken for N m')


def _push(cls):
    q, wanted = _motion()
    e = wanted - q
    aimless = "the reference is not used: it pushes towards zero or away from it, whatever is wanted"
    slips = (
        (-_KP * e, "it pushes the wrong way: an arm below its target is pushed further down"),
        (_KP * (wanted + q), "it takes the sum of both angles: at its target the arm would be pushed hardest. How much "
         "is *missing*?"),
        (np.degrees(_KP * e), "the push is 57 times too strong: everything here is rad, no degrees anywhere"),
        (_KP * wanted, "q is not used: it pushes the same wherever the arm is"),
        (-_KP * q, aimless),
        (_KP * q, aimless),
        (np.maximum(_KP * e, 0), "it cannot push downwards: a push has two directions"),
        (_KP * (0.3 - q), "the speed that is wanted is taken for the angle: the reference has three rows"),
        (_KP * e**2, "the error is squared: twice as far is twice the push, and an error has a sign"),
        (_KP * np.abs(e), "it pushes the same way on both sides of the target: an error has a sign"),
        (_KP * np.sign(e), "it pushes as hard when little is missing as when much is: only the error's sign is used"),
        (np.round(_KP * e), "it rounds: a push need not be a whole number of counts"),
    )  # fmt: skip
    otherwise = "the push is not proportional to what is missing"
    u = _run(_make(cls, kp=tuple(_KP)), q, wanted, speed=0.3)
    says = otherwise
    if np.allclose(u, (gain := u[0] / e[0] + 0.0) * e):
        says = f"for each rad that is missing it pushes with {shown(gain)} counts, where kp is {shown(_KP)}"
    elif np.allclose(u - _KP * e, more := u[0] - _KP * e[0]):
        says = f"at its target, where nothing is missing, it pushes with {shown(more)} counts"
    _expect(u, _KP * e, slips, says)
    _expect(_run(_make(cls, kp=50), q, wanted), 50 * e, (), f"with one number for kp: {otherwise}")


def gains(*names):
    """A probe: these gains are kept in `self` and read in every step."""

    def probe(cls):
        pid = _make(cls, kp=1.0)
        missing = [name for name in names if not hasattr(pid, name)]
        if missing:
            raise Failed(f"it has no self.{missing[0]}: the live panel looks there for the gain, and changes it")
        q, wanted = _motion(6)
        for name in names:
            made, changed = _make(cls, **{"kp": 10.0, name: 20.0}), _make(cls, kp=10.0)
            setattr(changed, name, np.full(3, 20.0))
            says = f"self.{name} was changed while it ran, and nothing happened: read the gain in every step"
            _expect(_run(changed, q, wanted), _run(made, q, wanted), (), says)

    return probe


def _shared(cls):
    q, wanted = _motion(10)
    first = _run(_make(cls, kp=10.0, ki=200.0), q, wanted)
    one, other = _make(cls, kp=10.0, ki=200.0), _make(cls, kp=20.0, ki=200.0)
    _run(other, q, wanted)
    says = "two controllers share one memory: what belongs to one of them goes into `self`, in __init__"
    _expect(_run(one, q, wanted), first, (), says)


# --------------------------------------------------------------------------------------------------------- I
def _integral(cls):
    q, wanted = _motion()
    e = wanted - q
    push, total = _KP * e, np.cumsum(e, axis=0)
    u = _run(_make(cls, kp=_KP, ki=_KI, period=_PERIOD), q, wanted)
    rights = (
        (total, ""),
        (total - e, "Yours adds the newest error one period later than the course's: right, too."),
        (total - e[0], "Yours counts no time before the first sample: right, too."),
    )
    trapezoid = (
        "Yours takes the mean of two neighbouring errors, the trapezoidal sum: half a period apart, and right, too."
    )
    rights += tuple((total - e / 2 + first * e[0] / 2, trapezoid) for first in (-1, 0, 1))  # the first strip
    for area, says in rights:
        if np.allclose(u, push + _KI * _PERIOD * area, atol=1e-6):
            return says
    area, memory = total * _PERIOD, _KI * _PERIOD * total
    slips = (
        (push + _KI * total, "the period is missing in it: the memory is a sum of areas, and an area has a width"),
        (push + _KI * total * 0.01, "0.01 s is written into it: it was made with another period"),
        (push - memory, "the integral pulls away from the target: look at the sign of what you add up"),
        (push + _KI * _PERIOD * e, "it does not remember: only the newest error is in its integral"),
        (push, "ki does nothing: does the memory grow, or rest where it need not?"),
        (push + _KI * total / _PERIOD, "it divides by the period: the sum is one of areas, error x period"),
        (push + _KI * np.cumsum(np.abs(e), axis=0) * _PERIOD, "its memory can only grow: an error has a sign"),
        (push + area, "ki is not used: the sum is added as it is"),
        (push + _KP * memory, "kp multiplies all: here ki is a gain of its own, not a share of kp"),
        (push + _KP * area, "the integral has the gain kp: it has its own, ki"),
        (push + np.cumsum(memory, axis=0) * _PERIOD, "it is summed up twice: one memory is enough"),
        (push + _KI * total.sum(axis=1, keepdims=True) * _PERIOD, "all joints share one sum: each remembers its own"),
    )
    taken, strip = shown(np.diff((u - push) / _KI, axis=0)[-1]), shown(e[-1] * _PERIOD)
    otherwise = f"P is right, the memory is not: its last step takes in {taken} rad s, where error x period is {strip}"
    return _expect(u, push + memory, slips, otherwise)


def _again(cls, forgotten, **settings):
    """Whether a run after a reset is the first one again."""
    pid = _make(cls, kp=10.0, period=_PERIOD, **settings)
    if not callable(getattr(pid, "reset", None)):
        raise Failed("it has no `reset`: the second run would begin with the memory of the first")
    q, wanted = _motion(10)
    first = _run(pid, q, wanted)
    _guarded(pid.reset)
    says = f"after `reset` it is not as new: {forgotten} of the last run is still there"
    _expect(_run(pid, q, wanted), first, (), says)


# ---------------------------------------------------------------------------------------------------- limits
def _limit(cls):
    e = _constant(0.1, 1.0) * [1.0, -1.0, 0.01]
    right, free = np.clip(400 * e, -100, 100), 400 * e
    slips = (
        (
            free,
            "it has no limit: it asks for 400 counts where 100 are allowed. If there is a np.clip, is what it gives "
            "used? It changes nothing by itself",
        ),
        (free / 4, "one joint at its limit weakens the others: each joint has a limit of its own"),
        (np.minimum(free, 100), "it is limited upwards only: the limit holds on both sides"),
        (np.clip(free, -255, 255), "255 is written into it: it was made with another limit_pwm"),
    )
    u = _run(_make(cls, kp=400.0, limit_pwm=100), 0 * e, e)
    otherwise = f"where kp times the error is [400, -400, 4] and limit_pwm 100, it sends {shown(u[0])}"
    _expect(u, right, slips, otherwise)
    _expect(_run(_make(cls, kp=400.0), 0 * e, e), np.clip(free, -255, 255), (), "without limit_pwm the limit is 255")


def _at_its_limit(cls, error):
    """Commands held at the limit by an error (rad) for 3 s and for 6 s, and those against one of other sign after."""
    held, tails = [], []
    for seconds in (3, 6):
        wanted = np.vstack([_constant(seconds, error), _constant(10, -error / 2)])
        u = _run(_make(cls, kp=100.0, ki=200.0, period=_PERIOD), 0 * wanted, wanted)
        half, end = round(seconds / _PERIOD / 2), round(seconds / _PERIOD)
        held.append(u[half:end])
        tails.append(u[end:])
    return held, tails


def _windup(cls):
    held, tails = _at_its_limit(cls, 1.0)
    if (most := max(one.max() for one in held)) > 255 + 1e-9:
        raise Failed(f"P and I together push with {most:.0f} counts, 255 are allowed: limit their sum")
    if min(one.min() for one in held) < 250:
        raise Failed(
            f"while the error stays at 1 rad, its push falls back from the limit to {min(o.min() for o in held):.0f}: "
            "rest the integral there, do not throw it away"
        )
    if np.abs(tails[0] - tails[1]).max() > 1.0:
        if np.allclose(*_at_its_limit(cls, 100.0)[1]):
            raise Failed(
                "its memory has a limit, and far too late: 255 is counts, your memory is in rad s. Multiply by ki "
                "before you add up"
            )
        late = [_PERIOD * np.sum((tail > 250).all(axis=1)) for tail in tails]
        raise Failed(
            f"it winds up: after 3 s at its limit it pushes on for {late[0]:.1f} s against an error of other sign, "
            f"after 6 s for {late[1]:.1f} s or more. What does the integral do while the motor can give no more?"
        )
    wanted = np.vstack([_constant(3, 1.0), _constant(3, -1.0)])
    u = _run(_make(cls, kp=0.0, ki=200.0, period=_PERIOD), 0 * wanted, wanted)
    if u[-1].max() > -200:
        raise Failed("once at its limit it never lets go: an error that leads back from the limit has to count")


def _joint_by_joint(cls):
    wanted = _constant(1, 1.0) * [0.01, 0.02, 0.03]
    calm = _run(_make(cls, kp=200.0, ki=100.0, period=_PERIOD), 0 * wanted, wanted)
    beside = _run(_make(cls, kp=200.0, ki=100.0, period=_PERIOD), 0 * wanted, wanted + 5.0 * np.eye(3)[0])
    says = "while joint 1 is at its limit, the integrals of the others rest as well: decide joint by joint (np.where)"
    _expect(beside[:, 1:], calm[:, 1:], (), says)


# --------------------------------------------------------------------------------------------------------- D
def _filtered(slope, share, mean=False):
    """First-order low pass of slope (n, 3) from rest; mean: of two neighbouring samples (bilinear)."""
    y, out, last = np.zeros(3), [], np.zeros(3)
    for one in slope:
        y = y + share * ((one + last) / 2 - y if mean else one - y)
        last = one
        out.append(y)
    return np.array(out)


def _damping(cls):
    q, hz = _motion()[0], 8.0
    slope = np.diff(q, axis=0, prepend=q[:1]) / _PERIOD
    turn = 2 * np.pi * hz * _PERIOD
    exact, backward, bilinear = 1 - np.exp(-turn), turn / (1 + turn), turn / (1 + turn / 2)
    settings = {"kp": 0.0, "kd": _KD, "limit_pwm": 1e6, "period": _PERIOD, "filter_hz": hz}
    u = _run(_make(cls, **settings), q, q[0])
    other = "Yours filters with another share a sample than the course's, of the same cut-off: right, too."
    rights = (
        (_filtered(slope, exact), ""),
        (_filtered(slope, backward), other),
        (_filtered(slope, bilinear, mean=True), other),
    )
    for speed, says in rights:
        if np.allclose(u, -_KD * speed, atol=1e-6):
            return says
    right, from_zero = -_KD * rights[0][0], np.diff(q, axis=0, prepend=0 * q[:1]) / _PERIOD
    from_first = (q - q[0]) / _PERIOD
    slips = (
        (-right, "D pushes along with the motion: it has to act against it"),
        (-_KD * slope, "the speed is not filtered: a potentiometer's trembling goes straight to the motor"),
        (right * _PERIOD, "the period is missing: the difference of two angles is no speed yet"),
        (right * _PERIOD / 0.01, "0.01 s is written into it: it was made with another period"),
        (-_KD * _filtered(from_zero, exact), "at the first sample it believes that the arm has come from zero in one "
         "period: what is the speed when there is no angle before?"),
        (-_KD * _filtered(from_first, exact), "the last angle stays the first one: is it brought up to date in every "
         "step?"),
        (-_KD * _filtered(slope, 1 - np.exp(-hz * _PERIOD)), "its filter is six times too slow: filter_hz counts whole "
         "turns a second, and a turn has 2 pi"),
        (-_KD * _filtered(slope, 1 - exact), "the two shares of the filter are swapped"),
        (-_KD[0] * rights[0][0], "all joints get the kd of joint 1: each has its own"),
        (-_KD * exact * slope, "its filter keeps nothing: the speed of the last sample is where it goes on from"),
        (np.degrees(right), "D is 57 times too strong: everything here is rad, no degrees anywhere"),
        (_KD * (q[0] - q), "D looks at how far away the arm is: it is to look at how fast it moves"),
        (0 * right, "kd does nothing: is the last angle kept for the next step, and used before it is written over?"),
    )  # fmt: skip
    return _expect(u, right, slips, "D is not kd times the filtered speed, against the motion")


def _kick(cls):
    q = _constant(0.6, 0.3)
    wanted = q.copy()
    wanted[10:] += 0.2
    u = _run(_make(cls, kp=0.0, kd=_KD, period=_PERIOD), q, wanted)
    if np.abs(u).max() > 1e-6:
        raise Failed(
            f"the target jumps by 0.2 rad, nothing moves, and D kicks with {np.abs(u).max():.0f} counts: which of "
            "the two, target or arm, has a speed that needs damping?"
        )


def _moving(cls):
    wanted = 0.5 * _PERIOD * np.arange(100)[:, None] * np.ones(3)
    u = _run(_make(cls, kp=0.0, kd=_KD, period=_PERIOD), wanted, wanted, speed=0.5)[-1]
    if np.abs(u).max() > 0.01 * 0.5 * _KD.min():
        raise Failed(
            f"the target moves at 0.5 rad/s, the arm moves with it, and D gives {shown(u)} counts: it acts against "
            "what is too fast, and the reference says which speed is wanted"
        )


def _limit_with_d(cls):
    q = np.arange(20)[:, None] * np.array([0.5, -0.5, 0.1])
    if np.abs(_run(_make(cls, kp=0.0, kd=1e3, period=_PERIOD), q)).max() > 255 + 1e-9:
        raise Failed("with D it pushes beyond its limit: limit the sum of all three")


# ---------------------------------------------------------------------------------------------------- stages
def tried_by(*probes):
    """A function that tries a class by all probes in order, and returns what they remark."""

    def tried(cls):
        return " ".join(filter(None, [probe(cls) for probe in probes]))

    return tried


PUSH = (_unit, _push)
MEMORY = (_integral, _shared, lambda cls: _again(cls, "the integral", ki=200.0))
LIMITS = (_limit, _windup, _joint_by_joint)
DAMPING = (
    _damping,
    _kick,
    _moving,
    _limit_with_d,
    lambda cls: _again(cls, "the last angle or the filter's speed", kd=20.0),
)
