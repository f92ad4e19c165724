"""Where rays meet things: depth along the ray, outward normal, all in camera coordinates."""

import numpy as np


class SphereShape:
    """A sphere: centre (3,) in camera coordinates, radius."""

    def __init__(self, centre, radius):
        self.centre, self.radius = np.asarray(centre, dtype=float), float(radius)

    def bounds(self):
        """Corners (8, 3) of a box around it."""
        return _cube(self.centre, self.radius)

    def depth(self, rays):
        """Depth Z of the first hit, inf where there is none."""
        cx, cy, cz = self.centre.astype(rays.x.dtype)
        b = rays.x * cx + rays.y * cy + cz
        disc = b * b - rays.length2 * (self.centre @ self.centre - self.radius**2).astype(rays.x.dtype)
        hit = (disc > 0) & (b > 0)
        with np.errstate(invalid="ignore"):
            return np.where(hit, (b - np.sqrt(disc)) / rays.length2, np.inf)

    def normal(self, X):
        """Normals (3, n) at the points X (3, n)."""
        return (X - self.centre[:, None]) / self.radius


class StickShape:
    """A cylinder of `radius` from a to b (3,) with round ends."""

    def __init__(self, a, b, radius):
        self.a, self.b, self.radius = np.asarray(a, dtype=float), np.asarray(b, dtype=float), float(radius)

    def bounds(self):
        """Corners (16, 3) of boxes around its ends."""
        return np.concatenate([_cube(self.a, self.radius), _cube(self.b, self.radius)])

    def depth(self, rays):
        """Depth Z of the first hit, inf where there is none."""
        best = np.minimum(SphereShape(self.a, self.radius).depth(rays), SphereShape(self.b, self.radius).depth(rays))
        axis = self.b - self.a
        length = np.linalg.norm(axis)
        if length < 1e-9:
            return best
        u = axis / length
        ud = rays.x * u[0] + rays.y * u[1] + u[2]
        ua = self.a @ u
        # components across the axis: |d t - a|^2 - ((d t - a) . u)^2 = r^2
        da = rays.x * self.a[0] + rays.y * self.a[1] + self.a[2]
        A = rays.length2 - ud * ud
        B = da - ud * ua
        C = self.a @ self.a - ua * ua - self.radius**2
        disc = B * B - A * C
        with np.errstate(invalid="ignore", divide="ignore"):
            t = (B - np.sqrt(disc)) / A
            along = t * ud - ua
            hit = (disc > 0) & (t > 0) & (along >= 0) & (along <= length)
        return np.where(hit, np.minimum(t, best), best)

    def normal(self, X):
        """Normals (3, n) at the points X (3, n)."""
        axis = self.b - self.a
        along = np.clip(axis @ (X - self.a[:, None]) / max(axis @ axis, 1e-18), 0, 1)
        return (X - self.a[:, None] - axis[:, None] * along) / self.radius


class SheetShape:
    """A printed sheet, bent about its y axis: T_cam_sheet (4, 4), x and y ranges of the print, curvature `bend`.

    A point of the print (u, v) lies at x = middle + sin(bend u') / bend, y = v, z = (1 - cos(bend u')) / bend with
    u' = u - middle: z points away from the viewer, so the middle bulges towards him for bend > 0.
    """

    def __init__(self, T_cam_sheet, x, y, bend=0.0):
        self.R, self.t = T_cam_sheet[:3, :3], T_cam_sheet[:3, 3]
        self.x, self.y, self.bend, self.middle = x, y, float(bend), (x[0] + x[1]) / 2

    def place(self, u, v):
        """Sheet coordinates (n, 3) of the points u, v (n,) of the print."""
        angle = self.bend * (u - self.middle)
        if self.bend == 0:
            return np.stack([u, v, np.zeros_like(u)], axis=-1)
        return np.stack([self.middle + np.sin(angle) / self.bend, v, (1 - np.cos(angle)) / self.bend], axis=-1)

    def bounds(self):
        """Points (n, 3) along its rim, in camera coordinates."""
        u, v = np.meshgrid(np.linspace(*self.x, 9), np.array(self.y))
        return self.place(u.ravel(), v.ravel()) @ self.R.T + self.t

    def depth(self, rays):
        """Depth Z of the hit, inf where there is none."""
        origin, k = -self.R.T @ self.t, self.bend / 2
        ox, oz = origin[0] - self.middle, origin[2]
        dx, dy, dz = (rays.x * self.R[0, i] + rays.y * self.R[1, i] + self.R[2, i] for i in range(3))
        # z = bend/2 (x'^2 + z^2) on the cylinder; the root that becomes the plane's for bend -> 0, without cancelling
        A, B, C = k * (dx * dx + dz * dz), 2 * k * (ox * dx + oz * dz) - dz, k * (ox * ox + oz * oz) - oz
        with np.errstate(invalid="ignore", divide="ignore"):
            t = -2 * C / (B + np.sign(B) * np.sqrt(B * B - 4 * A * C))
            u, v = self.unroll(ox + t * dx, oz + t * dz), origin[1] + t * dy
            hit = (t > 0) & (u >= self.x[0]) & (u <= self.x[1]) & (v >= self.y[0]) & (v <= self.y[1])
        return np.where(hit, t, np.inf)

    def unroll(self, x, z):
        """Print coordinate u of sheet coordinates x (from the middle) and z."""
        if self.bend == 0:
            return self.middle + x
        return self.middle + np.arctan2(self.bend * x, 1 - self.bend * z) / self.bend

    def print_coordinates(self, X):
        """Coordinates u, v of the print at the points X (3, n), and whether its front is seen (n,)."""
        local = self.R.T @ (X - self.t[:, None])
        x, z = local[0] - self.middle, local[2]
        front = np.sum(self.R @ np.stack([-self.bend * x, 0 * x, 1 - self.bend * z]) * X, axis=0) > 0
        return self.unroll(x, z), local[1], front

    def normal(self, X):
        """Normals (3, n) on the side of the camera."""
        local = self.R.T @ (X - self.t[:, None])
        n = self.R @ np.stack([-self.bend * (local[0] - self.middle), 0 * local[0], 1 - self.bend * local[2]])
        return -n * np.sign(np.sum(n * X, axis=0))


def _cube(centre, half):
    return centre + half * np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, -1).T
