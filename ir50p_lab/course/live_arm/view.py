"""The widget LiveArm: what Python says to the view in the browser, and hears from it."""

import base64
import gzip
import hashlib
import threading
import weakref
from functools import cache
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

_FOLDER = Path(__file__).parent
_WINDOW = 10.0  # s of a live run that are shown
LAYERS = ("table", "shadow", "ghost", "trail")


@cache
def bundle_text():
    """The script that draws, as built by npm."""
    return (_FOLDER / "static" / "live_arm.js").read_text(encoding="utf-8")


class Bundle(anywidget.AnyWidget):
    """Holds the script for all views of a notebook, so that a saved notebook has it once."""

    _esm = "export default {};"
    packed = traitlets.Bytes().tag(sync=True)
    shared = None

    @classmethod
    def get(cls):
        """The one of this kernel."""
        if cls.shared is None or cls.shared.comm is None:
            cls.shared = cls(packed=gzip.compress(bundle_text().encode(), 9, mtime=0))
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
    `play(run)` shows a motion, `draw(T)` an arm by its frames. Raises InputError for what cannot be drawn.
    """

    _esm = _FOLDER / "loader.js"
    bundle = traitlets.Instance(ipywidgets.Widget).tag(sync=True, **ipywidgets.widget_serialization)
    digest = traitlets.Unicode().tag(sync=True)
    lengths = traitlets.List().tag(sync=True)
    limits = traitlets.List().tag(sync=True)
    q = traitlets.List().tag(sync=True)
    options = traitlets.Dict().tag(sync=True)
    layers = traitlets.List().tag(sync=True)
    things = traitlets.Dict().tag(sync=True)
    poses = traitlets.List().tag(sync=True)
    track = traitlets.Bytes(b"").tag(sync=True)
    shape = traitlets.Dict().tag(sync=True)

    def __init__(self, arm, q=(0.0, 0.0, 0.0), *, on_drag=None, frames=None, badge=None, layers=LAYERS, ball=None,
                 board=None, camera=None, height=420, sliders=True, readout=True):  # fmt: skip
        self.arm, self._on_drag, self._frames = arm, on_drag, frames
        self._stop = threading.Event()
        things = {}
        if ball is not None:
            things["ball"] = {"p": vectors3("ball", ball[0]).tolist(), "radius": float(ball[1])}
        if board is not None:
            things["board"] = {"T": _rows(board[0]), "square": float(board[1]), "pattern": list(board[2])}
        if camera is not None:
            K, T, size = camera
            things["camera"] = {"K": np.asarray(K, dtype=float).tolist(), "T": _rows(T), "size": list(size)}
        super().__init__(
            bundle=Bundle.get(),
            digest=hashlib.sha256(bundle_text().encode()).hexdigest()[:16],
            lengths=lengths(arm).tolist(),  # refuses what is no Arm
            limits=np.column_stack([np.clip(arm.q_min, -np.pi, None), np.clip(arm.q_max, None, np.pi)]).tolist(),
            q=vectors3("q", q).tolist(),
            options={
                "badge": badge or badge_of(on_drag or frames),
                "drag": "browser" if on_drag is None else "kernel",
                "frames": None if frames is None else "function",
                "height": int(height),
                "sliders": bool(sliders),
                "readout": bool(readout),
                "speed": 1.0,
                "loop": False,
            },
            layers=[*layers, *things],
            things=things,
        )
        if frames is not None:
            self._pose(self.q)
        self.on_msg(self._heard)

    def draw(self, T):
        """Draw the arm by T (4, 4, 4): transforms of frames 0 to 3 to the base, right or wrong."""
        T = np.asarray(T, dtype=float)
        if T.shape != (4, 4, 4):
            raise InputError(f"frames of shape {T.shape}: give (4, 4, 4), the transforms of frames 0 to 3")
        self.options = self.options | {"frames": self.options["frames"] or "given"}
        self.poses = [[[float(v) if np.isfinite(v) else None for v in row] for row in one] for one in T]

    def play(self, *runs, labels=None, speed=1.0, loop=False):
        """Show a motion, or two side by side, with a bar to play, pause and scrub, and curves over time.

        Args: runs: SimulationResult, Recording, anything with t and q; or one open Bench or LiveRun, which is
        followed 25 times a second until it ends and can then be played. labels: a name for each run; speed: times
        real time; loop: again and again.
        Returns: the view. Raises InputError for runs that cannot be shown.
        """
        self._stop.set()
        self.options = self.options | {"speed": float(speed), "loop": bool(loop)}
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

    def _heard(self, _, message, __):
        """What the browser asks for. Errors of the student's function are shown under the arm."""
        if "frames" in message:
            self._pose(message["frames"])
            self.send({"posed": True})
        elif "drag" in message:
            answer = {"dragged": None}
            try:
                q = self._on_drag(np.array(message["drag"]), np.array(message["q"]))
                answer["dragged"] = None if q is None else vectors3("q", q).tolist()
                self.q = answer["dragged"] or self.q
            except Exception as error:
                answer["error"] = f"{type(error).__name__}: {error}"
            self.send(answer)
        elif "picture" in message:
            self.send({"picture": True}, buffers=[still_png(self)])

    def _pose(self, q):
        try:
            self.draw(self._frames(np.array(q)))
        except Exception as error:
            self.send({"dragged": None, "error": f"{type(error).__name__}: {error}"})

    def _repr_mimebundle_(self, **kwargs):
        """The widget, and the picture of this moment for viewers without one."""
        data, metadata = super()._repr_mimebundle_(**kwargs)
        return {"image/png": base64.b64encode(still_png(self)).decode("ascii"), **data}, metadata


def _rows(T):
    return np.asarray(T, dtype=float).reshape(4, 4).tolist()


def _feed(view, source, stop):
    """Send the last samples of a bench or of a loop in the background; when a run has ended, the whole of it."""
    is_bench = hasattr(source, "is_open")
    words = "live" + (", simulated" if getattr(source, "simulated", False) else "")
    shown, ended = None, True
    while not stop.wait(0.04) and view() is not None:
        over = not (source.is_open if is_bench else source.alive)
        run = (source.live_run or source.recording) if is_bench else source
        samples = None if run is None else run.recent(_WINDOW)
        if samples is not None and len(samples.t) > 1 and samples.t[-1] != shown:
            shown, ended = samples.t[-1], False
            rows, shape = pack([samples], [""])
            view().send({"live": shape | {"source": words}}, buffers=[rows])
        if not ended and (over or not getattr(run, "alive", True)):
            ended, whole = True, getattr(run, "recording", run)
            if whole is not None and len(whole) > 1:
                view()._show([whole], [""])
        if over:
            return
