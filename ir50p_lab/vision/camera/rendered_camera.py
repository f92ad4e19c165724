"""The rendered bench as a camera: a scene that can be changed between pictures, with the truth kept beside."""

from ir50p_lab.errors import CameraError, InputError
from ir50p_lab.inputs import number, whole
from ir50p_lab.vision.camera.interface import Camera, Frame
from ir50p_lab.vision.rendering.places import bench_scene
from ir50p_lab.vision.rendering.render import render_scene
from ir50p_lab.vision.rendering.scene import Scene


class RenderedCamera(Camera):
    """Pictures of a Scene, drawn when read: the bench without a bench. Its pictures say so (`Frame.simulated`).

    scene: Scene, or a function of t (s) that gives one; default `bench_scene()`. seed: of the noise, another for each
    picture. period: s between pictures; t counts pictures, not the clock.
    What is in it can change between pictures: `camera.scene = ...`.
    `truth` is that of the last picture, None before it: for tests, and plots that say so; nothing that looks at
    pictures may use it.
    """

    simulated = True

    def __init__(self, scene=None, *, seed=0, period=1 / 30):
        self.scene = bench_scene() if scene is None else scene
        self.seed = whole("seed", seed, 0, 2**62)
        self.period = number("period", period, "> 0", unit="s", hint="the time between two pictures")
        self._count, self.truth, self._closed = 0, None, False
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
        image, self.truth = render_scene(self._now(), seed=self.seed + self._count)
        self._count += 1
        return Frame(image=image, t=(self._count - 1) * self.period, simulated=True, source=self.name)

    def close(self):
        """No more pictures."""
        self._closed = True
