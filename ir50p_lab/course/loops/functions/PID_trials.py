"""What a student's PID is put through: runs that show one part of it each, and what a wrong one is told.

Where one right answer, or one of several (`PID.STAGE.right.txt`), can be told from its commands alone, a table of
mistakes says what else they are (`PID.STAGE.txt`): each row is the loan with a change in its text.
"""

import inspect
from functools import cache
from pathlib import Path

import numpy as np

from ir50p_lab.course.checking.calling import guarded
from ir50p_lab.course.checking.forms import no_numbers
from ir50p_lab.course.checking.task import Failed, changed, shown, solutions, table

LOANS = dict(zip(("PID.p", "PID.pi", "PID.limits", "PID"), solutions("PID.loans", __file__), strict=True))
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
    return np.array([_one_step(pid, k * _PERIOD, q[k], rows[k]) for k in range(len(q))])


def _one_step(pid, t, q, reference):
    def what():
        return f"step({t:.2f}, {shown(q)}, reference), reference = {shown(reference)}"

    given = q.copy(), reference.copy()
    command = guarded(lambda: pid.step(t, *given), what)
    for name, now, before in zip(("q", "the reference"), given, (q, reference), strict=True):
        if not np.array_equal(now, before):
            raise Failed(f"it changes {name} that it was given: `q -= x` writes into it; write `q = q - x`", what())
    if says := _NO_PUSH.get(np.shape(command) if command is not None else None) or no_numbers(command, np.zeros(3)):
        raise Failed(says.replace("it returns", "step returns"), what())
    return np.array(command, dtype=float)


_NO_PUSH = {
    None: "it returns nothing: what is printed or kept does not reach the motors, what `return` gives back does",
    (): "it returns one number: three are asked for, one a joint. Are the joints added up, or two left out?",
    (3, 3): "it returns three rows of three: is the whole reference taken where its first row is asked for?",
}


def _motion(count=40):
    rng = np.random.default_rng(8)
    return rng.uniform(-0.75, 0.75, (count, 3)), rng.uniform(-0.75, 0.75, (count, 3))


def _constant(seconds, value):
    return np.full((round(seconds / _PERIOD), 3), value, dtype=float)


@cache
def _made(stage, name=""):
    """Pairs (class, sentence): what a table makes of the solution of a stage; without a table the solution itself."""
    there = Path(__file__).with_name(f"{name}.txt").exists()
    rows = table(name, __file__) if there else [("", ())] if not name else []
    return [(changed(LOANS[stage], changes, {"np": np})["PID"], says) for says, changes in rows]


def compared(stage, commands, otherwise, name=""):
    """A probe: the commands have to be those of a right one; name: the table of mistakes, else that of the stage."""

    def probe(cls):
        u = commands(cls)
        rights = [*_made(stage), *_made(stage, f"{stage}.right")]
        for right, remark in rights:
            if np.allclose(u, commands(right), atol=1e-6, rtol=1e-9):
                return remark
        expected = commands(rights[0][0])
        good = np.isclose(u, expected, atol=1e-6, rtol=1e-9)
        k = np.flatnonzero(~good.all(axis=1))[0]
        example = f"sample {k} of a run, counts\nexpected: {shown(expected[k])}\nyours: {shown(u[k])}"
        for wrong, says in _made(stage, name or stage):
            if np.allclose(u, commands(wrong), atol=1e-6, rtol=1e-6):
                raise Failed(says, example)
        joints = " and ".join(str(joint + 1) for joint in np.flatnonzero(good.all(axis=0)))
        says = otherwise(cls, u, expected) if callable(otherwise) else otherwise
        raise Failed(f"{says}; joint {joints} is right" if joints else says, example)

    return probe


def _alike(one, other, says):
    if not np.allclose(one, other, atol=1e-6, rtol=1e-9):
        raise Failed(says)


# ------------------------------------------------------------------------------------------------------ P and I
def _unit(cls):
    if getattr(cls, "unit", None) != "PWM":
        raise Failed('it does not say its unit: without `unit = "PWM"` its counts are taken for N m')


def _push(kp):
    return lambda cls: _run(_make(cls, kp=kp), *_motion(), _SPEED)


