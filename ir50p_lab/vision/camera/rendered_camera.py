"""The rendered bench as a camera: a scene that can be changed between pictures."""

from ir50p_lab.errors import CameraError
from ir50p_lab.vision.camera.interface import Camera, Frame
from ir50p_lab.vision.rendering.places import bench_scene
from ir50p_lab.vision.rendering.render import render_scene


class RenderedCamera(Camera):
    """Pictures of a Scene, drawn when read: the bench without a bench. Its pictures say so (`Frame.simulated`).

    scene: Scene, default `bench_scene()`; it can change between pictures: `camera.scene = ...`. seed: of the noise,
    another for each picture.
    """

    simulated = True

    def __init__(self, scene=None, *, seed=0):
        self.scene = bench_scene() if scene is None else scene
        self.name, self.size = "rendered camera", self.scene.pinhole.size
        self._next_seed = seed

    def read(self):
        """Draw the scene as it is now: a Frame."""
        if self.closed:
            raise CameraError("the rendered camera is closed: open it again with open_camera('rendered')")
        image, _ = render_scene(self.scene, seed=self._next_seed)
        self._next_seed += 1
        return Frame(image=image, simulated=True, source=self.name)
