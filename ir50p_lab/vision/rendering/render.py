"""`render_scene`: a Scene to a picture, by following a ray through every pixel, and the truth beside it."""

import numpy as np

from ir50p_lab.vision.rendering.colours import light_of
from ir50p_lab.vision.rendering.light import highlight, irradiance
from ir50p_lab.vision.rendering.rays import grid_rays, rays_through
from ir50p_lab.vision.rendering.scene import SceneBall, Sky
from ir50p_lab.vision.rendering.sensor import expose
from ir50p_lab.vision.rendering.surface import room_light, table_albedo
from ir50p_lab.vision.rendering.truth import SceneTruth, ball_truth

ROOM, TABLE = 0, 1  # owners of pixels; things follow
_DETAILS = 64  # codes per owner: faces, squares, patches
_ON_TOP = 1.0001  # what lies in the plane of the table is above it: 0.1 mm at 1 m
_SUB = 34  # rays through a pixel that an edge runs through


def render_scene(scene, seed=0):
    """The picture of a scene and the truth beside it: the same bytes for the same scene and seed.

    Every pixel is the mean light over its square: one ray where nothing changes, 34 where an edge runs through it. The
    lens blurs light, not bytes; then come noise, tone curve and JPEG.

    Args: scene: Scene; seed: of the noise. Returns: image (h, w, 3) uint8, red green blue; SceneTruth.
    Raises InputError for things that cannot be drawn.
    """
    picture = RayTracer(scene)
    light = scene.lens.through(picture.light())
    image = expose(light, scene.sensor, np.random.default_rng([int(seed), 0]))
    balls = (ball_truth(scene.pinhole, picture.T, thing) for thing in picture.things if isinstance(thing, SceneBall))
    truth = SceneTruth(balls=tuple(balls), pinhole=scene.pinhole, scene=scene)
    return image, truth


class RayTracer:
    """The scene in camera coordinates."""

    def __init__(self, scene):
        self.scene, self.T = scene, np.asarray(scene.T_cam_world, dtype=float)
        self.R, self.t = self.T[:3, :3], self.T[:3, 3]
        self.C = -self.R.T @ self.t
        self._c, self._r = self.C.tolist(), self.R.tolist()  # plain floats keep float32 arrays what they are
        self.things = (*scene.objects, *scene.arm)
        self.shapes = [thing.shape(self.T) for thing in self.things]
        self.table_colour = light_of(scene.table.colour).astype(np.float32)

    def light(self):
        """Light (h, w, 3) float32 of the sharp picture."""
        import cv2

        rays = grid_rays(self.scene.pinhole)
        light, code = self.trace(rays)
        w, h = self.scene.pinhole.size
        light, code = light.reshape(h, w, 3), code.reshape(h, w).astype(np.float32)
        cross = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))
        y, x = np.nonzero(cv2.dilate(code, cross) != cv2.erode(code, cross))  # beside another code: an edge
        dx, dy = _spread(_SUB)
        for part in np.array_split(np.arange(len(x)), max(1, len(x) // 8000)):
            px, py = (x[part, None] + dx).ravel(), (y[part, None] + dy).ravel()
            fine, _ = self.trace(rays_through(self.scene.pinhole, px, py))
            light[y[part], x[part]] = fine.reshape(-1, _SUB, 3).mean(axis=1)
        return light

    def first_hits(self, rays):
        """Depth (inf: nothing) and owner of the first thing on each ray."""
        owner = np.zeros(rays.x.shape, dtype=np.int16)
        depth = np.full(rays.x.shape, np.inf, dtype=rays.x.dtype)
        table = self.scene.table
        down = rays.x * self._r[0][2] + rays.y * self._r[1][2] + self._r[2][2]
        with np.errstate(divide="ignore", invalid="ignore"):
            t = -self._c[2] / down
            X, Y = self._table_xy(rays.x, rays.y, t)
            hit = (t > 0) & (X > table.x[0]) & (X < table.x[1]) & (Y > table.y[0]) & (Y < table.y[1])
        owner[hit], depth[hit] = TABLE, t[hit]
        for number, shape in enumerate(self.shapes):
            index = rays.near(shape.bounds())
            t = shape.depth(rays.at(index))
            nearer = t < depth[index] * _ON_TOP
            depth[index] = np.where(nearer, t, depth[index])
            owner[index] = np.where(nearer, number + 2, owner[index])
        return depth, owner

    def _table_xy(self, x, y, t):
        (c1, c2, _), (r1, r2, r3) = self._c, self._r
        return c1 + t * (r1[0] * x + r2[0] * y + r3[0]), c2 + t * (r1[1] * x + r2[1] * y + r3[1])

    def trace(self, rays):
        """Light (n, 3) float32 along the rays, and a code (n,) that changes where an edge is."""
        depth, owner = self.first_hits(rays)
        x, y = rays.x, rays.y
        light = np.empty((len(x), 3), dtype=np.float32)
        code = owner.astype(np.int32) * _DETAILS
        scene = self.scene
        for who in np.unique(owner):
            at = np.flatnonzero(owner == who)
            if who == ROOM:
                light[at] = room_light(scene.table, x[at], y[at], scene.texture_seed)
            elif who == TABLE:
                X, Y = self._table_xy(x[at], y[at], depth[at])
                albedo, detail = table_albedo(scene.table, scene.patches, X, Y, scene.texture_seed)
                light[at] = albedo * table_light(scene, X, Y)
                code[at] += detail
            else:
                light[at], detail = self._thing_light(who - 2, x[at], y[at], depth[at])
                code[at] += detail
        return light, code

    def _thing_light(self, number, x, y, depth):
        thing, shape = self.things[number], self.shapes[number]
        X = np.stack([depth * x, depth * y, depth])
        N = self.R.T @ shape.normal(X)
        world = self.R.T @ (X - self.t[:, None])
        light, direct = irradiance(self.scene, world, N, self.table_colour)
        albedo, detail = thing.paint(shape, X)
        light = light * albedo
        if getattr(thing, "gloss", 0) > 0:
            V = self.C[:, None] - world
            light = light + highlight(thing, N, V / np.sqrt(np.sum(V * V, axis=0)), direct)
        return light, detail


def table_light(scene, X, Y):
    """Light (n, 3) on the table at X, Y (n,) m: every light, less what the things keep from it."""
    light = np.zeros((len(X), 3), dtype=np.float32)
    P = np.stack([X, Y, np.zeros_like(X)])
    for source in scene.lights:
        if isinstance(source, Sky):
            part = np.full(len(X), 1, dtype=np.float32)
            for thing in (*scene.objects, *scene.arm):
                thing.dim_sky(part, X, Y)
            part = source.strength * part
        else:
            towards, strength, softness = source.direction(P)
            part = np.broadcast_to(strength * towards[2], X.shape).astype(np.float32)
            for thing in (*scene.objects, *scene.arm):
                thing.shade(part, source, softness, X, Y)
        light += part[:, None] * np.asarray(source.colour, dtype=np.float32)
    return light


def _spread(n):
    """Places (n,), (n,) within a pixel, -0.5..0.5: a Fibonacci lattice, so that edges of any angle meet many distances.

    A square grid of 25 knows only 5 positions of an upright edge.
    """
    i = np.arange(n)
    return (i + 0.5) / n - 0.5, (21 * i % n + 0.5) / n - 0.5
