"""The widget LiveArm: what Python tells the view in the browser, and what it hears from it."""

import base64
import gzip
import json
import threading
from pathlib import Path

import anywidget
import ipywidgets
import numpy as np
import traitlets

from ir50p_lab.browser_tab import IN_BROWSER, needs_more
from ir50p_lab.course.checking.calling import call_or_fail
from ir50p_lab.course.checking.note import Note, show
from ir50p_lab.course.checking.shape_checks import no_numbers
from ir50p_lab.course.checking.task import Failed
from ir50p_lab.course.draw.arm3d import ArmView
from ir50p_lab.course.draw.painter import DRAWING, Painter
from ir50p_lab.course.draw.style import COLOURS, new_figure
from ir50p_lab.course.live_arm.badge import badge_of
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import vectors3
from ir50p_lab.modelling.chain import forward_kinematics, lengths

BUNDLE = Path(__file__).parent / "static" / "live_arm.js"  # the script that draws, as built by npm
_MOST = 600  # rows of a motion: 40 kB in a saved notebook, 20 a second for half a minute; the view interpolates


class Bundle(anywidget.AnyWidget):  # whose bytes, unlike those of an ipywidgets.Widget, JupyterLab saves
    """Holds the script for all views of a notebook, so that a saved notebook has it once."""

    _esm = "export default {}"
    packed = traitlets.Bytes().tag(sync=True)
    shared = None

    @classmethod
    def get(cls):
        """Return the Bundle of this kernel."""
        if cls.shared is None or cls.shared.comm is None:
            cls.shared = cls(packed=gzip.compress(BUNDLE.read_bytes(), 9, mtime=0))
        return cls.shared


