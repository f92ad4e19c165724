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
    """A flat printed sheet: T_cam_sheet (4, 4), x and y ranges of the print; its z points away from the viewer."""

    def __init__(self, T_cam_sheet, x, y):
        self.R, self.t, self.x, self.y = T_cam_sheet[:3, :3], T_cam_sheet[:3, 3], x, y

    def bounds(self):
        """Its corners (4, 3)."""
        u, v = np.meshgrid(self.x, self.y)
        return np.stack([u.ravel(), v.ravel(), np.zeros(4)], axis=1) @ self.R.T + self.t

    def depth(self, rays):
        """Depth Z of the hit, inf where there is none."""
        origin = -self.R.T @ self.t
        dx, dy, dz = (rays.x * self.R[0, i] + rays.y * self.R[1, i] + self.R[2, i] for i in range(3))
        with np.errstate(invalid="ignore", divide="ignore"):
            t = -origin[2] / dz
            u, v = origin[0] + t * dx, origin[1] + t * dy
            hit = (t > 0) & (u >= self.x[0]) & (u <= self.x[1]) & (v >= self.y[0]) & (v <= self.y[1])
        return np.where(hit, t, np.inf)

    def print_coordinates(self, X):
        """Coordinates u, v of the print at the points X (3, n), and whether its front is seen (n,)."""
        local = self.R.T @ (X - self.t[:, None])
        return local[0], local[1], self.R[:, 2] @ X > 0

    def normal(self, X):
        """Normals (3, n) on the side of the camera."""
        return -self.R[:, 2:] * np.sign(self.R[:, 2] @ X)


def _cube(centre, half):
    return centre + half * np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, -1).T
