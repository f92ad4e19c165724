"""What a student's PID is put through: runs that show one part of it each, and what a wrong one is told."""

import inspect
from functools import cache

import numpy as np

from ir50p_lab.course.checking.forms import no_numbers
from ir50p_lab.course.checking.grade import guarded
from ir50p_lab.course.checking.task import Failed, changed, shown, table
from ir50p_lab.course.loops.functions import controller_loans as loans

_KP, _KI, _KD = np.array([40.0, 60.0, 80.0]), np.array([20.0, 30.0, 40.0]), np.array([10.0, 20.0, 30.0])
_PERIOD = 0.02  # s; not the 0.01 that a student may write down
_SPEED, _ACCELERATION = 0.3, 7.0  # rad/s, rad/s^2 in the reference
_SIGNS = np.array([1.0, -1.0, 1.0])  # joint 2 is driven downwards, the others upwards


def _make(cls, **settings):
    try:
        inspect.signature(cls).bind(**settings)
    except TypeError:
        names = ", ".join(inspect.signature(cls).parameters)
        raise Failed(f"it is made with PID({', '.join(settings)}); its __init__ takes ({names})") from None
    return guarded(lambda: cls(**settings), lambda: f"PID({settings})")


def _run(pid, q, wanted=0.0, speed=0.0):
    """Commands (n, 3) of a controller that is shown q (n, 3) rad, one sample a period, and asked for wanted, speed."""
    try:
        inspect.signature(pid.step).bind(0.0, q, q)
    except TypeError:
        names = ", ".join(inspect.signature(type(pid).step).parameters)
        raise Failed(f"its step takes ({names}); begin it with `def step(self, t, q, reference):`") from None
    q = np.asarray(q, dtype=float)
    rows = np.zeros((len(q), 3, 3))
    rows[:, 0], rows[:, 1], rows[:, 2] = wanted, speed, _ACCELERATION
    commands = np.empty((len(q), 3))
    for k in range(len(q)):

        def what(k=k):
            return f"step({k * _PERIOD:.2f}, {shown(q[k])}, reference), reference = {shown(rows[k])}"

        given = q[k].copy(), rows[k].copy()
        command = guarded(lambda k=k, given=given: pid.step(k * _PERIOD, *given), what)
        for name, now, before in zip(("q", "the reference"), given, (q[k], rows[k]), strict=True):
            if not np.array_equal(now, before):
                raise Failed(
                    f"it changes {name} that it was given: `-=` and the like write into what is another's", what()
                )
        if says := _no_push(command) or no_numbers(command, np.zeros(3)):
            raise Failed(says.replace("it returns", "step returns"), what())
        commands[k] = command
    return commands


def _no_push(command):
    """What is wrong with the form of a push, if it is one of the usual mistakes; else ""."""
    if command is None:
        return "it returns nothing: what is printed or kept does not reach the motors, what `return` gives back does"
    if np.shape(command) == ():
        return "it returns one number: three are asked for, one a joint. Are the joints added up, or two left out?"
    if np.shape(command) == (3, 3):
        return "it returns three rows of three: is the whole reference taken where its first row is asked for?"
    return ""


def _motion(count=40):
    rng = np.random.default_rng(8)
    return rng.uniform(-0.75, 0.75, (count, 3)), rng.uniform(-0.75, 0.75, (count, 3))


def _constant(seconds, value):
    return np.full((round(seconds / _PERIOD), 3), value, dtype=float)


def _expect(u, right, slips, otherwise):
    """Fail with the sentence of the slip that gives these commands; slips: pairs (commands, sentence)."""
    if np.allclose(u, right, atol=1e-6, rtol=1e-9):
        return
    good = np.isclose(u, right, atol=1e-6, rtol=1e-9)
    k = np.flatnonzero(~good.all(axis=1))[0]
    example = f"sample {k} of a run, counts\nexpected: {shown(right[k])}\nyours: {shown(u[k])}"
    for wrong, says in slips:
        if np.allclose(u, wrong, atol=1e-6, rtol=1e-6):
            raise Failed(says, example)
    joints = " and ".join(str(j + 1) for j in np.flatnonzero(good.all(axis=0)))
    raise Failed(f"{otherwise}; joint {joints} is right" if slips and joints else otherwise, example)


def _slips(table_name, commands):
    """Pairs (commands, sentence): what the mistakes of a table send; commands: function of a class."""
    return ((commands(wrong), says) for wrong, says in _wrong_ones(table_name))