class LiveArm(anywidget.AnyWidget):
    """The arm in 3-D; shown if it is the last line of a cell.

    Args:
        arm: Arm. q: (3,) rad, where it starts.
        on_drag: f(p, q_now) -> q or None, moves the arm when its tip is dragged to p (3,) m; None: inverse kinematics
        in the browser. frames: f(q) -> (4, 4, 4), transforms of frames 0 to 3 to the base, by which the arm is drawn,
        even if they are wrong. badge: whose code moves the arm, 'yours' or "the course's"; by default found from them.
        layers: which of table, shadow, trail, frames, joint axes, velocity ellipsoid, force ellipsoid, ball are shown
        at first. ball: (p, radius) m, p (3,) or, for several, (n, 3). height: CSS pixels; sliders: whether the joints
        have them. in_space: without table, stops and set point, for motions that know none of them.

    Attributes: q, list of rad, in both directions; layers.
    `play(run)` shows a motion. Raises InputError for what cannot be drawn. If `frames` gives no frames, a
    sentence says so, and the arm is drawn by the course's.
    """

    _esm = BUNDLE.parents[1] / "loader.js"
    bundle = traitlets.Instance(ipywidgets.Widget).tag(sync=True, **ipywidgets.widget_serialization)
    options = traitlets.Dict().tag(sync=True)
    q = traitlets.List().tag(sync=True)
    layers = traitlets.List().tag(sync=True)
    poses = traitlets.List().tag(sync=True)
    track = traitlets.Bytes(b"").tag(sync=True)
    shape = traitlets.Dict().tag(sync=True)
    description = traitlets.Unicode().tag(sync=True)

    def __init__(self, arm, q=(0.0, 0.0, 0.0), *, on_drag=None, frames=None, badge=None,
                 layers=("table", "shadow", "trail"), ball=None,
                 height=420, sliders=True, in_space=False):  # fmt: skip
        self.arm, self._on_drag, self._frames = arm, on_drag, frames
        self._stop = threading.Event()
        ball = None if ball is None else (vectors3("ball", ball[0], unit="m").reshape(-1, 3), float(ball[1]))
        options = {
            "lengths": lengths(arm),  # refuses what is not an Arm
            "limits": np.clip([arm.q_min, arm.q_max], -np.pi, np.pi).T,
            "badge": badge or badge_of(on_drag or frames),
            "drag": "browser" if on_drag is None else "kernel",
            "height": height,
            "sliders": sliders,
            "in_space": in_space,
            "ball": ball,
        }
        super().__init__(
            bundle=Bundle.get(),
            options=json.loads(json.dumps(options, default=lambda array: array.tolist())),
            q=vectors3("q", q).tolist(),
            layers=[name for name in layers if not in_space or name == "trail"] + ["ball"] * bool(ball),
        )
        if frames is not None:
            self._begin()
        self.on_msg(self._heard)

    def play(self, *runs, labels=None, speed=1.0):
        """Show a motion, or two side by side, with a bar to play, pause and scrub, and curves over time.

        Args: runs: SimulationResult, Recording, anything with t and q; or one open Bench or LiveRun, which is
        followed 25 times a second until it ends and can then be played. labels: a name for each run; speed: times
        real time.
        Returns: the view. Raises InputError for runs that cannot be shown.
        """
        self._stop.set()
        self.options = self.options | {"speed": speed}
        if hasattr(runs[0], "is_open") or hasattr(runs[0], "alive"):
            if IN_BROWSER:
                needs_more("to follow an open bench needs threads")
            self._stop = threading.Event()
            threading.Thread(target=self._follow, args=(runs[0], self._stop), daemon=True).start()
        else:
            self._show(runs, labels or (["first", "second"][: len(runs)] if len(runs) > 1 else [""]))
        return self

    def _show(self, runs, labels):
        rows, self.shape = pack(runs, labels, wanted=not self.options["in_space"])
        self._shown = runs[0]
        self.q = [float(v) for v in runs[0].q[0]]
        self.track = rows

    def _begin(self):
        """Draw the arm by its own frames; if they are none, say so as `check` does, and draw it by the course's."""
        try:
            self._pose(self.q)
        except Failed as stopped:
            self._frames, self.options = None, self.options | {"badge": "the course's"}
            show(Note("mistake", "the arm below is the course's", stopped.args[0]))

    def _pose(self, q):
        T = call_or_fail(lambda: self._frames(np.array(q)))
        if says := no_numbers(T, np.full((4, 4, 4), np.nan)):  # numbers that are not finite are left out
            raise Failed(f"of frames 0 to 3: {says}")
        T = np.array(T, dtype=float)
        self.poses = np.where(np.isfinite(T), T, None).tolist()

    def _follow(self, source, stop):
        """Send the last samples of a bench or of a loop in the background; when a run has ended, the whole of it."""
        words = "live, simulated" if getattr(source, "simulated", False) else "live"
        sent, fresh, alive = None, False, True
        while alive and not stop.wait(0.04) and self.comm is not None:
            alive = getattr(source, "is_open", None) or getattr(source, "alive", False)
            run = getattr(source, "live_run", source) or source.recording
            runs = getattr(run, "alive", alive)  # asked before its samples: after the whole no window follows
            samples = run.recent(10.0) if run is not None else None
            if samples is not None and len(samples.t) > 1 and samples.t[-1] != sent:
                sent, fresh = samples.t[-1], True
                rows, shape = pack([samples], [""])
                shape |= {"source": words, "push": getattr(run, "most_push", 0.0)}
                self._live = run
                self.send({"live": shape}, buffers=[rows])
            if fresh and not runs:
                fresh = False
                self._show([getattr(run, "recording", run)], [""])

    def _heard(self, _, message, __):
        """What the browser asks for: frames, a drag, a push or a picture. The answer bears the names of the question.

        Errors of the student's function are shown under the arm.
        """
        answer, buffers = dict.fromkeys(message), []
        try:
            if "frames" in message:
                self._pose(message["frames"])
            elif "push" in message:
                self._live.push(*message["push"])
            elif "picture" in message:
                buffers = [still_png(self)]
            else:
                q = call_or_fail(lambda: self._on_drag(np.array(message["drag"]), np.array(message["q"])))
                if q is not None:
                    self.q = answer["drag"] = vectors3("q", q).tolist()
        except Exception as error:
            answer["error"] = error.args[0] if isinstance(error, Failed) else f"{type(error).__name__}: {error}"
        self.send(answer, buffers=buffers)

    def _repr_mimebundle_(self, **kwargs):
        """The widget, and the picture of this moment for viewers without one."""
        self.description = self._words()
        data, metadata = super()._repr_mimebundle_(**kwargs)
        picture = base64.b64encode(still_png(self)).decode("ascii")
        return {"image/png": picture, **data}, metadata | {"image/png": {"alt": self.description}}

    def _words(self):
        """What the picture shows, for those who do not see it."""
        angles = ", ".join(f"{angle:.0f}" for angle in np.degrees(self.q))
        tip = np.array(self.poses, dtype=float)[3, :3, 3] if self.poses else forward_kinematics(self.arm, self.q)
        x, y, z = tip
        plays = f"; it plays a motion of {np.ptp(self._shown.t):.1f} s" if self.track else ""
        badge = self.options["badge"]
        return f"The arm in 3-D, {badge}: joints at {angles} degrees, tip at x {x:.3f}, y {y:.3f}, z {z:.3f} m{plays}"


