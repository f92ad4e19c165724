"""The rendered bench as a camera: a scene that can be changed between pictures, with the truth kept beside."""

from dataclasses import replace

import numpy as np

from ir50p_lab.errors import CameraError, InputError
from ir50p_lab.inputs import number, numbers, whole
from ir50p_lab.vision.camera.interface import Camera, Frame
from ir50p_lab.vision.rendering.arm_shape import arm_sticks
from ir50p_lab.vision.rendering.places import bench_scene
from ir50p_lab.vision.rendering.render import render_scene
from ir50p_lab.vision.rendering.scene import Scene, SceneBall


class RenderedCamera(Camera):
    """Pictures of a Scene, drawn when read: the bench without a bench. Its pictures say so (`Frame.simulated`).

    scene: Scene, or a function of t (s) that gives one; default `bench_scene()`. seed: of the noise, another for each
    picture. period: s between pictures; t counts pictures, not the clock.
    What is in it can change between pictures: `camera.scene = ...`, `move_ball`, `pose_arm`.
    `truth` is that of the last picture: for tests, and plots that say so; nothing that looks at pictures may use it.
    """

    simulated = True

    def __init__(self, scene=None, *, seed=0, period=1 / 30):
        self.scene = bench_scene() if scene is None else scene
        self.seed = whole("seed", seed, 0, 2**62)
        self.period = number("period", period, "> 0", unit="s", hint="the time between two pictures")
        self._count, self._truth, self._closed = 0, None, False
        self.name = "rendered camera"
        self.size = self._now().pinhole.size

    def _now(self):

        scene = self.scene(self._count * self.period) if callable(self.scene) else self.scene
        if not isinstance(scene, Scene):
            raise InputError(f"the rendered camera needs a Scene, or a function of t that gives one, not {scene!r:.60}")
        return scene

    def read(self):
        """Draw the scene as it is now: a Frame; its truth is in `camera.truth`."""
        if self._closed:
            raise CameraError("the rendered camera is closed: open it again with open_camera('rendered')")
        image, self._truth = render_scene(self._now(), seed=self.seed + self._count)
        self._count += 1
        return Frame(image=image, t=(self._count - 1) * self.period, simulated=True, source=self.name)

    @property
    def truth(self):
        """Truth of the last picture. Raises CameraError before the first."""
        if self._truth is None:
            raise CameraError("no picture was read yet, so there is no truth of it: call camera.read() first")
        return self._truth

    def move_ball(self, position, index=0):
        """Put ball number `index` with its centre at `position` (3,) m, or (2,): on the table at these x, y."""
        scene = self._fixed()
        places = [i for i, thing in enumerate(scene.objects) if isinstance(thing, SceneBall)]
        if not 0 <= index < len(places):
            raise InputError(f"ball {index}: the scene has {len(places)} balls, counted from 0")
        position = numbers("position", position, unit="m")
        ball = scene.objects[places[index]]
        if position.shape == (2,):
            position = np.append(position, ball.radius)
        if position.shape != (3,) or not np.isfinite(position).all():
            raise InputError(f"position = {position.tolist()}: give x, y, z of the ball's centre, m")
        objects = list(scene.objects)
        objects[places[index]] = replace(ball, position=tuple(position.tolist()))
        self.scene = replace(scene, objects=tuple(objects))

    def pose_arm(self, q, arm=None):
        """Show the arm (default `load_arm()`) at q (3,) rad; None takes it out of the picture."""
        self.scene = replace(self._fixed(), arm=() if q is None else arm_sticks(q, arm))

    def _fixed(self):
        if callable(self.scene):
            raise InputError("the scene is a function of time: change what it returns, or set camera.scene to a Scene")
        return self._now()

    def close(self):
        """No more pictures."""
        self._closed = True