def _push_symptom(cls, u, expected):
    """What is seen of a push that is not kp times the error, and no known mistake."""
    if np.allclose(u, _push(100)(cls)):
        return "kp does nothing: with twice the kp it pushes the same. Is a number written in its place?"
    if np.allclose(u - expected, more := (u - expected)[0]):
        return f"at its target, where nothing is missing, it pushes with {shown(more)} counts"
    return "the push is not kp times what is missing"


def gains(*names):
    """A probe: these gains are kept in `self` and read in every step."""

    def probe(cls):
        for name in names:
            made, later = _make(cls, **{"kp": 10.0, name: 20.0}), _make(cls, kp=10.0)
            setattr(later, name, np.full(3, 20.0))
            says = f"self.{name} was changed while it ran, as the live panel does, and nothing happened: read it there"
            _alike(_run(later, *_motion()), _run(made, *_motion()), says)

    return probe


def _shared(cls):
    first = _run(_make(cls, kp=10.0, ki=200.0), *_motion())
    one, other = _make(cls, kp=10.0, ki=200.0), _make(cls, kp=20.0, ki=200.0)
    _run(other, *_motion())
    says = "two controllers share one memory: what belongs to one of them goes into `self`, in __init__"
    _alike(_run(one, *_motion()), first, says)


def _memory(cls):
    return _run(_make(cls, kp=_KP, ki=_KI, period=_PERIOD), *_motion())


def _takes_tuples(cls):
    _run(_make(cls, kp=tuple(_KP.tolist()), ki=tuple(_KI.tolist()), period=_PERIOD), *_motion())  # does it stop?


def _memory_symptom(cls, u, expected):
    q, wanted = _motion()
    held, strips = (u - _KP * (wanted - q)) / _KI, (wanted - q) * _PERIOD
    kept = np.sum(held[:-1] * (held[1:] - strips[1:])) / max(np.sum(held[:-1] ** 2), 1e-9)
    if np.allclose(held[1:], kept * held[:-1] + strips[1:]):
        return f"its memory keeps only {100 * kept:.3g} % of itself from step to step: it has to keep all"
    taken = f"its last step takes in {shown(held[-1] - held[-2])} rad s, where error x period is {shown(strips[-1])}"
    return f"P is right, the memory is not: {taken}"


def again(forgotten, **settings):
    """A probe: a run after a reset is the first one again."""

    def probe(cls):
        pid = _make(cls, kp=10.0, period=_PERIOD, **settings)
        if not callable(getattr(pid, "reset", None)):
            raise Failed("it has no `reset`: the second run would begin with the memory of the first")
        first = _run(pid, *_motion())
        guarded(pid.reset)
        _alike(
            _run(pid, *_motion()), first, f"after `reset` it is not as new: {forgotten} of the last run is still there"
        )

    return probe


# ------------------------------------------------------------------------------------------------------- limits
def _limited(**limit):
    e = _constant(0.1, 1.0) * [1.0, -1.0, 0.01]
    return lambda cls: _run(_make(cls, kp=400.0, **limit), 0 * e, e)


def _limited_symptom(cls, u, expected):
    return f"where kp times the error is [400, -400, 4] and limit_pwm 100, it sends {shown(u[0])}"


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
    most, least = max(ten.max(), twenty.max()), min(ten[250:-500].min(), twenty[250:-500].min())
    soon, late = ((run[-500:] > 0).sum(axis=0) for run in (ten, twenty))  # samples of pushing on against the error
    winds = late > soon + 5
    if winds.any():
        u = _rest(cls)
        known = (says for wrong, says in _made("PID.limits", "PID.rest") if np.allclose(u, _rest(wrong)))
        ways = [word for sign, word in ((1, "upwards"), (-1, "downwards")) if (winds == (_SIGNS == sign)).all()]
        where = f" when it pushes {ways[0]}" if ways else ""
        told = (
            f"it winds up{where}: after 10 s at its limit it pushes on for {_PERIOD * soon[winds].max():.1f} s against "
        )
        told += "an error of other sign, after 20 s for longer. What does the integral do at the limit?"
        told = next((f"it winds up: {says}" for says in known), told)
    for wrong, says in (
        (most > 255 + 1e-9, f"P and I together push with {most:.0f} counts, 255 are allowed: limit their sum"),
        (most < 250, f"its memory stops too early: with 1 rad missing it pushes with {most:.0f} counts at most"),
        (
            least < 250,
            f"while the error stays, its push falls back from the limit to {least:.0f}: rest the integral there",
        ),
        (winds.any(), told if winds.any() else ""),
        (
            memory[150].min() < 200,
            "when the error changes its sign, the push at its limit jumps from 255 to -255 at once",
        ),
        (memory[-1].max() > -200, "once at its limit it never lets go: an error that leads back has to count"),
    ):
        if wrong:
            raise Failed(says)


