"""The live panel: the arm in the background under sliders, with a scope, while the notebook stays free.

    panel = live_panel(bench, PID(kp=(289, 225, 270), ki=(50, 10, 50), kd=(40, 30, 30), limit_pwm=255))
    panel

The panel only gives orders to the loop of `bench.start(...)` and looks at its samples. No safety depends on it: a
closed browser changes nothing, a dead kernel cuts the drive.
"""

import html
import math
import threading
import time
import weakref
from functools import partial
from typing import ClassVar

import ipywidgets as widgets
import numpy as np

from ir50p_lab.controllers.base import GAINS, gains_of, set_gains
from ir50p_lab.course.draw.controls import close_all, make_control, on_scale, slider
from ir50p_lab.course.draw.scope import Scope
from ir50p_lab.course.draw.style import alarm
from ir50p_lab.errors import InputError, LabError

_UNITS = {"kp": "PWM/rad", "ki": "PWM/(rad s)", "kd": "PWM s/rad"}
_LEAST = {"kp": 400, "ki": 100, "kd": 100}  # smallest right end of a slider
_FRAME, _WINDOW = 1 / 25, 10.0  # s, of the scope


def live_panel(bench, controller, reference=None):
    """Return a panel to start, stop and tune `controller` on `bench`.

    Args:
        bench: any open bench. controller: PID, or any controller; one with kp, ki, kd gets sliders for them.
        reference: target(t), until a set point slider is moved; None: hold the pose where the arm stands.

    Returns: BenchPanel, shown if it is the last line of a cell. A cell that is run again takes over a running loop.
    """
    return BenchPanel(bench, controller, reference)