@cache
def _wrong_ones(name):
    """Pairs (class, sentence): the mistakes of a table, made in the solution of its stage."""
    text = {"PID.p": loans.P, "PID.pi": loans.PI, "PID": loans.PID}.get(name, loans.LIMITS)
    return [(changed(text, changes, {"np": np})["PID"], says) for says, changes in table(name, __file__)]


# --------------------------------------------------------------------------------------------------------- P
def _unit(cls):
    if getattr(cls, "unit", None) != "PWM":
        raise Failed('it does not say its unit: without `unit = "PWM"` its counts are taken for N m')


def _push(cls, kp):
    q, wanted = _motion()

    def push(other):
        return _run(_make(other, kp=kp), q, wanted, speed=_SPEED)

    u = push(cls)
    _expect(u, np.ones(3) * kp * (wanted - q), _slips("PID.p", push), _push_symptom(cls, kp, q, wanted, u))


def _push_symptom(cls, kp, q, wanted, u):
    """What is seen of a push that is not kp times the error, and no known mistake."""
    e, gain = wanted - q, np.ones(3) * kp
    if not u.any():
        return "it sends 0 whatever is missing: where does kp times the error go?"
    if np.allclose(u, _run(_make(cls, kp=tuple(2 * gain) if np.ndim(kp) else 2 * kp), q, wanted, _SPEED)):
        return "kp does nothing: with twice the kp it pushes the same. Is a number written in its place?"
    still = ~u.any(axis=0)
    if still.any() and np.allclose(u[:, ~still], (gain * e)[:, ~still]):
        joints = " and ".join(str(joint + 1) for joint in np.flatnonzero(still))
        return f"no push reaches joint {joints} (is one joint meant, or a loop left at its first turn?)"
    if np.allclose(u, (found := u[0] / e[0] + 0.0) * e):
        divides = ": it divides by kp" if np.allclose(found * gain, 1) else ""
        return f"for each rad that is missing it pushes with {shown(found)} counts, where kp is {shown(kp)}{divides}"
    if np.allclose(u - gain * e, more := u[0] - gain * e[0]):
        return f"at its target, where nothing is missing, it pushes with {shown(more)} counts"
    if np.allclose(u[0], gain * e[0]):
        return "the first push is right, the later ones are not: does `step` change something in `self`?"
    return "the push is not proportional to what is missing"


def gains(*names):
    """A probe: these gains are kept in `self` and read in every step."""

    def probe(cls):
        q, wanted = _motion(6)
        for name in names:
            made, later = _make(cls, **{"kp": 10.0, name: 20.0}), _make(cls, kp=10.0)
            setattr(later, name, np.full(3, 20.0))
            says = (
                f"self.{name} was changed while it ran, as the live panel does, and nothing happened: keep the gain "
                "there, and read it in every step"
            )
            _expect(_run(later, q, wanted), _run(made, q, wanted), (), says)

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

    def commands(other):
        return _run(_make(other, kp=_KP, ki=_KI, period=_PERIOD), q, wanted)

    u = commands(cls)
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
            _run(_make(cls, kp=_KP, ki=tuple(_KI.tolist()), period=_PERIOD), q, wanted)  # does it stop?
            return says
    memory = _KI * _PERIOD * total
    taken, strip = shown(np.diff((u - push) / _KI, axis=0)[-1]), shown(e[-1] * _PERIOD)
    held = (u - push) / _KI
    kept = np.sum(held[:-1] * (held[1:] - e[1:] * _PERIOD)) / max(np.sum(held[:-1] ** 2), 1e-9)
    otherwise = f"P is right, the memory is not: its last step takes in {taken} rad s, where error x period is {strip}"
    if np.allclose(held[1:], kept * held[:-1] + e[1:] * _PERIOD):
        otherwise = f"its memory keeps only {100 * kept:.3g} % of itself from step to step: it has to keep all"
    return _expect(u, push + memory, _slips("PID.pi", commands), otherwise)


def _again(cls, forgotten, **settings):
    """Whether a run after a reset is the first one again."""
    pid = _make(cls, kp=10.0, period=_PERIOD, **settings)
    if not callable(getattr(pid, "reset", None)):
        raise Failed("it has no `reset`: the second run would begin with the memory of the first")
    q, wanted = _motion(10)
    first = _run(pid, q, wanted)
    guarded(pid.reset)
    says = f"after `reset` it is not as new: {forgotten} of the last run is still there"
    _expect(_run(pid, q, wanted), first, (), says)