def _joint_by_joint(cls):
    wanted, settings = _constant(1, 1.0) * [0.01, 0.02, 0.03], {"kp": 200.0, "ki": 100.0, "period": _PERIOD}
    calm, beside = (_run(_make(cls, **settings), 0 * wanted, wanted + far * np.eye(3)[0]) for far in (0, 5))
    says = "while joint 1 is at its limit, the integrals of the others rest as well: decide joint by joint (np.where)"
    _alike(beside[:, 1:], calm[:, 1:], says)


# ------------------------------------------------------------------------------------------------------------ D
def _damping(cls):
    """What kd adds to the commands after the first sample, when there is no speed yet."""
    q, settings = _motion()[0], {"kp": _KP, "ki": _KI, "limit_pwm": 1e6, "period": _PERIOD, "filter_hz": 8.0}
    with_d, without = _make(cls, **settings, kd=tuple(_KD)), _make(cls, **settings)
    return (_run(with_d, q, q[0] + 1.0, _SPEED) - _run(without, q, q[0] + 1.0, _SPEED))[1:]


def _kick(cls):
    wanted = np.where(np.arange(30)[:, None] < 10, 0.0, [0.2, 0.2, 0.2])
    u = np.abs(_run(_make(cls, kp=0.0, kd=_KD, period=_PERIOD), 0 * wanted, wanted))
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
                f"kd is 0, nothing is missing, the arm moves, and with {name} = 20 it pushes: {name} multiplies D"
            )


def _order(cls):
    settings = {"kp": 10.0, "ki": 20.0, "kd": 30.0, "limit_pwm": 40.0, "period": 0.05, "filter_hz": 6.0}
    own = ", ".join(inspect.signature(cls).parameters)
    by_place = _run(guarded(lambda: cls(*settings.values())), *_motion())
    says = f"it takes ({own}); it will be made with ({', '.join(settings)}), in this order"
    _alike(by_place, _run(_make(cls, **settings), *_motion()), says)


def _limits_with_d(cls):
    q = np.arange(20)[:, None] * np.array([0.5, -0.5, 0.1])
    if np.abs(_run(_make(cls, kp=400.0, kd=1e3, period=_PERIOD), q)).max() > 255 + 1e-9:
        raise Failed("with D it pushes beyond its limit: limit the sum of all three")
    error = _constant(1, 1.0)
    u = _run(_make(cls, kp=300.0, ki=20.0, kd=400.0, period=_PERIOD), 0 * error, error, speed=-0.5)
    if (u[-1] - u[1] < 0.5 * 20.0 * (len(u) - 2) * _PERIOD).any():
        raise Failed(
            "P alone is beyond the limit, D brings the push back, and the memory rests all the same: does D count?"
        )


# ------------------------------------------------------------------------------------------------------- stages
_PUSH = (_unit, compared("PID.p", _push(50), _push_symptom), compared("PID.p", _push(tuple(_KP)), _push_symptom))
_MEMORY = (
    _shared,
    compared("PID.pi", _memory, _memory_symptom),
    _takes_tuples,
    again("the integral, or an error it keeps,", ki=200.0),
)
_LIMITS = (
    compared("PID.limits", _limited(limit_pwm=100), _limited_symptom),
    compared("PID.limits", _limited(), "without limit_pwm the limit is 255"),
    _windup,
    _joint_by_joint,
)
_DAMPING = (
    _order,
    _kick,
    compared("PID", _damping, "D is not kd times the filtered speed, against the motion"),
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
    """Try a class by all probes of a stage in order; returns what they remark. Raises Failed."""
    return " ".join(filter(None, [probe(cls) for probe in PROBES[stage]]))
