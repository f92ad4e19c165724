"""The simulated bench with a table, balls and a rendered camera that sees them, to try out what a webcam does."""

from dataclasses import replace

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.home import setting
from ir50p_lab.inputs import vectors3
from ir50p_lab.modelling.chain import frames
from ir50p_lab.vision.board_pose import transform_points
from ir50p_lab.vision.frame import Camera, Frame
from ir50p_lab.vision.reaching.ball_locator import MARKER_AT
from ir50p_lab.vision.rendering import SceneBall, arm_sticks, bench_camera, bench_scene, render_scene

_RADIUS = 0.03  # m, of the balls
_MARKER = 0.012  # m, radius of the green ball on the wrist: 10 px in the default camera (assumed)
_GRIP = 0.012  # m: fingers that close hold the ball if the tip is no farther from its centre (assumed)


class RenderedBench(Camera):
    """A camera that sees the simulated arm of a bench, and balls that lie, roll, or are carried by its gripper.

    Args:
        bench: a SimulatedBench. balls: (n, 3) or (3,) m, where they lie; or a function of time, t s -> (3,) m, for one
        that rolls. seed: of the noise of the pictures; small: pictures of half the width and height.

    `read()` gives a Frame of this moment. Time is that of the simulation, `t` s: it counts the periods in which the
    bench was driven. `balls_true`, and the camera in `scene` (that of the bench without balls), are the truth, for
    tests and for drawings that say so. The fingers hold a ball if they close with the tip within 12 mm of its centre.
    """

    name, simulated = "rendered camera over the simulated arm", True

    def __init__(self, bench, balls=(0.40, 0.0, 0.03), *, seed=0, small=False):
        if not hasattr(bench, "plant"):
            raise InputError("a rendered camera sees a simulated arm only: for a real one use open_camera()")
        pinhole, _ = bench_camera()
        self.scene = bench_scene(pinhole=pinhole.scaled((320, 240)) if small else pinhole, objects=())
        self.bench, self.seed, self.size = bench, int(seed), self.scene.pinhole.size
        self._rolling = balls if callable(balls) else None
        self._lying = None if callable(balls) else np.atleast_2d(vectors3("balls", balls, unit="m")).copy()
        self.t, self.pictures = 0.0, 0
        self._held, self._closed = None, False
        self._send, bench._send = bench._send, self._watched

    def _watched(self, pwm, gripper):
        """Called with all that the bench sends: counts the time, and lets the gripper take or leave a ball."""
        self.t += self.bench.period
        if gripper != self._closed:
            self._closed = gripper
            self._take() if gripper else self._leave()
        return self._send(pwm, gripper)

    def _take(self):
        tip, balls = self.bench.plant.tip_true, self.balls_true
        near = np.linalg.norm(tip - balls, axis=1) < _GRIP
        if near.any() and self._rolling is None:
            self._held = (int(np.argmax(near)), balls[np.argmax(near)] - tip)

    def _leave(self):
        if self._held is not None:
            number, _ = self._held
            self._lying[number] = [*self.balls_true[number, :2], _RADIUS]  # it drops, and stays
            self._held = None

    @property
    def balls_true(self):
        """The centres of the balls now, (n, 3) m."""
        if self._rolling is not None:
            return np.atleast_2d(np.asarray(self._rolling(self.t), dtype=float))
        balls = self._lying.copy()
        if self._held is not None:
            number, offset = self._held
            balls[number] = self.bench.plant.tip_true + offset
        return balls

    def lay(self, place):
        """Lay the first ball at `place` (3,) m, as somebody's hand would."""
        self._lying[0] = place

    def read(self):
        """Return a picture of this moment as a Frame."""
        arm, q = self.bench.arm, self.bench.plant.q_true
        balls = [SceneBall(position=tuple(p), radius=_RADIUS) for p in self.balls_true]
        place = tuple(transform_points(frames(arm, q)[3], np.array(MARKER_AT)))
        marker = SceneBall(position=place, radius=_MARKER, colour=(25, 150, 60), gloss=0.1)
        sticks = arm_sticks(q, arm, opening=0.06 if self._closed else 0.07)
        self.pictures += 1
        scene = replace(self.scene, objects=(*balls, marker), arm=sticks)
        image, _ = render_scene(scene, seed=1000 * self.seed + self.pictures)
        return Frame(image=image, simulated=True, source=self.name)

    def close(self):
        """Stop watching what the bench sends."""
        self.bench._send = self._send


def camera_over(bench, balls=(0.40, 0.0, 0.03), *, small=False):
    """Return the camera for a bench: rendered over a simulated arm, else a webcam; one line says which.

    The webcam is what IR50P_CAMERA says, else number 0: a loop needs one that gives pictures while a cell runs.
    balls: where balls lie in a rendered picture (a real camera sees yours); small: pictures of half the width and
    height, where speed matters.
    Raises CameraError for a real arm if there is no webcam, because the arm would reach for a ball that was only drawn.
    """
    from ir50p_lab.vision.camera import open_camera

    if hasattr(bench, "plant"):
        camera = RenderedBench(bench, balls, small=small)
        width, height = camera.size
        print(f"Camera: {camera.name}, {width}x{height}, rendered (a simulated arm is seen by no webcam)")
        return camera
    source = setting("IR50P_CAMERA") or 0
    return open_camera(source, size=(320, 240)) if small else open_camera(source)
