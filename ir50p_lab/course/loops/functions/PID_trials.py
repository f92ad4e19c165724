"""What a student's PID is put through: runs that each show one part of it, and what is said of a wrong one.

If a right answer can be recognised by its commands alone, a table says what other commands mean: a mistake, or another
right answer ("also right" in PID.STAGE.txt). What the other trials say is in PID.txt, each sentence with its key.
"""

import inspect
from functools import cache

import numpy as np

from ir50p_lab.course.checking.calling import call_or_fail
from ir50p_lab.course.checking.shape_checks import no_numbers
from ir50p_lab.course.checking.task import Failed, apply_changes, changes_of, sections, sentences, short_text

LOANS = {stage: sections(stage, __file__)["solution"] for stage in ("PID.p", "PID.pi", "PID.limits", "PID")}
_SAYS = sentences("PID", __file__)
_KP, _KI, _KD = np.array([40.0, 60.0, 80.0]), np.array([20.0, 30.0, 40.0]), np.array([10.0, 20.0, 30.0])
_PERIOD = 0.02  # s; not the 0.01 that a student may write down
_SPEED, _ACCELERATION = 0.3, 7.0  # rad/s, rad/s^2 in the reference
_SIGNS = np.array([1.0, -1.0, 1.0])  # joint 2 is driven downwards, the others upwards


def _failed(key, *values):
    return Failed(_SAYS[key].format(*values))


def _alike(one, other, key, *values):
    if not np.allclose(one, other, atol=1e-6, rtol=1e-9):
        raise _failed(key, *values)


def _at_most(values, bound, key, *more):
    """Raise Failed where the largest of some values is beyond a bound; its sentence may name that one."""
    if np.max(values) > bound:
        raise _failed(key, np.max(values), *more)


def _at_least(values, bound, key):
    if np.min(values) < bound:
        raise _failed(key, np.min(values))


def _make(cls, **settings):
    try:
        inspect.signature(cls).bind(**settings)
    except TypeError:
        names = ", ".join(inspect.signature(cls).parameters)
        raise _failed("made with", ", ".join(settings), names) from None
    return call_or_fail(lambda: cls(**settings), lambda: f"PID({settings})")


def _run(pid, q, wanted=0.0, speed=0.0):
    """Commands (n, 3) of a controller that is shown q (n, 3) rad, one sample a period, and asked for wanted, speed."""
    try:
        inspect.signature(pid.step).bind(0.0, q, q)
    except TypeError:
        names = ", ".join(inspect.signature(type(pid).step).parameters)
        raise _failed("step takes", names) from None
    q = np.asarray(q, dtype=float)
    rows = np.zeros((len(q), 3, 3))
    rows[:, 0], rows[:, 1], rows[:, 2] = wanted, speed, _ACCELERATION
    return np.array([_one_step(pid, k * _PERIOD, q[k], rows[k]) for k in range(len(q))])


def _one_step(pid, t, q, reference):
    def what():
        return f"step({t:.2f}, {short_text(q)}, reference), reference = {short_text(reference)}"

    given = q.copy(), reference.copy()
    command = call_or_fail(lambda: pid.step(t, *given), what)
    for name, now, before in zip(("q", "the reference"), given, (q, reference), strict=True):
        if now.tobytes() != before.tobytes():  # quicker than by their numbers
            raise Failed(_SAYS["changes"].format(name), what())
    kind = "nothing" if command is None else f"shape {np.shape(command)}"
    if says := _SAYS.get(kind) or no_numbers(command, np.zeros(3)):
        raise Failed(says.replace("it returns", "step returns"), what())
    return np.array(command, dtype=float)


def _motion(count=40):
    rng = np.random.default_rng(8)
    return rng.uniform(-0.75, 0.75, (count, 3)), rng.uniform(-0.75, 0.75, (count, 3))


def _constant(seconds, value):
    return np.full((round(seconds / _PERIOD), 3), value, dtype=float)


@cache
def _made(stage, heading):
    """Pairs (class, sentence): what the table under a heading of PID.STAGE.txt makes of the solution of that stage."""
    rows = changes_of(sections(stage, __file__).get(heading, ""))
    return [(apply_changes(LOANS[stage], changes, {"np": np})["PID"], says) for says, changes in rows]


