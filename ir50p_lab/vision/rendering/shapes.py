"""Where rays meet a ball or a stick: depth along the ray, outward normal, all in camera coordinates."""

import numpy as np

_CORNERS = np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, -1).T


class RoundShape:
    """A cylinder of `radius` from a to b (3,) with round ends; a sphere if both are the same."""

    def __init__(self, a, b, radius):
        self.a, self.b, self.radius = a, b, float(radius)
        self.axis = b - a

    def bounds(self):
        """Corners (16, 3) of boxes around its ends."""
        return np.concatenate([end + self.radius * _CORNERS for end in (self.a, self.b)])

    def depth(self, rays):
        """Depth Z of the first hit, inf where there is none."""
        best = self._end_depth(rays, self.a)
        length = np.linalg.norm(self.axis)
        if length < 1e-9:
            return best
        best = np.minimum(best, self._end_depth(rays, self.b))
        u = self.axis / length
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

    def _end_depth(self, rays, centre):
        cx, cy, cz = centre.astype(rays.x.dtype)
        b = rays.x * cx + rays.y * cy + cz
        disc = b * b - rays.length2 * (centre @ centre - self.radius**2).astype(rays.x.dtype)
        hit = (disc > 0) & (b > 0)
        with np.errstate(invalid="ignore"):
            return np.where(hit, (b - np.sqrt(disc)) / rays.length2, np.inf)

    def normal(self, X):
        """Normals (3, n) at the points X (3, n)."""
        along = np.clip(self.axis @ (X - self.a[:, None]) / max(self.axis @ self.axis, 1e-18), 0, 1)
        return (X - self.a[:, None] - self.axis[:, None] * along) / self.radius
