"""The widget LiveArm: what Python says to the view in the browser, and hears from it."""

import base64
import gzip
import hashlib
import json
import threading
import weakref
from pathlib import Path

import anywidget
import ipywidgets
import numpy as np
import traitlets

from ir50p_lab.course.badge import badge_of
from ir50p_lab.course.live_arm.still import still_png
from ir50p_lab.course.live_arm.track import pack
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import vectors3
from ir50p_lab.modelling.chain import lengths

BUNDLE = Path(__file__).parent / "static" / "live_arm.js"  # the script that draws, as built by npm
LAYERS = ("table", "shadow", "ghost", "trail")
_WINDOW = 10.0  # s of a live run that are shown


class Bundle(anywidget.AnyWidget):
    """Holds the script for all views of a notebook, so that a saved notebook has it once."""

    _esm = "export default {};"
    packed = traitlets.Bytes().tag(sync=True)
    digest = traitlets.Unicode().tag(sync=True)
    shared = None

    @classmethod
    def get(cls):
        """The one of this kernel."""
        if cls.shared is None or cls.shared.comm is None:
            script = BUNDLE.read_bytes()
            cls.shared = cls(packed=gzip.compress(script, 9, mtime=0), digest=hashlib.sha256(script).hexdigest())
        return cls.shared


class LiveArm(anywidget.AnyWidget):
    """The arm in 3-D; shown when it is the last line of a cell.

    Args:
        arm: Arm. q: (3,) rad, where it starts.
        on_drag: f(p, q_now) -> q or None, moves the arm when its tip is dragged to p (3,) m; None: inverse kinematics
        in the browser. frames: f(q) -> (4, 4, 4), transforms of frames 0 to 3 to the base: the arm is drawn by them,
        wrong ones too. badge: whose code moves the arm, 'yours' or "the course's"; by default told from them.
        layers: which of table, shadow, ghost, trail, frames, joint axes, velocity ellipsoid, force ellipsoid,
        workspace, ball, board, camera are shown at first. ball: (p, radius) m; board: (T, square, (columns, rows)),
        T (4, 4) of the checkerboard's first inner corner; camera: (K, T, (width, height)), T camera to base.
        height: CSS pixels; sliders: of the joints; readout: where the tip is, in numbers (the menu has a switch too).

    Attributes: q, list of rad, in both directions; layers.
    `play(run)` shows a motion. Raises InputError for what cannot be drawn, and what `frames` raises at first.
    """

    _esm = BUNDLE.parents[1] / "loader.js"
    bundle = traitlets.Instance(ipywidgets.Widget).tag(sync=True, **ipywidgets.widget_serialization)
    options = traitlets.Dict().tag(sync=True)
    q = traitlets.List().tag(sync=True)
    layers = traitlets.List().tag(sync=True)
    poses = traitlets.List().tag(sync=True)
    track = traitlets.Bytes(b"").tag(sync=True)
    shape = traitlets.Dict().tag(sync=True)

    def __init__(self, arm, q=(0.0, 0.0, 0.0), *, on_drag=None, frames=None, badge=None, layers=LAYERS, ball=None,
                 board=None, camera=None, height=420, sliders=True, readout=True):  # fmt: skip
        self.arm, self._on_drag, self._frames = arm, on_drag, frames
        self._stop = threading.Event()
        ball = None if ball is None else (vectors3("ball", ball[0], unit="m"), float(ball[1]))
        things = {"ball": ball, "board": board, "camera": camera}
        things = {name: thing for name, thing in things.items() if thing is not None}
        options = {
            "lengths": lengths(arm),  # refuses what is no Arm
            "limits": np.clip([arm.q_min, arm.q_max], -np.pi, np.pi).T,
            "badge": badge or badge_of(on_drag or frames),
            "drag": "browser" if on_drag is None else "kernel",
            "frames": frames is not None,
            "height": height,
            "sliders": sliders,
            "readout": readout,
            "things": things,
        }
        super().__init__(
            bundle=Bundle.get(),
            options=json.loads(json.dumps(options, default=lambda array: array.tolist())),
            q=vectors3("q", q).tolist(),
            layers=[*layers, *things],
        )
        if frames is not None:
            self._pose(self.q)
        self.on_msg(self._heard)

    def play(self, *runs, labels=None, speed=1.0, loop=False):
        """Show a motion, or two side by side, with a bar to play, pause and scrub, and curves over time.

        Args: runs: SimulationResult, Recording, anything with t and q; or one open Bench or LiveRun, which is
        followed 25 times a second until it ends and can then be played. labels: a name for each run; speed: times
        real time; loop: again and again.
        Returns: the view. Raises InputError for runs that cannot be shown.
        """
        self._stop.set()
        self.options = self.options | {"speed": speed, "loop": loop}
        if hasattr(runs[0], "is_open") or hasattr(runs[0], "alive"):
            self._stop = threading.Event()
            threading.Thread(target=_feed, args=(weakref.ref(self), runs[0], self._stop), daemon=True).start()
        else:
            self._show(runs, labels or (["first", "second"][: len(runs)] if len(runs) > 1 else [""]))
        return self

    def _show(self, runs, labels):
        rows, self.shape = pack(runs, labels)
        self.q = [float(v) for v in runs[0].q[0]]
        self.track = rows

    def _pose(self, q):
        T = np.asarray(self._frames(np.array(q)), dtype=float)
        if T.shape != (4, 4, 4):
            raise InputError(f"frames of shape {T.shape}: give (4, 4, 4), the transforms of frames 0 to 3")
        self.poses = np.where(np.isfinite(T), T, None).tolist()

    def _heard(self, _, message, __):
        """What the browser asks for. Errors of the student's function are shown under the arm."""
        answer, buffers = {}, []
        try:
            if "frames" in message:
                answer["posed"] = True
                self._pose(message["frames"])
            elif "drag" in message:
                answer["dragged"] = None
                q = self._on_drag(np.array(message["drag"]), np.array(message["q"]))
                if q is not None:
                    self.q = answer["dragged"] = vectors3("q", q).tolist()
            else:
                answer["picture"] = True
                buffers = [still_png(self)]
        except Exception as error:
            answer["error"] = f"{type(error).__name__}: {error}"
        self.send(answer, buffers=buffers)

    def _repr_mimebundle_(self, **kwargs):
        """The widget, and the picture of this moment for viewers without one."""
        data, metadata = super()._repr_mimebundle_(**kwargs)
        return {"image/png": base64.b64encode(still_png(self)).decode("ascii"), **data}, metadata


def _feed(view, source, stop):
    """Send the last samples of a bench or of a loop in the background; when a run has ended, the whole of it."""
    words = "live" + (", simulated" if getattr(source, "simulated", False) else "")
    shown, fresh, alive = None, False, True
    while alive and not stop.wait(0.04) and view() is not None:
        alive = getattr(source, "is_open", None) or getattr(source, "alive", False)
        run = getattr(source, "live_run", source) or source.recording
        samples = run.recent(_WINDOW) if run is not None else None
        if samples is not None and len(samples.t) > 1 and samples.t[-1] != shown:
            shown, fresh = samples.t[-1], True
            rows, shape = pack([samples], [""])
            view().send({"live": shape | {"source": words}}, buffers=[rows])
        if fresh and not getattr(run, "alive", alive):
            fresh = False
            view()._show([getattr(run, "recording", run)], [""])