class BenchPanel(widgets.VBox):
    """Buttons, sliders, scope, a line of statistics and one of status; see `live_panel`.

    start(), stop(), cut() do what the buttons do; set(kp1=300, q2=20) moves sliders (q in deg); close() ends it all.

    Attributes: run, the LiveRun or None; controls, name -> slider: q1..q3 in deg, kp1..kd3; scope; status; statistics;
    error, the last thing that went wrong, or None.
    """

    panels: ClassVar = weakref.WeakSet()

    def __init__(self, bench, controller, reference):
        self.bench, self.error, self.run = bench, None, None
        self._controller, self._reference = controller, reference
        self._quiet, self._busy, self._cut_wanted = threading.local(), threading.Lock(), False
        self._closed = threading.Event()
        self._shown = self._phase = None  # run and cycle of the last frame of a run that has ended; the phase written
        self.controls = {}
        self.scope = Scope(window=_WINDOW, badge="simulated" if bench.simulated else bench.kind)
        self.statistics = widgets.HTML(layout=widgets.Layout(min_height="1.4em"))
        self.status = widgets.HTML(layout=widgets.Layout(min_height="1.4em"))
        super().__init__(
            [self._heading(), self._sliders(), self.scope, self.statistics, self.status],
            layout=widgets.Layout(width="100%", max_width="1060px"),
        )
        self._take_over()
        BenchPanel.panels.add(self)
        threading.Thread(target=_pump, args=(weakref.ref(self), self._closed), daemon=True).start()

    # ---- what it looks like

    def _button(self, words, icon, order, *, width="110px", **look):
        layout = widgets.Layout(width=width, height="44px")
        button = widgets.Button(description=words, icon=icon, layout=layout, **look)
        button.on_click(lambda _: self._guarded(order))
        return button

    def _heading(self):
        start, stop = partial(self.start, wait=False), partial(self.stop, wait=False)
        self._start_button = self._button("Start", "play", start, button_style="success")
        self._stop_button = self._button("Stop", "stop", stop, tooltip="To the rest pose, then let go")
        look = {"button_style": "danger", "tooltip": "Drive off at once; the arm sinks"}
        self._cut_button = self._button("CUT THE DRIVE", "bolt", self.cut, width="190px", **look)
        self._cut_button.style.font_weight = "bold"
        kind = "simulated arm, no motor moves" if self.bench.simulated else "motors will move"
        title = widgets.HTML(f"<b>{html.escape(self.bench.name)}</b><br>{kind}")
        row = [self._start_button, self._stop_button, self._cut_button, title]
        return widgets.HBox(row, layout=widgets.Layout(align_items="center", grid_gap="8px", margin="4px 0"))

    def _sliders(self):
        """Set points left, gains right: a row per joint."""
        # whole degrees: the browser sends back a fraction that it was told with rounding noise, and that late echo
        # would undo a set() which follows start() at once
        arm, points = self.bench.arm, []
        for i in range(3):
            low, high = math.ceil(math.degrees(arm.q_min[i])), math.floor(math.degrees(arm.q_max[i]))
            numbers = low, high, 1, min(max(0, low), high)
            points.append(self._slider(f"q{i + 1}", numbers, self._set_point_moved, 150))
        columns = {"Set point [deg]": points}
        for name, values in gains_of(self._controller).items():
            highs = [max(_LEAST[name], 50 * math.ceil(2 * value / 50)) for value in values]
            columns[f"{name.capitalize()} [{_UNITS[name]}]"] = [
                self._slider(f"{name}{i + 1}", (0.0, float(highs[i]), 0.5, float(values[i])), self._gain_moved, 110)
                for i in range(3)
            ]
        blocks = [widgets.VBox([widgets.HTML(f"<b>{title}</b>"), *rows]) for title, rows in columns.items()]
        return widgets.HBox(blocks, layout=widgets.Layout(grid_gap="14px", flex_flow="row wrap"))

    def _slider(self, name, numbers, moved, width):
        label = name if name[0] == "q" else name.capitalize()
        spec = slider(*numbers, label=label)
        control, row = make_control(name, spec, "34px", partial(self._guarded, moved, name))
        control.layout.width = f"{100 + width}px"
        row.children = (control,)
        self.controls[name] = control
        return row

    # ---- what it does

    def start(self, *, wait=True):
        """Start the loop. wait: whether to wait until it runs (a board that restarts takes 3 s)."""
        if wait:
            self._start()
        else:
            threading.Thread(target=self._guarded, args=(self._start,), daemon=True).start()

    def _start(self):
        with self._busy:
            if self.run is not None and self.run.alive:
                raise LabError(f"the loop runs already ({self.run.phase})")
            self._cut_wanted, self.error = False, None
            self.status.value = "starting ..."
            if "kp1" in self.controls:
                set_gains(self._controller, **self._gains())
            run = self.bench.start(self._controller, self._reference)
            self.run = run
            if self._cut_wanted:
                run.cut()
            self.status.value = ""
            self._sliders_follow(run)

    def _gains(self):
        """The gains that the sliders show."""
        return {name: [self.controls[f"{name}{i}"].value for i in (1, 2, 3)] for name in GAINS}

    def _sliders_follow(self, run):
        """Put the set point sliders where the reference is."""
        deadline = time.monotonic() + 2.0
        while not (samples := run.recent(0.1)).t.size and run.alive and time.monotonic() < deadline:
            time.sleep(0.01)
        if samples.t.size:
            self._put({f"q{i + 1}": math.degrees(samples.reference[-1, i]) for i in range(3)})

    def stop(self, *, wait=True):
        """End the loop in order: the arm moves to the rest pose and is let go. wait: whether to wait for that."""
        if self.run is not None:
            self.run.stop(wait=wait)

    def cut(self):
        """Cut the drive at once and end the loop."""
        self._cut_wanted = True
        if self.run is not None:
            self.run.cut()
        else:
            self.bench.cut()

    def set(self, **values):
        """Move sliders from Python: q1..q3 in deg, kp1..kd3. Raises the error that a moved slider causes."""
        for name, value in values.items():
            if name not in self.controls:
                raise InputError(f"no slider {name!r}; this panel has {', '.join(self.controls)}")
            self.error = None
            self.controls[name].value = value
            if self.error is not None:
                raise self.error

    def close(self):
        """End loop, scope and panel. The bench stays open."""
        self._closed.set()
        if self.run is not None and self.run.alive and self.bench.live_run is self.run:
            self.run.stop()
        self._detach()

    def __del__(self):
        """Not the close() of other widgets: garbage collection must not move an arm."""

    # ---- callbacks

    def _gain_moved(self, name):
        if self.run is not None and self.run.alive:
            self.run.set_gains(**{name[:2]: self._gains()[name[:2]]})

    def _set_point_moved(self, _):
        if self.run is None or not self.run.alive:
            return
        goal = [math.radians(self.controls[f"q{i}"].value) for i in (1, 2, 3)]
        arm = self.bench.arm  # the sliders' ends are whole degrees
        self.run.set_point(np.clip(goal, arm.q_min, arm.q_max))

    def _put(self, values):
        """Move sliders without giving orders."""
        self._quiet.on = True
        try:
            for name, value in values.items():
                self.controls[name].value = on_scale(self.controls[name], value)
        finally:
            self._quiet.on = False

    def _guarded(self, what, *args, **options):
        """Show errors of a callback in the status line: JupyterLab shows them nowhere."""
        if getattr(self._quiet, "on", False):
            return
        try:
            what(*args, **options)
            if self.error is not None and what in (self._gain_moved, self._set_point_moved):
                self.error = None
                self.status.value = ""
        except Exception as error:
            self._complain(error)

    def _complain(self, error):
        self.error = error
        self.status.value = alarm(f"{type(error).__name__}: {error}")

    # ---- the scope's thread

    def _frame(self, count):
        """One frame of the scope; twice a second the texts."""
        run = self.run
        alive = run is not None and run.alive
        phase = run.phase if run is not None else "not started"
        if run is not None and (alive or self._shown != (run, run.statistics().cycles)):
            samples = run.recent(_WINDOW)
            if samples.t.size:
                cuts = samples.t[1:][np.diff(samples.trips) > 0]
                self.scope.show(samples.t, samples.q, samples.reference, samples.u, cuts)
            self._shown = (run, run.statistics().cycles) if not alive else None
        if count % 10 == 0 or phase != self._phase:
            self._phase = phase
            self._texts(run, phase, alive)

    def _texts(self, run, phase, alive):
        self._start_button.disabled = alive
        self._stop_button.disabled = not alive or phase == "moving to the rest pose"
        text = f"<b>{phase}</b>"
        if run is not None:
            text += f": {html.escape(str(run.statistics()))}"
            if run.error is not None and self.error is not run.error:
                self._complain(run.error)
        self.statistics.value = text

    # ---- one panel after the other

    def _take_over(self):
        """When a cell is run again, the new panel takes over the running loop and the old one detaches."""
        for old in list(BenchPanel.panels):
            if old.bench is self.bench and not old._closed.is_set():
                old._closed.set()
                old._detach()
        live = self.bench.live_run
        if live is not None and live.alive:
            self.run = live
            self._put({f"{name}{i + 1}": value for name in live.gains for i, value in enumerate(live.gains[name])})
            self._sliders_follow(live)

    def _detach(self):
        """End the widgets, not the loop."""
        BenchPanel.panels.discard(self)
        close_all(self)


def _pump(reference, closed):
    """Draw frames until the panel is closed or forgotten: absolute deadlines, and no frame twice."""
    due, count = time.monotonic(), 0
    while not closed.is_set():
        panel = reference()
        if panel is None:
            return
        try:
            panel._frame(count)
        except Exception as error:
            if not closed.is_set():
                panel._complain(error)
        del panel
        count += 1
        now = time.monotonic()
        due = due + _FRAME if due + _FRAME > now - 4 * _FRAME else now
        closed.wait(max(0.0, due - now))