# ---------------------------------------------------------------------------------------------------- limits
def _limit(cls):
    e = _constant(0.1, 1.0) * [1.0, -1.0, 0.01]

    def commands(other, **limit):
        return _run(_make(other, kp=400.0, **limit), 0 * e, e)

    u = commands(cls, limit_pwm=100)
    otherwise = f"where kp times the error is [400, -400, 4] and limit_pwm 100, it sends {shown(u[0])}"
    slips = _slips("PID.limits", lambda other: commands(other, limit_pwm=100))
    _expect(u, np.clip(400 * e, -100, 100), slips, otherwise)
    _expect(commands(cls), np.clip(400 * e, -255, 255), (), "without limit_pwm the limit is 255")


def _held(cls, seconds, kp, period=_PERIOD):
    """Commands held at the limit by an error of 1 rad, and for 10 s against one of -1 rad; all as if upwards."""
    wanted = np.vstack([_constant(seconds, 1.0), _constant(10, -1.0)]) * _SIGNS
    return _SIGNS * _run(_make(cls, kp=kp, ki=200.0, period=period), 0 * wanted, wanted)


def _late(run):
    """Samples that each joint pushes on after the error has changed its sign."""
    return (run[-500:] > 0).sum(axis=0)


def _windup(cls):
    runs = [_held(cls, seconds, kp=100.0) for seconds in (10, 20)]
    if (most := max(run.max() for run in runs)) > 255 + 1e-9:
        raise Failed(f"P and I together push with {most:.0f} counts, 255 are allowed: limit their sum")
    if (least := min(run[250:-500].min() for run in runs)) < 250:
        if most < 250:
            raise Failed(f"its memory stops too early: with 1 rad missing it pushes with {most:.0f} counts at most")
        raise Failed(
            f"while the error stays at 1 rad, its push falls back from the limit to {least:.0f}: rest the integral "
            "there, do not throw it away"
        )
    soon, late = map(_late, runs)
    if (winds := late > soon + 5).any():
        if all(abs(_late(_held(cls, seconds, kp=0.0, period=1.0)) - 255).max() < 3 for seconds in (10, 20)):
            raise Failed(
                "its memory has a limit, and far too late: 255 is counts, your memory is in rad s. Multiply by ki "
                "before you add up"
            )
        if says := _wrong_rest(cls):
            raise Failed(f"it winds up: {says}")
        joints = " and ".join(str(joint + 1) for joint in np.flatnonzero(winds))
        where = "" if winds.all() else f" in joint {joints}"
        for sign, word in ((1, "upwards"), (-1, "downwards")):
            if (winds == (_SIGNS == sign)).all():
                where = f" when it pushes {word}"
        raise Failed(
            f"it winds up{where}: after 10 s at its limit it pushes on for {_PERIOD * soon[winds].max():.1f} s against "
            "an error of other sign, after 20 s for longer. What does the integral do while the motor can give no more?"
        )
    full = _held(cls, 3, kp=0.0)
    if full[150].min() < 200:
        raise Failed(
            f"where its memory alone fills the limit and the error changes its sign, the push jumps from "
            f"{full[149].min():.0f} to {full[150].min():.0f} at once: beyond its limit a push keeps its own sign"
        )
    if full[-1].max() > -200:
        raise Failed("once at its limit it never lets go: an error that leads back from the limit has to count")


def _wrong_rest(cls):
    """The sentence for a memory that rests at the wrong time, or never; "" if it is none of these."""
    q, wanted = 4 * _motion(150)[0], 4 * _motion(150)[1] + 2.0  # a memory that has a limit of its own meets it

    def commands(other):
        return _run(_make(other, kp=_KP, ki=10 * _KI, period=_PERIOD), q, wanted)

    u = commands(cls)
    return next((says for wrong, says in _slips("PID.rest", commands) if np.allclose(u, wrong)), "")


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
    settings = {"kp": _KP, "ki": _KI, "limit_pwm": 1e6, "period": _PERIOD, "filter_hz": hz}
    wanted = q[0] + 1.0

    def of_d(other):
        """What kd adds to the commands."""
        with_d = _make(other, **settings, kd=tuple(_KD.tolist()))
        return _run(with_d, q, wanted, _SPEED) - _run(_make(other, **settings), q, wanted, _SPEED)

    u = of_d(cls)
    other = "Yours filters with another share a sample than the course's, of the same cut-off: right, too."
    rights = (
        (_filtered(slope, exact), ""),
        (_filtered(slope, backward), other),
        (_filtered(slope, bilinear, mean=True), other),
    )

    def d(speed):
        return _KD * (_SPEED - speed)

    first = int(u.any() and np.allclose(u[0], 0, atol=1e-6))  # there is no speed yet: D may wait
    for speed, says in rights:
        if np.allclose(u[first:], d(speed)[first:], atol=1e-6):
            return says
    otherwise = "D is not kd times the filtered speed, against the motion"
    share = np.mean((d(0.0) - u[1]) / _KD / slope[1])
    if np.allclose(u[first:], d(_filtered(slope, share))[first:], atol=1e-6):
        otherwise = f"its filter takes {share:.2f} of each new speed: filter_hz 8 and period 0.02 s ask for another"
    slips = ((wrong[first:], says) for wrong, says in _slips("PID", of_d))
    return _expect(u[first:], d(rights[0][0])[first:], slips, otherwise)