def compared(stage, commands, otherwise, heading="mistakes"):
    """Return a probe: the commands have to be those of a right PID. heading: of the table of mistakes."""

    def probe(cls):
        u = commands(cls)
        rights = [(apply_changes(LOANS[stage], (), {"np": np})["PID"], ""), *_made(stage, "also right")]
        for right, remark in rights:
            if np.allclose(u, commands(right), atol=1e-6, rtol=1e-9):
                return remark
        expected = commands(rights[0][0])
        good = np.isclose(u, expected, atol=1e-6, rtol=1e-9)
        k = np.flatnonzero(~good.all(axis=1))[0]
        example = f"sample {k} of a run, counts\nexpected: {short_text(expected[k])}\nyours: {short_text(u[k])}"
        for wrong, says in _made(stage, heading):
            if np.allclose(u, commands(wrong), atol=1e-6, rtol=1e-6):
                raise Failed(says, example)
        joints = " and ".join(str(joint + 1) for joint in np.flatnonzero(good.all(axis=0)))
        says = otherwise(cls, u, expected) if callable(otherwise) else _SAYS[otherwise].format(short_text(u[k]))
        raise Failed(f"{says}; joint {joints} is right" if joints else says, example)

    return probe


# ------------------------------------------------------------------------------------------------------ P and I
def _unit(cls):
    if getattr(cls, "unit", None) != "PWM":
        raise _failed("unit")


def _push_symptom(cls, u, expected):
    """What is seen of a push that is not kp times the error, and no known mistake."""
    if np.allclose(u, _on_the_move(kp=100)(cls)):
        return _SAYS["kp does nothing"]
    if np.allclose(u - expected, more := (u - expected)[0]):
        return _SAYS["push at the target"].format(short_text(more))
    return _SAYS["push"]


def gains(*names):
    """Return a probe: these gains have to be kept in `self` and read in every step."""

    def probe(cls):
        for name in names:
            made, later = _make(cls, **{"kp": 10.0, name: 20.0}), _make(cls, kp=10.0)
            setattr(later, name, np.full(3, 20.0))
            _alike(_run(later, *_motion()), _run(made, *_motion()), "gain read once", name)

    return probe


def _on_the_move(speed=_SPEED, **settings):
    """The commands of a controller with these settings, of any class, while the arm and its target move."""
    return lambda cls: _run(_make(cls, **settings), *_motion(), speed)


def _shared(cls):
    first = _run(_make(cls, kp=10.0, ki=200.0), *_motion())
    one, other = _make(cls, kp=10.0, ki=200.0), _make(cls, kp=20.0, ki=200.0)
    _run(other, *_motion())
    _alike(_run(one, *_motion()), first, "shared")


def again(forgotten, **settings):
    """Return a probe: a run after a reset has to be the same as the first one."""

    def probe(cls):
        pid = _make(cls, kp=10.0, period=_PERIOD, **settings)
        if not callable(getattr(pid, "reset", None)):
            raise _failed("no reset")
        first = _run(pid, *_motion())
        call_or_fail(pid.reset)
        _alike(_run(pid, *_motion()), first, "reset", forgotten)

    return probe


# ------------------------------------------------------------------------------------------------------- limits
def _limited(**limit):
    e = _constant(0.1, 1.0) * [1.0, -1.0, 0.01]
    return lambda cls: _run(_make(cls, kp=400.0, **limit), 0 * e, e)


def _held(cls, seconds, kp):
    """Commands held at the limit by an error of 1 rad, and for 10 s against one of -1 rad; all as if upwards."""
    wanted = np.vstack([_constant(seconds, 1.0), _constant(10, -1.0)]) * _SIGNS
    return _SIGNS * _run(_make(cls, kp=kp, ki=200.0, period=_PERIOD), 0 * wanted, wanted)


def _rest(cls):
    q, wanted = _motion(300)
    there = np.where(np.arange(300) < 150, 3.0, -3.0)[:, None]  # a memory that has a limit of its own meets it
    return _run(_make(cls, kp=_KP, ki=10 * _KI, period=1.0), 4 * q, 4 * wanted + there)


def _windup(cls):
    ten, twenty, memory = _held(cls, 10, 100.0), _held(cls, 20, 100.0), _held(cls, 3, 0.0)
    _at_most([ten.max(), twenty.max()], 255 + 1e-9, "sum beyond its limit")
    _at_least(max(ten.max(), twenty.max()), 250, "stops too early")
    _at_least([ten[250:-500].min(), twenty[250:-500].min()], 250, "falls back")
    soon, late = ((run[-500:] > 0).sum(axis=0) for run in (ten, twenty))  # samples of pushing on against the error
    if (late > soon + 5).any():
        compared("PID.limits", _rest, "winds up", "mistakes in a long run")(cls)
        raise _failed("winds up")
    _at_least(memory[150], 200, "jumps")
    _at_most(memory[-1], -200, "never lets go")