def pack(runs, labels, *, wanted=True):
    """Return the rows of one or two runs on a common time, and what their columns hold.

    Args: runs: each with t (n,) s and q (n, 3) rad; optional reference (n, 3) or (n, 3, 3) rad, u (n, 3), unit,
    simulated (bool). labels: a name for each; wanted: with the set point.
    Returns: bytes of float32 (rows, columns), time first; dict for the browser. Raises InputError for runs that
    cannot be shown.
    """
    times = [np.asarray(run.t, dtype=float) for run in runs]
    if len(runs) > 2 or len(labels) != len(runs) or min(map(len, times)) < 2:
        raise InputError("give one or two runs of two samples or more, and a label for each")
    even = np.linspace(min(one[0] for one in times), max(one[-1] for one in times), min(_MOST, max(map(len, times))))
    t = times[0] if len(runs) == 1 and len(even) == len(times[0]) else even
    columns, places = [t], []
    for run, time, label in zip(runs, times, labels, strict=True):
        place = {"label": label, "reference": None, "u": None}
        held = np.clip(np.searchsorted(time, t + 1e-9, side="right") - 1, 0, len(time) - 1)
        for name in ("q", "reference", "u"):
            values = None if name == "reference" and not wanted else getattr(run, name, None)
            if values is not None and np.isfinite(values).any():
                place[name] = len(columns)
                values = np.reshape(values, (len(time), -1))  # of a reference, angles first
                columns += [values[held, i] if name == "u" else np.interp(t, time, values[:, i]) for i in range(3)]
        places.append(place)
    source = {True: "simulated", False: "measured"}.get(getattr(runs[0], "simulated", None), "")
    shape = {"columns": len(columns), "runs": places, "unit": getattr(runs[0], "unit", "PWM"), "source": source}
    return np.column_stack(columns).astype("<f4").tobytes(), shape


def still_png(view):
    """Return a PNG file, as bytes, of a LiveArm's present pose, and of its path if it plays a run."""
    with DRAWING:
        figure = new_figure(7.2, 4.6, projection="3d")
        ax = figure.axes[0]
        arm = ArmView(ax, view.arm, view.q, frames="frames" in view.layers)
        if view.track and "trail" in view.layers:
            arm.trail(forward_kinematics(view.arm, view._shown.q))
        if view.options["ball"]:
            ax.scatter(*np.transpose(view.options["ball"][0]), s=230, color="#C8102E")
        if view.poses:
            if "frames" in view.layers:
                ax.view_init(elev=22, azim=-30)  # no axis hides another
            arm.place(np.array(view.poses, dtype=float))
        arm.ellipsoids(view.layers)
        ax.text2D(0.02, 0.95, view.options["badge"], transform=ax.transAxes, color=COLOURS["dark"], weight="bold")
        return Painter(figure).png()