def _kick(cls):
    q = _constant(0.6, 0.0)
    wanted = q.copy()
    wanted[10:] += 0.2
    u = np.abs(_run(_make(cls, kp=0.0, kd=_KD, period=_PERIOD), q, wanted))
    if u.max() > 1e-6 + 2 * u[-1].max():
        raise Failed(
            f"the target jumps by 0.2 rad, nothing moves, and D kicks with {u.max():.0f} counts: which of "
            "the two, target or arm, has a speed that needs damping?"
        )


def _gain_of_d(cls):
    moving = np.linspace(0, 0.1, 20)[:, None] * _SIGNS
    for name in ("kp", "ki"):
        still, moved = (_run(_make(cls, **({"kp": 0.0} | {name: 20.0})), q, q) for q in (0 * moving + 0.1, moving))
        if np.abs(still).max() < 1e-6 < np.abs(moved).max():
            raise Failed(
                f"kd is 0, nothing is missing, the arm moves, and with {name} = 20 it pushes: {name} multiplies D. "
                "Which number does self.kd hold, and where does it stand?"
            )


def _order(cls):
    settings = {"kp": 10.0, "ki": 20.0, "kd": 30.0, "limit_pwm": 40.0, "period": 0.05, "filter_hz": 6.0}
    q, wanted = _motion(6)
    by_place = _run(guarded(lambda: cls(*settings.values())), q, wanted)
    own = ", ".join(inspect.signature(cls).parameters)
    says = f"it takes ({own}); it will be made with ({', '.join(settings)}), in this order"
    _expect(by_place, _run(_make(cls, **settings), q, wanted), (), says)


def _rest_with_d(cls):
    """P beyond the limit, D brings the push back within it: the memory has to go on."""
    error, settings = _constant(1, 1.0), {"kp": 300.0, "ki": 20.0, "kd": 400.0, "period": _PERIOD}
    u = _run(_make(cls, **settings), 0 * error, error, speed=-0.5)
    if (u[-1] - u[1] < 0.5 * settings["ki"] * (len(u) - 2) * _PERIOD).any():
        raise Failed(
            f"P alone is beyond the limit, D brings the push back to {u[1].max():.0f} counts, and the memory rests all "
            "the same: what does it ask before it rests, and does D count in it?"
        )


def _limit_with_d(cls):
    q = np.arange(20)[:, None] * np.array([0.5, -0.5, 0.1])
    if np.abs(_run(_make(cls, kp=400.0, kd=1e3, period=_PERIOD), q)).max() > 255 + 1e-9:
        raise Failed("with D it pushes beyond its limit: limit the sum of all three")


# ---------------------------------------------------------------------------------------------------- stages
def tried_by(*probes):
    """A function that tries a class by all probes in order, and returns what they remark."""

    def tried(cls):
        return " ".join(filter(None, [probe(cls) for probe in probes]))

    return tried


PUSH = (_unit, lambda cls: _push(cls, 50), lambda cls: _push(cls, tuple(_KP.tolist())))
MEMORY = (_shared, _integral, lambda cls: _again(cls, "the integral, or the last error if it keeps one,", ki=200.0))
LIMITS = (_limit, _windup, _joint_by_joint)
SPEED = (_gain_of_d,)
DAMPING = (
    _order,
    _kick,
    _damping,
    _limit_with_d,
    _rest_with_d,
    lambda cls: _again(cls, "the last angle or the filter's speed", kd=20.0),
)