def _joint_by_joint(cls):
    wanted, settings = _constant(1, 1.0) * [0.01, 0.02, 0.03], {"kp": 200.0, "ki": 100.0, "period": _PERIOD}
    calm, beside = (_run(_make(cls, **settings), 0 * wanted, wanted + far * np.eye(3)[0]) for far in (0, 5))
    _alike(beside[:, 1:], calm[:, 1:], "joint by joint")


# ------------------------------------------------------------------------------------------------------------ D
def _damping(cls):
    """What kd adds to the commands after the first sample, when there is no speed yet."""
    q, settings = _motion()[0], {"kp": _KP, "ki": _KI, "limit_pwm": 1e6, "period": _PERIOD, "filter_hz": 8.0}
    with_d, without = _make(cls, **settings, kd=tuple(_KD)), _make(cls, **settings)
    return (_run(with_d, q, q[0] + 1.0, _SPEED) - _run(without, q, q[0] + 1.0, _SPEED))[1:]


def _kick(cls):
    wanted = np.where(np.arange(30)[:, None] < 10, 0.0, [0.2, 0.2, 0.2])
    u = np.abs(_run(_make(cls, kp=0.0, kd=_KD, period=_PERIOD), 0 * wanted, wanted))
    _at_most(u, 1e-6 + 2 * u[-1].max(), "kicks")


def _gain_of_d(cls):
    moving = np.linspace(0, 0.1, 20)[:, None] * _SIGNS
    for name in ("kp", "ki"):
        still, moved = (_run(_make(cls, **({"kp": 0.0} | {name: 20.0})), q, q) for q in (0 * moving + 0.1, moving))
        if np.abs(still).max() < 1e-6 < np.abs(moved).max():
            raise _failed("multiplies D", name)


def _order(cls):
    settings = {"kp": 10.0, "ki": 20.0, "kd": 30.0, "limit_pwm": 40.0, "period": 0.05, "filter_hz": 6.0}
    own = ", ".join(inspect.signature(cls).parameters)
    by_place = _run(call_or_fail(lambda: cls(*settings.values())), *_motion())
    _alike(by_place, _run(_make(cls, **settings), *_motion()), "order", own, ", ".join(settings))


def _limits_with_d(cls):
    q = np.arange(20)[:, None] * np.array([0.5, -0.5, 0.1])
    _at_most(np.abs(_run(_make(cls, kp=400.0, kd=1e3, period=_PERIOD), q)), 255 + 1e-9, "D beyond its limit")
    error = _constant(1, 1.0)
    u = _run(_make(cls, kp=300.0, ki=20.0, kd=400.0, period=_PERIOD), 0 * error, error, speed=-0.5)
    _at_least(u[-1] - u[1], 0.5 * 20.0 * (len(u) - 2) * _PERIOD, "does D count")


# ------------------------------------------------------------------------------------------------------- stages
_PUSH = (
    _unit,
    compared("PID.p", _on_the_move(kp=50), _push_symptom),
    compared("PID.p", _on_the_move(kp=tuple(_KP)), _push_symptom),
)
_MEMORY = (
    _shared,
    compared("PID.pi", _on_the_move(0.0, kp=_KP, ki=_KI, period=_PERIOD), "memory"),
    compared("PID.pi", _on_the_move(0.0, kp=tuple(_KP), ki=tuple(_KI), period=_PERIOD), "memory"),
    again("the integral, or an error it keeps,", ki=200.0),
)
_LIMITS = (
    compared("PID.limits", _limited(limit_pwm=100), "limited"),
    compared("PID.limits", _limited(), "default limit"),
    _windup,
    _joint_by_joint,
)
_DAMPING = (
    _order,
    _kick,
    compared("PID", _damping, "damping"),
    _limits_with_d,
    again("the last angle or the filter's speed", kd=20.0),
)
PROBES = {
    "PID.p": (*_PUSH, gains("kp")),
    "PID.pi": (*_PUSH, *_MEMORY, gains("kp", "ki")),
    "PID.limits": (*_PUSH, *_MEMORY, *_LIMITS, gains("kp", "ki")),
    "PID": (_gain_of_d, *_PUSH, *_MEMORY, *_LIMITS, *_DAMPING, gains("kp", "ki", "kd")),
}


def tried(stage, cls):
    """Try a class with all probes of a stage in order; return what they remark. Raises Failed."""
    remarks = filter(None, [probe(cls) for probe in PROBES[stage]])
    return " ".join(dict.fromkeys(remarks))  # each once
