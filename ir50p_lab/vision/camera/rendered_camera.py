"""The rendered bench as a camera: a scene that can be changed between pictures, with the truth kept beside."""

from ir50p_lab.errors import CameraError
from ir50p_lab.inputs import whole
from ir50p_lab.vision.camera.interface import Camera, Frame
from ir50p_lab.vision.rendering.places import bench_scene
from ir50p_lab.vision.rendering.render import render_scene

_PERIOD = 1 / 30  # s


class RenderedCamera(Camera):
    """Pictures of a Scene, drawn when read: the bench without a bench. Its pictures say so (`Frame.simulated`).

    scene: Scene, default `bench_scene()`. seed: of the noise, another for each picture. Times count pictures, 30 a
    second, not the clock.
    What is in it can change between pictures: `camera.scene = ...`.
    `truth` is that of the last picture, None before it: for tests, and plots that say so; nothing that looks at
    pictures may use it.
    """

    simulated = True

    def __init__(self, scene=None, *, seed=0):
        self.scene = bench_scene() if scene is None else scene
        self.seed = whole("seed", seed, 0, 2**62)
        self._count, self.truth = 0, None
        self.name = "rendered camera"
        self.size = self.scene.pinhole.size

    def read(self):
        """Draw the scene as it is now: a Frame; its truth is in `camera.truth`."""
        if self.closed:
            raise CameraError("the rendered camera is closed: open it again with open_camera('rendered')")
        image, self.truth = render_scene(self.scene, seed=self.seed + self._count)
        self._count += 1
        return Frame(image=image, t=(self._count - 1) * _PERIOD, simulated=True, source=self.name)
